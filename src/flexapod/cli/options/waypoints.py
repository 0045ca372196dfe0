"""Waypoints as a CSV file: t in s, x, y, z in m, roll, pitch, yaw in degrees, and, where wanted, weight."""

from __future__ import annotations

from pathlib import Path

from flexapod.cli.options import pose_columns
from flexapod.conventions import AXES
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError
from flexapod.paths.trajectory import Ends, Trajectory
from flexapod.pose import Pose
from flexapod.tables import naming, parse_table, read_text, written_table

COLUMNS = ("t", *AXES)
NAMES = {"t": "t", "time": "t", "weight": "weight"} | pose_columns.TITLES | {name: name for name in pose_columns.BESIDE}
FORM = f"Its first line must be {','.join(COLUMNS)} and may end in ,weight (s, m, degrees, or units as in x_mm)."


def read(file: Path, ends: Ends, origin: Pose | None = None) -> Trajectory:
    """The trajectory in a file, from an origin. Raises ArgumentError, with the line, if it is not such a file."""
    text = read_text(file)
    with naming(file):
        table = parse_table(text, NAMES, FORM)
        columns = {column.name: column for column in table.columns}
        if "t" not in columns:
            raise ArgumentError(f"there is no column t. {FORM}")
        times = table.numbers(columns["t"], QUANTITIES["time"])
        weights = table.numbers(columns["weight"]) if "weight" in columns else None
        return Trajectory(pose_columns.six(table, FORM), times, ends=ends, weights=weights, origin=origin)


def written(path: Trajectory) -> str:
    """A path as the text of a file, which says how its angles turn."""
    return written_table({"t_s": path.times, **pose_columns.written(path.waypoints)})
