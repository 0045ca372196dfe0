"""Rest: the leg forces that hold a pose, and where the platform settles for given unstretched leg lengths."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import numbers
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import KinematicsError, SingularPoseError
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import ZERO, as_hexapod, as_joint, pose_or_home, single_pose, states, wrench
from flexapod.mechanics.kinematics import forward_kinematics, inverse_kinematics
from flexapod.pose import Pose, PoseLike, as_pose, orthonormal, unpack


class Equilibrium(NamedTuple):
    """A pose at rest and what its legs carry.

    pose: `Pose`. leg_force: (..., 6) N, positive: compression. leg_length, unstretched_length: (..., 6) m.

    Source: Eqs 2 to 4; E6.
    """

    pose: Pose
    leg_force: Array
    leg_length: Array
    unstretched_length: Array


def hold(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Equilibrium:
    """Leg forces (N) and unstretched lengths (m) that hold a pose at rest under gravity and a wrench (platform frame).

    From F = -K (L - L0). force (N), moment (N m): at the platform's reference point. joint: legs whose mass is off
    their axis weigh a little differently in the paper's model "spin_free".

    Raises: SingularPoseError where no leg forces hold the pose, and PoseError at a pose that no leg can take; in a
    batch such poses give NaN.
    Source: Eqs 2 to 4; E6.
    """
    pose = pose_or_home(hexapod, pose)
    leg_force = inverse_dynamics(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    length = inverse_kinematics(hexapod, pose, base=base)
    return Equilibrium(pose, leg_force, length, length + leg_force / hexapod.legs.stiffness)


def static_equilibrium(
    hexapod: Hexapod,
    unstretched_length: ArrayLike,
    *,
    start: PoseLike | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Equilibrium:
    """Where the platform is at rest under gravity and a wrench for unstretched leg lengths.

    unstretched_length: (6,) m. force (N), moment (N m): on the platform, in its frame, at its reference point. Newton's
    method with the exact tangent, from `start` or from the pose at which the legs have these lengths. The equilibrium
    found may be unstable: poles of `linearise` with a positive real part tell.

    Raises: KinematicsError where no equilibrium is found, and for lengths that are not six numbers > 0;
    SingularPoseError where the tangent becomes singular.
    Source: own; E6, part C.
    """
    as_hexapod(hexapod)
    L_0 = numbers(unstretched_length, "unstretched_length", (6,))
    if (L_0 <= 0).any():
        raise KinematicsError(f"unstretched_length has {L_0.min():.6g} m; every leg length must be > 0 m")
    base = None if base is None else as_pose(base, "base")
    if start is not None:
        start = single_pose(hexapod, start, "start")
    else:
        start = forward_kinematics(hexapod, L_0)
        if base is not None:
            start = Pose(base.position + base.matrix @ start.position, base.matrix @ start.matrix)
    s = states(hexapod, start, base)
    found, outcome = _core.settle(hexapod.packed, as_joint(joint), s.platform, s.base, wrench(force, moment, ()), L_0)
    parts = unpack(found)
    pose = Pose(parts["position"], orthonormal(parts["matrix"]))
    if outcome == _core.Rest.singular:
        raise SingularPoseError(
            f"the search for equilibrium met {pose!r}, where the legs have no stiffness in some direction. "
            "Start nearer to the equilibrium, or stiffen the legs."
        )
    if outcome == _core.Rest.not_found:
        raise KinematicsError(
            f"no equilibrium was found; the search ended at {pose!r}. The load may be more than the legs can carry "
            "before they collapse: start nearer, reduce the load, or stiffen the legs."
        )
    length = inverse_kinematics(hexapod, pose, base=base)
    return Equilibrium(pose, hexapod.legs.stiffness * (L_0 - length), length, L_0)
