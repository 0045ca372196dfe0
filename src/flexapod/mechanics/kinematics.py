"""Geometry of the legs: lengths, rates, joint angles, limits, the force transformation H and its condition."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import positive
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, KinematicsError, PoseError
from flexapod.mechanics.inputs import as_hexapod, pose_or_home, states
from flexapod.pose import Motion, MotionLike, Pose, PoseLike, as_pose, orthonormal, rpy_matrix, unpack, vectors


class LegRates(NamedTuple):
    """length: leg lengths, m. rate: m/s. acceleration: m/s2. Each (..., 6).

    Source: Eqs 6 to 8.
    """

    length: Array
    rate: Array
    acceleration: Array


class JointAngles(NamedTuple):
    """universal_first, universal_second, universal, spherical: joint angles, rad, (..., 6) each; see `joint_angles`.

    Source: own.
    """

    universal_first: Array
    universal_second: Array
    universal: Array
    spherical: Array


class LimitsCheck(NamedTuple):
    """Outcome of `check_limits`. ok: (...) bool. exceeded: for a single pose what is exceeded, in words, else empty.

    Source: own.
    """

    ok: np.ndarray
    exceeded: tuple[str, ...]


def inverse_kinematics(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array:
    """Leg lengths (..., 6) in m at a pose.

    Raises: PoseError at a pose that no leg can take; in a batch such a pose gives NaN.
    Source: Eq. 6.
    """
    return leg_rates(hexapod, pose, base=base).length


def leg_rates(hexapod: Hexapod, pose: MotionLike | None = None, *, base: MotionLike | None = None) -> LegRates:
    """Leg lengths, rates and accelerations, (..., 6) m, m/s, m/s2, for motions of platform and base.

    Raises: PoseError at a pose that no leg can take; in a batch such a pose gives NaN.
    Source: Eqs 6 to 8.
    """
    s = states(hexapod, pose, base)
    return LegRates(*(x.reshape(*s.shape, 6) for x in _core.leg_rates(hexapod.packed, s.platform, s.base)))


def force_transformation(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> Array:
    """The force transformation H, (..., 6, 6): leg forces (N) to the wrench on the platform at its reference point.

    Inertial axes. Column i is [s_i; q_i x s_i]; rows 1-3 have no unit, rows 4-6 are in m. Its transpose maps the
    platform's twist to leg rates.

    Raises: PoseError at a pose that no leg can take; in a batch such a pose gives NaN.
    Source: Eq. 34.
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
    """Ratio of the largest to the least singular value of H, (...); at a singular pose infinite, or about 1e16.

    H mixes units (rows of forces, rows of moments in m), so the number depends on the unit of length: in metres it is
    the paper's. With a `characteristic_length` (m) the moment rows are divided by it, which removes the unit.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for a characteristic length that is
    not > 0.
    Source: Section 3; the characteristic length is our own.
    """
    H = force_transformation(hexapod, pose, base=base)
    if characteristic_length is not None:
        H = H * np.repeat([1.0, 1.0 / positive(characteristic_length, "characteristic_length", "m")], 3)[:, None]
    sigma = _singular_values(H)
    with np.errstate(divide="ignore"):
        return (sigma[..., 0] / sigma[..., -1])[()]


def _singular_values(H: Array) -> Array:
    bad = np.asarray(~np.isfinite(H).all(axis=(-2, -1)))
    sigma = np.linalg.svd(np.where(bad[..., None, None], 0.0, H), compute_uv=False)
    return np.where(bad[..., None], np.nan, sigma)


def home_pose(hexapod: Hexapod) -> Pose | None:
    """The design's home pose, m and rad, in the base frame; None where the design names none.

    Raises: nothing of its own.
    Source: own.
    """
    return as_hexapod(hexapod).home


def forward_kinematics(hexapod: Hexapod, lengths: ArrayLike, *, start: PoseLike | None = None) -> Pose:
    """The pose, in the base frame, at which the legs have the given lengths, (..., 6) m.

    From `start`, one pose for all or one for each, the nearest assembly is found by Newton's method (damped far from
    it). Without a start the search begins at the design's home pose, or above the base, and then from poses turned and
    tilted about it; among several assemblies the first found in this order is returned.

    Raises: KinematicsError, with the misfit, where no pose is found, and for a length that is not > 0;
    ArgumentError for lengths that are not six numbers each; PoseError for a start that does not fit them.
    Source: own: Newton's method on Eq. 6.
    """
    as_hexapod(hexapod)
    wanted = vectors(lengths, "lengths", 6, ArgumentError)
    if (wanted <= 0).any():
        raise KinematicsError(f"lengths has {wanted.min():.6g} m; every leg length must be > 0 m")
    starts = [None] * (wanted.size // 6) if start is None else _one_for_each(start, wanted.shape[:-1])
    found = [_assemble(hexapod, row, near) for row, near in zip(wanted.reshape(-1, 6), starts, strict=True)]
    position = np.array([p for p, _ in found]).reshape(*wanted.shape[:-1], 3)
    return Pose(position, np.array([R for _, R in found]).reshape(*wanted.shape[:-1], 3, 3))


def _one_for_each(start: PoseLike, shape: tuple[int, ...]) -> list[Pose]:
    start = as_pose(start, "start")
    try:
        position, matrix = np.broadcast_to(start.position, (*shape, 3)), np.broadcast_to(start.matrix, (*shape, 3, 3))
    except ValueError:
        raise PoseError(f"start has batch axes {start.shape}, which do not fit those of the lengths, {shape}") from None
    return [Pose(p, R) for p, R in zip(position.reshape(-1, 3), matrix.reshape(-1, 3, 3), strict=True)]


def _assemble(hexapod: Hexapod, lengths: Array, start: Pose | None) -> tuple[Array, Array]:
    starts = _starts(hexapod, lengths) if start is None else start
    packed = np.atleast_2d(Motion(starts).packed)
    rows = np.ascontiguousarray(np.broadcast_to(lengths, (len(packed), 6)))
    best = np.inf
    tolerance = 1e-11 * lengths.max()
    for i in range(len(packed)):  # one after the other: the first start nearly always succeeds
        pose, error = _core.forward_kinematics(hexapod.packed, rows[i], packed[i])
        best = np.fmin(best, error[0])
        if error[0] <= tolerance:
            found = unpack(pose[0])
            return found["position"], orthonormal(found["matrix"])
    tried = "from this start" if start is not None else f"from {len(packed)} starts"
    remedy = "give a start nearer to the pose, or none" if start is not None else "check the lengths, or give a start"
    raise KinematicsError(
        f"leg lengths {np.array2string(lengths, precision=6)} m admit no pose that could be found {tried}: the closest "
        f"one misses a length by {best:.3g} m; {remedy}."
    )


def _starts(hexapod: Hexapod, lengths: Array) -> Pose:
    """Poses to start from: home (or over the base at a height that the lengths suggest), then turned and tilted."""
    home = home_pose(hexapod)
    if home is None:
        b, p = hexapod.base_joints, hexapod.platform_joints
        centre = b.mean(axis=0) - p.mean(axis=0)
        offset = np.linalg.norm((p + centre - b)[:, :2], axis=1)
        rise = np.sqrt(np.maximum(lengths**2 - offset**2, (0.3 * lengths) ** 2)).mean()
        home = Pose(centre + np.array([0.0, 0.0, rise]))
    turns = np.radians([[0, 0, y] for y in (0, 30, -30, 60, -60, 90, -90, 120, -120, 180)])
    tilts = np.radians([[r, p, 0] for r in (-40, 0, 40) for p in (-40, 0, 40) if r or p])
    rotations = home.matrix @ rpy_matrix(np.concatenate([turns, tilts]))
    heights = np.array([1.0, 0.7, 1.3, -1.0])
    positions = home.position * np.stack([np.ones(4), np.ones(4), heights], axis=-1)
    return Pose(np.repeat(positions, len(rotations), axis=0), np.tile(rotations, (4, 1, 1)))


def joint_angles(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> JointAngles:
    """Angles of every universal and spherical joint from neutral, rad, (..., 6) each.

    `universal_first`: turn of the universal joint about its axis in the base; `universal_second`: tilt of the leg out
    of the plane normal to that axis. `universal`, `spherical`: angle between the leg and the joint's neutral direction
    in the base and in the platform. Neutral is the leg's direction at the home pose; without one, the frame's z axis.

    Raises: PoseError at a pose that no leg can take; in a batch such a pose gives NaN.
    Source: own.
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
    """Least distance between any two leg axes, as segments between their joints, (...) m.

    Raises: PoseError at a pose that no leg can take; in a batch such a pose gives NaN.
    Source: own: the closest points of two segments.
    """
    s = states(hexapod, pose, base)
    return _core.leg_distance(hexapod.packed, s.platform, s.base).reshape(s.shape)[()]


def check_limits(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> LimitsCheck:
    """Whether leg lengths (m), joint angles (rad) and leg distance (m) are within the design's limits.

    A limit that the design does not give always holds.

    Raises: PoseError at a single pose that no leg can take, where something is limited.
    Source: own.
    """
    pose = pose_or_home(hexapod, pose)
    excess = limit_excess(hexapod, pose, base=base)
    ok = np.ones(pose.shape, dtype=bool)
    words: list[str] = []
    for quantity in excess:
        _, value, least, most = quantity
        ok &= ((value >= least) & (value <= most)).reshape(*pose.shape, -1).all(axis=-1)
        if not pose.shape:
            words += in_words(quantity)
    return LimitsCheck(ok, tuple(words))


class Quantity(NamedTuple):
    """A limited quantity: its name and unit, its values and its bounds."""

    what: str
    value: Array
    least: Array | float
    most: Array | float


def limit_excess(hexapod: Hexapod, pose: PoseLike | None = None, *, base: PoseLike | None = None) -> list[Quantity]:
    """Every quantity that the design limits, with its bounds."""
    limits = hexapod.limits
    result = []
    if limits.leg_length is not None:
        bounds = np.asarray(limits.leg_length)
        lengths = inverse_kinematics(hexapod, pose, base=base)
        result.append(Quantity("length m", lengths, bounds[..., 0], bounds[..., 1]))
    if limits.universal_angle is not None or limits.spherical_angle is not None:
        angles = joint_angles(hexapod, pose, base=base)
        for name, most in (("universal", limits.universal_angle), ("spherical", limits.spherical_angle)):
            if most is not None:
                value = np.degrees(getattr(angles, name))
                result.append(Quantity(f"{name} joint angle deg", value, -np.inf, float(np.degrees(most))))
    if limits.leg_distance is not None:
        distance = np.asarray(leg_distance(hexapod, pose, base=base))
        result.append(Quantity("least distance between legs m", distance, limits.leg_distance, np.inf))
    return result


def in_words(quantity: Quantity) -> list[str]:
    """What a quantity of one pose exceeds, leg by leg."""
    value = np.atleast_1d(quantity.value)
    name, unit = quantity.what.rsplit(" ", 1)
    low, high = np.broadcast_to(quantity.least, value.shape), np.broadcast_to(quantity.most, value.shape)
    words = []
    for i, v in enumerate(value):
        leg = f"leg {i + 1}: " if value.size == 6 else ""
        if v < low[i]:
            words.append(f"{leg}{name} {v:.4g} {unit} is below {low[i]:.4g} {unit}")
        elif v > high[i]:
            words.append(f"{leg}{name} {v:.4g} {unit} is above {high[i]:.4g} {unit}")
    return words
