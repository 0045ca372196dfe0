"""Energies of the moving machine, and the power that friction takes."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import NO_LEGS, as_joint, per_leg, states
from flexapod.pose import MotionLike
from flexapod.showing import in_notebooks


@in_notebooks
class Energy(NamedTuple):
    """Energies of platform and legs, and the power lost to friction.

    Attributes
    ----------
    kinetic : ndarray or float
        Kinetic energy, J, (...).
    gravitational : ndarray or float
        Potential energy of gravity, zero at the inertial origin, J, (...).
    elastic : ndarray or float
        Energy of all springs, J, (...).
    dissipation : ndarray or float
        Power lost to friction in the joints and in the suspension's damper, W, (...).
    joints, suspension : ndarray or float
        Parts of `elastic` in the springs of the joints and in the suspension, J, (...).
    """

    kinetic: Array | float
    gravitational: Array | float
    elastic: Array | float
    dissipation: Array | float
    joints: Array | float
    suspension: Array | float


def energy(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    unstretched_length: ArrayLike | None = None,
    joint: JointModel = "universal",
) -> Energy:
    """Compute kinetic, gravitational and elastic energy, and the power lost to friction.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose, Motion or array_like, optional
        Pose or motion of the platform, one or many; six numbers are x, y, z in m and roll, pitch, yaw in rad. Left out,
        the home pose. Without a motion the platform is at rest.
    base : Pose, Motion or array_like, optional
        The same of the base, in the inertial frame. Left out, the base is at rest at the inertial frame's origin.
    unstretched_length : array_like, optional
        Lengths of the unloaded legs, m, (..., 6). Left out, the energy of the legs' springs is not counted.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Energy
        `kinetic`, `gravitational` and `elastic`, J, `dissipation`, W, and `joints` and `suspension`, J, (...) each.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For lengths of a shape that does not fit, or an unknown joint model.

    Notes
    -----
    Energies of the rigid bodies of the platform and of both parts of the legs, and of all springs. That of a leg is
    k (L - L_0)^2 / 2 with the stiffness k of the unstretched length L_0; joints and suspension have theirs from the
    rest pose.

    Examples
    --------
    >>> moving = fx.Motion([0, 0, 2.4, 0, 0, 0], velocity=[0, 0, 0.5])
    >>> round(float(fx.energy(fx.load("motion-base"), moving).kinetic), 1)
    529.3
    """
    s = states(hexapod, pose, base)
    L_0 = per_leg(NO_LEGS if unstretched_length is None else unstretched_length, "unstretched_length", s.shape)
    rows = _core.energy(hexapod.packed, as_joint(joint), s.platform, s.base, L_0)
    kinetic, gravitational, legs, joints, suspension, lost = (column.reshape(s.shape)[()] for column in rows.T)
    elastic = joints + suspension + (0.0 if unstretched_length is None else legs)
    nothing = 0.0 * kinetic  # NaN where there is no pose
    return Energy(kinetic, gravitational, elastic, lost, joints + nothing, suspension + nothing)
