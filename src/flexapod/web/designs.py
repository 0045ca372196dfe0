"""Designs that a page sends: the text of a design file, changes to it, and the hexapod that they give."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any, NamedTuple

from flexapod.design.hexapod import Hexapod
from flexapod.design.text_limits import MOST_KEYS
from flexapod.errors import DesignError
from flexapod.web.answers import FieldError
from flexapod.web.design_errors import InvalidDesign, error_at, errors_in, first
from flexapod.web.parameters import RADII, with_radius


class Source(NamedTuple):
    """A design as a page holds it: the text of its file, and changes to it as JSON text of an object."""

    text: str
    changes: str = "{}"


@lru_cache(maxsize=256)
def built(source: Source) -> Hexapod:
    """The hexapod of a source. Raises InvalidDesign with every field that is wrong."""
    changes = json.loads(source.changes)
    hexapod = original(source.text)
    return _changed(hexapod, changes) if changes else hexapod


@lru_cache(maxsize=64)
def original(text: str) -> Hexapod:
    """The hexapod of a design file's text, without changes."""
    try:
        return Hexapod.from_toml(text)
    except DesignError as error:
        raise InvalidDesign(errors_in(text, error)) from error


def _changed(hexapod: Hexapod, changes: dict[str, Any]) -> Hexapod:
    try:
        return _apply(hexapod, changes)
    except DesignError as error:
        if len(changes) > MOST_KEYS:
            raise InvalidDesign([error_at(str(error))]) from error
        alone: list[FieldError] = []
        for key, value in changes.items():
            try:
                _apply(hexapod, {key: value})
            except DesignError as own:
                alone.append({"key": key, "message": str(own), "line": 0})
        raise InvalidDesign(first(alone) or [error_at(str(error))]) from error


def _apply(hexapod: Hexapod, changes: dict[str, Any]) -> Hexapod:
    plain = {key: value for key, value in changes.items() if key not in RADII}
    if plain:
        hexapod = hexapod.replace(plain)
    for key in RADII & changes.keys():
        hexapod = with_radius(hexapod, key, changes[key])
    return hexapod
