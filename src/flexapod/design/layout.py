"""The numbers of a design that a search may change.

Those of `Hexapod.packed`, after them six of the home pose, and then those of all short forms, which make some of the
others.
"""

from __future__ import annotations

import math
import re

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import LEGS, ROTATIONS, TRANSLATIONS, Array
from flexapod.design import packing
from flexapod.design.hexapod import Hexapod
from flexapod.design.key_names import resolve
from flexapod.design.schema import KEYS, Key
from flexapod.design.shorthands import MAKES
from flexapod.design.units import printed, to_si
from flexapod.errors import ArgumentError, DesignError

HOME = slice(_core.design_size, _core.design_size + 6)
SIZE = HOME.stop
#: Key of the design file -> numbers of its entries, in the key's shape.
PLACES = packing.PLACES | {
    "home.position": np.arange(HOME.start, HOME.start + 3),
    "home.orientation": np.arange(HOME.start + 3, SIZE),
}


def _short_places() -> dict[str, NDArray[np.int64]]:
    places: dict[str, NDArray[np.int64]] = {}
    first = SIZE
    for key, rule in KEYS.items():
        if key.rpartition(".")[0] in MAKES:
            shape = rule.shapes[-1]  # what may be one for all legs is a number of each
            places[key] = np.arange(first, first := first + math.prod(shape)).reshape(shape)
    return places


#: The same of the keys of short forms.
SHORT = _short_places()
FULL = SIZE + sum(place.size for place in SHORT.values())
EVERY = PLACES | SHORT
#: What optional keys of a short form that is given are where they are left out.
_LEFT_OUT = {"circle.height": 0.0, "rod.radius": 0.0, "cubic.center_in_platform": 0.0}


def numbers(hexapod: Hexapod) -> Array:
    """The design as `SIZE` numbers; those of a home pose that is not there are NaN."""
    home = np.full(6, np.nan) if hexapod.home is None else np.concatenate([hexapod.home.position, hexapod.home.rpy])
    return np.concatenate([hexapod.packed, home])


def with_short_forms(hexapod: Hexapod) -> Array:
    """The design as `FULL` numbers; those of short forms that it does not have are NaN as well."""
    found = np.concatenate([numbers(hexapod), np.full(FULL - SIZE, np.nan)])
    for form in hexapod.short_forms:
        for key, value in _LEFT_OUT.items():
            if key.partition(".")[0] == form.table.rpartition(".")[2]:
                found[SHORT[f"{form.table}.{key.partition('.')[2]}"]] = value
        for key, number in form.values().items():
            found[SHORT[key]] = number
    return found


def own(hexapod: Hexapod, index: NDArray[np.int64], name: str) -> Array:
    """Numbers of the design. Raises ArgumentError for those that it does not have."""
    found = with_short_forms(hexapod)[index]
    missing = index[np.isnan(found)]
    if not missing.size:
        return found
    if missing[0] < SIZE:
        raise ArgumentError(f"{name} changes the home pose, but {hexapod.name!r} names none. Add [home].")
    table, _, key = owner(int(missing[0])).rpartition(".")
    if any(form.table == table for form in hexapod.short_forms):
        raise ArgumentError(f"{name}: [{table}] of {hexapod.name!r} does not give {key}, but another key in its place.")
    plate = table.partition(".")[0]
    hint = f' Use JointCircle("{plate}", ...), which makes circles of any joints.' if ".circle" in table else ""
    raise ArgumentError(
        f"{name}: {hexapod.name!r} has no [{table}]; it gives {' and '.join(MAKES[table])} as they are. Take these, or "
        f"write the design with [{table}].{hint}"
    )


def entries(key: str) -> tuple[NDArray[np.int64], Key, float]:
    """`platform.joints_mm[0][2]` or `base.joints[:][2]` -> numbers of its entries, its rule, its unit in SI units.

    Raises ArgumentError for what is no number of a design.
    """
    match = re.fullmatch(r"([^\[\]]+)((?:\[(?:\d+|:)\])*)", key)
    if match is None:
        raise ArgumentError(
            f"{key!r} is no number of a design; write it as legs.stiffness[2] or platform.joints[:][2]."
        )
    table, _, last = match[1].rpartition(".")
    try:
        name, unit = resolve(table, last)
    except DesignError as error:
        raise ArgumentError(f"{key}: {error}") from None
    if name not in EVERY:
        raise ArgumentError(f"{key} is not a number that a search can change. There are: {', '.join(sorted(EVERY))}.")
    rule = KEYS[name]
    scale = float(to_si(1.0, rule.dimension, unit)) if rule.dimension else 1.0
    index = tuple(slice(None) if i == ":" else int(i) for i in re.findall(r"\[(\d+|:)\]", match[2]))
    place = EVERY[name]
    try:
        chosen = place[index]
    except IndexError:
        shape = " x ".join(map(str, place.shape)) or "one number"
        raise ArgumentError(f"{key} is outside {name}, which is {shape}. Indices count from 0.") from None
    return np.unique(chosen), rule, scale


def unit_name(key: str) -> str:
    """The unit of a key that `entries` takes, as people write it: "mm" of platform.joints_mm[0]; "" if it has none."""
    table, _, last = key.partition("[")[0].rpartition(".")
    return printed(resolve(table, last)[1])


def describe(number: int) -> str:
    """The key of one of the numbers, such as platform.joints[0][2]."""
    return owner(number) + "".join(f"[{i}]" for i in indices(number))


def indices(number: int) -> list[int]:
    """The indices of one of the numbers within its key, counted from 0."""
    return [int(i) for i in np.argwhere(EVERY[owner(number)] == number)[0]]


def words(number: int) -> str:
    """Which of its key's numbers it is, for readers: "leg 3", "leg 3, y", "xz"; "" for a key of one number."""
    at = indices(number)
    leg = [f"leg {LEGS[at.pop(0)]}"] if at and len(EVERY[owner(number)]) == len(LEGS) else []
    axes = ROTATIONS if owner(number) == "home.orientation" else TRANSLATIONS
    return ", ".join([*leg, *filter(None, ("".join(axes[i] for i in at),))])


def owner(number: int) -> str:
    """The key that one of the numbers is of."""
    return next(key for key, place in EVERY.items() if number in place)
