"""Numbers that are known up to a range only and have no worst end: places of joints, mass centre and payload."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import TRANSLATIONS, Array
from flexapod.design import layout
from flexapod.design.form_numbers import with_numbers
from flexapod.design.hexapod import Hexapod
from flexapod.design.payload import add_payload, with_payload

#: Keys of the numbers that may stray.
KEYS = ("base.joints", "platform.joints", "platform.mass_center")
MOST = 40  # strays of a design
#: Numbers of a payload's place, which come after those of the design.
AT_PAYLOAD = tuple(range(_core.design_size, _core.stray_numbers))
_PAYLOAD = "payload."  # and an axis: the name of such a number


class Stray(NamedTuple):
    """A variable from -1 to 1: what it adds to numbers of `Hexapod.packed`, or to those of `AT_PAYLOAD`, SI.

    words: its name for readers.
    """

    words: str
    numbers: tuple[int, ...]
    reach: tuple[float, ...]


def rows_of(strays: Sequence[Stray]) -> Array:
    """What each of some strays adds to the numbers of a design and of its payload's place, (n, stray_numbers)."""
    rows = np.zeros((len(strays), _core.stray_numbers))
    for row, stray in zip(rows, strays, strict=True):
        row[list(stray.numbers)] = stray.reach
    return rows


def strayed(
    hexapod: Hexapod, strays: Sequence[Stray], values: Sequence[float], payload: Sequence[float] = ()
) -> Hexapod:
    """A design whose strays have values from -1 to 1, none standing for zeros. Raises DesignError where it is none.

    payload: mass (kg) and place (m) of a load beside the design's, (4,), or nothing.
    """
    changes = np.asarray(values) @ rows_of(strays) if len(values) else np.zeros(_core.stray_numbers)
    own = changes[: _core.design_size]
    if own.any():
        numbers = layout.with_short_forms(hexapod)
        numbers[: len(own)] += own
        changed = np.concatenate([own != 0, np.zeros(layout.FULL - len(own), bool)])
        hexapod = with_numbers(hexapod, numbers, changed)
    if not len(payload):
        return hexapod
    mass, *place = payload
    return with_payload(hexapod, mass, np.array(place) + changes[list(AT_PAYLOAD)], np.zeros((3, 3)))


def strayed_numbers(hexapod: Hexapod, strays: Sequence[Stray], values: Array, payload: Sequence[float] = ()) -> Array:
    """`Hexapod.packed` of what `strayed` makes of each row of values (m, n), unchecked: (m, design_size)."""
    changes = values @ rows_of(strays)
    designs = np.asarray(hexapod.packed + changes[:, : _core.design_size])
    if len(payload):
        mass, *place = payload
        add_payload(designs, np.full(len(designs), mass), np.array(place) + changes[:, AT_PAYLOAD])
    return designs


def data_of(strays: Sequence[Stray]) -> list[dict[str, Any]]:
    """Strays as plain data, by keys of the design file."""
    return [
        {"words": one.words, "reach": {_name(k): r for k, r in zip(one.numbers, one.reach, strict=True)}}
        for one in strays
    ]


def strays_of(data: Sequence[Mapping[str, Any]]) -> tuple[Stray, ...]:
    """Strays of plain data. Raises KeyError, TypeError, ValueError or ArgumentError where they are none."""
    return tuple(
        Stray(
            str(one["words"]),
            tuple(_number(str(one["words"]), key) for key in one["reach"]),
            tuple(map(float, one["reach"].values())),
        )
        for one in data
    )


def _name(number: int) -> str:
    return _PAYLOAD + TRANSLATIONS[AT_PAYLOAD.index(number)] if number in AT_PAYLOAD else layout.describe(number)


def _number(words: str, key: str) -> int:
    if key.startswith(_PAYLOAD):
        return AT_PAYLOAD[TRANSLATIONS.index(key.removeprefix(_PAYLOAD))]
    number = int(layout.entries(key)[0].item())
    if layout.owner(number) not in KEYS:
        raise ValueError(f"{words!r} may not stray")
    return number
