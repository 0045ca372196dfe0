"""A hexapod at a pose as a rigid-body program sees it: placements, bodies, springs at rest. All in the base frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import LegPart
from flexapod.interchange.rigid_bodies import check_physical
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.statics import hold
from flexapod.pose import Pose, PoseLike


class Body(NamedTuple):
    """mass kg, center (3,) m, inertia (3, 3) kg m2 about the centre; in the axes of what it belongs to."""

    mass: float
    center: Array
    inertia: Array

    def scaled(self, factor: float) -> Body:
        """With its mass in another unit, that is `factor` times smaller."""
        return self._replace(mass=factor * self.mass, inertia=factor * self.inertia)


class Leg(NamedTuple):
    """One leg; its axes are x from base to platform joint, y = k x s normalised, z = x cross y."""

    name: str  # leg1 to leg6
    base_joint: Array  # (3,) m, base frame
    platform_joint: Array  # (3,) m, platform frame
    axes: Array  # (3, 3), the leg's axes as columns, base frame
    axis: Array  # (3,) the universal joint's axis that is fixed in the base, in the leg's axes
    length: float  # m
    lower: Body  # from the base joint, leg axes
    upper: Body  # from the platform joint, leg axes
    stiffness: float  # N/m
    force: float  # N, at rest, compression > 0
    prismatic: float  # N s/m
    universal: float  # N m s/rad
    spherical: float  # N m s/rad
    travel: tuple[float, float] | None  # m, from here to the shortest and the longest leg

    def scaled(self, factor: float) -> Leg:
        """With masses, and so forces, in units that are `factor` times smaller."""
        forces = ("stiffness", "force", "prismatic", "universal", "spherical")
        changed = {name: factor * getattr(self, name) for name in forces}
        return self._replace(lower=self.lower.scaled(factor), upper=self.upper.scaled(factor), **changed)


class Machine(NamedTuple):
    """A hexapod at rest at a pose."""

    name: str
    gravity: Array  # (3,) m/s2
    pose: Pose
    platform: Body  # from the platform's reference point, platform axes
    legs: tuple[Leg, ...]

    def scaled(self, factor: float) -> Machine:
        """With masses and forces in units that are `factor` times smaller: it moves as before."""
        return self._replace(platform=self.platform.scaled(factor), legs=tuple(leg.scaled(factor) for leg in self.legs))


def at_rest(hexapod: Hexapod, pose: PoseLike | None = None) -> Machine:
    """The machine at a pose, by default at home, at rest under gravity, with bodies that rigid-body programs accept."""
    where = single_pose(hexapod, pose)
    check_physical(hexapod)
    rest = hold(hexapod, where)
    platform = Body(hexapod.platform_mass, hexapod.platform_mass_center, hexapod.platform_inertia)
    legs = tuple(_leg(hexapod, where, i, float(rest.leg_force[i])) for i in range(6))
    name = "".join(filter(str.isprintable, hexapod.name)) or "hexapod"  # XML takes no control characters
    return Machine(name, hexapod.gravity, where, platform, legs)


def _leg(hexapod: Hexapod, pose: Pose, i: int, force: float) -> Leg:
    start, k = hexapod.base_joints[i], hexapod.universal_axes[i]
    along = pose.position + pose.matrix @ hexapod.platform_joints[i] - start
    length = float(np.linalg.norm(along))
    s = along / length
    y = np.cross(k, s)
    y /= np.linalg.norm(y)
    axes = np.column_stack([s, y, np.cross(s, y)])
    legs, limit = hexapod.legs, hexapod.limits.leg_length
    travel = None
    if limit is not None:
        low, high = np.broadcast_to(limit, (6, 2))[i] - length
        travel = (float(low), float(high))
    return Leg(
        name=f"leg{i + 1}",
        base_joint=start,
        platform_joint=hexapod.platform_joints[i],
        axes=axes,
        axis=axes.T @ k,
        length=length,
        lower=_body(legs.lower, i),
        upper=_body(legs.upper, i),
        stiffness=float(legs.stiffness[i]),
        force=force,
        prismatic=float(legs.damping.prismatic[i]),
        universal=float(legs.damping.universal[i]),
        spherical=float(legs.damping.spherical[i]),
        travel=travel,
    )


def _body(part: LegPart, i: int) -> Body:
    return Body(float(part.mass[i]), part.mass_center[i], part.inertia[i])
