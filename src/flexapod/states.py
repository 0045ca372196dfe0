"""From poses and motions to the rows of numbers that the core takes, and the checks that every study shares."""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.errors import PoseError
from flexapod.hexapod import Hexapod
from flexapod.pose import Array, Motion, Pose, vectors

JointModel = Literal["universal", "spin_free"]
ZERO = (0.0, 0.0, 0.0)
NO_LEGS = (0.0,) * 6


class States(NamedTuple):
    """n states of platform and base as rows of 24 numbers, and the batch axes to give results."""

    platform: Array
    base: Array
    shape: tuple[int, ...]


def states(hexapod: Hexapod, platform: Pose | Motion, base: Pose | Motion | None = None) -> States:
    """Rows for the core. A single pose that no leg can take raises PoseError; in a batch it gives NaN."""
    motions = [_motion(platform, "platform"), _motion(Motion.fixed() if base is None else base, "base")]
    try:
        shape = np.broadcast_shapes(*(motion.shape for motion in motions))
    except ValueError:
        raise PoseError(
            f"platform has batch axes {motions[0].shape}, base {motions[1].shape}; they must be equal or 1"
        ) from None
    rows = [np.ascontiguousarray(np.broadcast_to(m.packed, (*shape, 24)).reshape(-1, 24)) for m in motions]
    if not shape:
        check_legs(hexapod, rows[0][0], rows[1][0])
    return States(rows[0], rows[1], shape)


def _motion(value: Pose | Motion, name: str) -> Motion:
    if isinstance(value, Motion):
        return value
    if isinstance(value, Pose):
        return Motion(value)
    raise PoseError(f"{name} is {type(value).__name__}; it must be a flexapod Pose or Motion")


def check_legs(hexapod: Hexapod, platform: Array, base: Array) -> None:
    """Raises PoseError where a leg has no length or lies along its universal joint's axis."""
    R, R_b = platform[3:12].reshape(3, 3), base[3:12].reshape(3, 3)
    b = hexapod.base_joints @ R_b.T
    S = platform[:3] - base[:3] + hexapod.platform_joints @ R.T - b
    length = np.linalg.norm(S, axis=1)
    size = np.ptp(hexapod.base_joints, axis=0).max()
    for i in np.flatnonzero(length < 1e-9 * size):
        raise PoseError(
            f"leg {i + 1} has length {length[i]:.3g} m at this pose; its joints must not meet. Move the platform."
        )
    slant = np.linalg.norm(np.cross(hexapod.universal_axes @ R_b.T, S), axis=1) / length
    for i in np.flatnonzero(slant < 1e-7):
        raise PoseError(
            f"base.universal_axes[{i}] is parallel to leg {i + 1} at this pose; a universal joint cannot turn there. "
            "Choose an axis across the leg, or another pose."
        )


def check_pose_of_one(pose: Pose, name: str) -> None:
    """Raises PoseError unless `pose` is one Pose."""
    if not isinstance(pose, Pose):
        raise PoseError(f"{name} is {type(pose).__name__}; it must be a flexapod Pose")
    if pose.shape:
        raise PoseError(f"{name} has batch axes {pose.shape}; one pose is needed. Index it first.")


def is_universal(joint: str) -> bool:
    """True for the exact joint model; raises PoseError for an unknown name."""
    if joint not in get_args(JointModel):
        raise PoseError(f"joint is {joint!r}; it must be 'universal' (exact) or 'spin_free' (the paper's W.s = 0)")
    return joint == "universal"


def per_leg(value: ArrayLike, name: str, shape: tuple[int, ...]) -> Array:
    """Six numbers for each state, as contiguous rows (n, 6)."""
    return _fitted(vectors(value, name, 6), name, shape)


def wrench(force: ArrayLike, moment: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Force (N) and moment (N m) in the platform's frame at its reference point, as rows (n, 6)."""
    parts = [_fitted(vectors(v, name), name, shape) for v, name in ((force, "force"), (moment, "moment"))]
    return np.ascontiguousarray(np.concatenate(parts, axis=-1))


def _fitted(value: Array, name: str, shape: tuple[int, ...]) -> Array:
    try:
        spread = np.broadcast_to(value, (*shape, value.shape[-1]))
    except ValueError:
        raise PoseError(
            f"{name} has shape {value.shape}, which does not fit the batch axes {shape} of the states"
        ) from None
    return np.ascontiguousarray(spread.reshape(-1, value.shape[-1]))
