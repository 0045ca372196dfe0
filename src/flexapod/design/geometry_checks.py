"""Checks of a design as a whole: joints that coincide, axes with a direction, inertias of rigid bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import LEG_PAIRS, Array
from flexapod.design.inertia import inertia_flaw, unusual
from flexapod.errors import DesignError


def unit_axes(axes: Array) -> Array:
    """Axes of length 1. Those that have it but for rounding stay as they are, so that saved designs read back equal."""
    square = (axes * axes).sum(axis=1)
    zero = np.flatnonzero(square < 1e-24)
    if zero.size:
        leg = zero[0]
        raise DesignError(
            f"base.universal_axes[{leg}] is {axes[leg].tolist()}; it must have a direction. "
            "Give a vector of any length, or leave universal_axes out for axes tangent to the base circle."
        )
    near_one = np.abs(square - 1) < 16 * np.finfo(float).eps
    unit = np.where(near_one[:, None], axes, axes / np.sqrt(square)[:, None]) + 0.0
    unit.flags.writeable = False
    return np.asarray(unit)


def joint_warnings(base_joints: Array, platform_joints: Array) -> list[str]:
    """Which legs meet at common joints; DesignError where all joints of a plate are at one point."""
    joints = {"base": base_joints, "platform": platform_joints}
    shared = {plate: _core.shared_joints(at) > 0 for plate, at in joints.items()}
    for plate, at in joints.items():
        extent = at - at[0]
        if not (extent * extent).any():  # squares, which the mechanics takes, vanish before the numbers do
            raise DesignError(
                f"{plate}.joints[0] to {plate}.joints[5] coincide at {at[0].tolist()} m; such a plate can turn about "
                "this point without stretching a leg. Move some of them: the joints must be at three places at least."
            )
    both = shared["base"] & shared["platform"]
    found = []
    if both.any():
        found.append(
            f"Legs {_pairs(both)} share both joints: they are one leg twice, and the machine is singular at every "
            "pose. Move one of these joints."
        )
    words = [f"legs {_pairs(one & ~both)} on the {plate}" for plate, one in shared.items() if (one & ~both).any()]
    if words:
        found.append(
            f"Joints coincide: {'; '.join(words)}. Such legs meet there, so the distance between two of them is that "
            "of either's other joint from the other leg."
        )
    return found


def _pairs(chosen: NDArray[np.bool_]) -> str:
    """Pairs of legs in words: 1 and 6, 2 and 3."""
    return ", ".join(f"{i + 1} and {j + 1}" for (i, j), yes in zip(LEG_PAIRS, chosen, strict=True) if yes)


def platform_warnings(inertia: Array) -> list[str]:
    """What is odd about the platform's inertia; DesignError where nothing can be computed with it."""
    moments = np.linalg.eigvalsh(inertia)
    if moments[0] <= 1e-14 * np.abs(moments).max():
        raise DesignError(
            f"platform.inertia is not positive definite: its smallest principal moment is {moments[0]:.3g} kg m2; it "
            "must be > 0. Check the signs and sizes of its entries; it is taken about the mass centre, not the origin."
        )
    flaw = inertia_flaw(inertia)
    return [f"platform.inertia: no rigid body has it; {flaw}. Results are computed with it as given."] if flaw else []


def warnings_of_part(key: str, inertias: Array) -> list[str]:
    """What is odd about the inertias of a part of the six legs."""
    legs = np.flatnonzero(unusual(inertias))
    if not legs.size:
        return []
    which = "all legs" if len(legs) == 6 else f"legs {', '.join(str(leg + 1) for leg in legs)}"
    flaw = inertia_flaw(inertias[legs[0]])
    return [f"{key}.inertia ({which}): no rigid body has it; {flaw}. Results are computed with it as given."]
