"""Angles of the joints, distances of the legs, and whether a pose keeps the design's limits."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import LEG_PAIRS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.mechanics.inputs import States, as_joint, pose_or_home, states
from flexapod.mechanics.joint_springs import joint_moments
from flexapod.mechanics.kinematics import force_transformation, home_pose, inverse_kinematics
from flexapod.mechanics.limited import LimitedQuantity
from flexapod.mechanics.load_limits import static_force_excess
from flexapod.pose import PoseLike, as_pose
from flexapod.showing import in_notebooks


@in_notebooks
class JointAngles(NamedTuple):
    """Angles of the joints from neutral, the leg's direction at the home pose (without one, the frame's z axis).

    Attributes
    ----------
    universal_first : ndarray
        Turn of the universal joint about its axis in the base, rad, (..., 6).
    universal_second : ndarray
        Tilt of the leg out of the plane normal to that axis, rad, (..., 6).
    universal : ndarray
        Angle between the leg and the neutral direction in the base, rad, (..., 6).
    spherical : ndarray
        Angle between the leg and the neutral direction in the platform, rad, (..., 6).
    """

    universal_first: Array
    universal_second: Array
    universal: Array
    spherical: Array


@in_notebooks
class LimitsCheck(NamedTuple):
    """Whether poses keep the design's limits.

    Attributes
    ----------
    ok : ndarray
        True where every limit is kept, (...).
    exceeded : tuple of str
        For a single pose what is exceeded, in words; empty for a batch.
    """

    ok: np.ndarray
    exceeded: tuple[str, ...]


def joint_angles(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> JointAngles:
    """Compute the angles of every universal and spherical joint from neutral.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.

    Returns
    -------
    JointAngles
        `universal_first`, `universal_second`, `universal` and `spherical`, rad, (..., 6) each.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.

    See Also
    --------
    flexapod.check_limits : Whether the design allows these angles.

    Notes
    -----
    Neutral is the leg's direction at the home pose, in the base for the universal joint and in the platform for the
    spherical joint; in a design without a home pose, the frame's z axis.

    Examples
    --------
    >>> angles = fx.joint_angles(fx.load("motion-base"), [0.2, 0, 2.4, 0, 0, 0])
    >>> np.degrees(angles.universal).round(2).tolist()
    [4.04, 3.96, 3.92, 3.92, 3.96, 4.04]
    """
    s = states(hexapod, pose, base)
    angles = _core.joint_angles(hexapod.packed, s.platform, s.base, neutral_directions(hexapod))
    return JointAngles(*(x.reshape(*s.shape, 6) for x in angles))


def neutral_directions(hexapod: Hexapod) -> Array:
    """Neutral leg directions in base axes and in platform axes, (2, 6, 3)."""
    home = home_pose(hexapod)
    if home is None:
        return np.broadcast_to([0.0, 0.0, 1.0], (2, 6, 3)).copy()
    try:
        s = force_transformation(hexapod, home)[:3].T
    except PoseError as error:
        raise PoseError(f"the design's [home], which joint angles are measured from: {error}") from error
    return np.stack([s, s @ home.matrix])


def leg_distance(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array | float:
    """Compute the least distance between any two leg axes.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.

    Returns
    -------
    float or ndarray
        The distance of the axes as segments between their joints, m, (...). Two legs that meet at a common joint are as
        far apart as the other joint of either is from the other leg; legs that share both joints have distance 0.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.

    Notes
    -----
    The closest points of two segments, over all pairs of legs. Joints that coincide but for a billionth of their
    plate's size are one joint.

    Examples
    --------
    >>> round(float(fx.mechanics.leg_distance(fx.load("motion-base"))), 3)
    0.2
    """
    s = states(hexapod, pose, base)
    return leg_distances(hexapod, s).min(axis=-1)[()]


def leg_distances(hexapod: Hexapod, at: States) -> Array:
    """Distances of all pairs of legs, in the order of `LEG_PAIRS`, m, (..., 15)."""
    return _core.leg_distances(hexapod.packed, at.platform, at.base).reshape(*at.shape, len(LEG_PAIRS))


def check_limits(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> LimitsCheck:
    """Check all that the design limits at a pose at rest: lengths, angles, moments, distances and forces.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints, which moments and forces depend on.

    Returns
    -------
    LimitsCheck
        `ok`, (...), and for a single pose `exceeded`, in words. A limit that the design does not give always holds.

    Raises
    ------
    PoseError
        At a single pose that no leg can take, where something is limited.

    See Also
    --------
    flexapod.design.Limits : The limits of a design.

    Notes
    -----
    Joint angles are those of `joint_angles`, the distance is that of `flexapod.mechanics.leg_distance`. The moments are
    those of `joint_moments`: of a base joint about both axes together, and of a platform joint across the leg. Joints
    without springs have none. Leg forces are those of `hold`, under the machine's own weight; at a singular pose, where
    none hold, a limit of them is not kept. Limits of leg rate, acceleration and power are of a motion and are not
    checked here.

    Examples
    --------
    >>> check = fx.check_limits(fx.load("motion-base"), [0, 0, 3.5, 0, 0, 0])
    >>> bool(check.ok), check.exceeded[0]
    (False, 'leg 1: length 3.723 m is above 3.261 m')
    """
    as_joint(joint)
    one = not pose_or_home(hexapod, pose).shape and (base is None or not as_pose(base, "base").shape)
    shape = () if one else states(hexapod, pose, base).shape
    ok = np.ones(shape, dtype=bool)
    words: list[str] = []
    for quantity in limit_excess(hexapod, pose, base=base, joint=joint):
        kept = quantity.kept
        ok &= kept.all(axis=-1) if kept.ndim > len(shape) else kept  # of each leg, or of all of them
        if not shape:
            words += quantity.in_words()
    return LimitsCheck(ok, tuple(words))


def limit_excess(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
    forces: bool = True,
) -> list[LimitedQuantity]:
    """Every quantity that the design limits at rest, with its bounds. forces: those of the weight as well."""
    limits = hexapod.limits
    result = []
    law = hexapod.legs.stiffness_law
    if limits.leg_length is not None or law is not None:
        lengths = inverse_kinematics(hexapod, pose, base=base)
    if limits.leg_length is not None:
        bounds = np.asarray(limits.leg_length)
        result.append(LimitedQuantity("length", "m", lengths, bounds[..., 0], bounds[..., 1]))
    if law is not None:
        least, most = law.range.T
        result.append(LimitedQuantity("length for its stiffness law", "m", lengths, least, most))
    if limits.universal_angle is not None or limits.spherical_angle is not None:
        angles = joint_angles(hexapod, pose, base=base)
        for name, most in (("universal", limits.universal_angle), ("spherical", limits.spherical_angle)):
            if most is not None:
                value = np.degrees(getattr(angles, name))
                result.append(LimitedQuantity(f"{name} joint angle", "deg", value, -np.inf, float(np.degrees(most))))
    result += moment_excess(hexapod, pose, base, joint)
    if limits.leg_distance is not None:
        distance = np.asarray(leg_distance(hexapod, pose, base=base))
        result.append(LimitedQuantity("least distance between legs", "m", distance, limits.leg_distance, np.inf))
    if forces:
        result += static_force_excess(hexapod, pose, base, joint)
    return result


def moment_excess(
    hexapod: Hexapod, pose: PoseLike | None, base: PoseLike | None = None, joint: JointModel = "universal"
) -> list[LimitedQuantity]:
    """The moments of the springs in the joints that the design limits, with their bounds."""
    limits = hexapod.limits
    if limits.universal_moment is None and limits.spherical_moment is None:
        return []
    if hexapod.rest is None:  # then there are no springs in the joints
        shape = states(hexapod, pose, base).shape
        bends = {"universal": np.zeros((*shape, 6)), "spherical": np.zeros((*shape, 6))}
    else:
        found = joint_moments(hexapod, pose, base=base, joint=joint)
        bends = {"universal": np.linalg.norm(found.universal_moment, axis=-1), "spherical": found.bending_moment}
    most = {"universal": limits.universal_moment, "spherical": limits.spherical_moment}
    return [
        LimitedQuantity(f"{name} joint moment", "N m", bends[name], -np.inf, bound)
        for name, bound in most.items()
        if bound is not None
    ]
