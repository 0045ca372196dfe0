"""Geometry of the legs: lengths, rates, the force transformation H and its condition."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.checks import positive
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import as_hexapod, at_once, states
from flexapod.pose import MotionLike, Pose, PoseLike
from flexapod.showing import in_notebooks

_NO_SIDE = 1e-7  # least singular value of H over its largest, moments over the platform's size: a singular pose


@in_notebooks
class LegRates(NamedTuple):
    """Lengths of the legs and their derivatives in time.

    Attributes
    ----------
    length : ndarray
        Leg lengths, m, (..., 6).
    rate : ndarray
        Rates of the lengths, m/s, (..., 6).
    acceleration : ndarray
        Second derivatives of the lengths, m/s2, (..., 6).
    """

    length: Array
    rate: Array
    acceleration: Array


def inverse_kinematics(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array:
    """Compute the leg lengths at a pose.

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
    ndarray
        Leg lengths, m, (..., 6).

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.

    See Also
    --------
    flexapod.forward_kinematics : The pose at which the legs have given lengths.

    Notes
    -----
    Eq. 6 of the paper: the distance between the joints of each leg.

    Examples
    --------
    >>> fx.inverse_kinematics(fx.load("motion-base")).round(3).tolist()
    [2.706, 2.706, 2.706, 2.706, 2.706, 2.706]
    """
    length: Array | None = at_once("leg_lengths", hexapod, pose, base, "universal")
    return leg_rates(hexapod, pose, base=base).length if length is None else length


def leg_rates(hexapod: Hexapod, pose: MotionLike | None = None, *, base: MotionLike | None = None) -> LegRates:
    """Compute leg lengths, rates and accelerations for motions of platform and base.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose, Motion or array_like, optional
        Pose or motion of the platform, one or many; six numbers are x, y, z in m and roll, pitch, yaw in rad. Left out,
        the home pose. Without a motion the platform is at rest.
    base : Pose, Motion or array_like, optional
        The same of the base, in the inertial frame. Left out, the base is at rest at the inertial frame's origin.

    Returns
    -------
    LegRates
        `length` (m), `rate` (m/s) and `acceleration` (m/s2), (..., 6) each.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.

    Notes
    -----
    Eqs 6 to 8 of the paper.

    Examples
    --------
    >>> rising = fx.Motion([0, 0, 2.4, 0, 0, 0], velocity=[0, 0, 0.1])
    >>> fx.leg_rates(fx.load("motion-base"), rising).rate.round(4).tolist()
    [0.0884, 0.0884, 0.0884, 0.0884, 0.0884, 0.0884]
    """
    s = states(hexapod, pose, base)
    return LegRates(*(x.reshape(*s.shape, 6) for x in _core.leg_rates(hexapod.packed, s.platform, s.base)))


def force_transformation(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array:
    """Compute the force transformation H, from leg forces to the wrench on the platform.

    Its transpose is the Jacobian from the platform's twist (velocity of the reference point and angular velocity) to
    the leg rates.

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
    ndarray
        H, (..., 6, 6), in inertial axes: column i is the direction s of leg i (rows 1 to 3, no unit) and its moment
        q x s about the platform's reference point (rows 4 to 6, m).

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.

    See Also
    --------
    flexapod.condition_number : How near H is to singular.

    Notes
    -----
    Eq. 34 of the paper.

    Examples
    --------
    >>> H = fx.force_transformation(fx.load("motion-base"))
    >>> (H @ np.full(6, 1000.0)).round(1)[2].item()  # equal leg forces lift
    5299.2
    """
    s = states(hexapod, pose, base)
    return _core.force_transformation(hexapod.packed, s.platform, s.base).reshape(*s.shape, 6, 6)


def condition_number(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    characteristic_length: float | None = None,
) -> Array | float:
    """Compute the condition number of H, the ratio of its largest to its least singular value.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    characteristic_length : float, optional
        Length in m by which the moment rows of H are divided, so that the number has no unit. Left out, H is in metres
        and the number depends on the unit of length; it then is the paper's.

    Returns
    -------
    float or ndarray
        The ratio, (...); at a singular pose infinite, or about 1e16.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For a characteristic length that is not > 0.

    Notes
    -----
    Section 3 of the paper; the characteristic length is not in the paper.

    Examples
    --------
    >>> round(float(fx.condition_number(fx.load("motion-base"), characteristic_length=1.6)), 2)
    2.92
    """
    H = force_transformation(hexapod, pose, base=base)
    if characteristic_length is not None:
        H = H * np.repeat([1.0, 1.0 / positive(characteristic_length, "characteristic_length", "m")], 3)[:, None]
    sigma = _singular_values(H)
    with np.errstate(divide="ignore"):
        return (sigma[..., 0] / sigma[..., -1])[()]


def det_sign(hexapod: Hexapod, pose: Pose) -> Array:
    """Sign of det H at poses (n,): those of different signs have a singular pose between them on every way."""
    return np.linalg.slogdet(_without_nan(force_transformation(hexapod, pose)))[0]


def sides(hexapod: Hexapod, pose: Pose) -> np.ndarray:
    """The same as whole numbers, 0 where H is singular to rounding, and where no leg can take the pose."""
    H = _without_nan(force_transformation(hexapod, pose)) / np.repeat([1.0, platform_size(hexapod)], 3)[:, None]
    sigma = np.linalg.svd(H, compute_uv=False)
    return np.where(sigma[..., -1] > _NO_SIDE * sigma[..., 0], np.linalg.slogdet(H)[0], 0.0).astype(int)


def _without_nan(H: Array) -> Array:
    """H with zeros at poses that no leg can take."""
    return np.where(np.isnan(H), 0.0, H)


def platform_size(hexapod: Hexapod) -> float:
    """Largest distance of a platform joint from the middle of all, m."""
    return float(np.linalg.norm(hexapod.platform_joints - hexapod.platform_joints.mean(axis=0), axis=1).max())


def _singular_values(H: Array) -> Array:
    bad = np.asarray(~np.isfinite(H).all(axis=(-2, -1)))
    sigma = np.linalg.svd(np.where(bad[..., None, None], 0.0, H), compute_uv=False)
    return np.where(bad[..., None], np.nan, sigma)


def home_pose(hexapod: Hexapod) -> Pose | None:
    """Return the design's home pose.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.

    Returns
    -------
    Pose or None
        `hexapod.home`: the pose of the platform in the base frame; None where the design has none.

    Notes
    -----
    Functions that take a pose take this one where it is left out.

    Examples
    --------
    >>> fx.home_pose(fx.load("motion-base"))
    Pose(x=0 y=0 z=2.39 m, roll=0 pitch=0 yaw=0 deg)
    """
    return as_hexapod(hexapod).home
