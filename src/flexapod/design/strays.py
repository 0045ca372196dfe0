"""Numbers of a design that are known up to a range only and have no worst end: places of joints and mass centre."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design import layout
from flexapod.design.form_numbers import with_numbers
from flexapod.design.hexapod import Hexapod

#: Keys of the numbers that may stray.
KEYS = ("base.joints", "platform.joints", "platform.mass_center")
MOST = 40  # strays of a design


class Stray(NamedTuple):
    """A variable from -1 to 1: what it adds to numbers of `Hexapod.packed`, SI. words: its name for readers."""

    words: str
    numbers: tuple[int, ...]
    reach: tuple[float, ...]


def rows_of(strays: Sequence[Stray]) -> Array:
    """What each of some strays adds to the numbers of a design, (n, design_size)."""
    rows = np.zeros((len(strays), _core.design_size))
    for row, stray in zip(rows, strays, strict=True):
        row[list(stray.numbers)] = stray.reach
    return rows


def strayed(hexapod: Hexapod, strays: Sequence[Stray], values: Sequence[float]) -> Hexapod:
    """A design whose strays have values from -1 to 1; itself without them. Raises DesignError where it is none."""
    if not np.any(values):
        return hexapod
    numbers = layout.with_short_forms(hexapod)
    changes = np.asarray(values) @ rows_of(strays)
    numbers[: len(changes)] += changes
    return with_numbers(hexapod, numbers, np.concatenate([changes != 0, np.zeros(layout.FULL - len(changes), bool)]))


def data_of(strays: Sequence[Stray]) -> list[dict[str, Any]]:
    """Strays as plain data, by keys of the design file."""
    return [
        {"words": one.words, "reach": {layout.describe(k): r for k, r in zip(one.numbers, one.reach, strict=True)}}
        for one in strays
    ]


def strays_of(data: Sequence[Mapping[str, Any]]) -> tuple[Stray, ...]:
    """Strays of plain data. Raises KeyError, TypeError, ValueError or ArgumentError where they are none."""
    found = []
    for one in data:
        numbers = [int(layout.entries(key)[0].item()) for key in one["reach"]]
        if any(layout.owner(number) not in KEYS for number in numbers):
            raise ValueError(f"{one['words']!r} may not stray")
        found.append(Stray(str(one["words"]), tuple(numbers), tuple(map(float, one["reach"].values()))))
    return tuple(found)
