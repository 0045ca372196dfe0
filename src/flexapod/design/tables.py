"""Nested tables of a design to checked values under dotted keys, and what is filled in or missing."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from flexapod.design.key_names import resolve
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS, rule_of
from flexapod.design.shorthands import Values
from flexapod.design.units import printed, si_unit
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown

_REQUIRED = ("base.joints", "platform.joints", "platform.mass", "platform.mass_center", "platform.inertia")
_SHORT_FORMS = {
    "base.joints": "[base.circle], [cubic] or [joints] with csv",
    "platform.joints": "[platform.circle], [cubic] or [joints] with csv",
}
DEFAULT_GRAVITY = np.array([0.0, 0.0, -9.81])
LONGEST_TEXT = 255  # characters of a name, as of a file's
START = "`flexapod new my-machine.toml` writes a design to start from."


def flatten(tables: Mapping[str, Any], table: str = "") -> Values:
    """Nested tables to checked values under dotted keys without units."""
    values: Values = {}
    written: dict[str, str] = {}
    for key, value in tables.items():
        full = f"{table}.{key}" if table else key
        if full in TABLES:
            values |= flatten(table_of(value, full), full)
            continue
        canonical, unit = resolve(table, key)
        if canonical in written:
            raise DesignError(f"{written[canonical]} and {full} both give {canonical}. Leave one of them out.")
        written[canonical] = full
        values[canonical] = _check(full, canonical, value, unit)
    return values


def _check(name: str, canonical: str, value: Any, unit: str) -> Any:
    if canonical not in TEXT_KEYS:
        return check_value(name, value, rule_of(canonical), unit)
    if not isinstance(value, str) or not value.strip():
        raise DesignError(f'{name} is {shown(value)}; it must be text. Write {name} = "{TEXT_KEYS[canonical]}".')
    if not is_text(value):
        raise DesignError(f"{name} is {shown(value)}; it must be text that UTF-8 can hold. Leave such characters out.")
    if len(value) > LONGEST_TEXT:
        raise DesignError(f"{name} has {len(value)} characters; it must have at most {LONGEST_TEXT}. Shorten it.")
    return value


def is_text(value: str) -> bool:
    """Whether a string can be written to a file; those that stand for the bytes of a file's name may not."""
    return value == value.encode(errors="replace").decode()


def table_of(value: Any, name: str) -> Any:
    """The value, which must be a table."""
    if not isinstance(value, Mapping):
        raise DesignError(f"{name} is {shown(value)}; it must be a table. Write [{name}] and its keys below it.")
    return value


def complete(values: Values) -> Values:
    """Values with the defaults filled in. Raises DesignError that lists every key that is missing."""
    required = _REQUIRED if has_law(values) else (*_REQUIRED, "legs.stiffness")
    if has_law(values) and "legs.stiffness" in values:
        raise DesignError(
            "legs.stiffness and [legs.stiffness_law] are both given, and both say how stiff the legs are. Leave one of "
            "them out."
        )
    missing = [key for key in required if key not in values]
    parts = [part for part in ("legs.lower", "legs.upper") if any(key.startswith(f"{part}.") for key in values)]
    for part in parts:
        missing += [f"{part}.{key}" for key in ("mass", "mass_center", "inertia") if f"{part}.{key}" not in values]
    if len(parts) == 1:
        other = "legs.upper" if parts == ["legs.lower"] else "legs.lower"
        raise DesignError(
            f"[{other}] is missing while [{parts[0]}] is given. Give both parts (one may have mass 0), "
            "or leave both out for massless legs."
        )
    poses = [pose for pose in ("home", "legs.joint_rest") if f"{pose}.orientation" in values]
    missing += [f"{pose}.position" for pose in poses if f"{pose}.position" not in values]
    if missing:
        lines = "; ".join(f"{key} ({_how_to_give(key)})" for key in missing)
        raise DesignError(f"missing: {lines}. Add {'it' if len(missing) == 1 else 'them'} to the design. {START}")
    zero = np.zeros(())
    defaults: Values = {"gravity": DEFAULT_GRAVITY}
    defaults |= {key: np.array(rule.default) for key, rule in KEYS.items() if rule.default is not None}
    for part in ("legs.lower", "legs.upper"):
        defaults |= {f"{part}.mass": zero, f"{part}.mass_center": np.zeros(3), f"{part}.inertia": np.zeros((3, 3))}
    for pose in ("home", "legs.joint_rest"):
        if f"{pose}.position" in values:
            defaults[f"{pose}.orientation"] = np.zeros(3)
    return defaults | values


def has_law(values: Values) -> bool:
    """Whether a stiffness law is given, or a part of one."""
    return any(key.startswith("legs.stiffness_law.") for key in values)


def _how_to_give(key: str) -> str:
    rule = KEYS[key]
    unit = printed(si_unit(rule.dimension))
    short = f", or {_SHORT_FORMS[key]}" if key in _SHORT_FORMS else ""
    return f"{rule.meaning}: {rule.shape_text}, {unit}{short}"
