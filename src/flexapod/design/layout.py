"""The numbers of a design that a search may change.

Those of `Hexapod.packed`, after them six of the home pose, then those of springs in series and of the angles of rest,
and those of all short forms; these last make some of the first (see form_numbers.py).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import LEGS, ROTATIONS, TRANSLATIONS, Array
from flexapod.design import packing
from flexapod.design.hexapod import SPRINGS, Hexapod
from flexapod.design.key import Key
from flexapod.design.key_names import resolve
from flexapod.design.parts import MOST_IN_SERIES
from flexapod.design.schema import KEYS
from flexapod.design.shorthands import MAKES, SETS
from flexapod.design.stiffness_laws import TableLaw, keys_of
from flexapod.design.units import printed, to_si
from flexapod.errors import ArgumentError, DesignError

HOME = slice(_core.design_size, _core.design_size + 6)
SIZE = HOME.stop
#: Key of the design file -> numbers of its entries, in the key's shape.
PLACES = packing.PLACES | {
    "home.position": np.arange(HOME.start, HOME.start + 3),
    "home.orientation": np.arange(HOME.start + 3, SIZE),
}


def _places(first: int, shapes: Mapping[str, tuple[int, ...]]) -> dict[str, NDArray[np.int64]]:
    places: dict[str, NDArray[np.int64]] = {}
    for key, shape in shapes.items():
        places[key] = np.arange(first, first := first + math.prod(shape)).reshape(shape)
    return places


#: The same of keys of which the core has other words, with room for the most springs in series.
WORDED = _places(SIZE, {"legs.series_stiffness": (6, MOST_IN_SERIES), "legs.joint_rest.orientation": (3,)})
_SHORT_FIRST = SIZE + sum(place.size for place in WORDED.values())
#: The same of the keys of short forms: what may be one for all legs is a number of each.
SHORT = _places(_SHORT_FIRST, {key: rule.shapes[-1] for key, rule in KEYS.items() if key.rpartition(".")[0] in MAKES})
FULL = _SHORT_FIRST + sum(place.size for place in SHORT.values())
EVERY = {key: place for key, place in PLACES.items() if key not in packing.DERIVED} | WORDED | SHORT
#: Keys that stand for the numbers of several others.
_SETS = {key: np.stack([PLACES[other] for other in keys], axis=-1) for key, keys in SETS.items()}
#: What the last index of a key counts, where it is no axis.
_COUNTED = {
    "legs.series_stiffness": "spring",
    "legs.joint_stiffness.universal": "axis",
    "legs.stiffness_law.lengths": "node",
    "legs.stiffness_law.stiffnesses": "node",
}
#: Keys on which nothing that a search looks at depends, by their beginnings, and what does depend on them.
_ELSEWHERE = {
    "drive.": "it counts for the motors along a path, and for no index or constraint",
    "points.": "it is a place at which motions are told, and no index or constraint depends on it",
    "limits.": "searches keep the limits as the design has them",
    **dict.fromkeys(
        ("legs.loss_factor", "legs.joint_stiffness.loss_factor"),
        "it counts in responses, in random vibration and in time, and for no index or constraint",
    ),
}
#: What optional keys of a short form that is given are where they are left out.
_LEFT_OUT = {"circle.height": 0.0, "rod.radius": 0.0, "cubic.center_in_platform": 0.0}


def numbers(hexapod: Hexapod) -> Array:
    """The design as `SIZE` numbers; those of a home pose that is not there are NaN."""
    home = np.full(6, np.nan) if hexapod.home is None else np.concatenate([hexapod.home.position, hexapod.home.rpy])
    return np.concatenate([hexapod.packed, home])


def with_short_forms(hexapod: Hexapod) -> Array:
    """The design as `FULL` numbers; those of short forms that it does not have are NaN as well."""
    found = np.concatenate([numbers(hexapod), np.full(FULL - SIZE, np.nan)])
    legs = hexapod.legs
    found[WORDED["legs.series_stiffness"][:, : legs.series_stiffness.shape[1]]] = legs.series_stiffness
    if legs.joint_rest is not None:
        found[WORDED["legs.joint_rest.orientation"]] = legs.joint_rest.rpy
    for form in hexapod.short_forms:
        for key, value in _LEFT_OUT.items():
            if key.partition(".")[0] == form.table.rpartition(".")[2]:
                found[SHORT[f"{form.table}.{key.partition('.')[2]}"]] = value
        for key, number in form.values().items():
            found[SHORT[key]] = number
    return found


def own(hexapod: Hexapod, index: NDArray[np.int64], name: str) -> Array:
    """Numbers of the design. Raises ArgumentError for those that it does not have."""
    numbers = with_short_forms(hexapod)
    found = numbers[index]
    missing = index[np.isnan(found) | is_absent(hexapod)[index]]
    if not missing.size:
        return found
    if missing[0] < HOME.start or (missing[0] < _SHORT_FIRST and missing[0] >= SIZE):
        raise ArgumentError(f"{name}: {hexapod.name!r} has no {describe(int(missing[0]))}. {_remedy(int(missing[0]))}")
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


def present(hexapod: Hexapod, index: NDArray[np.int64]) -> NDArray[np.int64]:
    """The numbers without room that the design leaves unused: further springs in series, further nodes of a table."""
    room = np.zeros(FULL, dtype=bool)
    for key in ("legs.series_stiffness", "legs.stiffness_law.lengths", "legs.stiffness_law.stiffnesses"):
        room[EVERY[key]] = True
    lost = (is_absent(hexapod) | np.isnan(with_short_forms(hexapod))) & room
    return index if lost[index].all() else index[~lost[index]]


def springs(hexapod: Hexapod) -> list[str]:
    """Keys of the springs that the design has beside constant ones along the legs."""
    values = hexapod.values()
    return [key for key in values if key.startswith(SPRINGS) and key in EVERY and not key.startswith("legs.joint_rest")]


def is_absent(hexapod: Hexapod) -> NDArray[np.bool_]:
    """Which of the numbers the design does not have although the core has room for them."""
    absent = np.zeros(FULL, dtype=bool)
    law, legs = hexapod.legs.stiffness_law, hexapod.legs
    own = () if law is None else tuple(f"legs.stiffness_law.{name}" for name in keys_of(type(law)))
    for key, place in EVERY.items():
        if key.startswith("legs.stiffness_law."):
            absent[place] = key not in own
        elif key.startswith("suspension."):
            absent[place] = hexapod.suspension is None
        elif key.startswith("legs.joint_stiffness."):
            absent[place] = hexapod.rest is None
    if isinstance(law, TableLaw):
        for key in own:
            absent[EVERY[key][len(law.lengths) :]] = True
    absent[EVERY["legs.stiffness"]] = law is not None
    absent[EVERY["legs.joint_rest.position"]] = legs.joint_rest is None
    return absent


def _remedy(number: int) -> str:
    """What a design lacks that does not have one of the numbers."""
    key = owner(number)
    if key == "legs.stiffness":
        return "Its legs have a stiffness law: change the numbers of [legs.stiffness_law]."
    if key.startswith("legs.joint_stiffness."):
        return "It names no pose in which its joints are without moment: add [home] or [legs.joint_rest]."
    return (
        f"Write the design with [{key.rpartition('.')[0]}]."
        if key.count(".") > 1 or "suspension" in key
        else (f"Write the design with {key}.")
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
    places = EVERY | _SETS
    if name not in places:
        why = next((words for start, words in _ELSEWHERE.items() if name.startswith(start)), "it is text")
        raise ArgumentError(
            f"{key} is not a number that a search can change or that may stray: {why}. Change it in the design, on the "
            f"command line with --set {name}=..., and compare."
        )
    rule = KEYS[name]
    scale = float(to_si(1.0, rule.dimension, unit)) if rule.dimension else 1.0
    index = tuple(slice(None) if i == ":" else int(i) for i in re.findall(r"\[(\d+|:)\]", match[2]))
    place = places[name]
    try:
        chosen = place[index]
    except IndexError:
        shape = " x ".join(map(str, place.shape)) or "one number"
        raise ArgumentError(f"{key} is outside {name}, which is {shape}. Indices count from 0.") from None
    return np.unique(chosen), rule, scale


#: Units of entries of the suspension's matrices: of no, one or two rotations.
_SUSPENDED = {
    "suspension.stiffness": ("N/m", "N", "N m/rad"),
    "suspension.damping": ("N s/m", "N s", "N m s/rad"),
}


def unit_name(key: str) -> str:
    """The unit of a key that `entries` takes, as people write it: "mm" of platform.joints_mm[0]; "" if it has none."""
    stem = key.partition("[")[0]
    if stem in _SUSPENDED:
        at = [int(i) for i in re.findall(r"\[(\d+)\]", key)]
        return (
            _SUSPENDED[stem][sum(i >= len(TRANSLATIONS) for i in at)] if len(at) == 2 else ""
        )  # else of several units
    table, _, last = stem.rpartition(".")
    return printed(resolve(table, last)[1])


def describe(number: int) -> str:
    """The key of one of the numbers, such as platform.joints[0][2]."""
    return owner(number) + "".join(f"[{i}]" for i in indices(number))


def indices(number: int) -> list[int]:
    """The indices of one of the numbers within its key, counted from 0."""
    return [int(i) for i in np.argwhere(EVERY[owner(number)] == number)[0]]


def words(number: int) -> str:
    """Which of its key's numbers it is, for readers: "leg 3", "leg 3, y", "xz"; "" for a key of one number."""
    key, at = owner(number), indices(number)
    of_leg = at and len(EVERY[key]) == len(LEGS) and not key.startswith("suspension.")
    leg = [f"leg {LEGS[at.pop(0)]}"] if of_leg else []
    if key.endswith(".orientation"):
        names: tuple[str, ...] = tuple(ROTATIONS)
    elif key in _COUNTED:
        names = tuple(f"{_COUNTED[key]} {i + 1}" for i in range(EVERY[key].shape[-1]))
    else:
        names = (*TRANSLATIONS, *ROTATIONS)
    told = [names[i] for i in at]
    return ", ".join([*leg, *filter(None, (("-" if max(map(len, told), default=1) > 1 else "").join(told),))])


def owner(number: int) -> str:
    """The key that one of the numbers is of."""
    return next(key for key, place in EVERY.items() if number in place)
