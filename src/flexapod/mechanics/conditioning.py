"""How near a pose is to a singular one, told by the condition number of H without units."""

from __future__ import annotations

import numpy as np

from flexapod.design.hexapod import Hexapod

SINGULAR = 1e12  # condition number without units from which H is singular to rounding
NEAR_SINGULAR = 100.0  # a leg force up to a hundred times the load; stiffness 1e4 times less in some direction


def platform_radius(hexapod: Hexapod) -> float:
    """Mean distance of the platform joints from their centre, m."""
    p = hexapod.platform_joints
    return float(np.linalg.norm(p - p.mean(axis=0), axis=1).mean())


def singularity(condition: float) -> list[str]:
    """What a pose's condition number without units means, if it means trouble."""
    if not condition < SINGULAR:
        return [
            "The pose is singular: the platform can move without stretching any leg, so the index is 0, and no leg "
            "forces hold it against every load. Leg forces, the tangent and sensitivities are not available here. "
            "Choose another pose, or move the joints."
        ]
    if condition > NEAR_SINGULAR:
        return [
            f"Near a singular pose: the condition number of H is {condition:.3g} without units, so some load needs "
            f"leg forces about {condition:.1g} times as large. Keep away from here, or move the joints."
        ]
    return []
