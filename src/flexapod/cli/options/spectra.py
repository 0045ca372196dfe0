"""Spectra of the base's motion or of a load in a CSV file: a frequency and densities by axis, one-sided, per Hz."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from flexapod.conventions import AXES, ROTATIONS, TWO_PI, Array
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError
from flexapod.excitation.spectra import Quantity
from flexapod.tables import Column, Table, Units, naming, parse_table, read_text, unit_named
from flexapod.vibration.source_spectrum import LOAD_AXES

FORM = (
    f"It must have frequency_hz and one or more of {', '.join(AXES)}: spectra of the base's acceleration, (m/s2)2/Hz "
    "or (rad/s2)2/Hz, or of what the units say, as in z_g2/Hz or x_mm2/Hz."
)
LOAD_FORM = (
    f"It must have frequency_hz and one or more of {', '.join(LOAD_AXES)}: spectra of a load, N2/Hz or (N m)2/Hz, or "
    "in the units of their titles, as force_x_lbf2/Hz."
)
FREQUENCY = {"frequency": "frequency", "freq": "frequency", "f": "frequency"}
HERTZ: Units = {"Hz": (1, 1), "mHz": (1, 1e3), "kHz": (1e3, 1), "rad_per_s": (1, TWO_PI)}
KINDS: tuple[Quantity, ...] = ("acceleration", "velocity", "displacement")
#: The dimensions of these, for a translation and a rotation.
LINEAR = ("acceleration", "velocity", "length")
ANGULAR = ("angular acceleration", "angular velocity", "angle")


class Spectra(NamedTuple):
    """Frequencies (n,) Hz, densities (n, 6) per Hz of a quantity, and what there is to say of the file."""

    frequency: Array
    density: Array
    of: Quantity
    notes: list[str]


def read_spectra(path: Path) -> Spectra:
    """The spectra of the base in a file. Raises ArgumentError with the line that is wrong."""
    return _read(path, AXES, FORM)


def read_load(path: Path) -> Spectra:
    """The spectra of a load in a file, (n, 6), forces first. Raises ArgumentError with the line that is wrong."""
    return _read(path, LOAD_AXES, LOAD_FORM)


def _read(path: Path, axes: tuple[str, ...], form: str) -> Spectra:
    text = read_text(path)
    with naming(path):
        table = parse_table(text, {**FREQUENCY, **{axis: axis for axis in axes}}, form)
        frequency = table.column("frequency")
        if frequency is None or len(table.columns) < 2:
            raise ArgumentError(f"it has columns {', '.join(column.title for column in table.columns)}. {form}")
        hertz = table.numbers(frequency, HERTZ, "Hz")
        columns = [column for column in table.columns if column.name in axes]
        kinds = {_quantity(column) for column in columns}
        if len(kinds) > 1 and axes == AXES:
            titles = ", ".join(column.title for column in columns)
            raise ArgumentError(f"{titles} are spectra of {' and '.join(sorted(kinds))}; all must be of one quantity.")
        density = np.zeros((hertz.size, 6))
        for column in columns:
            density[:, axes.index(column.name)] = _densities(table, column)
        first = _first(table, frequency, hertz)
    notes = [f"{path}, line {table.lines[0]}: the density at 0 Hz is left out; a mean is no vibration."] * first
    return Spectra(hertz[first:], density[first:], kinds.pop(), notes)


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
    """What a column's unit says that it is the spectrum of; without a unit acceleration, or the load of its title."""
    if column.name in LOAD_AXES:
        return "force"
    each = _densities_of(column.name)
    found = (kind for kind, units in zip(KINDS, each, strict=True) if column.unit and unit_named(column.unit, units))
    return next(found, "acceleration")


def _densities_of(axis: str) -> list[Units]:
    """Units of the densities of an axis in all that people write: of a motion acceleration, velocity, displacement."""
    if axis in LOAD_AXES:
        dimensions: tuple[str, ...] = (axis.split("_")[0],)
    else:
        dimensions = ANGULAR if axis in ROTATIONS else LINEAR
    return [
        {name: (up**2, down**2) for unit, (up, down) in QUANTITIES[dimension].items() for name in _squares(unit)}
        for dimension in dimensions
    ]


def _squares(unit: str) -> list[str]:
    """The square of a unit per Hz: m_per_s2 -> m_per_s22_per_Hz for (m/s2)2/Hz, m2_per_s4_per_Hz, m2_per_s3."""
    bare, _, rate = unit.partition("_per_")
    if not rate:
        return [f"{bare}2_per_Hz", *([f"{bare}2_s"] if bare != "g" else []), f"{bare.replace('_', '2_')}2_per_Hz"]
    power = 2 if rate == "s" else 4
    return [f"{unit}2_per_Hz", f"{bare}2_per_s{power}_per_Hz", f"{bare}2_per_s{power - 1 if power > 2 else ''}"]
