"""Equations of motion of the machine on a moving base (Section 4), and what the joints carry."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import number
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.inputs import NO_LEGS, ZERO, as_joint, per_leg, states, wrench
from flexapod.pose import MotionLike


class EquationsOfMotion(NamedTuple):
    """J_p [a; alpha] - J_b [a_b; alpha_b] + eta = H F + [R F_ext; R M_ext], in inertial axes.

    J_p, J_b, H: (..., 6, 6); eta: (..., 6). Rows 1-3 are forces in N, rows 4-6 moments in N m about the platform's
    reference point.

    Source: Eq. 34; E1 to E5, part B.
    """

    J_p: Array
    J_b: Array
    eta: Array
    H: Array


class Reactions(NamedTuple):
    """Forces (N) and moments (N m) in the joints, inertial axes; see `joint_reactions` for what acts on what.

    spherical_force, spherical_moment, prismatic_force, prismatic_moment, universal_force, universal_moment:
    (..., 6, 3), leg by leg. base_force, base_moment: (..., 3).

    Source: Section 4.1; E1 to E5, part B.
    """

    spherical_force: Array
    spherical_moment: Array
    prismatic_force: Array
    prismatic_moment: Array
    universal_force: Array
    universal_moment: Array
    base_force: Array
    base_moment: Array


class Energy(NamedTuple):
    """kinetic, gravitational, elastic: energies, J. dissipation: the power lost to friction, W. Each (...).

    Source: own.
    """

    kinetic: Array | float
    gravitational: Array | float
    elastic: Array | float
    dissipation: Array | float


def equations_of_motion(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    joint: JointModel = "universal",
) -> EquationsOfMotion:
    """The terms of Eq. 34 for motions of platform and base (default: base fixed at the origin), in SI units.

    eta holds gravity, velocity terms and joint friction, and no leg forces. joint="spin_free" gives the paper's model
    W.s = 0.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for an unknown joint model.
    Source: Eq. 34; E1 to E5, part B.
    """
    s = states(hexapod, pose, base)
    J_p, J_b, eta, H = _core.equations_of_motion(hexapod.packed, as_joint(joint), s.platform, s.base)
    square = (*s.shape, 6, 6)
    return EquationsOfMotion(J_p.reshape(square), J_b.reshape(square), eta.reshape(*s.shape, 6), H.reshape(square))


def forward_dynamics(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    leg_force: ArrayLike = NO_LEGS,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> tuple[Array, Array]:
    """Acceleration of the platform's reference point (m/s2) and its angular acceleration (rad/s2).

    leg_force: (..., 6) N, positive pushes the platform from the base. force (N), moment (N m): on the platform, in its
    own frame, at its reference point. The accelerations in `pose` play no part; those of `base` do. Returns
    vectors (..., 3) in inertial axes.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), for forces of a shape that does not fit,
    or an unknown joint model.
    Source: Eq. 35; E1 to E5, part B.
    """
    s = states(hexapod, pose, base)
    result = _core.forward_dynamics(
        hexapod.packed,
        as_joint(joint),
        s.platform,
        s.base,
        per_leg(leg_force, "leg_force", s.shape),
        wrench(force, moment, s.shape),
    ).reshape(*s.shape, 6)
    return result[..., :3], result[..., 3:]


def inverse_dynamics(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Array:
    """Leg forces (..., 6) in N that give the platform the accelerations in `pose`.

    force (N), moment (N m): on the platform, in its own frame, at its reference point.

    Raises: SingularPoseError where H is singular, and PoseError at a pose that no leg can take; in a batch such poses
    give NaN. PoseError for loads of a shape that does not fit.
    Source: Eq. 34, solved for F.
    """
    s = states(hexapod, pose, base)
    loads = wrench(force, moment, s.shape)
    result = _core.inverse_dynamics(hexapod.packed, as_joint(joint), s.platform, s.base, loads)
    if not s.shape and np.isnan(result).any():
        raise SingularPoseError(
            "the legs cannot drive the platform at this pose: H is singular. Choose another pose, or change the joints."
        )
    return result.reshape(*s.shape, 6)


def joint_reactions(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    leg_force: ArrayLike = NO_LEGS,
    section: float = 0.5,
    joint: JointModel = "universal",
) -> Reactions:
    """What every joint carries for the motions given and the leg forces that go with them, N and N m.

    leg_force: (..., 6) N. Per leg, (..., 6, 3): `spherical_force` and `spherical_moment` on the platform by the leg at
    the platform joint; `prismatic_` on the upper part by the lower part, the moment (bending and torsion) at the
    fraction `section` of the leg's length from the base joint; `universal_` on the base by the leg at the base joint.
    `base_force`, `base_moment` (..., 3): the total on the base, about its reference point. In the model "spin_free" the
    universal joint also holds the leg about its own axis, a moment that no real universal joint has.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for leg forces of a shape that does
    not fit.
    Source: Section 4.1, forces and moments on a leg; E1 to E5, part B.
    """
    s = states(hexapod, pose, base)
    forces = per_leg(leg_force, "leg_force", s.shape)
    legs, total = _core.joint_reactions(
        hexapod.packed, as_joint(joint), s.platform, s.base, forces, number(section, "section")
    )
    legs = legs.reshape(*s.shape, 6, 6, 3)
    total = total.reshape(*s.shape, 2, 3)
    return Reactions(*np.moveaxis(legs, -2, 0), *np.moveaxis(total, -2, 0))


def energy(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    unstretched_length: ArrayLike | None = None,
    joint: JointModel = "universal",
) -> Energy:
    """Kinetic, gravitational (zero at the inertial origin) and elastic energy, J, and power lost to friction, W.

    unstretched_length: of the leg springs, (..., 6) m; without it the elastic energy is zero.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for lengths of a shape that does not
    fit.
    Source: own.
    """
    s = states(hexapod, pose, base)
    L_0 = per_leg(NO_LEGS if unstretched_length is None else unstretched_length, "unstretched_length", s.shape)
    rows = _core.energy(hexapod.packed, as_joint(joint), s.platform, s.base, L_0)
    if unstretched_length is None:
        rows[:, 2] = 0.0
    return Energy(*(column.reshape(s.shape)[()] for column in rows.T))
