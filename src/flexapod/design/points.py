"""The named points of a design: places on the platform that studies and commands may be asked for by name."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.design.schema import POINT, POINTS
from flexapod.design.units import ALL_UNITS
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown

LONGEST_NAME = 40
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*", re.ASCII)


class Points(Mapping[str, Array]):
    """Points of the platform by name, read-only: (3,) m each, in the platform's frame, in order of their names."""

    def __init__(self, given: Mapping[str, Any] | None = None) -> None:
        if not isinstance(given, Mapping | None):
            raise DesignError(f"points is {shown(given)}; it must be a mapping from names to [x, y, z].")
        found = {}
        for name, place in (given or {}).items():
            check_name(name)
            array = check_value(f"{POINTS}.{name}", place, POINT)
            array.flags.writeable = False
            found[name] = array
        self._points = dict(sorted(found.items()))

    def __getitem__(self, name: str) -> Array:
        return self._points[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._points)

    def __len__(self) -> int:
        return len(self._points)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mapping):
            return NotImplemented
        return self.keys() == other.keys() and all(np.array_equal(self[name], other[name]) for name in self)

    __hash__ = None  # type: ignore[assignment]  # as of any mapping

    def __repr__(self) -> str:
        return repr({name: place.tolist() for name, place in self.items()})


def check_name(name: object) -> None:
    """Refuses what is no name of a point: a letter, then letters, digits, - and _."""
    if not isinstance(name, str) or not _NAME.fullmatch(name) or len(name) > LONGEST_NAME:
        raise DesignError(
            f"{POINTS} has the name {shown(name)}; the name of a point is a letter followed by letters, digits, - and "
            f"_, at most {LONGEST_NAME} in all, such as vertex."
        )
    unit = next((unit for unit in ALL_UNITS if name.endswith(f"_{unit}")), None)
    if unit is not None:
        raise DesignError(f"{POINTS}.{name} ends in {unit!r}, which a file reads as a unit. Give another name.")


def points_of(values: Mapping[str, Any]) -> Points:
    """The points among the values of a design by file key. Raises DesignError for a name or a place that is none."""
    start = f"{POINTS}."
    return Points({key[len(start) :]: value for key, value in values.items() if key.startswith(start)})


def values_of_points(points: Mapping[str, Array]) -> dict[str, Array]:
    """Points by dotted file key."""
    return {f"{POINTS}.{name}": place for name, place in points.items()}
