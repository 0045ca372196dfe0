"""A hexapod at a pose as a rigid-body program sees it: placements, bodies, springs at rest. All in the base frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import LegPart
from flexapod.interchange.rigid_bodies import check_physical
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.joint_springs import joint_moments
from flexapod.mechanics.springs import axial_stiffness
from flexapod.mechanics.statics import hold
from flexapod.mechanics.viscous_losses import has_losses
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
    stiffness: float  # N/m, at the unstretched length
    force: float  # N, at rest, compression > 0
    prismatic: float  # N s/m
    universal: float  # N m s/rad
    spherical: float  # N m s/rad
    travel: tuple[float, float] | None  # m, from here to the shortest and the longest leg
    universal_stiffness: Array  # (2,) N m/rad, about the axis fixed in the base and about y
    universal_rest: Array  # (2,) rad, from here to where these springs are unstressed
    spherical_stiffness: Array  # (3,) N m/rad, about the leg's axes: torsion, and bending twice
    spherical_rest: Array  # (3,) rad, turns of the platform about these axes from here that have no moment

    @property
    def sprung(self) -> bool:
        """Whether the spherical joint has stiffness."""
        return bool(self.spherical_stiffness.any())

    def scaled(self, factor: float) -> Leg:
        """With masses, and so forces, in units that are `factor` times smaller."""
        forces = (
            "stiffness",
            "force",
            "prismatic",
            "universal",
            "spherical",
            "universal_stiffness",
            "spherical_stiffness",
        )
        changed = {name: factor * getattr(self, name) for name in forces}
        return self._replace(lower=self.lower.scaled(factor), upper=self.upper.scaled(factor), **changed)


class Machine(NamedTuple):
    """A hexapod at rest at a pose."""

    name: str
    gravity: Array  # (3,) m/s2
    pose: Pose
    platform: Body  # from the platform's reference point, platform axes
    legs: tuple[Leg, ...]
    left_out: tuple[str, ...]  # what the file leaves out of the design, in words

    def scaled(self, factor: float) -> Machine:
        """With masses and forces in units that are `factor` times smaller: it moves as before."""
        return self._replace(platform=self.platform.scaled(factor), legs=tuple(leg.scaled(factor) for leg in self.legs))


def at_rest(hexapod: Hexapod, pose: PoseLike | None = None, kind: str = "mjcf") -> Machine:
    """The machine at a pose, by default at home, at rest under gravity, with bodies that rigid-body programs accept.

    kind: of the file that it is for.
    """
    where = single_pose(hexapod, pose)
    check_physical(hexapod)
    rest = hold(hexapod, where)
    platform = Body(hexapod.platform_mass, hexapod.platform_mass_center, hexapod.platform_inertia)
    stiffness, _ = axial_stiffness(hexapod, rest.unstretched_length)
    legs = tuple(_leg(hexapod, where, i, float(rest.leg_force[i]), float(stiffness[i])) for i in range(6))
    name = "".join(filter(str.isprintable, hexapod.name)) or "hexapod"  # XML takes no control characters
    return Machine(name, hexapod.gravity, where, platform, legs, left_out(hexapod, where, kind))


def left_out(hexapod: Hexapod, pose: Pose, kind: str) -> tuple[str, ...]:
    """What of a design a file of a kind (mjcf, urdf, sdf, mat) leaves out, in words."""
    found = []
    if has_losses(hexapod):
        found.append("loss factors (mechanics.viscous_equivalent makes friction of them)")
    if kind == "mat":
        return tuple(found)
    if hexapod.legs.stiffness_law is not None:
        found.append("legs.stiffness_law (the legs keep the stiffness that it gives here)")
    if hexapod.suspension is not None:
        found.append("the suspension")
    joints = hexapod.legs.joint_stiffness
    bent = joints.spherical.any() or joints.torsion.any()
    if kind == "sdf" and bent:
        found.append("the stiffness of the platform joints (bending and torsion)")
    elif bent and not _rests(hexapod, pose):
        found.append("how the moments of bent platform joints change in large turns (three hinges have them here)")
    return tuple(found)


def _rests(hexapod: Hexapod, pose: Pose) -> bool:
    """Whether the joints' springs are unstressed at a pose."""
    rest = hexapod.rest
    return rest is not None and np.allclose(rest.packed, pose.packed, atol=1e-12)


def _leg(hexapod: Hexapod, pose: Pose, i: int, force: float, stiffness: float) -> Leg:
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
        stiffness=stiffness,
        force=force,
        prismatic=float(legs.damping.prismatic[i]),
        universal=float(legs.damping.universal[i]),
        spherical=float(legs.damping.spherical[i]),
        travel=travel,
        **_joint_springs(hexapod, pose, axes, i),
    )


def _joint_springs(hexapod: Hexapod, pose: Pose, axes: Array, i: int) -> dict[str, Array]:
    """Stiffness and rest of the springs of a leg's joints, as `Leg` has them; axes: the leg's, as columns."""
    springs, rest = hexapod.legs.joint_stiffness, hexapod.rest
    universal = springs.universal[i]
    spherical = np.array([springs.torsion[i], springs.spherical[i], springs.spherical[i]])
    rests = {"universal_rest": np.zeros(2), "spherical_rest": np.zeros(3)}
    if springs.any and rest is not None and not _rests(hexapod, pose):
        found = joint_moments(hexapod, pose)
        there = rest.position + rest.matrix @ hexapod.platform_joints[i] - hexapod.base_joints[i]
        neutral = axes.T @ pose.matrix @ rest.matrix.T @ (there / np.linalg.norm(there))  # fixed in the platform
        along = np.array([1.0, 0.0, 0.0])
        bent = np.cross(along, neutral)
        size = float(np.linalg.norm(bent)) or 1.0
        twisting = found.torsion_moment[i] / (1 + neutral[0]) * (along + neutral)
        moment = -found.bending_moment[i] / size * bent - twisting
        rests["universal_rest"] = found.universal_angle[i] * [-1.0, 1.0]  # the tilt turns the leg about -y
        rests["spherical_rest"] = np.divide(moment, spherical, out=np.zeros(3), where=spherical > 0)
    return {"universal_stiffness": universal, "spherical_stiffness": spherical, **rests}


def _body(part: LegPart, i: int) -> Body:
    return Body(float(part.mass[i]), part.mass_center[i], part.inertia[i])
