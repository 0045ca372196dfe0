"""Joint coordinates from a table, as a CAD program or a spreadsheet exports them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.conventions import LEGS, Array
from flexapod.design.units import UNITS
from flexapod.errors import DesignError
from flexapod.pose import PoseLike, as_pose
from flexapod.tables import LEFT_OUT, Table, naming, parse_table, read_text

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
HEADER = "leg, base_x_mm, base_y_mm, base_z_mm, platform_x_mm, platform_y_mm, platform_z_mm"
FORM = (
    "Columns are leg, base_x, platform_x or home_x, axis_x and the same with y and z, with a unit as in base_x_mm; "
    f"{', '.join(LEFT_OUT)} are left out. A header is {HEADER}. Or give twelve lines point, x, y, z with the points B1 "
    "to B6 of the base and P1 to P6 of the platform."
)
#: What a title may be -> "leg", or a group of points and one of its axes.
NAMES: dict[str, Any] = dict.fromkeys(LEG, "leg")
NAMES |= {f"{word}_{axis}": (group, axis) for word, group in GROUPS.items() for axis in "xyz"}
NAMES |= {"point": "point", **{axis: ("point", axis) for axis in "xyz"}}
POINT = re.compile(r"([a-z]+)[\s_.-]*([1-6])", re.IGNORECASE)


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
        is None where the file has no axes: they then become the default ones (see `Hexapod`).

    Raises
    ------
    DesignError
        For a file that cannot be read or makes no joints, with the line, column and value.

    Notes
    -----
    Columns: `leg` (1 to 6, may be left out), `base_x`, `base_y`, `base_z` (short: `bx`), and either `platform_x`, ...
    (`px`) in the platform frame, or `home_x`, ... (`hx`): the platform joints where they stand at home, in the base
    frame. `axis_x`, ... (`kx`) are the axes of the universal joints. Lengths are in m unless the column says otherwise:
    `base_x_mm` or `Base X [mm]`. Or twelve lines `point`, `x`, `y`, `z` with the points B1 to B6 and P1 to P6 (H1 to H6
    where they stand at home). Semicolons and tabs separate as well, and then numbers may have decimal commas. Lines
    that begin with `#` are left out, and columns name, note, comment, part, remark.

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
    text = read_text(file, DesignError)
    with naming(file, DesignError):
        table = parse_table(text, NAMES, FORM, DesignError)
        return _joints(_points(table) if table.column("point") is None else _listed_points(table), home)


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


def _points(table: Table) -> dict[str, Array]:
    """Points by group, (6, 3) m in order of the legs."""
    groups = _groups(table)
    if len(table.lines) != 6:
        raise DesignError(f"there are {len(table.lines)} lines below the header; six are needed, one for each leg.")
    order = np.argsort(_legs(table))
    points = {group: np.empty((6, 3)) for group in groups}
    for column in table.columns:
        if column.name != "leg":
            group, axis = column.name
            units = {} if group == "axis" else UNITS["length"]
            points[group][:, "xyz".index(axis)] = table.numbers(column, units)[order]
    return points


def _listed_points(table: Table) -> dict[str, Array]:
    """The same from twelve lines with a point each."""
    given = {column.name for column in table.columns}
    wanted = {"point", *(("point", axis) for axis in "xyz")}
    if given != wanted:
        raise DesignError("a table of points has the columns point, x, y, z and no others. Correct the header.")
    column = table.column("point")
    assert column is not None
    places: dict[tuple[str, int], int] = {}
    for row, (line, cell) in enumerate(zip(table.lines, column.cells, strict=True)):
        match = POINT.fullmatch(cell)
        group = GROUPS.get(match[1].lower()) if match else None
        if match is None or group in (None, "axis"):
            raise DesignError(
                f"line {line}, column {column.title}: {cell!r} is no point; points are B1 to B6 of the base and P1 to "
                "P6 of the platform, or H1 to H6 where these stand at home."
            )
        place = (str(group), int(match[2]) - 1)
        if place in places:
            raise DesignError(f"lines {table.lines[places[place]]} and {line} are both point {cell}. Give each once.")
        places[place] = row
    groups = {group for group, _ in places}
    if groups not in ({"base", "platform"}, {"base", "home"}) or len(places) != 12:
        raise DesignError(
            f"it has the points {', '.join(column.cells)}; B1 to B6 and P1 to P6 (or H1 to H6) are needed, each once."
        )
    numbers = [table.numbers(c, UNITS["length"]) for axis in "xyz" for c in table.columns if c.name == ("point", axis)]
    rows = np.column_stack(numbers)
    return {group: rows[[places[group, leg] for leg in range(6)]] for group in groups}


def _groups(table: Table) -> list[str]:
    """The groups that the columns give, each of them whole."""
    given = {column.name for column in table.columns}
    groups = [group for group in ("base", "platform", "home", "axis") if any(name[0] == group for name in given)]
    if {"platform", "home"} <= set(groups):
        raise DesignError(
            "columns platform_x, ... and home_x, ... both give the platform joints, in the platform frame and where "
            "they stand at home. Leave one of them out."
        )
    needed = {*groups, "base"} | (set() if "home" in groups else {"platform"})
    missing = [f"{group}_{axis}" for group in sorted(needed) for axis in "xyz" if (group, axis) not in given]
    if missing:
        either = " (or home_x, home_y, home_z)" if "platform" in needed and "platform" not in groups else ""
        raise DesignError(f"missing columns: {', '.join(missing)}{either}. A header is {HEADER}.")
    return groups


def _legs(table: Table) -> list[str]:
    """Which leg each line is: as its column says, or by its place."""
    column = table.column("leg")
    if column is None:
        return list(LEGS)
    seen: dict[str, int] = {}
    for line, cell in zip(table.lines, column.cells, strict=True):
        if cell not in LEGS:
            raise DesignError(f"line {line}, column {column.title}: {cell!r} is no leg; legs are 1 to 6.")
        if cell in seen:
            raise DesignError(f"lines {seen[cell]} and {line} are both leg {cell}. Give each leg, 1 to 6, once.")
        seen[cell] = line
    return column.cells
