"""Loads on the platform, given one by one or as a CSV file: a row for each, with mass, centre, inertia and forces."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from flexapod.conventions import Array
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError
from flexapod.paths.payloads import PayloadCase
from flexapod.tables import Table, naming, parse_table, read_text

AS_IT_IS = "design"  #: what the machine without payloads is called beside them
_INERTIA = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}
_COLUMNS = {
    "mass": "mass",
    **dict.fromkeys("xyz", "length"),
    **dict.fromkeys(_INERTIA, "inertia"),
    **{f"force_{axis}": "force" for axis in "xyz"},
    **{f"moment_{axis}": "moment" for axis in "xyz"},
}
_FORM = (
    "Give a row for each payload, with columns case (its name), mass (kg), x, y, z (its centre, m, platform frame), "
    "ixx, iyy, izz, ixy, ixz, iyz (about its centre, kg m2), force_x, ..., moment_x, ... (platform axes), each if "
    "wanted."
)


def read(given: Iterable[tuple[float, ...]], file: Path | None) -> list[PayloadCase]:
    """The machine as it is, and the payloads of the command line and of a file; nothing where there are none.

    Raises ArgumentError for what is none, with its line.
    """
    found = [
        PayloadCase(f"{mass:.6g} kg at {x:.6g} {y:.6g} {z:.6g} m", mass, np.array([x, y, z])) for mass, x, y, z in given
    ]
    if file is not None:
        text = read_text(file)
        with naming(file):
            found += _cases(parse_table(text, {name: name for name in (*_COLUMNS, "case")}, _FORM))
    return [PayloadCase(AS_IT_IS), *found] if found else []


def _cases(table: Table) -> list[PayloadCase]:
    count = len(table.lines)
    if not count:
        raise ArgumentError(f"there are no rows. {_FORM}")
    values = {name: np.zeros(count) for name in _COLUMNS}
    for column in table.columns:
        if column.name != "case":
            values[column.name] = table.numbers(column, QUANTITIES[_COLUMNS[column.name]])
    inertia = np.zeros((count, 3, 3))
    for name, (i, j) in _INERTIA.items():
        inertia[:, i, j] = inertia[:, j, i] = values[name]
    place, force, moment = (_vector(values, start) for start in ("", "force_", "moment_"))
    given = table.column("case")
    names = [str(k + 1) for k in range(count)] if given is None else given.cells
    found = []
    for k, line in enumerate(table.lines):
        with naming(f"line {line}"):
            if names[k] == AS_IT_IS:
                raise ArgumentError(
                    f"a payload is called {AS_IT_IS!r}, as the machine without payloads is called beside them. Give it "
                    "another name."
                )
            found.append(PayloadCase(names[k], float(values["mass"][k]), place[k], inertia[k], force[k], moment[k]))
    return found


def _vector(values: dict[str, Array], start: str) -> Array:
    return np.column_stack([values[f"{start}{axis}"] for axis in "xyz"])
