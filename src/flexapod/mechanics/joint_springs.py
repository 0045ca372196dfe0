"""Angles and moments of the springs in the joints: what flexures bear."""

from __future__ import annotations

from typing import NamedTuple

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError
from flexapod.mechanics.inputs import as_joint, states
from flexapod.pose import PoseLike
from flexapod.showing import in_notebooks


@in_notebooks
class JointMoments(NamedTuple):
    """Angles of the joints from the rest pose, and the moments of their springs.

    Attributes
    ----------
    universal_angle : ndarray
        Angles of the base joint about its two axes, rad, (..., 6, 2): the turn about the axis fixed in the base, and
        the tilt of the leg out of the plane normal to it. In the model "spin_free" the two parts of the leg's swing
        from its direction at rest: about the axis across the leg in the plane of leg and universal axis, and about the
        axis across both.
    bending_angle : ndarray
        Angle between the leg and its direction at rest in the platform, rad, (..., 6).
    torsion_angle : ndarray
        Turn of the platform about the leg, rad, (..., 6): what is left after the least turn that bends the joint.
    universal_moment : ndarray
        Moments of the base joint about these axes, N m, (..., 6, 2).
    bending_moment : ndarray
        Moment of the platform joint across the leg, N m, (..., 6).
    torsion_moment : ndarray
        Moment about the leg, N m, (..., 6).
    """

    universal_angle: Array
    bending_angle: Array
    torsion_angle: Array
    universal_moment: Array
    bending_moment: Array
    torsion_moment: Array


def joint_moments(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> JointMoments:
    """Compute the angles of the joints from the rest pose and the moments of their springs.

    Parameters
    ----------
    hexapod : Hexapod
        The machine; its rest pose is `legs.joint_rest`, or home.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    JointMoments
        Angles (rad) and moments (N m) of every leg's joints, (..., 6) or (..., 6, 2).

    Raises
    ------
    DesignError
        For a design without a rest pose.
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.joint_angles : Angles of joints of any kind from the home pose.
    flexapod.check_limits : Whether the design allows these moments.

    Notes
    -----
    A joint's moment is its stiffness times its angle at any rotation; with angles small beside 1 rad that is a
    flexure's linear theory. Dividing a bending moment by a flexure's section modulus gives its bending stress.

    Examples
    --------
    >>> soft = fx.load("precision-positioner").replace({"legs.joint_stiffness.spherical": 15.0})
    >>> found = fx.joint_moments(soft, soft.home.displaced([0.0005, 0, 0, 0, 0, 0]))
    >>> bool((found.bending_moment < 0.5).all())
    True
    """
    s = states(hexapod, pose, base)
    if hexapod.rest is None:
        raise DesignError(
            f"{hexapod.name!r} has no rest pose to measure its joints from. Add [home], or [legs.joint_rest]."
        )
    angles, moments = (
        part.reshape(*s.shape, 6, 4)
        for part in _core.joint_moments(hexapod.packed, as_joint(joint), s.platform, s.base)
    )
    return JointMoments(
        angles[..., :2], angles[..., 2], angles[..., 3], moments[..., :2], moments[..., 2], moments[..., 3]
    )
