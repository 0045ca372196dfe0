"""From poses and motions to the rows of numbers that the core takes, and the checks that every study shares."""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError, PoseError
from flexapod.pose import Array, Motion, Pose, vectors

JointModel = Literal["universal", "spin_free"]
LEAST_SINE = 1e-7  # of the angle between a leg and its universal joint's axis
ZERO = (0.0, 0.0, 0.0)
NO_LEGS = (0.0,) * 6


_AT_ORIGIN = Motion.fixed()


class States(NamedTuple):
    """n states of platform and base as rows of 24 numbers, and the batch axes to give results."""

    platform: Array
    base: Array
    shape: tuple[int, ...]


def states(hexapod: Hexapod, platform: Pose | Motion, base: Pose | Motion | None = None) -> States:
    """Rows for the core. A single pose that no leg can take raises PoseError; in a batch its row is NaN."""
    if not isinstance(hexapod, Hexapod):
        raise DesignError(f"hexapod is {hexapod!r}; it must be a flexapod Hexapod, as flexapod.load returns it")
    motions = [_motion(platform, "platform"), _AT_ORIGIN if base is None else _motion(base, "base")]
    try:
        shape = np.broadcast_shapes(*(motion.shape for motion in motions))
    except ValueError:
        raise PoseError(
            f"platform has batch axes {motions[0].shape}, base {motions[1].shape}; they must be equal or 1"
        ) from None
    rows = [np.ascontiguousarray(_spread(m.packed, shape).reshape(-1, 24)) for m in motions]
    length, sine = _core.leg_fit(hexapod.packed, *rows)
    good = np.all((length >= _shortest(hexapod)) & (sine >= LEAST_SINE), axis=1, keepdims=True)
    if not good.all():
        if not shape:
            _refuse(hexapod, length[0], sine[0])
        rows[0] = np.where(good, rows[0], np.nan)
    return States(rows[0], rows[1], shape)


def _motion(value: Pose | Motion, name: str) -> Motion:
    if isinstance(value, Motion):
        return value
    if isinstance(value, Pose):
        return Motion(value)
    raise PoseError(f"{name} is {type(value).__name__}; it must be a flexapod Pose or Motion")


def _shortest(hexapod: Hexapod) -> float:
    """Below this length, m, a leg's direction is rounding."""
    return float(1e-9 * np.ptp(hexapod.base_joints, axis=0).max())


def _refuse(hexapod: Hexapod, length: Array, sine: Array) -> None:
    """Raises PoseError for the first leg that has no length, or lies along its universal joint's axis."""
    i = int(np.argmin((length >= _shortest(hexapod)) & (sine >= LEAST_SINE)))
    if length[i] < _shortest(hexapod):
        raise PoseError(
            f"leg {i + 1} has length {length[i]:.3g} m at this pose; its joints must not meet. Move the platform."
        )
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


def _spread(value: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (..., k) for each state of a batch; most calls are for one state, where there is nothing to spread."""
    return value if value.shape[:-1] == shape else np.broadcast_to(value, (*shape, value.shape[-1]))


def _fitted(value: Array, name: str, shape: tuple[int, ...]) -> Array:
    try:
        spread = _spread(value, shape)
    except ValueError:
        raise PoseError(
            f"{name} has shape {value.shape}, which does not fit the batch axes {shape} of the states"
        ) from None
    return np.ascontiguousarray(spread.reshape(-1, value.shape[-1]))
