"""Forces and moments that the joints carry."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import number
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import NO_LEGS, as_joint, per_leg, states
from flexapod.pose import MotionLike
from flexapod.showing import in_notebooks


@in_notebooks
class Reactions(NamedTuple):
    """Forces (N) and moments (N m) in the joints, leg by leg, in inertial axes.

    Attributes
    ----------
    spherical_force, spherical_moment : ndarray
        On the platform by each leg, at the platform joint, (..., 6, 3).
    prismatic_force, prismatic_moment : ndarray
        On the leg's upper part by the lower part, at a section of the leg, (..., 6, 3). The moment is bending and
        torsion.
    universal_force, universal_moment : ndarray
        On the base by each leg, at the base joint, (..., 6, 3).
    base_force, base_moment : ndarray
        Their sum on the base, about its reference point, (..., 3).
    """

    spherical_force: Array
    spherical_moment: Array
    prismatic_force: Array
    prismatic_moment: Array
    universal_force: Array
    universal_moment: Array
    base_force: Array
    base_moment: Array


def joint_reactions(
    hexapod: Hexapod,
    pose: MotionLike | None = None,
    *,
    base: MotionLike | None = None,
    leg_force: ArrayLike = NO_LEGS,
    section: float = 0.5,
    joint: JointModel = "universal",
) -> Reactions:
    """Compute what every joint carries for given motions and the leg forces that go with them.

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
    section : float
        Where along the leg the prismatic joint's moment is taken, as a fraction of its length from the base joint.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Reactions
        Forces (N) and moments (N m) of the spherical, prismatic and universal joints, (..., 6, 3), and their sum on the
        base, (..., 3).

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For leg forces of a shape that does not fit, or an unknown joint model.

    See Also
    --------
    flexapod.inverse_dynamics : The leg forces of a motion.

    Notes
    -----
    Section 4.1 of the paper. In the model "spin_free" the universal joint also holds the leg about its own axis, a
    moment that no real universal joint has.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> carried = fx.joint_reactions(machine, leg_force=fx.inverse_dynamics(machine))
    >>> carried.base_force.round(0)[2].item()  # the weight
    -48658.0
    """
    s = states(hexapod, pose, base)
    forces = per_leg(leg_force, "leg_force", s.shape)
    legs, total = _core.joint_reactions(
        hexapod.packed, as_joint(joint), s.platform, s.base, forces, number(section, "section")
    )
    legs = legs.reshape(*s.shape, 6, 6, 3)
    total = total.reshape(*s.shape, 2, 3)
    return Reactions(*np.moveaxis(legs, -2, 0), *np.moveaxis(total, -2, 0))
