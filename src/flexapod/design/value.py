"""What the parts of a design have in common: frozen values, checked, equal and hashed by their numbers."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.design.home import Home
from flexapod.design.schema import KEYS
from flexapod.design.value_checks import check_value
from flexapod.showing import in_notebooks

#: Metadata of fields that came later: None there leaves the bytes of a design as they were.
ADDED = MappingProxyType({"added": True})


@in_notebooks
class Value:
    """A frozen bundle of read-only arrays, equal and hashed by value; copies and pickles are built and checked anew."""

    def state(self) -> dict[str, Any]:
        """What the bundle is made from, by field."""
        return {item.name: getattr(self, item.name) for item in fields(self) if item.init}  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and bytes_of(self) == bytes_of(other)

    def __hash__(self) -> int:
        return hash(bytes_of(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(type(self), **self.state()), ()

    def set_checked(self, name: str, value: Any, key: str, shape: tuple[int, ...] | None = None) -> None:
        """Store a checked value, spread over the legs when `shape` says so."""
        array = check_value(key, value, KEYS[key])
        self.hold(name, array if shape is None else np.broadcast_to(array, shape))

    def hold(self, name: str, value: Array) -> None:
        """Store a copy of an array, read-only."""
        array = value.copy()
        array.flags.writeable = False
        object.__setattr__(self, name, array)


def bytes_of(value: Any) -> bytes:
    """Every number of a design in one string of bytes; parts that are left out are marked."""
    if isinstance(value, Home):
        return b"(" + bytes_of(value.position) + b"," + bytes_of(value.rpy) + b")"
    if isinstance(value, Value):
        compared = []
        for item in fields(value):  # type: ignore[arg-type]
            given = getattr(value, item.name)
            if item.metadata.get("added"):
                compared += [] if given is None else [item.name.encode() + bytes_of(given)]
            elif item.init and item.compare:
                compared.append(bytes_of(given))
        return b"(" + b",".join(compared) + b")"
    if isinstance(value, Mapping):
        return b"{" + b",".join(key.encode() + bytes_of(item) for key, item in value.items()) + b"}"
    if isinstance(value, np.ndarray):
        return str(value.shape).encode() + value.tobytes()
    return repr(value).encode()
