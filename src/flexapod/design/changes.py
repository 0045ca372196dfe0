"""Changes to the values of a design: keys with units and indices, texts from a command line, short forms."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from flexapod.design.key import ANY
from flexapod.design.key_names import resolve, unknown_key
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS, is_of_each_leg, rule_of
from flexapod.design.short_forms import ShortForm
from flexapod.design.shorthands import BESIDE, MAKES, NEEDS, SETS, Values, expand, stands_in_pairs
from flexapod.design.tables import complete, flatten, has_law, table_of
from flexapod.design.text_limits import MOST_KEYS
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


def changed(
    values: Values, forms: Iterable[ShortForm], changes: Mapping[str, Any]
) -> tuple[Values, tuple[ShortForm, ...]]:
    """Values and short forms with changes made, checked: dotted keys, units in names, indices; None takes a key out.

    A short form of which a key is changed makes its values anew; one whose values are changed ends where the design is
    built (see `standing`).
    """
    if len(changes) > MOST_KEYS:
        raise DesignError(f"there are {len(changes)} changes; a design has less than {MOST_KEYS} numbers to change.")
    tables: dict[str, Any] = {}
    places: dict[str, list[tuple[str, Any]]] = {}
    taken: list[str] = []
    for key, value in changes.items():
        if not isinstance(key, str):
            raise DesignError(f"{shown(key)} is no key; keys of a change are text such as 'platform.mass'.")
        if "[" in key:
            places.setdefault(_canonical(key.partition("[")[0])[0], []).append((key, _parsed(key, value)))
        elif value is None:
            taken.append(key if key in TABLES else _canonical(key)[0])
        else:
            _nest(tables, key, _parsed(key, value))
    new = flatten(tables)
    opened = [form for form in forms if any(key in form for key in (*new, *places, *taken))]
    values = _opened(values, opened)
    for key in taken:
        _take_out(values, key)
    for key in (*_overruled(new, opened), *_other_stiffness(values, new)):
        values.pop(key, None)
    values |= new
    short = [key for key in places if any(key in form for form in opened)]
    for key in short:
        _set_places(values, places.pop(key))
    values, made = expand(values)
    for given in places.values():
        _set_places(values, given)
    return complete(values), (*(form for form in forms if form not in opened), *made)


def _opened(values: Values, forms: Iterable[ShortForm]) -> Values:
    """The values with some short forms in place of what these made."""
    made = {key for form in forms for key in form.made}
    found = {key: value for key, value in values.items() if key not in made}
    for form in forms:
        found |= form.values()
    return found


def _overruled(new: Values, opened: Iterable[ShortForm]) -> set[str]:
    """Keys that the short keys among the changes take the place of: plain ones, and those that say the same."""
    keys: set[str] = set()
    for table, makes in MAKES.items():
        given = {key[len(table) + 1 :] for key in new if key.startswith(f"{table}.")}
        if not given:
            continue
        needs = [(need,) if isinstance(need, str) else need for need in NEEDS[table.split(".")[-1]]]
        if not any(form.table == table for form in opened):
            missing = [" or ".join(need) for need in needs if not given & {*need}]
            if missing:
                raise DesignError(
                    f"{table}.{min(given)} is set, but this design has no [{table}]: it gives {' and '.join(makes)} as "
                    f"they are. Change these, or give {' and '.join(missing)} of {table} as well."
                )
            keys |= {*makes, *BESIDE.get(table, ())}
        if "half_angle" in given:
            _check_pairs(table, opened)
        keys |= {f"{table}.{key}" for need in needs if given & {*need} for key in need if key not in given}
    return keys


def _other_stiffness(values: Values, new: Values) -> set[str]:
    """Keys of the stiffness that another one takes the place of: a constant, a law, a law of another kind."""
    keys = {key for name, sets in SETS.items() if name in new for key in sets}
    law = {key for key in values if key.startswith("legs.stiffness_law.")}
    if "legs.stiffness" in new and not has_law(new):
        return keys | law
    if "legs.stiffness_law.kind" in new:
        keys.add("legs.stiffness")
        if new["legs.stiffness_law.kind"] != values.get("legs.stiffness_law.kind"):
            keys |= law
    return keys


def _check_pairs(table: str, opened: Iterable[ShortForm]) -> None:
    """Refuses a half angle for a circle whose joints are not the pairs that it stands for: they would change places."""
    for form in opened:
        angles = form.given.get("angles") if form.table == table else None
        if angles is not None and not stands_in_pairs(table.split(".")[0], angles):
            raise DesignError(
                f"{table}.half_angle is {KEYS[f'{table}.half_angle'].meaning}; the joints of this design are "
                f"elsewhere. Change {table}.angles."
            )


def _parsed(key: str, value: Any) -> Any:
    """Text is read as a TOML value, so that a command line can say what a file can."""
    if not isinstance(value, str) or key in TEXT_KEYS:
        return value
    try:
        parsed = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        parsed = {}
    if list(parsed) != ["value"]:
        must = "it must be a TOML value: a number such as 400 or a list [1, 2, 3], its unit at the end of the key"
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
    for full in [full for full in values if full == key or full.startswith(f"{key}.")]:
        del values[full]


def _canonical(key: str) -> tuple[str, str]:
    """A dotted key as written -> (its name without unit, its unit)."""
    table, _, last = key.rpartition(".")
    if table and table not in TABLES:
        parent, _, name = table.rpartition(".")
        unknown_key(parent, name)
    return resolve(table, last)


def _set_places(values: Values, given: Iterable[tuple[str, Any]]) -> None:
    for key, value in given:
        _set_place(values, key, value)


def _set_place(values: Values, key: str, value: Any) -> None:
    """One entry, row or matrix of a value: `legs.stiffness[2]`, `base.joints[0][2]`."""
    match = re.fullmatch(r"([^\[\]]+)((?:\[\d{1,9}\])+)", key)
    if match is None:
        raise DesignError(f"{key!r} is no key; write an index as in legs.stiffness[2], counting from 0.")
    canonical, unit = _canonical(match[1])
    if canonical in TEXT_KEYS or canonical not in values:
        raise DesignError(f"{key}: {canonical} is not a list in this design. Give {canonical} as a whole.")
    rule = rule_of(canonical)
    index = tuple(int(number) for number in re.findall(r"\d+", match[2]))
    shape = values[canonical].shape
    if is_of_each_leg(canonical) and shape[:1] != (6,):
        shape = (6, *(shape if ANY in rule.shapes[0] else rule.shapes[0]))
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
