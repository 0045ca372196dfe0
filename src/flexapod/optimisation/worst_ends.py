"""Which numbers of a design the index rises or falls with at every pose."""

from __future__ import annotations

from flexapod.design import layout

#: Numbers that raise the index with themselves, those that lower it, and those that are not in it.
_RAISING = (
    "legs.stiffness",
    "legs.series_stiffness",
    "legs.joint_stiffness.universal",
    "legs.joint_stiffness.spherical",
    "legs.joint_stiffness.torsion",
    "legs.stiffness_law.fixed",
    "legs.stiffness_law.axial_rigidity",
    "legs.stiffness_law.bulk_modulus",
    "legs.stiffness_law.area_1",
    "legs.stiffness_law.area_2",
)
_LOWERING = (
    "platform.mass",
    "legs.lower.mass",
    "legs.upper.mass",
    "legs.stiffness_law.dead_1",
    "legs.stiffness_law.dead_2",
)
#: The same of symmetric matrices, by numbers on their diagonals.
_RAISING_MATRICES = ("suspension.stiffness",)
_LOWERING_MATRICES = ("platform.inertia", "legs.lower.inertia", "legs.upper.inertia")
_WITHOUT_EFFECT = (
    "gravity",
    "legs.damping.prismatic",
    "legs.damping.universal",
    "legs.damping.spherical",
    "suspension.damping",
)


def side_of(number: int) -> int:
    """1 for a number that the index rises with at every pose, -1 for one that it falls with, 0 for others.

    One that is not in the index counts as 1: either end is as bad.
    """
    key = layout.owner(number)
    if key in _RAISING or key in _WITHOUT_EFFECT:
        return 1
    if key in _RAISING_MATRICES + _LOWERING_MATRICES:
        on_diagonal = len(set(layout.indices(number)[-2:])) == 1
        return 0 if not on_diagonal else 1 if key in _RAISING_MATRICES else -1
    return -1 if key in _LOWERING else 0
