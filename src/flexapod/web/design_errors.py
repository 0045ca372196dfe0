"""What is wrong with a design, at each of its fields: the key, the message and the line in the text."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from flexapod.design import design_file
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS
from flexapod.design.units import ALL_UNITS
from flexapod.errors import DesignError
from flexapod.web.answers import FieldError

MOST = 20  # errors that are told one by one


class InvalidDesign(DesignError):
    """A design with all its errors, each at its field."""

    def __init__(self, errors: list[FieldError]) -> None:
        super().__init__(errors[0]["message"])
        self.errors = errors


def errors_in(text: str, error: DesignError) -> list[FieldError]:
    """Every key of the text that is wrong by itself; otherwise the error that stopped the reading."""
    try:
        tables = design_file.tables_of(text)
    except DesignError:
        line = re.search(r"(?:at |^)line (\d+)", str(error))
        return [{"key": "", "message": str(error), "line": int(line[1]) if line else 0}]
    lines = _lines(text)
    found = [e for path, value in _leaves(tables) for e in _error_of_key(path, value, lines)]
    return first(found) or [error_at(str(error), text)]


def first(errors: list[FieldError]) -> list[FieldError]:
    """The first errors of a long list, and how many more there are."""
    if len(errors) <= MOST:
        return errors
    return [*errors[:MOST], {"key": "", "message": f"There are {len(errors) - MOST} errors more.", "line": 0}]


def error_at(message: str, text: str = "") -> FieldError:
    """An error at the first key that its message names."""
    key = _key_in(message)
    return {"key": key, "message": message, "line": _line_of(_lines(text), key)}


def _leaves(tables: Mapping[str, Any], start: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], Any]]:
    """Paths and values of all keys of nested tables."""
    result: list[tuple[tuple[str, ...], Any]] = []
    for key, value in tables.items():
        path = (*start, key)
        result += _leaves(value, path) if isinstance(value, Mapping) and ".".join(path) in TABLES else [(path, value)]
    return result


def _error_of_key(path: tuple[str, ...], value: Any, lines: Mapping[tuple[str, str], int]) -> list[FieldError]:
    """The error of a file that has only this key, if any."""
    alone = value
    for name in reversed(path):
        alone = {name: alone}
    try:
        design_file.flatten(alone)
    except DesignError as error:
        key = ".".join(path)
        return [{"key": _key_in(key) or key, "message": str(error), "line": _line_of(lines, key)}]
    return []


def _key_in(message: str) -> str:
    """The first key of a design file that a message names, without unit or index."""
    known = sorted({*KEYS, *TEXT_KEYS}, key=len, reverse=True)
    places = [(message.find(key), -len(key), key) for key in known if key in message]
    return min(places)[2] if places else ""


def _lines(text: str) -> dict[tuple[str, str], int]:
    """The line where each key is first set in a design file, by its table and its name as it is written."""
    here = ""
    found: dict[tuple[str, str], int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        header = re.match(r"\s*\[([\w.]+)\]\s*(#.*)?$", line)
        key = re.match(r"\s*([\w-]+)\s*=", line)
        if header:
            here = header[1]
        elif key:
            found.setdefault((here, key[1]), number)
    return found


def _line_of(lines: Mapping[tuple[str, str], int], key: str) -> int:
    """The line where a dotted key is set, whatever its unit; 0 if it is not."""
    table, _, last = key.rpartition(".")
    if (table, last) in lines:
        return lines[table, last]
    units = (number for (at, name), number in lines.items() if at == table and _unit_of(name, last) in ALL_UNITS)
    return next(units, 0)


def _unit_of(name: str, key: str) -> str:
    return name[len(key) + 1 :] if name.startswith(f"{key}_") else ""
