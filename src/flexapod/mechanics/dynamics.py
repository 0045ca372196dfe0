"""Equations of motion of the machine on a moving base (Section 4 of the paper), solved forwards and backwards."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.inputs import NO_LEGS, ZERO, as_joint, at_once, per_leg, states, wrench
from flexapod.pose import MotionLike
from flexapod.showing import in_notebooks


@in_notebooks
class EquationsOfMotion(NamedTuple):
    """Terms of J_p [a; alpha] - J_b [a_b; alpha_b] + eta = H F + [R F_ext; R M_ext], in inertial axes.

    Rows 1 to 3 are forces in N, rows 4 to 6 moments in N m about the platform's reference point. a, alpha are the
    accelerations of the platform's reference point, a_b, alpha_b those of the base.

    Attributes
    ----------
    J_p : ndarray
        Mass matrix of platform and legs, (..., 6, 6).
    J_b : ndarray
        Coupling to the acceleration of the base, (..., 6, 6).
    eta : ndarray
        Gravity, velocity terms and joint friction, (..., 6), without leg forces.
    H : ndarray
        Force transformation, (..., 6, 6).
    """

    J_p: Array
    J_b: Array
    eta: Array
    H: Array


def equations_of_motion(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    joint: JointModel = "universal",
) -> EquationsOfMotion:
    """Compute the terms of the equations of motion for motions of platform and base.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose, Motion or array_like, optional
        Pose or motion of the platform, one or many; six numbers are x, y, z in m and roll, pitch, yaw in rad. Left out,
        the home pose. Without a motion the platform is at rest.
    base : Pose, Motion or array_like, optional
        The same of the base, in the inertial frame. Left out, the base is at rest at the inertial frame's origin.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    EquationsOfMotion
        `J_p`, `J_b`, `eta` and `H`, SI units, inertial axes. J_p is the mass matrix of platform and legs.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.forward_dynamics : The accelerations.
    flexapod.inverse_dynamics : The leg forces.

    Notes
    -----
    Eq. 34 of the paper, with its printed errors corrected (docs/paper.md) and exact universal joints. With "spin_free"
    the legs do not turn about their axes, as in the paper.

    Examples
    --------
    >>> terms = fx.equations_of_motion(fx.load("motion-base"))
    >>> np.diag(terms.J_p).round(1).tolist()
    [4218.5, 4218.5, 4234.7, 9383.4, 10467.4, 7647.4]
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
    """Compute the platform's accelerations from the leg forces.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose, Motion or array_like, optional
        Pose or motion of the platform, one or many; six numbers are x, y, z in m and roll, pitch, yaw in rad. Left out,
        the home pose. Without a motion the platform is at rest.
    base : Pose, Motion or array_like, optional
        The same of the base, in the inertial frame. Left out, the base is at rest at the inertial frame's origin.
    leg_force : array_like
        Forces of the legs, N, (..., 6), positive where they push platform and base apart.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, in its own frame, at its reference point, (..., 3).
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    acceleration : ndarray
        Acceleration of the platform's reference point, inertial axes, m/s2, (..., 3).
    angular_acceleration : ndarray
        Angular acceleration, inertial axes, rad/s2, (..., 3).

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For loads of a shape that does not fit, or an unknown joint model.

    See Also
    --------
    flexapod.inverse_dynamics : The leg forces for given accelerations.

    Notes
    -----
    Eq. 35 of the paper. The accelerations in `pose` play no part; those of `base` do.

    Examples
    --------
    >>> acceleration, _ = fx.forward_dynamics(fx.load("motion-base"), leg_force=np.full(6, 5000.0))
    >>> round(float(acceleration[2]), 3)
    -3.642
    """
    found: tuple[Array, Array] | None = at_once(
        "forward_dynamics", hexapod, pose, base, joint, leg_force, force, moment
    )
    if found is not None:
        return found
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
    """Compute the leg forces that give the platform its accelerations.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose, Motion or array_like, optional
        Pose or motion of the platform, one or many; six numbers are x, y, z in m and roll, pitch, yaw in rad. Left out,
        the home pose. Without a motion the platform is at rest.
    base : Pose, Motion or array_like, optional
        The same of the base, in the inertial frame. Left out, the base is at rest at the inertial frame's origin.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, in its own frame, at its reference point, (..., 3).
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    ndarray
        Leg forces, N, (..., 6), positive where they push platform and base apart.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    SingularPoseError
        At a single pose where H is singular; in a batch such a pose gives NaN.
    ArgumentError
        For loads of a shape that does not fit, or an unknown joint model.

    See Also
    --------
    flexapod.hold : The same at rest, with the unstretched leg lengths.

    Notes
    -----
    Eq. 34 of the paper, solved for the leg forces.

    Examples
    --------
    >>> forces = fx.inverse_dynamics(fx.load("motion-base"))  # that carry the weight at home
    >>> forces.round(0).tolist()
    [7911.0, 7911.0, 7911.0, 7911.0, 7911.0, 7911.0]
    """
    found: Array | None = at_once("inverse_dynamics", hexapod, pose, base, joint, force, moment)
    if found is not None:
        return found
    s = states(hexapod, pose, base)
    loads = wrench(force, moment, s.shape)
    result = _core.inverse_dynamics(hexapod.packed, as_joint(joint), s.platform, s.base, loads)
    if not s.shape and np.isnan(result).any():
        raise SingularPoseError(
            "the legs cannot drive the platform at this pose: H is singular. Choose another pose, or change the joints."
        )
    return result.reshape(*s.shape, 6)
