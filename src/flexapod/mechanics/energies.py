"""Energies of the moving machine, and the power that friction takes."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import NO_LEGS, as_joint, per_leg, states
from flexapod.pose import MotionLike


class Energy(NamedTuple):
    """Energies of platform and legs, and the power lost to friction.

    Attributes
    ----------
    kinetic : ndarray or float
        Kinetic energy, J, (...).
    gravitational : ndarray or float
        Potential energy of gravity, zero at the inertial origin, J, (...).
    elastic : ndarray or float
        Energy of the leg springs, J, (...).
    dissipation : ndarray or float
        Power lost to friction in the joints, W, (...).
    """

    kinetic: Array | float
    gravitational: Array | float
    elastic: Array | float
    dissipation: Array | float


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
        Lengths of the unloaded legs, m, (..., 6). Left out, the elastic energy is zero.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Energy
        `kinetic`, `gravitational` and `elastic`, J, and `dissipation`, W, (...) each.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For lengths of a shape that does not fit, or an unknown joint model.

    Notes
    -----
    Energies of the rigid bodies of the platform and of both parts of the legs, and of the leg springs.

    Examples
    --------
    >>> moving = fx.Motion([0, 0, 2.4, 0, 0, 0], velocity=[0, 0, 0.5])
    >>> round(float(fx.energy(fx.load("motion-base"), moving).kinetic), 1)
    529.3
    """
    s = states(hexapod, pose, base)
    L_0 = per_leg(NO_LEGS if unstretched_length is None else unstretched_length, "unstretched_length", s.shape)
    rows = _core.energy(hexapod.packed, as_joint(joint), s.platform, s.base, L_0)
    if unstretched_length is None:
        rows[:, 2] = 0.0
    return Energy(*(column.reshape(s.shape)[()] for column in rows.T))
