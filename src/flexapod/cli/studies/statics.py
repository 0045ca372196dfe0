"""The study of `flexapod statics`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click
import numpy as np

from flexapod.cli.options import common, pose_columns
from flexapod.cli.options.given import needed
from flexapod.cli.options.quantities import read
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.units import QUANTITIES
from flexapod.mechanics.load_cases import gravity_at, load_cases
from flexapod.pose import Pose
from flexapod.report.studies.statics import StaticsFindings, study
from flexapod.report.study import Study
from flexapod.rotations import rpy_matrix
from flexapod.tables import Table, naming, parse_table, read_text

if TYPE_CHECKING:
    from flexapod.cli.options.points import PointGiven
    from flexapod.conventions import JointModel

_VECTORS = {
    "gravity": ("acceleration", "m_per_s2"),
    "force": ("force", "N"),
    "moment": ("moment", "N_m"),
    "at": ("length", "m"),
}
_ANGLES = ("elevation", "base_roll")
_FORM = (
    "Give a row for each case, with columns elevation, base_roll (degrees), or gravity_x, gravity_y, gravity_z; "
    "force_x, ..., moment_x, ..., at_x, ...; x, y, z, roll, pitch, yaw of the pose; each if wanted, and case, its name."
)
_MOST = 100_000  # cases


@dataclass(frozen=True)
class Options:
    """The command line, as given."""

    design: str
    file: Path | None
    changes: tuple[str, ...]
    joint: JointModel
    pose: tuple[float, ...] | None
    elevation: str | None
    base_roll: str | None
    reference: str | None
    point: PointGiven
    axes: Any


class _Cases(NamedTuple):
    """Cases by name: elevation (rad) where it is given, the gravity that follows, what else `load_cases` takes."""

    names: list[str]
    elevation: Array | None
    gravity: Array | None
    loads: dict[str, Any]


def compute(options: Options) -> Study:
    """The load cases of the options."""
    needed(options.file, "the forces and moments of FILE", "axes")
    hexapod = common.load_design(options.design, options.changes)
    cases = _of_file(hexapod, options) if options.file is not None else _of_elevations(hexapod, options)
    pose = cases.loads.pop("pose", None)
    if pose is None:
        pose = common.chosen_pose(hexapod, options.pose)
    elif options.pose is not None:
        raise click.UsageError("--pose and columns of FILE both give the pose. Leave one of them out.")
    reference = _reference(cases, options.reference)
    found = load_cases(
        hexapod,
        pose,
        gravity=cases.gravity,
        **cases.loads,
        axes=options.axes,
        point=options.point,
        reference=reference,
        joint=options.joint,
    )
    varies = cases.elevation is not None and np.unique(cases.elevation).size > 1
    names = cases.names or ["1"]
    return study(hexapod, StaticsFindings(found, names, cases.elevation if varies else None, reference))


def _of_elevations(hexapod: Hexapod, options: Options) -> _Cases:
    if options.elevation is None:
        if options.base_roll is not None:
            raise click.UsageError("--base-roll turns the base at an elevation. Give --elevation as well.")
        return _Cases(["1"], None, None, {})
    parts = options.elevation.split(":")
    count = parts[2].strip() if len(parts) == 3 else "1"
    if len(parts) not in (1, 3) or not (count.isascii() and count.isdigit() and 1 <= int(count[:9]) <= _MOST):
        raise click.UsageError(
            f"--elevation {options.elevation} is no range; write FIRST:LAST:COUNT, as 90:15:6, or one angle, with at "
            f"least 1 and at most {_MOST} angles."
        )
    ends = [read(text, "angle", "--elevation", "deg") for text in parts[:2]]
    degrees = np.linspace(ends[0], ends[-1], int(count))
    roll = math.radians(read(options.base_roll or "0", "angle", "--base-roll", "deg"))
    elevation = np.radians(degrees)
    return _Cases([f"{angle:.6g}" for angle in degrees], elevation, _gravity(hexapod, elevation, roll), {})


def _gravity(hexapod: Hexapod, elevation: Array, roll: Array | float) -> Array:
    size = float(np.linalg.norm(hexapod.gravity))
    if size == 0:
        raise click.UsageError(
            f"{hexapod.name!r} has no gravity that an elevation could turn. Set it, as --set gravity=[0,0,-9.81]."
        )
    return gravity_at(elevation, roll, magnitude=size)


def _of_file(hexapod: Hexapod, options: Options) -> _Cases:
    assert options.file is not None
    if options.elevation is not None or options.base_roll is not None:
        raise click.UsageError("FILE and --elevation both give cases. Leave one of them out.")
    vectors = [f"{name}_{axis}" for name in _VECTORS for axis in "xyz"]
    known = {name: name for name in (*vectors, *_ANGLES, "case")} | pose_columns.TITLES
    text = read_text(options.file)
    with naming(options.file):
        table = parse_table(text, known, _FORM)
        count = len(table.lines)
        if not 1 <= count <= _MOST:
            raise table.error(f"there are {count} cases; there must be 1 to {_MOST}. {_FORM}")
        loads: dict[str, Any] = {name: _vector(table, name) for name in _VECTORS}
        gravity, elevation = loads.pop("gravity"), None
        if loads["at"] is not None and loads["force"] is None:
            raise table.error("at_x, ... say where a force acts, and there is none. Give force_x, ... as well.")
        if (column := table.column("elevation")) is not None:
            if gravity is not None:
                raise table.error("elevation and gravity_x, ... both give gravity. Leave one of them out.")
            elevation = table.numbers(column, QUANTITIES["angle"], "deg")
            rolled = table.column("base_roll")
            roll = 0.0 if rolled is None else table.numbers(rolled, QUANTITIES["angle"], "deg")
            gravity = _gravity(hexapod, elevation, roll)
        elif table.column("base_roll") is not None:
            raise table.error("base_roll turns the base at an elevation. Give a column elevation as well.")
        posed = any(column.name in pose_columns.TITLES for column in table.columns)
        common.turning_needs(posed or options.pose)
        if posed:
            rows = pose_columns.six(table, _FORM)
            loads["pose"] = Pose(rows[:, :3], rpy_matrix(rows[:, 3:]))
        given = table.column("case")
        names = (
            [cell or str(k) for k, cell in enumerate(given.cells, 1)] if given else [str(k + 1) for k in range(count)]
        )
    if gravity is None:
        gravity = np.tile(hexapod.gravity, (count, 1))
    return _Cases(names, elevation, gravity, {name: value for name, value in loads.items() if value is not None})


def _vector(table: Table, name: str) -> Array | None:
    """Three columns of a vector; those left out are zero, None where all are."""
    dimension, unit = _VECTORS[name]
    columns = [table.column(f"{name}_{axis}") for axis in "xyz"]
    if not any(columns):
        return None
    zero = np.zeros(len(table.lines))
    return np.column_stack([zero if c is None else table.numbers(c, QUANTITIES[dimension], unit) for c in columns])


def _reference(cases: _Cases, name: str | None) -> int | None:
    if name is None:
        return None
    found = [k for k, one in enumerate(cases.names) if one == name.strip()]
    if len(found) != 1:
        known = ", ".join(cases.names[:8]) + (" and more" if len(cases.names) > 8 else "")
        raise click.UsageError(
            f"--reference {name} names {len(found) or 'no'} case{'s' * (len(found) > 1)}; the cases are {known}."
        )
    return found[0]
