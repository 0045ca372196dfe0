"""Joint coordinates from a table, as a CAD program or a spreadsheet exports them."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.units import UNITS, to_si
from flexapod.errors import DesignError
from flexapod.pose import PoseLike, as_pose

GROUPS = {
    "base": "base",
    "b": "base",
    "bottom": "base",
    "platform": "platform",
    "p": "platform",
    "top": "platform",
    "home": "home",
    "h": "home",
    "axis": "axis",
    "k": "axis",
}
LEG = ("leg", "no", "number", "index")
LEFT_OUT = ("name", "note", "comment", "part")
HEADER = "leg, base_x_mm, base_y_mm, base_z_mm, platform_x_mm, platform_y_mm, platform_z_mm"


def read_joints(path: str | Path, home: PoseLike | None = None) -> dict[str, Array | None]:
    """Read the joints of six legs from a CSV file.

    Parameters
    ----------
    path : str or Path
        The file: a header and one line for each leg.
    home : Pose, optional
        Home pose of the platform; needed where the file gives the platform joints as they stand at home.

    Returns
    -------
    dict
        Changes for `Hexapod.replace`: base.joints and platform.joints, (6, 3) m, and base.universal_axes, (6, 3), which
        is None where the file has no axes: they then become tangent to the base circle.

    Raises
    ------
    DesignError
        For a file that cannot be read or makes no joints, with the line, column and value.

    Notes
    -----
    Columns: `leg` (1 to 6, may be left out), `base_x`, `base_y`, `base_z` (short: `bx`), and either `platform_x`, ...
    (`px`) in the platform frame, or `home_x`, ... (`hx`): the platform joints where they stand at home, in the base
    frame. `axis_x`, ... (`kx`) are the axes of the universal joints. Lengths are in m unless the column says otherwise:
    `base_x_mm` or `Base X [mm]`. Semicolons and tabs separate as well, and then numbers may have decimal commas. Lines
    that begin with `#` are left out, and columns name, note, comment, part.

    Examples
    --------
    >>> machine = fx.load("mukherjee-ii")
    >>> rows = np.hstack([machine.base_joints, machine.platform_joints])
    >>> names = "base_x,base_y,base_z,platform_x,platform_y,platform_z"
    >>> np.savetxt("joints.csv", rows, delimiter=",", header=names, comments="")
    >>> sorted(fx.design.read_joints("joints.csv"))
    ['base.joints', 'base.universal_axes', 'platform.joints']
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise DesignError(f"{file} is not a text file in UTF-8. Export the joints as CSV in UTF-8.") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise DesignError(f"{file} cannot be read: {reason}. Check the name and its folder.") from error
    try:
        return _joints(_parsed(text), home)
    except csv.Error as error:
        raise DesignError(f"{file} is no CSV file: {error}. Export the joints as CSV.") from error
    except DesignError as error:
        raise DesignError(f"{file}: {error}") from error


class _Column(NamedTuple):
    title: str  # as written
    group: str  # base, platform, home, axis; "leg", or "" for one that is left out
    axis: int
    unit: str


def _joints(points: dict[str, Array], home: PoseLike | None) -> dict[str, Array | None]:
    platform = points.get("platform")
    if platform is None:
        if home is None:
            raise DesignError(
                "columns home_x, home_y, home_z say where the platform joints stand at home, but there is no home. "
                "Add a [home] table with position to the design (in Python, give home), or give platform_x, ... in "
                "the platform frame."
            )
        home = as_pose(home, "home")
        platform = (points["home"] - home.position) @ home.matrix + 0.0
    return {"base.joints": points["base"], "platform.joints": platform, "base.universal_axes": points.get("axis")}


def _parsed(text: str) -> dict[str, Array]:
    """Points by group, (6, 3) m in order of the legs."""
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise DesignError(f"there is nothing in it; a header such as {HEADER} and six lines are needed.")
    separator = next((mark for mark in (";", "\t") if mark in lines[0][1]), ",")
    columns = [_column(title) for title in _cells(lines[0][1], separator)]
    groups = _groups(columns)
    if len(lines) != 7:
        raise DesignError(f"there are {len(lines) - 1} lines below the header; six are needed, one for each leg.")
    points = {group: np.full((6, 3), np.nan) for group in groups}
    seen: dict[int, int] = {}
    for row, (number, line) in enumerate(lines[1:]):
        cells = _cells(line, separator)
        if len(cells) != len(columns):
            raise DesignError(f"line {number} has {len(cells)} entries; the header names {len(columns)} columns.")
        leg = _leg(number, cells, columns, row)
        if leg in seen:
            raise DesignError(f"lines {seen[leg]} and {number} are both leg {leg + 1}. Give each leg, 1 to 6, once.")
        seen[leg] = number
        for cell, column in zip(cells, columns, strict=True):
            if column.group in points:
                points[column.group][leg, column.axis] = _length(number, cell, column, separator)
    return points


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]


def _column(title: str) -> _Column:
    name = re.sub(r"[\s\-.\[\]()/]+", "_", title.lower().replace("µ", "u")).strip("_")
    if name in LEG:
        return _Column(title, "leg", 0, "")
    if name in LEFT_OUT:
        return _Column(title, "", 0, "")
    match = re.fullmatch(r"([a-z]+)_?([xyz])(?:_(\w+))?", name)
    if match is None or match[1] not in GROUPS:
        raise DesignError(
            f"column {title!r} is unknown. Columns are leg, base_x, platform_x or home_x, axis_x and the same with y "
            f"and z, with a unit as in base_x_mm; {', '.join(LEFT_OUT)} are left out. A header is {HEADER}."
        )
    group, unit = GROUPS[match[1]], match[3] or ""
    allowed = [] if group == "axis" else list(UNITS["length"])
    if unit and unit not in allowed:
        may_be = f"it may be {', '.join(allowed)}" if allowed else "an axis has none"
        raise DesignError(f"column {title!r} has the unit {unit!r}; {may_be}. Correct the header.")
    return _Column(title, group, "xyz".index(match[2]), unit or "m")


def _groups(columns: Iterable[_Column]) -> list[str]:
    """The groups that the columns give, each of them whole and once."""
    given: dict[tuple[str, int], str] = {}
    for column in columns:
        place = (column.group, column.axis)
        if column.group and place in given:
            raise DesignError(f"columns {given[place]!r} and {column.title!r} are the same. Leave one of them out.")
        given[place] = column.title
    groups = [group for group in ("base", "platform", "home", "axis") if any(name == group for name, _ in given)]
    if {"platform", "home"} <= set(groups):
        raise DesignError(
            "columns platform_x, ... and home_x, ... both give the platform joints, in the platform frame and where "
            "they stand at home. Leave one of them out."
        )
    needed = {*groups, "base"} | (set() if "home" in groups else {"platform"})
    missing = [f"{group}_{'xyz'[i]}" for group in sorted(needed) for i in range(3) if (group, i) not in given]
    if missing:
        either = " (or home_x, home_y, home_z)" if "platform" in needed and "platform" not in groups else ""
        raise DesignError(f"missing columns: {', '.join(missing)}{either}. A header is {HEADER}.")
    return groups


def _leg(number: int, cells: list[str], columns: list[_Column], row: int) -> int:
    """Which leg a line is, from 0: as its column says, or by its place."""
    for cell, column in zip(cells, columns, strict=True):
        if column.group == "leg":
            if cell not in ("1", "2", "3", "4", "5", "6"):
                raise DesignError(f"line {number}, column {column.title}: {cell!r} is no leg; legs are 1 to 6.")
            return int(cell) - 1
    return row


def _length(number: int, cell: str, column: _Column, separator: str) -> float:
    text = cell.replace(",", ".") if separator != "," else cell
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DesignError(
            f"line {number}, column {column.title}: {cell!r} is no finite number. Write it as -12.5 or 1.25e1."
        )
    return value if column.group == "axis" else float(to_si(value, "length", column.unit))
