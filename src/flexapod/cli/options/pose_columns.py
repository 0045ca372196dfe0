"""Poses as columns of a table: x, y, z, and angles in the order of rotation, about the pivot, that the table names.

roll, pitch and yaw are the angles about x, y and z, in whichever order `rotation_order` turns them ("xyz" if nothing
else is said); angle_1, angle_2 and angle_3 are those of any order, the first turn first. A pivot is a point of the
platform, pivot_x, pivot_y, pivot_z in its frame. Order and pivot may differ from row to row; what a table does not say
is as --rotation-order and --pivot say. A table that says what its poses are measured from, base or home, is read for
nothing else.
"""

from __future__ import annotations

import click
import numpy as np

from flexapod.cli.options import common
from flexapod.conventions import AXES, ROTATIONS, TRANSLATIONS, Array
from flexapod.design.units import QUANTITIES
from flexapod.errors import PoseError
from flexapod.pose import Pose
from flexapod.rotations import FIXED, check_order
from flexapod.tables import Table

ANGLES = ("angle_1", "angle_2", "angle_3")
PIVOT = ("pivot_x", "pivot_y", "pivot_z")
ORDER, FROM = "rotation_order", "measured_from"
#: What the titles of a table of poses may be, for `tables.parse_table`.
TITLES = {name: name for name in (*AXES, *ANGLES, *PIVOT, ORDER, FROM)}
#: What `kinematics` writes beside poses: read again, and left out.
BESIDE = ("line", "assembly", "side", "within_limits", "misfit", "status")


def six(table: Table, form: str, bare_angle: str | None = "deg", *, finite: bool = True) -> Array:
    """Rows x, y, z (m), roll, pitch, yaw (rad) about the fixed axes x, y, z; raises the table's error with `form`.

    bare_angle: the unit of angles whose titles name none; None where they must.
    """
    given = {column.name: column for column in table.columns}
    angles = ANGLES if any(name in given for name in ANGLES) else ROTATIONS
    if missing := [name for name in (*TRANSLATIONS, *angles) if name not in given]:
        raise table.error(f"there is no column {', '.join(missing)}. {form}")
    length, angle = QUANTITIES["length"], QUANTITIES["angle"]
    place = [table.numbers(given[name], length, "m", finite) for name in TRANSLATIONS]
    rows = np.column_stack([*place, *(table.numbers(given[name], angle, bare_angle, finite) for name in angles)])
    _check_origin(table)
    orders, pivots = _orders(table, angles), _pivots(table)
    for order in np.unique(orders):
        these = np.flatnonzero((orders == order) & np.isfinite(rows).all(axis=1))
        about = pivots[these]
        if (order != FIXED or about.any()) and these.size:
            turns = rows[these, 3:]
            if angles == ROTATIONS:
                turns = turns[:, ["xyz".index(axis) for axis in order.lower()]]
            pose = Pose.from_angles(rows[these, :3], turns, order, pivot=about)
            rows[these] = np.concatenate([pose.position, pose.rpy], axis=1)
    return rows


def _check_origin(table: Table) -> None:
    """Raises the table's error where its poses are measured from something else than the command line says."""
    column, context = table.column(FROM), click.get_current_context(silent=True)
    if column is None or context is None:
        return
    expected = "home" if context.params.get("from_home") else "base"
    for line, word in zip(table.lines, column.cells, strict=True):
        if word not in ("home", "base"):
            raise table.error(f"line {line}: {FROM} is {word!r}; it must be home or base.")
        if word != expected:
            remedy = "Leave --from-home out" if expected == "home" else "Measure them from the base"
            if expected == "base" and "from_home" in context.params:
                remedy = "Give --from-home"
            raise table.error(f"line {line}: its pose is measured from {word}, and is taken from {expected}. {remedy}.")


def _orders(table: Table, angles: tuple[str, ...]) -> np.ndarray:
    """The order of rotation of each row."""
    column, said = table.column(ORDER), common.turns()[0]
    words = [said or FIXED] * len(table.lines) if column is None else column.cells
    if column is None and said is None and angles == ANGLES:
        raise table.error(
            f"{', '.join(ANGLES)} need an order of rotation. Add a column {ORDER} with, for example, ZXZ, or give "
            "--rotation-order."
        )
    for line, word in zip(table.lines, words, strict=True):
        try:
            check_order(word)
        except PoseError as error:
            raise table.error(f"line {line}: {error}") from None
        if said not in (None, word):
            raise table.error(
                f"line {line}: the order is {word}, and --rotation-order is {said}. Leave one of them out."
            )
        if angles == ROTATIONS and sorted(word.lower()) != ["x", "y", "z"]:
            raise table.error(
                f"line {line}: roll, pitch and yaw turn about x, y and z once each, the order {word} does not. Name "
                f"the columns {', '.join(ANGLES)}."
            )
    return np.array(words, dtype=str)


def _pivots(table: Table) -> Array:
    """The pivot of each row, m, (n, 3)."""
    columns = [table.column(name) for name in PIVOT]
    if not any(columns):
        return np.tile(np.asarray(common.turns()[1] or (0.0, 0.0, 0.0)), (len(table.lines), 1))
    if missing := [name for name, column in zip(PIVOT, columns, strict=True) if column is None]:
        raise table.error(f"there is no column {', '.join(missing)}; a pivot has three. Add the others.")
    found = np.column_stack([table.numbers(column, QUANTITIES["length"], "m") for column in columns if column])
    said = common.turns()[1]
    if said is not None and np.any(found != said):
        raise table.error("its columns pivot_x, ... and --pivot name different points. Leave one of them out.")
    return found


def written(pose: Pose, measured_from: str = "") -> dict[str, Array]:
    """Columns of poses (n,) by title, in the command line's order of rotation and about its pivot, with units."""
    order, pivot = common.turns()
    order, about = order or FIXED, np.asarray(pivot or (0.0, 0.0, 0.0))
    turns = np.degrees(pose.angles(order))
    if sorted(order.lower()) == ["x", "y", "z"]:
        names, turns = ROTATIONS, turns[:, [order.lower().index(axis) for axis in "xyz"]]
    else:
        names = ANGLES
    place = pose.position_about(about)
    columns = {f"{name}_m": place[:, k] for k, name in enumerate(TRANSLATIONS)}
    columns |= {f"{name}_deg": turns[:, k] for k, name in enumerate(names)}
    if order != FIXED:
        columns[ORDER] = np.full(len(place), order)
    if about.any():
        columns |= {f"{name}_m": np.full(len(place), about[k]) for k, name in enumerate(PIVOT)}
    if measured_from:
        columns[FROM] = np.full(len(place), measured_from)
    return columns
