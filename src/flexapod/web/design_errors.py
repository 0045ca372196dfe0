"""What is wrong with a design, at each of its fields: the key, the message and the line in the text."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Any

from flexapod.design import design_file
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS
from flexapod.errors import DesignError
from flexapod.web.answers import FieldError


class InvalidDesign(DesignError):
    """A design with all its errors, each at its field."""

    def __init__(self, errors: list[FieldError]) -> None:
        super().__init__(errors[0]["message"])
        self.errors = errors


def errors_in(text: str, error: DesignError) -> list[FieldError]:
    """Every key of the text that is wrong by itself; otherwise the error that stopped the reading."""
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError):
        line = re.search(r"at line (\d+)", str(error))
        return [{"key": "", "message": str(error), "line": int(line[1]) if line else 0}]
    found = [e for path, value in _leaves(tables) for e in _error_of_key(path, value, text)]
    return found or [error_at(str(error), text)]


def error_at(message: str, text: str = "") -> FieldError:
    """An error at the first key that its message names."""
    key = _key_in(message)
    return {"key": key, "message": message, "line": _line_of(text, key)}


def _leaves(tables: Mapping[str, Any], start: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], Any]]:
    """Paths and values of all keys of nested tables."""
    result: list[tuple[tuple[str, ...], Any]] = []
    for key, value in tables.items():
        path = (*start, key)
        result += _leaves(value, path) if isinstance(value, Mapping) and ".".join(path) in TABLES else [(path, value)]
    return result


def _error_of_key(path: tuple[str, ...], value: Any, text: str) -> list[FieldError]:
    """The error of a file that has only this key, if any."""
    alone = value
    for name in reversed(path):
        alone = {name: alone}
    try:
        design_file.flatten(alone)
    except DesignError as error:
        key = ".".join(path)
        return [{"key": _key_in(key) or key, "message": str(error), "line": _line_of(text, key)}]
    return []


def _key_in(message: str) -> str:
    """The first key of a design file that a message names, without unit or index."""
    known = sorted({*KEYS, *TEXT_KEYS}, key=len, reverse=True)
    places = [(message.find(key), -len(key), key) for key in known if key in message]
    return min(places)[2] if places else ""


def _line_of(text: str, key: str) -> int:
    """The line where a dotted key (its unit aside) is set in a design file; 0 if it is not."""
    table, _, last = key.rpartition(".")
    here = ""
    for number, line in enumerate(text.splitlines(), 1):
        header = re.match(r"\s*\[([\w.]+)\]\s*(#.*)?$", line)
        if header:
            here = header[1].strip()
        elif here == table and re.match(rf"\s*{re.escape(last)}(_\w+)?\s*=", line):
            return number
    return 0
