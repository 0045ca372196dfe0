"""The study of `flexapod kinematics`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np

from flexapod.cli.options import pose_columns
from flexapod.conventions import LEGS as NUMBERS
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.design.units import QUANTITIES
from flexapod.mechanics.assembly import forward_kinematics, forward_kinematics_all
from flexapod.mechanics.joint_limits import check_limits, limit_excess
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.pose import Pose
from flexapod.rotations import rpy_matrix
from flexapod.tables import Table, naming, parse_table, read_text, written_table

LEGS = tuple(f"leg{number}" for number in NUMBERS)
_FORM = (
    "Give a column for each leg, leg1 to leg6, or columns x, y, z, roll, pitch, yaw (m, degrees, or units as in "
    "leg1_mm), and if wanted t."
)
_NAMES = {name: name for name in ("t", *LEGS, *pose_columns.BESIDE)} | {"time": "t"}
_TOLD = 20  # rows without an answer that are named


@dataclass(frozen=True)
class Conversion:
    """What came of each row: columns by title, their units among it; notes on rows that have no answer."""

    hexapod: Hexapod
    of: str
    columns: dict[str, Any]
    notes: list[str]

    def to_csv(self) -> str:
        """The rows as the text of a file."""
        return written_table(self.columns)

    def to_dict(self) -> dict[str, Any]:
        """The results as plain data: a row each, with its lengths or its pose as one list."""
        names = list(self.columns)
        rows = [dict(zip(names, row, strict=True)) for row in zip(*self.columns.values(), strict=True)]
        for row in rows:
            if self.of == "lengths":
                row["length_m"] = [row.pop(f"{leg}_m") for leg in LEGS]
        head = {**origin(self.hexapod), "converts_to": self.of}
        return {**head, "rows": rows, "warnings": self.notes}


def compute(hexapod: Hexapod, file: Path, *, start: Pose | None, every: bool, origin: Pose | None = None) -> Conversion:
    """Poses of the lengths in a file, or lengths of its poses, which count from the origin or else from the base."""
    text = read_text(file)
    with naming(file):
        table = parse_table(text, _NAMES | pose_columns.TITLES, _FORM)
        legs = [name for name in LEGS if table.column(name)]
        others = [column.title for column in table.columns if column.name in pose_columns.TITLES]
        if legs and others:
            raise click.UsageError(f"{file} has columns of legs and of poses ({', '.join(others)}). {_FORM}")
        head: dict[str, Any] = {"line": np.array(table.lines)}
        if (time := table.column("t")) is not None:
            head["t_s"] = table.numbers(time, QUANTITIES["time"], "s", finite=False)
        if not legs:
            if every:
                raise click.UsageError("--all gives all poses of leg lengths; FILE has poses. Leave it out.")
            return _lengths(hexapod, head, pose_columns.six(table, _FORM, finite=False), origin)
        lengths = _leg_columns(table)
    given = hexapod, head, lengths, start, origin
    return _all_poses(*given) if every else _poses(*given)


def _leg_columns(table: Table) -> Array:
    columns = {name: table.column(name) for name in LEGS}
    if missing := [name for name, column in columns.items() if column is None]:
        raise table.error(f"there is no column {', '.join(missing)}. {_FORM}")
    length = QUANTITIES["length"]
    return np.column_stack([table.numbers(column, length, "m", finite=False) for column in columns.values() if column])


def _lengths(hexapod: Hexapod, head: dict[str, Any], rows: Array, origin: Pose | None) -> Conversion:
    pose = Pose.trusted(rows[:, :3], rpy_matrix(rows[:, 3:]))
    if origin is not None:
        pose = origin.displaced(pose)
    lengths = inverse_kinematics(hexapod, pose)
    status = np.where(np.isfinite(rows).all(axis=1), "no_leg", "not_finite")
    status = np.where(np.isfinite(lengths).all(axis=1), "ok", status)
    columns = {**head, **{f"{leg}_m": lengths[:, k] for k, leg in enumerate(LEGS)}, **_kept(hexapod, pose)}
    columns["status"] = status
    return Conversion(hexapod, "lengths", columns, [*_told(head["line"], status, ("ok",)), *_beyond(columns)])


def _poses(
    hexapod: Hexapod, head: dict[str, Any], lengths: Array, start: Pose | None, origin: Pose | None
) -> Conversion:
    found = forward_kinematics(hexapod, lengths, start=start)
    columns = {**head, **_from(found, origin), **_kept(hexapod, found)}
    columns |= {"misfit_m": found.misfit, "status": found.status}
    notes = _told(head["line"], found.status, ("found", "nearest"))
    far = int((found.status == "nearest").sum())
    if far:
        notes.append(
            f"{far} of {len(lengths)} poses are not where the search led from the start, but the nearest of all "
            'assemblies on its side of the singular poses (status "nearest"); --all shows the others.'
        )
    return Conversion(hexapod, "poses", columns, [*notes, *_beyond(columns)])


def _from(pose: Pose, origin: Pose | None) -> dict[str, Array]:
    """Columns of poses in the base frame, or as they count from an origin: the inverse of `Pose.displaced`."""
    if origin is None:
        return pose_columns.written(pose)
    counted = Pose.trusted(pose.position - origin.position, pose.matrix @ origin.matrix.T)
    return pose_columns.written(counted, measured_from="home")


def _all_poses(
    hexapod: Hexapod, head: dict[str, Any], lengths: Array, start: Pose | None, origin: Pose | None
) -> Conversion:
    found = forward_kinematics_all(hexapod, lengths, start=start)
    row = found.row
    first = np.searchsorted(row, row)  # of each row's assemblies
    columns = {name: values[row] for name, values in head.items()}
    columns |= {
        "assembly": np.arange(len(row)) - first + 1,
        **_from(found.pose, origin),
        "side": found.side,
    }
    columns |= {**_kept(hexapod, found.pose), "misfit_m": found.misfit, "status": found.status[row]}
    notes = _told(head["line"], found.status, ("complete",))
    none = np.setdiff1d(np.flatnonzero(found.status == "complete"), row)
    if none.size:
        notes.append(f"no real assembly has the lengths of {_lines(head['line'][none])}.")
    return Conversion(hexapod, "poses", columns, [*notes, *_beyond(columns)])


def _kept(hexapod: Hexapod, pose: Pose) -> dict[str, np.ndarray]:
    """Whether poses keep the design's limits, where it has some."""
    limited = bool(limit_excess(hexapod, pose))
    return {"within_limits": check_limits(hexapod, pose).ok.astype(int)} if limited else {}


def _beyond(columns: dict[str, Any]) -> list[str]:
    """Which poses that were found break the design's limits."""
    if "within_limits" not in columns:
        return []
    good = np.isin(columns["status"], ("ok", "found", "nearest", "complete"))
    broken = good & (columns["within_limits"] == 0)
    if not broken.any():
        return []
    where = _lines(np.unique(columns["line"][broken]))
    text = f"{broken.sum()} of {good.sum()} poses break the design's limits, {where}: `flexapod check` says which."
    return [text]


def _told(lines: np.ndarray, status: np.ndarray, good: tuple[str, ...]) -> list[str]:
    bad = np.setdiff1d(np.unique(status), good)
    return [f"{(status == word).sum()} of {len(status)} rows: {word}, {_lines(lines[status == word])}." for word in bad]


def _lines(lines: np.ndarray) -> str:
    """Names of lines, not all of many."""
    told = ", ".join(str(line) for line in lines[:_TOLD])
    return f"line{'s' * (len(lines) > 1)} {told}" + (f" and {len(lines) - _TOLD} more" if len(lines) > _TOLD else "")
