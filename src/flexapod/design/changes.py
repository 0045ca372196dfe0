"""Changes to the values of a design: keys with units and indices, texts from a command line, short forms."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from flexapod.design.key_names import resolve, unknown_key
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS
from flexapod.design.shorthands import Values, expand
from flexapod.design.tables import complete, flatten, table_of
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown


def parse_assignments(texts: Iterable[str]) -> dict[str, str]:
    """`["platform.mass=400", ...]` from a command line to changes for `Hexapod.replace`."""
    changes: dict[str, str] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not key.strip() or not value.strip():
            raise DesignError(f"{text!r} is no change of a design; it must be KEY=VALUE, such as platform.mass=400.")
        if key.strip() in changes:
            raise DesignError(f"{key.strip()} is set twice. Leave one of them out.")
        changes[key.strip()] = value.strip()
    return changes


def changed(values: Values, changes: Mapping[str, Any]) -> Values:
    """Values with changes made, checked: dotted keys, units in names, indices; None takes an optional key out."""
    values = dict(values)
    tables: dict[str, Any] = {}
    places: list[tuple[str, Any]] = []
    for key, value in changes.items():
        if not isinstance(key, str):
            raise DesignError(f"{shown(key)} is no key; keys of a change are text such as 'platform.mass'.")
        if "[" in key:
            places.append((key, _parsed(key, value)))
        elif value is None:
            _take_out(values, key)
        else:
            _nest(tables, key, _parsed(key, value))
    new = flatten(tables)
    for key in _overruled(new):
        values.pop(key, None)
    values = expand(values | new)
    for key, value in places:
        _set_place(values, key, value)
    return complete(values)


def _overruled(new: Values) -> set[str]:
    """Plain keys that the short forms among the changes take the place of."""
    keys: set[str] = set()
    for key in new:
        if key.startswith("cubic."):
            keys |= {"base.joints", "base.universal_axes", "platform.joints", "home.position", "home.orientation"}
        elif ".circle." in key:
            plate = key.split(".")[0]
            keys |= {f"{plate}.joints"} | ({"base.universal_axes"} if plate == "base" else set())
        elif ".rod." in key:
            part = key.split(".rod.")[0]
            keys |= {f"{part}.mass", f"{part}.mass_center", f"{part}.inertia"}
    return keys


def _parsed(key: str, value: Any) -> Any:
    """Text is read as a TOML value, so that a command line can say what a file can."""
    if not isinstance(value, str) or key in TEXT_KEYS:
        return value
    try:
        parsed = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        parsed = {}
    if list(parsed) != ["value"]:
        must = "it must be a TOML value: a number such as 400 or a list [1, 2, 3]"
        raise DesignError(f"{key} is {shown(value)}; {must}.")
    return parsed["value"]


def _nest(tables: dict[str, Any], key: str, value: Any) -> None:
    *path, last = key.split(".")
    here = tables
    for depth, name in enumerate(path):
        if ".".join(path[: depth + 1]) not in TABLES:
            unknown_key(".".join(path[:depth]), name)
        here = table_of(here.setdefault(name, {}), ".".join(path[: depth + 1]))
    here[last] = {**table_of(here.get(last, {}), key), **value} if isinstance(value, Mapping) else value


def _take_out(values: Values, key: str) -> None:
    if key in TABLES:
        for full in [full for full in values if full.startswith(f"{key}.")]:
            del values[full]
        return
    values.pop(_canonical(key)[0], None)


def _canonical(key: str) -> tuple[str, str]:
    """A dotted key as written -> (its name without unit, its unit)."""
    table, _, last = key.rpartition(".")
    if table and table not in TABLES:
        parent, _, name = table.rpartition(".")
        unknown_key(parent, name)
    return resolve(table, last)


def _set_place(values: Values, key: str, value: Any) -> None:
    """One entry, row or matrix of a value: `legs.stiffness[2]`, `base.joints[0][2]`."""
    match = re.fullmatch(r"([^\[\]]+)((?:\[\d{1,9}\])+)", key)
    if match is None:
        raise DesignError(f"{key!r} is no key; write an index as in legs.stiffness[2], counting from 0.")
    canonical, unit = _canonical(match[1])
    if canonical in TEXT_KEYS or canonical not in values:
        raise DesignError(f"{key}: {canonical} is not a list in this design. Give {canonical} as a whole.")
    rule = KEYS[canonical]
    index = tuple(int(number) for number in re.findall(r"\d+", match[2]))
    shape = (6, *rule.shapes[0]) if canonical.startswith("legs.") else values[canonical].shape
    whole = np.broadcast_to(values[canonical], shape).copy()
    if len(index) > len(shape) or any(i >= n for i, n in zip(index, shape, strict=False)):
        raise DesignError(
            f"{key} is outside {canonical}, which is {' x '.join(map(str, shape)) or 'one number'}. "
            "Indices count from 0."
        )
    # The entry is checked as if it alone were the value; symmetry is a matter of the whole, checked when all are set.
    entry = replace(rule, shapes=(shape[len(index) :],), symmetric=False)
    whole[index] = check_value(key, value, entry, unit)
    values[canonical] = whole
