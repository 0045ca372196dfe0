"""Design files: TOML text to checked values in SI units, changes to such values, and values back to TOML text.

Values are a flat dict: the file's dotted keys without units -> arrays in SI units (`name` is text).
"""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS, check_value, resolve, unknown_key
from flexapod.design.shorthands import Values, expand
from flexapod.design.units import printed, si_unit
from flexapod.errors import DesignError, shown

_DESIGNS = Path(__file__).parent / "machines"
_TEMPLATE = "template"
_START = "`flexapod new my-machine.toml` writes a design to start from."
_REQUIRED = ("base.joints", "platform.joints", "platform.mass", "platform.mass_center", "platform.inertia")
_SHORT_FORMS = {
    "base.joints": "[base.circle], [cubic] or [joints] with csv",
    "platform.joints": "[platform.circle], [cubic] or [joints] with csv",
}


def packaged_designs() -> list[str]:
    """Names of the designs that come with Flexapod.

    Raises: nothing of its own.
    Source: own.
    """
    return sorted(path.stem for path in _DESIGNS.glob("*.toml") if path.stem != _TEMPLATE)


def find(name_or_path: str | Path) -> Path:
    """The file behind a packaged name or a path. Raises DesignError that lists the names when there is none."""
    text = str(name_or_path)
    if isinstance(name_or_path, str) and text in packaged_designs():
        return _DESIGNS / f"{text}.toml"
    path = Path(name_or_path)
    try:
        is_directory, exists = path.is_dir(), path.exists()
    except OSError:  # such as a name too long for the file system
        is_directory, exists = False, False
    if is_directory:
        raise DesignError(f"{text!r} is a directory; a design is a .toml file. Give the file in it.")
    if not exists:
        from difflib import get_close_matches

        near = get_close_matches(path.stem.lower(), packaged_designs(), n=1)
        hint = f"Did you mean {near[0]!r}? " if near else ""
        names = ", ".join(packaged_designs())
        raise DesignError(
            f"{text!r} is neither a file nor a packaged design. {hint}Packaged designs: {names}. "
            f"A design of your own: give the path of its .toml file; {_START}"
        )
    return path


def template(name: str) -> str:
    """A complete, commented design file (TOML text, SI units) for a new machine called `name`.

    Raises: nothing of its own.
    Source: own.
    """
    import tomlkit  # slow to import, and only writing needs it

    text = (_DESIGNS / f"{_TEMPLATE}.toml").read_text(encoding="utf-8")
    return text.replace('name = "template"', f"name = {tomlkit.item(name).as_string()}", 1)


def read_file(path: Path) -> Values:
    """Values of a design file. Without a name in it, the design is named after the file."""
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise DesignError(f"{path} is not a text file in UTF-8, so no TOML design. {_START}") from None
    except OSError as error:
        raise DesignError(f"{path} cannot be read: {error.strerror}. Check the file's permissions.") from error
    try:
        values = read_text(text, path.parent)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error
    values.setdefault("name", path.stem)
    return values


def self_contained(path: Path) -> str:
    """The text of a design file, with the numbers in place of another file that it names, where that can be read."""
    text = path.read_text("utf-8-sig", "replace")
    try:
        joints = tomllib.loads(text).get("joints")
        return write_text(read_file(path)) if isinstance(joints, dict) and "csv" in joints else text
    except (ValueError, RecursionError):  # no TOML, or no design
        return text


def read_text(text: str, directory: Path | None = None) -> Values:
    """Values of a design given as TOML text, short forms expanded. directory: where the files that it names are."""
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: wrong TOML, or an integer of thousands of digits
        raise DesignError(f"this is not TOML: {error}. Correct that line; {_START}") from None
    if not tables:
        raise DesignError(f"the design is empty; it must have [base], [platform] and [legs]. {_START}")
    return complete(expand(flatten(tables), directory))


def flatten(tables: Mapping[str, Any], table: str = "") -> Values:
    """Nested tables to checked values under dotted keys without units."""
    values: Values = {}
    written: dict[str, str] = {}
    for key, value in tables.items():
        full = f"{table}.{key}" if table else key
        if full in TABLES:
            values |= flatten(_table(value, full), full)
            continue
        canonical, unit = resolve(table, key)
        if canonical in written:
            raise DesignError(f"{written[canonical]} and {full} both give {canonical}. Leave one of them out.")
        written[canonical] = full
        values[canonical] = _check(full, canonical, value, unit)
    return values


def _check(name: str, canonical: str, value: Any, unit: str) -> Any:
    if canonical not in TEXT_KEYS:
        return check_value(name, value, KEYS[canonical], unit)
    if not isinstance(value, str) or not value.strip():
        example = "my hexapod" if canonical == "name" else "joints.csv"
        raise DesignError(f'{name} is {shown(value)}; it must be text. Write {name} = "{example}".')
    return value


def complete(values: Values) -> Values:
    """Values with the defaults filled in. Raises DesignError that lists every key that is missing."""
    missing = [key for key in (*_REQUIRED, "legs.stiffness") if key not in values]
    parts = [part for part in ("legs.lower", "legs.upper") if any(key.startswith(f"{part}.") for key in values)]
    for part in parts:
        missing += [f"{part}.{key}" for key in ("mass", "mass_center", "inertia") if f"{part}.{key}" not in values]
    if len(parts) == 1:
        other = "legs.upper" if parts == ["legs.lower"] else "legs.lower"
        raise DesignError(
            f"[{other}] is missing while [{parts[0]}] is given. Give both parts (one may have mass 0), "
            "or leave both out for massless legs."
        )
    if "home.orientation" in values and "home.position" not in values:
        missing.append("home.position")
    if missing:
        lines = "; ".join(f"{key} ({_how_to_give(key)})" for key in missing)
        raise DesignError(f"missing: {lines}. Add {'it' if len(missing) == 1 else 'them'} to the design. {_START}")
    zero = np.zeros(())
    defaults: Values = {"gravity": np.array([0.0, 0.0, -9.81])}
    defaults |= {f"legs.damping.{joint}": zero for joint in ("prismatic", "universal", "spherical")}
    for part in ("legs.lower", "legs.upper"):
        defaults |= {f"{part}.mass": zero, f"{part}.mass_center": np.zeros(3), f"{part}.inertia": np.zeros((3, 3))}
    if "home.position" in values:
        defaults["home.orientation"] = np.zeros(3)
    return defaults | values


def _how_to_give(key: str) -> str:
    rule = KEYS[key]
    unit = printed(si_unit(rule.dimension))
    short = f", or {_SHORT_FORMS[key]}" if key in _SHORT_FORMS else ""
    return f"{rule.meaning}: {rule.shape_text}, {unit}{short}"


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
        here = _table(here.setdefault(name, {}), ".".join(path[: depth + 1]))
    here[last] = {**_table(here.get(last, {}), key), **value} if isinstance(value, Mapping) else value


def _table(value: Any, name: str) -> Any:
    if not isinstance(value, Mapping):
        raise DesignError(f"{name} is {shown(value)}; it must be a table. Write [{name}] and its keys below it.")
    return value


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


def write_text(values: Values) -> str:
    """Values as a commented TOML file in SI units; reading it gives the same numbers bit for bit."""
    import tomlkit  # slow to import, and only writing needs it

    document = tomlkit.document()
    document.add("name", tomlkit.item(values["name"]))
    for key, value in values.items():
        if key in TEXT_KEYS:
            continue
        *path, last = key.split(".")
        here: Any = document
        for name in path:
            if name not in here:
                here.add(name, tomlkit.table())
            here = here[name]
        value = _one_for_all(key, value)
        item = tomlkit.item(value.tolist())
        if value.ndim > 1:
            item.multiline(True)
        rule = KEYS[key]
        unit = printed(si_unit(rule.dimension))
        item.comment(f"{rule.meaning}, {unit}" if unit else rule.meaning)
        here.add(last, item)
    return tomlkit.dumps(document)


def _one_for_all(key: str, value: Any) -> Any:
    """One value where all six legs have the same, else the value itself."""
    per_leg = key.startswith("legs.") and value.shape == (6, *KEYS[key].shapes[0])
    return value[0] if per_leg and (value == value[0]).all() else value
