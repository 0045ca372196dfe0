"""Tables in CSV files, read as loggers, spreadsheets and CAD programs write them, and written.

Commas, semicolons or tabs separate; with the last two, numbers may have decimal commas. Titles are read without regard
to case, and may end in a unit: `z_um`, `Base X [mm]`, `Frequency (Hz)`; or the units stand in a line of their own below
the titles: `s;mm;deg`. Lines that begin with # and empty ones are left out, and columns that are titled name, note,
comment, part or remark.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.errors import ArgumentError, FlexapodError

MOST_UNITS = 8  # that an error lists
LEFT_OUT = ("name", "note", "comment", "part", "remark")
#: Unit -> (multiply by, divide by), to SI. Two numbers, because x / 1000 is rounded once and x * 0.001 is not.
Units = Mapping[str, tuple[float, float]]
#: A unit below a title, as [mm] or m/s\u00b2, or nothing.
_UNIT = re.compile(r"[\[(]?[a-zA-Z\u00b5\u03bc\u00b0][\w\u00b2\u00b0\u00b7/^*. -]{0,11}[\])]?|", re.ASCII)


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

    def numbers(
        self, column: Column, units: Units | None = None, default: str | None = "", finite: bool = True
    ) -> Array:
        """The numbers of a column in SI units; those of a column without a unit are in the unit `default`.

        default: where it is None, the column must name its unit. finite: NaN, infinity and empty cells are refused;
        else they are NaN.
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

    def _factor(self, column: Column, units: Units, default: str | None) -> tuple[float, float]:
        unit = column.unit or default
        if unit is None:
            raise self.error(
                f"column {column.title!r} names no unit, and its numbers alone do not tell it. Write it in the title: "
                f"{', '.join(f'{column.title}_{known}' for known in list(units)[:3])} or the like."
            )
        found = unit_named(unit, units)
        if found is not None:
            return units[found]
        if not unit:
            return 1.0, 1.0
        some = list(units)[:: -(-len(units) // MOST_UNITS) or 1]
        rest = " and the like" * (len(some) < len(units))
        allowed = f"it may be {', '.join(some)}{rest}" if units else "this column has none"
        raise self.error(f"column {column.title!r} has the unit {column.unit!r}; {allowed}. Correct the header.")


def unit_named(word: str, units: Iterable[str]) -> str | None:
    """The unit that is meant, however it is written: `Nm` is N_m, `m/s^2` is m_per_s2, `MM` is mm; None if none is."""
    bare = normal_unit(word).replace("_", "")
    exact = [known for known in units if known.replace("_", "") == bare]
    alike = [known for known in units if known.replace("_", "").lower() == bare.lower()]
    plain = len(alike) == 1 and (alike[0].islower() or alike[0] in ("Hz", "kHz"))  # MM is mm, but MN is not mN
    return next(iter([*exact, *(alike if plain else [])]), None)


def normal_unit(word: str) -> str:
    """A unit as units are named in keys: `m/s²` is m_per_s2."""
    for sign, plain in {
        "\u00b5": "u",
        "\u03bc": "u",
        "\u00b2": "2",
        "\u00b3": "3",
        "\u00b0": "deg",
        "\u00b7": "_",
    }.items():
        word = word.replace(sign, plain)
    word = re.sub(r"[\[\](){}^]", "", word.strip(" _-.,:[](){}/")).replace("/", "_per_")
    return re.sub(r"[\s_*\-]+", "_", word)


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
    units = _units_line(rows)
    columns: list[Column] = []
    for place, title in enumerate(head):
        if title.lower() in LEFT_OUT:
            continue
        name, unit = _meaning(title, names)
        unit = unit or units.get(place, "")
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


def _units_line(rows: list[tuple[int, list[str]]]) -> dict[int, str]:
    """The units of a line below the titles that has nothing else, which is taken away."""
    cells = rows[0][1] if rows else []
    if not any(cells) or not all(_UNIT.fullmatch(cell) and _number(cell) is None for cell in cells):
        return {}
    return {place: normal_unit(cell) for place, cell in enumerate(rows.pop(0)[1])}


def written_table(columns: Mapping[str, NDArray[Any]]) -> str:
    """Columns by title as the text of a file: numbers with all their digits, nothing where there is none."""
    rows = zip(*map(_written, columns.values()), strict=True)
    return "\n".join([",".join(columns), *map(",".join, rows)]) + "\n"


def _written(values: NDArray[Any]) -> list[str]:
    if values.dtype.kind == "f":
        return ["" if np.isnan(value) else repr(float(value) + 0.0) for value in values]
    return [_quoted(str(value)) for value in values]


def _quoted(text: str) -> str:
    """A cell of text, in quotes where it would be taken for more than one."""
    return '"' + text.replace('"', '""') + '"' if any(mark in text for mark in ',;"\r\n\t') else text


def _number(cell: str) -> float | None:
    try:
        return None if "_" in cell else float(cell)  # Python reads 1_0 as 10
    except ValueError:
        return None


def _meaning(title: str, names: Mapping[str, Any]) -> tuple[Any, str]:
    """What a title stands for, or None, and its unit: "Base X [mm]" with the name base_x, unit mm."""
    for alias in sorted(names, key=len, reverse=True):
        pattern = r"[\s_.\-]*".join(map(re.escape, alias.split("_"))) + r"(?![A-Za-z0-9])"
        match = re.match(pattern, title, re.IGNORECASE)
        if match:
            return names[alias], normal_unit(title[match.end() :])
    return None, ""
