"""What the springs of a design need of the rest of it: a pose of rest, and lengths at which a stiffness law holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flexapod.conventions import LEGS, Array
from flexapod.errors import DesignError, told_apart

if TYPE_CHECKING:
    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose

_ALONG = 1e-7  # sine of the angle between a leg and its universal axis, below which the leg has no axes


def check_springs(hexapod: Hexapod) -> None:
    """Raises DesignError where springs have no pose of rest, or legs a length at which their law does not hold."""
    if hexapod.sprung:
        _check_rest(hexapod)
    law, limits = hexapod.legs.stiffness_law, hexapod.limits.leg_length
    if law is None:
        return
    if hexapod.home is not None:
        length = np.linalg.norm(_legs(hexapod, hexapod.home), axis=1)
        _check_range(law.range, np.stack([length, length], axis=1), "at home", "Move home, or extend the law.")
    if limits is not None:
        allowed = np.broadcast_to(limits, (6, 2))
        _check_range(law.range, allowed, "by limits.leg_length", "Narrow the limits, or extend the law.")


def _legs(hexapod: Hexapod, pose: Pose) -> Array:
    """Vectors of the legs at a pose, base frame."""
    at_platform: Array = pose.position + hexapod.platform_joints @ pose.matrix.T
    return at_platform - hexapod.base_joints


def _check_rest(hexapod: Hexapod) -> None:
    rest = hexapod.rest
    if rest is None:
        springs = "suspension" if hexapod.suspension is not None else "legs.joint_stiffness"
        raise DesignError(
            f"{springs} has no pose in which it is without force. Add [home] with position and orientation, or "
            "[legs.joint_rest] where it is another pose."
        )
    leg = _legs(hexapod, rest)
    across = np.linalg.norm(np.cross(hexapod.universal_axes, leg), axis=1)
    lost = np.flatnonzero(across <= _ALONG * np.linalg.norm(leg, axis=1))
    if lost.size:
        where = "legs.joint_rest" if hexapod.legs.joint_rest is not None else "home"
        raise DesignError(
            f"{where} has leg {LEGS[lost[0]]} without a direction across its universal axis, so that its joints have "
            "no neutral position there. Give [legs.joint_rest] another pose, or the joint another axis."
        )


def _check_range(known: Array, lengths: Array, where: str, remedy: str) -> None:
    rounding = 1e-12 * np.abs(lengths)
    for i, (held, asked) in enumerate(zip(known, lengths, strict=True)):
        for side, sign in ((0, 1.0), (1, -1.0)):
            if sign * (asked[side] - held[side]) < -rounding[i, side]:
                least = ("from", "to")[side]
                told, bound = told_apart(float(asked[side]), float(held[side]), (6, 6))
                raise DesignError(
                    f"leg {LEGS[i]} is {told} m long {where}; its legs.stiffness_law holds {least} {bound} m. {remedy}"
                )
