"""A design as it was read, line by line: what `flexapod check` prints back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from flexapod.design.hexapod import Hexapod
from flexapod.design.schema import TEXT_KEYS, rule_of
from flexapod.design.units import printed, si_unit
from flexapod.mechanics.plausibility import radii_of_gyration

_ALL = "all legs"
_MARGIN = 30  # characters before the values


def lines(hexapod: Hexapod) -> Iterator[str]:
    """Every number of a design by its key, short forms before what they stand for, angles in degrees."""
    values = hexapod.values()
    short = {key: form for form in hexapod.short_forms for key in form.made}
    told = set()
    for key, value in values.items():
        form = short.get(key)
        if form is not None and form.table not in told:
            told.add(form.table)
            for its, number in form.values().items():
                yield from [f"  {its:<{_MARGIN + 2}}{number}"] if its in TEXT_KEYS else _key(its, number)
        if key not in TEXT_KEYS:
            yield from _key(key, value)
        if key.endswith(".inertia"):
            yield from _gyration(values, key.removesuffix(".inertia"))


def gyration(hexapod: Hexapod) -> dict[str, Any]:
    """Radii of gyration about the principal axes, m: of the platform (3,), of the parts of the legs (6, 3)."""
    values = hexapod.values()
    return {body: _radii(values, body) for body in ("platform", "legs.lower", "legs.upper")}


def _radii(values: dict[str, Any], body: str) -> Any:
    mass, inertia = values[f"{body}.mass"], values[f"{body}.inertia"]
    if mass.ndim == 0:
        return radii_of_gyration(float(mass), inertia)
    return np.array([radii_of_gyration(float(m), J) for m, J in zip(mass, inertia, strict=True)])


def _gyration(values: dict[str, Any], body: str) -> Iterator[str]:
    yield from _rows(f"{body}: radii of gyration", _radii(values, body), "m", body.startswith("legs."))


def _key(key: str, value: Any) -> Iterator[str]:
    rule = rule_of(key)
    unit = printed(si_unit(rule.dimension))
    if rule.dimension == "angle":
        value, unit = np.degrees(value), "deg"
    yield from _rows(key, value, unit, key.startswith("legs."))


def _rows(name: str, value: Any, unit: str, of_legs: bool) -> Iterator[str]:
    """A value in one line, or in as many as it has rows, with the leg that each is of."""
    value = np.asarray(value)
    rows = [("", value)]
    if of_legs and value.ndim and len(value) == 6:
        same = (value == value[0]).all()
        rows = [(_ALL, value[0])] if same else [(f"leg {leg + 1}", row) for leg, row in enumerate(value)]
    elif value.shape == (6, 3):
        rows = [(f"leg {leg + 1}", row) for leg, row in enumerate(value)]
    for leg, row in rows:
        for part in row if row.ndim == 2 else [row]:
            words = ", ".join(f"{float(x) + 0.0:.6g}" for x in np.atleast_1d(part))
            told = (f"[{words}]" if part.ndim else words, unit, f"({leg})" if leg else "")
            yield f"  {name:{_MARGIN}}  {' '.join(filter(None, told))}"
            name = ""
