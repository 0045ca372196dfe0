"""Tables in CSV files, as loggers, spreadsheets and CAD programs write them.

Commas, semicolons or tabs separate; with the last two, numbers may have decimal commas. Titles are read without regard
to case, and may end in a unit: `z_um`, `Base X [mm]`, `Frequency (Hz)`. Lines that begin with # and empty ones are left
out, and columns that are titled name, note, comment, part or remark.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.errors import ArgumentError, FlexapodError

LEFT_OUT = ("name", "note", "comment", "part", "remark")
#: Unit -> (multiply by, divide by), to SI. Two numbers, because x / 1000 is rounded once and x * 0.001 is not.
Units = Mapping[str, tuple[float, float]]
TIMES: Units = {"s": (1, 1), "ms": (1, 1e3), "us": (1, 1e6), "min": (60, 1)}


@dataclass(frozen=True)
class Column:
    """A column: its title as written, what it stands for, its unit ("" if none is named), and its cells by line."""

    title: str
    name: Any
    unit: str
    cells: list[str]


@dataclass(frozen=True)
class Table:
    """A table by columns; `lines` are the numbers of its lines in the file, and `error` is what its methods raise."""

    columns: list[Column]
    lines: list[int]
    error: type[FlexapodError]

    def column(self, name: Any) -> Column | None:
        """The column that stands for a name, if there is one."""
        return next((column for column in self.columns if column.name == name), None)

    def numbers(self, column: Column, units: Units | None = None, default: str = "", finite: bool = True) -> Array:
        """The numbers of a column in SI units; those of a column without a unit are in the unit `default`.

        finite: NaN, infinity and empty cells are refused; else they are NaN.
        """
        multiply, divide = self._factor(column, units or {}, default)
        values = [_number(cell or "nan") for cell in column.cells]
        wrong = [k for k, value in enumerate(values) if value is None or (finite and not math.isfinite(value))]
        if wrong:
            raise self.error(
                f"line {self.lines[wrong[0]]}, column {column.title}: {column.cells[wrong[0]]!r} is no "
                f"{'finite ' * finite}number. Write it as -12.5 or 1.25e1."
            )
        with np.errstate(over="ignore"):  # an infinite result is refused with the value as it was given
            return np.array(values, dtype=np.float64) * multiply / divide

    def _factor(self, column: Column, units: Units, default: str) -> tuple[float, float]:
        unit = column.unit or default
        if unit in units:
            return units[unit]
        alike = [known for known in units if _bare(known) == _bare(unit)]
        if len(alike) == 1 and alike[0].islower():  # MM is mm, but MN is not mN, nor Nm nm
            return units[alike[0]]
        if not unit:
            return 1.0, 1.0
        allowed = f"it may be {', '.join(units)}" if units else "this column has none"
        raise self.error(f"column {column.title!r} has the unit {column.unit!r}; {allowed}. Correct the header.")


def read_text(file: Path, error: type[FlexapodError] = ArgumentError) -> str:
    """A file in UTF-8, without the mark that some editors put at its start."""
    try:
        return file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise error(f"{file} is not a text file in UTF-8. Export the table as CSV in UTF-8.") from None
    except (OSError, ValueError) as reason:  # ValueError: a name that no file can have
        words = getattr(reason, "strerror", None) or reason
        raise error(f"{file} cannot be read: {words}. Check the name and its folder.") from reason


@contextmanager
def naming(file: str | Path, error: type[FlexapodError] = ArgumentError) -> Iterator[None]:
    """Puts the name of a file before what an error says."""
    try:
        yield
    except error as reason:
        raise error(f"{file}: {reason}") from reason


def parse_table(
    text: str,
    names: Mapping[str, Any],
    form: str,
    error: type[FlexapodError] = ArgumentError,
    titles: Sequence[str] = (),
) -> Table:
    """The table in a text.

    names: what a title may be -> what it stands for; parts of a name that are joined by _ may be written otherwise, as
    `Base X`. form: sentences that say what is expected, for errors. titles: those of a table that has none, which
    begins with numbers.
    """
    given = [(n, line) for n, line in enumerate(text.lstrip("\ufeff").splitlines(), 1) if line.strip(" \t,;")]
    given = [(n, line) for n, line in given if not line.lstrip().startswith("#")]
    if not given:
        raise error(f"there is nothing in it. {form}")
    separator = next((mark for mark in (";", "\t") if mark in given[0][1]), ",")
    reader = csv.reader((line for _, line in given), delimiter=separator, skipinitialspace=True)
    try:
        rows = [(given[reader.line_num - 1][0], [cell.strip() for cell in row]) for row in reader]
    except csv.Error as reason:
        raise error(f"it is no CSV file: {reason}. Export the table as CSV.") from reason
    head = (
        list(titles)
        if titles and all(_number(cell.replace(",", ".")) is not None for cell in rows[0][1])
        else rows.pop(0)[1]
    )
    _trim(head, rows, error)
    columns: list[Column] = []
    for place, title in enumerate(head):
        if title.lower() in LEFT_OUT:
            continue
        name, unit = _meaning(title, names)
        if name is None:
            raise error(f"column {title!r} is unknown. {form}")
        same = next((column for column in columns if column.name == name), None)
        if same:
            raise error(f"columns {same.title!r} and {title!r} are the same. Leave one of them out.")
        cells = [row[place] if separator == "," else row[place].replace(",", ".") for _, row in rows]
        columns.append(Column(title, name, unit, cells))
    return Table(columns, [line for line, _ in rows], error)


def _trim(head: list[str], rows: list[tuple[int, list[str]]], error: type[FlexapodError]) -> None:
    """Takes away empty entries at the ends of lines, which come of a separator there, and compares their lengths."""
    while head and not head[-1] and not any("".join(row[len(head) - 1 :]) for _, row in rows):
        head.pop()
    for line, row in rows:
        while len(row) > len(head) and not row[-1]:
            row.pop()
        if len(row) != len(head):
            raise error(f"line {line} has {len(row)} entries; the header names {len(head)} columns.")


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _meaning(title: str, names: Mapping[str, Any]) -> tuple[Any, str]:
    """What a title stands for, or None, and its unit: "Base X [mm]" with the name base_x, unit mm."""
    text = title.replace("\u00b5", "u").replace("\u03bc", "u").replace("\u00b2", "2").replace("\u00b0", "deg")
    for alias in sorted(names, key=len, reverse=True):
        pattern = r"[\s_.\-]*".join(map(re.escape, alias.split("_"))) + r"(?![A-Za-z0-9])"
        match = re.match(pattern, text, re.IGNORECASE)
        if match:
            unit = text[match.end() :].strip(" _-.,:[](){}/")
            unit = re.sub(r"[\[\](){}^]", "", unit).replace("/", "_per_")
            return names[alias], re.sub(r"[\s_*\-]+", "_", unit)
    return None, ""


def _bare(unit: str) -> str:
    return unit.replace("_", "").lower()
