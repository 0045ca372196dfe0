"""What the whole library agrees on: array types, names of axes and legs, joint models, and their units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

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

TWO_PI = 2 * math.pi


def unit_of(axis: str, linear: str = "m", angular: str = "rad") -> str:
    """The unit of one of `AXES`: `linear` for a translation, `angular` for a rotation."""
    return linear if axis in TRANSLATIONS else angular
