"""Sets of poses as a command line says them: boxes, grids, files. Lengths in m, angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click
import numpy as np

from flexapod.conventions import AXES, ROTATIONS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError
from flexapod.mechanics.kinematics import home_pose
from flexapod.tables import naming, parse_table, read_text
from flexapod.workspace.box import Box
from flexapod.workspace.pose_sets import PoseSet
from flexapod.workspace.sampling import pose_grid

_FORM = "Give rows of six columns x,y,z,roll,pitch,yaw (m, degrees), with or without these titles."


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
        if len(numbers) not in (1, 3) or (len(numbers) == 3 and not numbers[2].strip().isdigit()):
            raise click.UsageError(
                f"--grid {name}={value} is no axis; write first:last:count, such as {name}=-0.1:0.1:21, or one value."
            )
        ends = [_number("--grid", name, text) for text in numbers[:2]]
        if len(numbers) == 3 and int(numbers[2]) < 1:
            raise click.UsageError(f"--grid {name}={value} has no value; its count must be at least 1.")
        axes[name] = np.linspace(ends[0], ends[1], int(numbers[2])) if len(numbers) == 3 else ends[0]
    return pose_grid(**_with_home(hexapod, "--grid", axes))


def read_poses(path: Path) -> Array:
    """Rows x y z (m) roll pitch yaw (deg) of a .npy file, or of a .csv file with or without a line of names."""
    if path.suffix != ".npy":
        return _read_csv(path)
    try:
        rows = np.load(path, allow_pickle=False).astype(np.float64)
    except (OSError, ValueError) as error:
        raise click.UsageError(f"{path} cannot be read: {error}. {_FORM}") from None
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise click.UsageError(f"{path} has shape {rows.shape}. {_FORM}")
    rows[:, 3:] = np.radians(rows[:, 3:])
    return rows


def _read_csv(path: Path) -> Array:
    text = read_text(path)
    with naming(path):
        table = parse_table(text, {axis: axis for axis in AXES}, _FORM, titles=AXES)
        columns = {column.name: column for column in table.columns}
        if missing := [axis for axis in AXES if axis not in columns]:
            raise ArgumentError(f"there is no column {', '.join(missing)}. {_FORM}")
        units = {axis: QUANTITIES["angle" if axis in ROTATIONS else "length"] for axis in AXES}
        default = {axis: "deg" if axis in ROTATIONS else "m" for axis in AXES}
        return np.column_stack([table.numbers(columns[a], units[a], default[a], finite=False) for a in AXES])


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
    try:
        number = float(text)
    except ValueError:
        raise click.UsageError(f"{option} {name}: {text!r} is no number.") from None
    return math.radians(number) if name in ROTATIONS else number


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
