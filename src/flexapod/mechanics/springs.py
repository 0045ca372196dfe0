"""The springs of a machine as the core has them (`model/springs.hpp`): the stiffness at the platform is F F^T."""

from __future__ import annotations

import numpy as np

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import states
from flexapod.pose import PoseLike

#: The leg, from 0, that each spring belongs to.
SPRING_LEG = np.array(_core.SPRING_LEGS)
#: (6, m): sums what springs have by legs.
BY_LEG = (np.arange(6)[:, None] == SPRING_LEG).astype(np.float64)


def spring_matrix(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array:
    """F (..., 6, m): a column for each spring, the root of its stiffness times the wrench of its unit force."""
    s = states(hexapod, pose, base)
    return _core.spring_matrix(hexapod.packed, s.platform, s.base).reshape(*s.shape, 6, len(SPRING_LEG))
