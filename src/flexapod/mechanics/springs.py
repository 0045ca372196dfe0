"""The springs of a machine as the core has them (`model/springs.hpp`): the stiffness at the platform is F F^T."""

from __future__ import annotations

import numpy as np

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError, told_apart
from flexapod.mechanics.inputs import States, as_joint, states
from flexapod.pose import MotionLike, PoseLike

#: The leg, from 0, that each spring belongs to: first those along the legs, then those of the joints; -1: suspension.
SPRING_LEG = np.array(_core.SPRING_LEGS)


def spring_matrix(
    hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None, joint: JointModel = "universal"
) -> Array:
    """F (..., 6, m): a column for each spring, the root of its stiffness times the wrench of its unit force.

    m is 6, or 42 where there are springs in the joints or a suspension.
    """
    s = law_states(hexapod, pose, base)
    F = _core.spring_matrix(hexapod.packed, as_joint(joint), s.platform, s.base)
    return F.reshape(*s.shape, 6, F.shape[-1])


def axial_stiffness(hexapod: Hexapod, length: Array) -> tuple[Array, Array]:
    """Stiffness of the legs, N/m, with what is in series with them, at lengths (..., 6), and its derivative by them.

    NaN outside the range of a stiffness law.
    """
    found = _core.axial_stiffness(hexapod.packed, np.ascontiguousarray(length, dtype=np.float64))
    stiffness, slope = (part.reshape(np.shape(length)) for part in found)
    return stiffness, slope


def law_states(hexapod: Hexapod, platform: MotionLike | None, base: MotionLike | None = None) -> States:
    """States as `inputs.states` makes them, where the legs have a stiffness too.

    A single pose outside the range of the design's stiffness law raises PoseError; in a batch its row is NaN.
    """
    s = states(hexapod, platform, base)
    law = hexapod.legs.stiffness_law
    if law is None:
        return s
    length = _core.leg_fit(hexapod.packed, s.platform, s.base)[0]
    good = ~np.isnan(axial_stiffness(hexapod, length)[0]).any(axis=1, keepdims=True)
    if not s.shape:
        refuse_outside_law(hexapod, length[0], "length")
    return States(np.where(good, s.platform, np.nan), s.base, s.shape)


def refuse_outside_law(hexapod: Hexapod, length: Array, what: str) -> None:
    """Raises PoseError for the first of six lengths that is outside the range of the design's stiffness law."""
    law = hexapod.legs.stiffness_law
    if law is None:
        return
    outside = np.flatnonzero(np.isnan(axial_stiffness(hexapod, length)[0]) & np.isfinite(length))
    if outside.size:
        i = int(outside[0])
        least, most = law.range[i]
        below = length[i] < least
        told, bound = told_apart(float(length[i]), float(least if below else most))
        raise PoseError(
            f"leg {i + 1}: {what} {told} m is {'below' if below else 'above'} {bound} m, where legs.stiffness_law "
            f"({law.kind.name}) says nothing. Move the platform, or give a law for such lengths."
        )
