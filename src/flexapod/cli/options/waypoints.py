"""Waypoints as a CSV file: t in s, x, y, z in m, roll, pitch, yaw in degrees, and, where wanted, weight."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from flexapod.paths.trajectory import Ends, Trajectory

COLUMNS = ("t", "x", "y", "z", "roll", "pitch", "yaw")


def read(file: Path, ends: Ends) -> Trajectory:
    """The path of a file. Raises UsageError, with the line, for what is no such file."""
    import numpy as np

    from flexapod.paths.trajectory import Trajectory
    from flexapod.pose import Pose

    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise click.UsageError(f"{file} cannot be read: {error}.") from error
    lines = [line for line in csv.reader(text.splitlines()) if line and not line[0].lstrip().startswith("#")]
    head = [name.strip() for name in lines[0]] if lines else []
    if head not in ([*COLUMNS], [*COLUMNS, "weight"]):
        raise click.UsageError(
            f"{file} begins with {','.join(head) or 'nothing'}; its first line must be {','.join(COLUMNS)} and may "
            "end in ,weight (s, m, degrees)."
        )
    rows = []
    for number, line in enumerate(lines[1:], start=1):
        try:
            rows.append([float(cell) for cell in line])
        except ValueError:
            rows.append([])
        if len(rows[-1]) != len(head):
            raise click.UsageError(f"{file}: waypoint {number} is {','.join(line)}; {len(head)} numbers are needed.")
    table = np.array(rows).reshape(-1, len(head))
    poses = Pose.from_rpy(*table[:, 1:4].T, *np.radians(table[:, 4:7]).T)
    return Trajectory(poses, table[:, 0], ends, table[:, 7] if len(head) > len(COLUMNS) else None)


def written(path: Trajectory) -> str:
    """A path as the text of a file."""
    import numpy as np

    table = np.column_stack([path.times, path.waypoints.position, np.degrees(path.waypoints.rpy)])
    lines = (",".join(f"{value:.12g}" for value in row) for row in table)
    return "\n".join([",".join(COLUMNS), *lines]) + "\n"
