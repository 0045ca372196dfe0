"""Spectra of the base's motion in a CSV file: a frequency and densities by axis, one-sided, per Hz."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from flexapod.conventions import AXES, ROTATIONS, TWO_PI, Array
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError
from flexapod.excitation.spectra import Quantity
from flexapod.tables import Column, Table, Units, naming, parse_table, read_text, unit_named

FORM = (
    f"It must have frequency_hz and one or more of {', '.join(AXES)}: spectra of the base's acceleration, (m/s2)2/Hz "
    "or (rad/s2)2/Hz, or of what the units say, as in z_g2/Hz or x_mm2/Hz."
)
NAMES = {"frequency": "frequency", "freq": "frequency", "f": "frequency", **{axis: axis for axis in AXES}}
HERTZ: Units = {"Hz": (1, 1), "mHz": (1, 1e3), "kHz": (1e3, 1), "rad_per_s": (1, TWO_PI)}
KINDS: tuple[Quantity, ...] = ("acceleration", "velocity", "displacement")
#: The dimensions of these, for a translation and a rotation.
LINEAR = ("acceleration", "velocity", "length")
ANGULAR = ("angular acceleration", "angular velocity", "angle")


class BaseSpectra(NamedTuple):
    """Frequencies (n,) Hz, densities (n, 6) per Hz of a quantity of the base, and what there is to say of the file."""

    frequency: Array
    density: Array
    of: Quantity
    notes: list[str]


def read_spectra(path: Path) -> BaseSpectra:
    """The spectra in a file. Raises ArgumentError with the line that is wrong."""
    text = read_text(path)
    with naming(path):
        table = parse_table(text, NAMES, FORM)
        frequency = table.column("frequency")
        if frequency is None or len(table.columns) < 2:
            raise ArgumentError(f"it has columns {', '.join(column.title for column in table.columns)}. {FORM}")
        hertz = table.numbers(frequency, HERTZ, "Hz")
        columns = [column for column in table.columns if column.name in AXES]
        kinds = {_quantity(column) for column in columns}
        if len(kinds) > 1:
            titles = ", ".join(column.title for column in columns)
            raise ArgumentError(f"{titles} are spectra of {' and '.join(sorted(kinds))}; all must be of one quantity.")
        density = np.zeros((hertz.size, 6))
        for column in columns:
            density[:, AXES.index(column.name)] = _densities(table, column)
        first = _first(table, frequency, hertz)
    notes = [f"{path}, line {table.lines[0]}: the density at 0 Hz is left out; a mean is no vibration."] * first
    return BaseSpectra(hertz[first:], density[first:], kinds.pop(), notes)


def _densities(table: Table, column: Column) -> Array:
    units = {unit: factor for each in _densities_of(column.name) for unit, factor in each.items()}
    values = table.numbers(column, units)
    wrong = np.flatnonzero(values < 0)
    if wrong.size:
        line, cell = table.lines[wrong[0]], column.cells[wrong[0]]
        raise ArgumentError(f"line {line}, column {column.title}: {cell} is negative; a density is not.")
    return values


def _first(table: Table, column: Column, hertz: Array) -> int:
    """1 where the first line is that of 0 Hz, as Welch's method gives it, else 0; frequencies ascend from there."""
    first = int(hertz.size > 0 and hertz[0] == 0)
    wrong = np.flatnonzero(np.diff(hertz) <= 0)
    if wrong.size or (hertz[first:] <= 0).any():
        i = int(wrong[0]) + 1 if wrong.size else 0
        raise ArgumentError(
            f"line {table.lines[i]}, column {column.title}: {column.cells[i]} Hz; frequencies must be above zero and "
            "ascending. Sort the lines, each frequency once."
        )
    if hertz.size - first < 2:
        raise ArgumentError(f"it has {hertz.size - first} frequencies above 0 Hz; two or more are needed.")
    return first


def _quantity(column: Column) -> Quantity:
    """What a column's unit says that it is the spectrum of; acceleration without a unit."""
    each = _densities_of(column.name)
    found = (kind for kind, units in zip(KINDS, each, strict=True) if column.unit and unit_named(column.unit, units))
    return next(found, "acceleration")


def _densities_of(axis: str) -> list[Units]:
    """Units of the densities of an axis, of acceleration, velocity and displacement, in all that people write."""
    return [
        {name: (up**2, down**2) for unit, (up, down) in QUANTITIES[dimension].items() for name in _squares(unit)}
        for dimension in (ANGULAR if axis in ROTATIONS else LINEAR)
    ]


def _squares(unit: str) -> list[str]:
    """The square of a unit per Hz: m_per_s2 -> m_per_s22_per_Hz for (m/s2)2/Hz, m2_per_s4_per_Hz, m2_per_s3."""
    bare, _, rate = unit.partition("_per_")
    if not rate:
        return [f"{bare}2_per_Hz", *([f"{bare}2_s"] if bare != "g" else [])]
    power = 2 if rate == "s" else 4
    return [f"{unit}2_per_Hz", f"{bare}2_per_s{power}_per_Hz", f"{bare}2_per_s{power - 1 if power > 2 else ''}"]
