"""Checks of a design as a whole: joints apart, axes with a direction, inertias of rigid bodies."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array
from flexapod.design.inertia import inertia_flaw
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


def check_apart(key: str, joints: Array) -> None:
    """Raises DesignError where two joints of a plate coincide."""
    span = np.ptp(joints, axis=0).max()
    for one in range(6):
        for other in range(one + 1, 6):
            if np.linalg.norm(joints[one] - joints[other]) <= 1e-9 * span:
                raise DesignError(
                    f"{key}[{one}] and {key}[{other}] coincide at {joints[one].tolist()} m; the six joints must be "
                    "apart. Move one of them: a joint has a size, a millimetre is enough."
                )


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
    flaws = [inertia_flaw(inertia) for inertia in inertias]
    legs = [leg for leg, flaw in enumerate(flaws) if flaw]
    if not legs:
        return []
    which = "all legs" if len(legs) == 6 else f"legs {', '.join(str(leg + 1) for leg in legs)}"
    return [f"{key}.inertia ({which}): no rigid body has it; {flaws[legs[0]]}. Results are computed with it as given."]
