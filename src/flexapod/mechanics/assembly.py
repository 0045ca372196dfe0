"""Forward kinematics: the pose at which the legs have given lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, KinematicsError, PoseError
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.kinematics import home_pose
from flexapod.pose import Motion, Pose, PoseLike, as_pose, orthonormal, rpy_matrix, unpack, vectors


def forward_kinematics(hexapod: Hexapod, lengths: ArrayLike, *, start: PoseLike | None = None) -> Pose:
    """Find the pose, in the base frame, at which the legs have given lengths.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    lengths : array_like
        Leg lengths, m, (..., 6).
    start : Pose or array_like, optional
        Where the search begins, one for all or one for each set of lengths: the nearest assembly is found. Left out,
        the search begins at home, or above the base, and then at poses turned and tilted about it; among several
        assemblies the first found in this order is returned.

    Returns
    -------
    Pose
        The pose or poses, with the leading axes of `lengths`.

    Raises
    ------
    KinematicsError
        Where no pose is found, with the misfit, and for a length that is not > 0.
    ArgumentError
        For lengths that are not six finite numbers each.
    PoseError
        For a start that is wrong, or does not fit the lengths.

    See Also
    --------
    flexapod.inverse_kinematics : The leg lengths at a pose.

    Notes
    -----
    Newton's method on Eq. 6 of the paper, damped far from the solution. The lengths are met to 1e-11 of the longest.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> lengths = fx.inverse_kinematics(machine, [0.1, 0, 2.4, 0, 0.05, 0])
    >>> (fx.forward_kinematics(machine, lengths).position.round(6) + 0.0).tolist()
    [0.1, 0.0, 2.4]
    """
    as_hexapod(hexapod)
    wanted = vectors(lengths, "lengths", 6, ArgumentError)
    if (wanted <= 0).any():
        raise KinematicsError(f"lengths has {wanted.min():.6g} m; every leg length must be > 0 m.")
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
