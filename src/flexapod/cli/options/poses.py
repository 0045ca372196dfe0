"""Sets of poses as a command line says them: boxes, grids, files. Lengths in m, angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click
import numpy as np

from flexapod.cli.options import pose_columns
from flexapod.cli.options.quantities import read
from flexapod.conventions import AXES, ROTATIONS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.kinematics import home_pose
from flexapod.tables import naming, parse_table, read_text
from flexapod.workspace.box import Box
from flexapod.workspace.pose_sets import PoseSet
from flexapod.workspace.quantities import QUANTITIES as SWEPT
from flexapod.workspace.quantities import table_titles
from flexapod.workspace.sampling import pose_grid

_MOST_VALUES = 10**7  # of one axis of a grid
_FORM = (
    "Give rows of six columns x,y,z,roll,pitch,yaw (m, degrees), with or without these titles; titles may name other "
    "units, as x_mm or roll_rad, and stand in any order; columns rotation_order, pivot_x, pivot_y and pivot_z say "
    "how they turn."
)


def box_of(hexapod: Hexapod, texts: Iterable[str], around: tuple[float, float] | None) -> Box:
    """The box of `--box x=-0.1:0.1,roll=-10:10 ...` or `--around 0.1 10`; the rest is held at the home pose."""
    parts = _parts("--box", texts)
    if around is not None:
        if parts:
            raise click.UsageError("--box and --around both give a box. Leave one of them out.")
        return Box.about(_home(hexapod, "--around"), around[0], math.radians(around[1]))
    ranges = {name: [_number("--box", name, text) for text in value.split(":")] for name, value in parts.items()}
    for name, bounds in ranges.items():
        if len(bounds) > 2:
            raise click.UsageError(
                f"--box {name}={parts[name]} is no range; write least:largest, such as {name}=-0.1:0.1."
            )
    return Box(**_with_home(hexapod, "--box", ranges))


def grid_of(hexapod: Hexapod, texts: Iterable[str]) -> PoseSet:
    """The grid of `--grid x=-0.1:0.1:21,z=0.8`: first:last:count, or one value."""
    axes: dict[str, Any] = {}
    for name, value in _parts("--grid", texts).items():
        numbers = value.split(":")
        count = numbers[2].strip() if len(numbers) == 3 else "1"
        if len(numbers) not in (1, 3) or not (count.isascii() and count.isdigit()):
            raise click.UsageError(
                f"--grid {name}={value} is no axis; write first:last:count, such as {name}=-0.1:0.1:21, or one value."
            )
        ends = [_number("--grid", name, text) for text in numbers[:2]]
        if len(count) > len(str(_MOST_VALUES)) or not 1 <= int(count) <= _MOST_VALUES:
            raise click.UsageError(
                f"--grid {name}={value if len(value) < 60 else value[:57] + '...'} has the wrong number of values; its "
                f"count must be at least 1 and at most {_MOST_VALUES}."
            )
        axes[name] = np.linspace(ends[0], ends[1], int(count)) if len(numbers) == 3 else ends[0]
    return pose_grid(**_with_home(hexapod, "--grid", axes))


def read_poses(path: Path) -> Array:
    """Poses, rows x y z (m) roll pitch yaw (rad), of a .npy file (m, degrees), or of a .csv file."""
    rows = _read_npy(path) if path.suffix == ".npy" else _read_csv(path)
    if not len(rows):
        raise click.UsageError(f"{path} is empty: it holds no pose. {_FORM}")
    return rows


def _read_npy(path: Path) -> Array:
    try:
        rows = np.load(path, allow_pickle=False, mmap_mode="r")
    except (OSError, ValueError, EOFError) as error:
        raise click.UsageError(f"{path} cannot be read: {error}. {_FORM}") from None
    if not isinstance(rows, np.ndarray) or rows.dtype.kind not in "fiu":
        kind = f"numbers of type {rows.dtype}" if isinstance(rows, np.ndarray) else "several arrays"
        raise click.UsageError(f"{path} holds {kind}; it must hold real numbers. {_FORM}")
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise click.UsageError(f"{path} has shape {rows.shape}. {_FORM}")
    found = np.array(rows, dtype=np.float64)
    found[:, 3:] = np.radians(found[:, 3:])
    return found


def _read_csv(path: Path) -> Array:
    """Columns by their names. In those of `sweep` and `kinematics`, others are left out, and angles name their unit.

    Tables of sweeps once had radians there under the names that stand for degrees in files of poses.
    """
    text = read_text(path)
    swept = ["t", *pose_columns.BESIDE, *(title for name in SWEPT for title in table_titles(name))]
    with naming(path):
        table = parse_table(text, {name: name for name in swept} | pose_columns.TITLES, _FORM, titles=AXES)
        bare = None if any(column.name not in pose_columns.TITLES for column in table.columns) else "deg"
        return pose_columns.six(table, _FORM, bare, finite=False)


def _parts(option: str, texts: Iterable[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text in ",".join(texts).replace(" ", "").split(","):
        if not text:
            continue
        name, equals, value = text.partition("=")
        if name not in AXES or not equals or not value:
            raise click.UsageError(
                f"{option} {text} says nothing about a coordinate; write NAME=VALUES with a name of "
                f"{', '.join(AXES)} (m, degrees)."
            )
        if name in found:
            raise click.UsageError(f"{option} gives {name} twice. Leave one of them out.")
        found[name] = value
    return found


def _number(option: str, name: str, text: str) -> float:
    if name in ROTATIONS:
        return math.radians(read(text, "angle", f"{option} {name}", "deg"))
    return read(text, "length", f"{option} {name}")


def _with_home(hexapod: Hexapod, option: str, given: dict[str, Any]) -> dict[str, Any]:
    """The coordinates that were not named, from the home pose."""
    if len(given) == len(AXES):
        return given
    home = _home(hexapod, option)
    values = [*home.position, *home.rpy]
    return {name: given.get(name, value) for name, value in zip(AXES, values, strict=True)}


def _home(hexapod: Hexapod, option: str) -> Any:
    home = home_pose(hexapod)
    if home is None:
        raise click.UsageError(
            f"{hexapod.name!r} names no home pose. Name all six coordinates with {option}, or add [home] to the design."
            if option != "--around"
            else f"{hexapod.name!r} names no home pose for --around. Use --box, or add [home] to the design."
        )
    return home
