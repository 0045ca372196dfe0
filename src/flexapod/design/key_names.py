"""Names of keys as people write them: with a unit at the end, misspelt, or in another table."""

from collections.abc import Sequence
from functools import cache
from typing import NoReturn

from flexapod.design.key import Key
from flexapod.design.schema import KEYS, POINT, POINTS, TABLES, TEXT_KEYS
from flexapod.design.units import ALL_UNITS, UNITS, si_unit
from flexapod.errors import DesignError

LONGEST = 80  # characters of a key: names are compared letter by letter, and told


@cache
def children(table: str) -> tuple[str, ...]:
    """Names that may stand in a table of the file ("" is the file itself), tables included."""
    start = f"{table}." if table else ""
    known = {*KEYS, *TEXT_KEYS, *TABLES}
    return tuple(sorted({key[len(start) :].split(".")[0] for key in known if key.startswith(start)}))


def resolve(table: str, key: str) -> tuple[str, str]:
    """A key as written -> (its dotted name without unit, its unit). Raises DesignError for a key that is not one."""
    if len(key) > LONGEST:
        unknown_key(table, f"{key[:LONGEST]}...")
    if table == POINTS:
        return _point(key)
    start = f"{table}." if table else ""
    known = [child for child in children(table) if start + child not in TABLES]
    if key in known:
        rule = KEYS.get(start + key)
        return start + key, si_unit(rule.dimension) if rule else ""
    stems = [child for child in known if key.startswith(f"{child}_")]
    if stems:
        stem = max(stems, key=len)
        unit = key[len(stem) + 1 :]
        rule = KEYS.get(start + stem)
        allowed = UNITS[rule.dimension] if rule and rule.dimension else {}
        if unit in allowed:
            return start + stem, unit
        if unit in ALL_UNITS or not _near(key, [child for child in children(table) if child != stem]):
            _wrong_unit(start + key, start + stem, unit, rule)
    unknown_key(table, key)


def _point(key: str) -> tuple[str, str]:
    """The name of a point that a key gives, and the unit of length at its end."""
    endings = [unit for unit in ALL_UNITS if key.endswith(f"_{unit}")]
    if not endings:
        return f"{POINTS}.{key}", si_unit(POINT.dimension)
    unit = max(endings, key=len)
    stem = f"{POINTS}.{key[: -len(unit) - 1]}"
    if unit not in UNITS["length"]:
        _wrong_unit(f"{POINTS}.{key}", stem, unit, POINT)
    return stem, unit


def _wrong_unit(key: str, stem: str, unit: str, rule: Key | None) -> NoReturn:
    if rule is None or rule.dimension is None:
        raise DesignError(f"{key} carries the unit {unit!r}; {stem} has none. Write {stem} = ...")
    is_a = f"is no unit of {rule.dimension}" if unit in ALL_UNITS else "is not a unit Flexapod knows"
    article = "an" if rule.dimension[0] in "aeiou" else "a"
    allowed = ", ".join(f"{stem.split('.')[-1]}_{known}" for known in UNITS[rule.dimension])
    raise DesignError(
        f"{key}: {unit!r} {is_a}; {stem} is {article} {rule.dimension}. Use {stem} (SI) or one of: {allowed}."
    )


def unknown_key(table: str, key: str) -> NoReturn:
    """Refuse a key, with the nearest keys there are."""
    where = f"[{table}]" if table else "the top level"
    name = f"{table}.{key}" if table else key
    here = children(table)
    start = f"{table}." if table else ""
    near = _elsewhere(key) or [start + match for match in _near(key, here)]
    hint = f"Did you mean {' or '.join(near)}? " if near else ""
    raise DesignError(f"{name} is not a key of a design. {hint}Keys of {where}: {', '.join(here)}.")


def _elsewhere(key: str) -> list[str]:
    """Keys of this name in other tables, with the unit that it carries."""
    found = []
    for full in sorted({*KEYS, *TABLES}):
        for name in (full.split(".")[-1], full.replace(".", "_")):  # also as Hexapod's fields are called
            if key == name or (key.startswith(f"{name}_") and key[len(name) + 1 :] in ALL_UNITS):
                found.append(full + key[len(name) :])
    return list(dict.fromkeys(found))


def _near(word: str, known: Sequence[str]) -> list[str]:
    from difflib import get_close_matches  # only a wrong key needs it

    return get_close_matches(word, known, n=2, cutoff=0.72)
