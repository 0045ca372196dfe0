"""What the whole library agrees on: array types, names of axes and legs, joint models, and their units."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Array: TypeAlias = "NDArray[np.float64]"
Complex: TypeAlias = "NDArray[np.complex128]"

#: Model of the joint between a leg and the base: an exact universal joint, or the paper's legs that do not spin.
JointModel = Literal["universal", "spin_free"]
JOINT_MODELS: tuple[JointModel, ...] = ("universal", "spin_free")

TRANSLATIONS = ("x", "y", "z")
ROTATIONS = ("roll", "pitch", "yaw")
AXES = (*TRANSLATIONS, *ROTATIONS)  #: of a displacement or a pose: m, then rad
LEGS = ("1", "2", "3", "4", "5", "6")
LEG_PAIRS = tuple(combinations(range(6), 2))  #: of leg numbers from 0, as the core orders them

TWO_PI = 2 * math.pi

#: A unit as the attribute `units` of Datasets spells it, so that Pint and the CF conventions read the same.
Unit = Literal[
    "1", "m", "rad", "s", "rad/s", "m/s", "m/s^2", "rad/s^2", "1/s", "1/s^2", "1/s^3", "N", "N m", "N/m", "N s/m",
    "N/(m s)", "J", "W", "kg", "N^2/(rad/s)"
]  # fmt: skip
UNITS: tuple[Unit, ...] = get_args(Unit)


def in_unit(unit: Unit, meaning: str = "") -> dict[str, str]:
    """Attributes of a variable of a Dataset, as the CF conventions name them."""
    return {"units": unit, **({"long_name": meaning} if meaning else {})}


def in_mixed_units(units: str, meaning: str = "") -> dict[str, str]:
    """The same where translations and rotations stand side by side: the names of the coordinates that hold the units.

    No one unit is right for such a variable, so it has no `units`.
    """
    return {"mixed_units": units, **({"long_name": meaning} if meaning else {})}


def printed_unit(unit: str) -> str:
    """A unit of a Dataset as people write it: `m/s^2` -> `m/s\u00b2`."""
    return unit.replace("^2", "\u00b2").replace("^3", "\u00b3")


def unit_of(axis: str, linear: Unit = "m", angular: Unit = "rad") -> Unit:
    """The unit of one of `AXES`: `linear` for a translation, `angular` for a rotation."""
    return linear if axis in TRANSLATIONS else angular


def metric(largest: float, unit: str) -> tuple[float, str]:
    """What to multiply a number by, and the unit, in which the largest of its like is 1 or more: 3e-6 m -> 1e6, µm."""
    for factor, prefix in ((1.0, ""), (1e3, "m"), (1e6, "µ")):
        if not 0 < abs(largest) * factor < 1:
            return factor, prefix + unit
    return 1e9, "n" + unit
