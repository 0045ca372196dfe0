"""The numbers of a design that a search may change: those of `Hexapod.packed`, and after them six of the home pose."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import LEGS, ROTATIONS, TRANSLATIONS, Array
from flexapod.design import packing
from flexapod.design.hexapod import Hexapod
from flexapod.design.key_names import resolve
from flexapod.design.schema import KEYS, Key
from flexapod.design.units import printed, to_si
from flexapod.errors import ArgumentError, DesignError

HOME = slice(_core.design_size, _core.design_size + 6)
SIZE = HOME.stop
#: Key of the design file -> numbers of its entries, in the key's shape.
PLACES = packing.PLACES | {
    "home.position": np.arange(HOME.start, HOME.start + 3),
    "home.orientation": np.arange(HOME.start + 3, SIZE),
}


def numbers(hexapod: Hexapod) -> Array:
    """The design as `SIZE` numbers; those of a home pose that is not there are NaN."""
    home = np.full(6, np.nan) if hexapod.home is None else np.concatenate([hexapod.home.position, hexapod.home.rpy])
    return np.concatenate([hexapod.packed, home])


def with_numbers(hexapod: Hexapod, given: Array, changed: NDArray[np.bool_]) -> Hexapod:
    """The design with the entries that are `changed` taken from `SIZE` numbers. Raises DesignError if it is none."""
    values = dict(hexapod.values())
    for key, place in PLACES.items():
        if changed[place].any():
            values[key] = given[place]
    return Hexapod.from_values(values, hexapod.short_forms)


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
    if name not in PLACES:
        hint = ""
        if ".circle." in name:
            hint = f' Use JointCircle("{name.split(".")[0]}", ...), which keeps the circle\'s symmetry.'
        raise ArgumentError(
            f"{key} is not a number that a search can change.{hint} There are: {', '.join(sorted(PLACES))}."
        )
    rule = KEYS[name]
    scale = float(to_si(1.0, rule.dimension, unit)) if rule.dimension else 1.0
    index = tuple(slice(None) if i == ":" else int(i) for i in re.findall(r"\[(\d+|:)\]", match[2]))
    place = PLACES[name]
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
    return _owner(number) + "".join(f"[{i}]" for i in indices(number))


def indices(number: int) -> list[int]:
    """The indices of one of the numbers within its key, counted from 0."""
    return [int(i) for i in np.argwhere(PLACES[_owner(number)] == number)[0]]


def words(number: int) -> str:
    """Which of its key's numbers it is, for readers: "leg 3", "leg 3, y", "xz"; "" for a key of one number."""
    at = indices(number)
    leg = [f"leg {LEGS[at.pop(0)]}"] if at and len(PLACES[_owner(number)]) == len(LEGS) else []
    axes = ROTATIONS if _owner(number) == "home.orientation" else TRANSLATIONS
    return ", ".join([*leg, *filter(None, ("".join(axes[i] for i in at),))])


def _owner(number: int) -> str:
    return next(key for key, place in PLACES.items() if number in place)
