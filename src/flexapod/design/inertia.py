"""Which inertias a rigid body can have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.errors import told_apart

ROUNDING = 1e-9  # of the largest moment: what printing with nine digits changes


def second_moments(inertia: Array) -> Array:
    """Second moments of mass, trace(I)/2 E - I, kg m2: positive semidefinite for every rigid body."""
    return np.asarray(np.trace(inertia) / 2 * np.eye(3) - inertia)


def unusual(inertias: Array) -> NDArray[np.bool_]:
    """Whether `inertia_flaw` finds anything, for many inertias (..., 3, 3)."""
    principal = np.linalg.eigvalsh(inertias)
    moments = principal.sum(axis=-1, keepdims=True) / 2 - principal
    return np.asarray(moments[..., 2] < -ROUNDING * np.abs(moments).max(axis=-1))


def inertia_flaw(inertia: Array, *, solid: bool = False) -> str:
    """Why no rigid body has this inertia; "" where one has. `solid`: nor may it be flat or a line."""
    principal = np.linalg.eigvalsh(inertia)
    moments = principal.sum() / 2 - principal  # the eigenvalues of second_moments, descending
    slack = ROUNDING * np.abs(moments).max()
    if moments[2] > slack or (not solid and moments[2] >= -slack):
        return ""
    if principal[0] < -ROUNDING * np.abs(principal).max():
        return f"its smallest principal moment is {principal[0]:.3g} kg m2, below zero"
    largest, others = principal[2], principal[0] + principal[1]
    if solid:
        return (
            f"its largest principal moment is {largest:.6g} kg m2 and the other two are together {others:.6g}, as of "
            "nothing that has an extent in all directions"
        )
    told, both = told_apart(float(largest), float(others), (6, 6))
    return f"its largest principal moment {told} kg m2 exceeds the sum of the other two, {both}"
