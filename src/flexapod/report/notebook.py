"""Designs and results in notebooks: small tables with units and drawings, right on light and on dark paper.

A type without a view of its own shows its attributes, each with the meaning and the unit that its docstring gives.
"""

from __future__ import annotations

import inspect
import itertools
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import partial
from html import escape
from typing import Any

import numpy as np
import xarray as xr

from flexapod import plots
from flexapod.conventions import TWO_PI, JointModel, printed_unit
from flexapod.design.catalogue import assumed_of
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.at_rest import pose_state
from flexapod.mechanics.cautions import other_than_vibration
from flexapod.mechanics.kinematics import home_pose
from flexapod.mechanics.linearisation import DampedModes
from flexapod.mechanics.modes import NaturalModes
from flexapod.pose import Pose
from flexapod.report import figures
from flexapod.report import html as pages
from flexapod.report.numbers import DASH, shown
from flexapod.report.studies import envelope, inputs
from flexapod.report.study import Column, Table, shown_on
from flexapod.workspace.envelope import Envelope

_STYLE = """<style>
.flexapod { --ink: currentColor; --faint: #8a929b; --base: #8492a1; --leg: #7d8b9a; --platform: #2f8fd0; }
.flexapod { max-width: 60em; }
.flexapod table { border-collapse: collapse; margin: 4px 0; font-variant-numeric: tabular-nums; background: none; }
.flexapod th, .flexapod td { color: inherit; background: none; text-align: right; padding: 2px 10px;
  white-space: nowrap; border: 0; border-bottom: 1px solid #8885; }
.flexapod tbody th, .flexapod .meaning { text-align: left; font-weight: normal; }
.flexapod .meaning { white-space: normal; opacity: 0.75; }
.flexapod caption { text-align: left; font-weight: bold; padding: 4px 10px; color: inherit; }
.flexapod svg { display: block; max-width: 26em; height: auto; color: inherit; }
.flexapod svg text { fill: currentColor; }
.flexapod summary { cursor: pointer; }
</style>"""
_FEW = 6  # numbers of an array that are shown one by one
_MANY = 12  # rows of a table
_LOOKED_AT = 10**6  # numbers of a variable whose range is shown
_CAUTIONS = ("caution", "spectrum_caution")  # attributes of Datasets
_numbers = itertools.count(1)  # of drawings, whose names must differ on one page


def html(thing: Any) -> str:
    """A design or a result as a small part of a page."""
    for kind, view in _VIEWS.items():
        if isinstance(thing, kind):
            return _page(view(thing))
    return _page(_attributes(thing, type(thing).__name__))


def _frequencies(modes: NaturalModes | DampedModes, **given: Any) -> Any:
    return plots.frequencies(modes.omega, **given)


def _page(body: str) -> str:
    return f'{_STYLE}<div class="flexapod">{body}</div>'


def _table(table: Table, caption: str = "") -> str:
    columns = shown_on(table.columns, "page")
    head = [escape(", ".join(filter(None, (column.title, column.unit)))) for column in columns]
    cells = [[pages.cell(column, i) for i in range(len(column.values))] for column in columns]
    return pages.rows_table(head, zip(*cells, strict=True), "", "", caption or table.title)


def _drawing(make: Callable[[], Any], words: str, tight: bool = False) -> str:
    return figures.drawn(make, f"flexapod{next(_numbers)}", words, tight)


def _hexapod(hexapod: Hexapod) -> str:
    picture = ""
    if home_pose(hexapod) is not None:
        picture = _drawing(partial(plots.machine, hexapod), f"{hexapod.name} at home")
    listed = "".join(_table(table) for table in inputs.section(hexapod).items if isinstance(table, Table))
    facts = f"{hexapod.platform_mass:.6g} kg on the platform"
    told = f"<p>{escape(assumed)}</p>" if (assumed := assumed_of(hexapod)) else ""
    return f"<b>{escape(hexapod.name)}</b>, {facts}{picture}{told}<details><summary>Inputs</summary>{listed}</details>"


def _modes(modes: NaturalModes | DampedModes) -> str:
    if np.ndim(modes.omega) != 1:
        return _attributes(modes, type(modes).__name__)
    columns = [
        Column("mode", [str(k + 1) for k in range(modes.omega.size)]),
        Column("", modes.omega / TWO_PI, "Hz", 5),
        Column("", modes.omega, "rad/s", 5),
    ]
    name = "Natural modes"
    if isinstance(modes, DampedModes):
        name = "Damped modes"
        columns.append(Column("damping ratio", modes.damping_ratio, "", 3))
        words = [other_than_vibration(pole, pole.real > 0) or "" for pole in modes.pole]
        if any(words):
            columns.append(Column("", words))
    seen = modes.omega[modes.omega > 0]
    picture = _drawing(partial(_frequencies, modes), "frequencies") if modes.omega.size == 6 and seen.size else ""
    return f"{_table(Table(columns), name)}{picture}"


def at_pose(hexapod: Hexapod, pose: Pose, joint: JointModel) -> str:
    """A machine at a pose: its drawing, its frequencies, and what to beware of."""
    state = pose_state(hexapod, pose, joint=joint)
    picture = _drawing(partial(plots.machine, hexapod, pose), f"{hexapod.name} at {pose}")
    modes = Table(
        [
            Column("mode", [str(k + 1) for k in range(6)]),
            Column("", state.modes.omega / TWO_PI, "Hz", 5),
            Column("what moves", [mode.text for mode in state.descriptions]),
        ]
    )
    cautions = "".join(f"<p>{escape(one.text)}</p>" for one in state.cautions)
    place = escape(str(pose).removeprefix("Pose"))
    return _page(f"<b>{escape(hexapod.name)}</b> {place}{picture}{_table(modes, 'Natural modes')}{cautions}")


def _envelope(found: Envelope) -> str:
    """Travel along each axis, and the largest box."""
    told = [" ".join(filter(None, (row.label, str(row.value), row.note))) for row in envelope.rows(found)[:1]]
    listed = "".join(_table(table, table.title or "Envelope") for table in envelope.tables(found))
    return f"{listed}<p>{escape(told[0])}</p>"


def _dataset(found: xr.Dataset) -> str:
    """Each variable with its dimensions, its range and its unit, and what to beware of."""
    rows = []
    for name, variable in found.data_vars.items():
        over = ", ".join(f"{dim} ({size})" for dim, size in variable.sizes.items())
        words = (f"<code>{escape(str(name))}</code>", *map(escape, (over, _range(variable), _unit(found, variable))))
        rows.append((*words, f'<td class="meaning">{escape(str(variable.attrs.get("long_name", "")))}</td>'))
    listed = pages.rows_table(("", "over", "range", "unit", ""), rows, caption=str(found.attrs["design"]))
    cautions = "".join(f"<p>{escape(text)}</p>" for key in _CAUTIONS if (text := str(found.attrs.get(key, ""))))
    return f"{listed}{cautions}"


def _unit(found: xr.Dataset, variable: xr.DataArray) -> str:
    """The unit of a variable, or those that stand side by side in it."""
    unit = str(variable.attrs.get("units", variable.attrs.get("mixed_units", "")))
    for name in re.findall(r"\w+_unit", unit):
        unit = unit.replace(name, f"({' or '.join(dict.fromkeys(found[name].values.tolist()))})")
    return "" if unit == "1" else printed_unit(unit)


def _range(variable: xr.DataArray) -> str:
    """The least and the greatest value, of complex ones the amplitude; nothing of too many to be looked at."""
    if variable.size > _LOOKED_AT or variable.dtype.kind not in "fiubc":
        return ""
    values = variable.values
    if variable.dtype.kind == "b":
        return _array(values)
    good = values[np.isfinite(values)]
    if not good.size:
        return DASH
    if variable.dtype.kind == "c":
        return f"amplitude up to {shown(float(np.abs(good).max()))}"
    return f"{shown(float(good.min()))} to {shown(float(good.max()))}"


#: Types with a view of their own.
_VIEWS: Mapping[type, Callable[[Any], str]] = {
    Hexapod: _hexapod,
    NaturalModes: _modes,
    DampedModes: _modes,
    Envelope: _envelope,
    xr.Dataset: _dataset,
}


def _attributes(thing: Any, title: str) -> str:
    """The attributes of a result: name, value, and what its docstring says of it."""
    meanings = _meanings(type(thing))
    rows = []
    for name, value in _parts(thing):
        meaning = f'<td class="meaning">{escape(meanings.get(name, ""))}</td>'
        rows.append((f"<code>{escape(name)}</code>", escape(_value(value)), meaning))
    cautions = "".join(f"<p>{escape(text)}</p>" for text in getattr(thing, "cautions", ()))
    return f"{pages.rows_table(('', '', ''), rows, caption=title)}{cautions}"


def _parts(thing: Any) -> Iterator[tuple[str, Any]]:
    if hasattr(thing, "_fields"):
        yield from thing._asdict().items()
        return
    names = [item.name for item in fields(thing)] if is_dataclass(thing) else list(_meanings(type(thing)))
    for name in names:
        if not name.startswith("_") and hasattr(thing, name):
            yield name, getattr(thing, name)


def _meanings(kind: type) -> dict[str, str]:
    """The first sentence of what a docstring in numpydoc form says of each attribute."""
    text = inspect.getdoc(kind) or ""
    found: dict[str, str] = {}
    for names, words in re.findall(r"^(\w+(?:, \w+)*) : .*\n((?:    .*\n?)+)", text, re.MULTILINE):
        sentence = re.split(r"(?<=[^.][.])\s", " ".join(words.split()))[0]
        found |= dict.fromkeys(names.split(", "), sentence)
    return found


def _value(value: Any) -> str:
    """A value in few words: numbers, small arrays, or what a large one is like."""
    if isinstance(value, bool | np.bool_) or value is None or isinstance(value, str):
        return str(value)
    if isinstance(value, float | int | np.number):
        return shown(float(value), 5) if not isinstance(value, int) else str(value)
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        return _array(value)
    if isinstance(value, tuple | list) and all(isinstance(one, str | float | int) for one in value):
        return ", ".join(_value(one) for one in value[:_MANY]) + (" ..." if len(value) > _MANY else "")
    if isinstance(value, tuple | list):
        return (
            f"{len(value)} of {type(value[0]).__name__}"
            if value and not hasattr(value, "_fields")
            else type(value).__name__
        )
    text = repr(value)
    tells = len(text) <= 80 and "\n" not in text and " object at 0x" not in text  # and not only its address
    return text if tells else type(value).__name__


def _array(values: np.ndarray) -> str:
    if values.dtype.kind == "b":
        return str(values) if values.ndim == 0 else f"{np.count_nonzero(values)} of {values.size} true"
    if values.size <= _FEW and values.ndim <= 1:
        return ", ".join(shown(float(x), 5) for x in np.atleast_1d(values))
    good = values[np.isfinite(values)]
    span = f", {shown(float(good.min()))} to {shown(float(good.max()))}" if good.size else ""
    return f"{' × '.join(map(str, values.shape))}{span}"
