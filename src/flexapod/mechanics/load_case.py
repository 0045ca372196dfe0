"""One load case: the equilibrium with held leg lengths, and what follows from it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import KinematicsError
from flexapod.mechanics.kinematics import force_transformation, inverse_kinematics
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.reactions import joint_reactions
from flexapod.mechanics.springs import axial_stiffness
from flexapod.mechanics.statics import Equilibrium, hold, static_equilibrium
from flexapod.pose import Pose
from flexapod.rotations import skew, vector_from_rotation

_TURNS = 25  # of a load in base axes with the platform, until both agree
_SAME = 1e-13


class Case(NamedTuple):
    """A machine in its gravity at a pose, with a force and a moment at a point. fixed: they keep to the base's axes."""

    machine: Hexapod
    pose: Pose
    force: Array
    moment: Array
    at: Array
    fixed: bool

    def wrench(self, matrix: Array) -> dict[str, Array]:
        """Force and moment in platform axes at its reference point, where the platform is turned by `matrix`."""
        turned = matrix.T if self.fixed else np.eye(3)
        force = turned @ self.force
        return {"force": force, "moment": turned @ self.moment + np.cross(self.at, force)}


class Answer(NamedTuple):
    """What is known of a case; see `load_cases`."""

    status: str
    leg_force: Array
    leg_length: Array
    unstretched_length: Array
    deflection: Array
    rotation: Array
    spherical_force: Array
    universal_force: Array
    leg_moment: Array
    universal_moment: Array
    stiffness: Array
    compliance: Array
    by_leg_length: Array
    by_stiffness: Array
    by_mass: Array
    by_mass_center: Array


def unanswered(status: str) -> Answer:
    """NaN for a case without an equilibrium."""
    six, legs, both = (np.full(shape, np.nan) for shape in ((6,), (6, 3), (6, 6)))
    three = six[:3]
    return Answer(status, six, six, six, three, three, legs, legs, legs, legs, both, both, both, both, six, legs)


def answer(case: Case, reference: Case | None, point: Array, section: float, joint: JointModel) -> Answer:
    """The equilibrium of a case whose leg lengths are held, set in another case or without weight and load."""
    if reference is None:
        lengths, zero_force = inverse_kinematics(case.machine, case.pose), np.zeros(6)
    else:
        set_ = hold(reference.machine, reference.pose, **reference.wrench(reference.pose.matrix), joint=joint)
        lengths, zero_force = set_.unstretched_length, set_.leg_force
    rest = _settled(case, lengths, joint)
    carried = joint_reactions(case.machine, rest.pose, leg_force=rest.leg_force, section=section, joint=joint)
    wrench = case.wrench(rest.pose.matrix)
    tangent = linearise(case.machine, rest.pose, **wrench, joint=joint)
    K = tangent.K + (_turning(case, rest.pose, wrench) if case.fixed else 0.0)
    to_point = np.eye(6)
    to_point[:3, 3:] = -skew(rest.pose.matrix @ point)  # from motions of the reference point to those of the point
    flexible = to_point @ np.linalg.inv(K)  # displacement of the point for a wrench at the reference point
    stiffness = np.linalg.inv(flexible @ to_point.T).astype(np.float64)
    by_force = flexible @ tangent.H
    k, slope = axial_stiffness(case.machine, lengths)
    push = k + slope * (lengths - rest.leg_length)  # force of a leg by its unstretched length
    moved = rest.pose.position + rest.pose.matrix @ point - case.pose.position - case.pose.matrix @ point
    weights = _weights(case.machine, rest.pose)
    if reference is not None:
        settings = np.linalg.solve(
            force_transformation(reference.machine, reference.pose), _weights(reference.machine, reference.pose)
        )
        as_set = k + slope * (lengths - inverse_kinematics(reference.machine, reference.pose))
        weights = weights - (tangent.H * (push / as_set)) @ settings
    by_weight = flexible @ weights
    return Answer(
        "ok",
        rest.leg_force,
        rest.leg_length,
        lengths,
        moved,
        vector_from_rotation(rest.pose.matrix @ case.pose.matrix.T),
        carried.spherical_force,
        carried.universal_force,
        carried.prismatic_moment,
        carried.universal_moment,
        stiffness,
        flexible @ to_point.T,
        by_force * push,
        by_force * (rest.leg_force - zero_force) / k,
        by_weight[:, 0],
        by_weight[:, 1:],
    )


def _settled(case: Case, lengths: Array, joint: JointModel) -> Equilibrium:
    """The equilibrium; a load in base axes is turned into those of the platform until it no longer changes."""
    rest = static_equilibrium(case.machine, lengths, start=case.pose, **case.wrench(case.pose.matrix), joint=joint)
    loaded = case.fixed and (case.force.any() or case.moment.any())
    for _ in range(_TURNS if loaded else 0):
        before = rest.pose.matrix
        rest = static_equilibrium(case.machine, lengths, start=rest.pose, **case.wrench(before), joint=joint)
        if np.abs(rest.pose.matrix - before).max() < _SAME:
            break
    else:
        if loaded:
            raise KinematicsError(
                "no equilibrium was found in which the load keeps to the base's axes: it turns the platform more and "
                "more. Reduce the load, or stiffen the legs."
            )
    return rest


def _turning(case: Case, pose: Pose, wrench: dict[str, Array]) -> Array:
    """What a load that keeps to the base's axes adds to the stiffness under one that turns with the platform."""
    force, total = pose.matrix @ wrench["force"], pose.matrix @ wrench["moment"]
    following = np.zeros((6, 6))
    following[:3, 3:], following[3:, 3:] = -skew(force), -skew(total)
    fixed = np.zeros((6, 6))
    fixed[3:, 3:] = skew(force) @ skew(pose.matrix @ case.at)
    return following - fixed


def _weights(machine: Hexapod, pose: Pose) -> Array:
    """Wrenches (6, 4) at the reference point that a unit of platform mass, and of its mass centre's x, y, z, adds."""
    g, R = machine.gravity, pose.matrix
    found = np.zeros((6, 4))
    found[:3, 0], found[3:, 0] = g, np.cross(R @ machine.platform_mass_center, g)
    found[3:, 1:] = machine.platform_mass * np.cross(R.T, g).T
    return found
