"""From poses and motions to the rows of numbers that the core takes, and the checks that every study shares."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod import _core
from flexapod.checks import numbers
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, DesignError, PoseError, shown
from flexapod.pose import Motion, MotionLike, Pose, PoseLike, as_pose, rates, vectors

LEAST_SINE = _core.least_sine
ZERO = (0.0, 0.0, 0.0)
NO_LEGS = (0.0,) * 6


#: A point of the platform: [x, y, z] in its frame, m, or the name of a point of the design.
PointLike = str | ArrayLike

_AT_ORIGIN = Motion.fixed().packed
_JOINTS = {joint.name: joint for joint in _core.Joint}


class States(NamedTuple):
    """n states of platform and base as rows of the core's numbers of a motion, and the batch axes to give results."""

    platform: Array
    base: Array
    shape: tuple[int, ...]


def as_hexapod(value: object) -> Hexapod:
    """The design itself; raises DesignError for anything that is not a Hexapod, such as a design's name."""
    if not isinstance(value, Hexapod):
        raise DesignError(
            f"hexapod is {shown(value)}; it must be a flexapod Hexapod. Read one with flexapod.load(name or path)."
        )
    return value


def pose_or_home(hexapod: Hexapod, pose: PoseLike | None, name: str = "pose") -> Pose:
    """A pose as `as_pose` takes it, or the design's home where it is None."""
    home = as_hexapod(hexapod).home
    if pose is not None:
        return as_pose(pose, name)
    if home is None:
        raise PoseError(
            f"{name} is not given, and {hexapod.name!r} names no home pose. Give a pose, or add [home] to the design."
        )
    return home


def single_pose(hexapod: Hexapod, pose: PoseLike | None, name: str = "pose") -> Pose:
    """The same where only one pose makes sense; raises PoseError for a batch."""
    found = pose_or_home(hexapod, pose, name)
    if found.shape:
        raise PoseError(f"{name} has batch axes {found.shape}; one pose is needed. Index it first.")
    return found


def single_base(hexapod: Hexapod, base: PoseLike | None) -> Pose | None:
    """A base as one pose, None where it is left out; raises PoseError for a batch."""
    return None if base is None else single_pose(hexapod, base, "base")


def as_point(hexapod: Hexapod, point: PointLike, name: str = "point") -> Array:
    """A point of the platform (3,), m, in its frame, by its place or by its name in the design.

    Raises ArgumentError for what is neither.
    """
    points = as_hexapod(hexapod).points
    if not isinstance(point, str):
        return numbers(point, name, (3,))
    if point in points:
        return points[point]
    from difflib import get_close_matches

    near = get_close_matches(point, points, n=1)
    known = f"; it has {', '.join(points)}" if points else ", which names none"
    hint = f"Did you mean {near[0]!r}? " if near else ""
    raise ArgumentError(
        f"{name} is {shown(point)}, which is no point of {hexapod.name!r}{known}. {hint}Give x, y, z in m, or add the "
        "point to [points] of the design: name = [x, y, z]."
    )


def point_attributes(hexapod: Hexapod, point: PointLike) -> dict[str, Any]:
    """Attributes of a Dataset that say at which point it is: its place, and its name, "" without one."""
    return {"point_m": as_point(hexapod, point).tolist(), "point": point if isinstance(point, str) else ""}


def at_once(
    question: str,
    hexapod: Hexapod,
    pose: MotionLike | None,
    base: MotionLike | None,
    joint: JointModel,
    *more: ArrayLike,
) -> Any:
    """The core's answer to a question at one pose, checks included (`_core.OnePose`). None for all that is unusual.

    That is a batch, numbers that are no plain arrays, and whatever is wrong: the way of many poses then tells of it.
    """
    if not isinstance(hexapod, Hexapod) or not isinstance(joint, str):
        return None
    machine = hexapod.one_pose.get(joint)
    if machine is None:
        return None
    return getattr(machine, question)(_given(hexapod.home if pose is None else pose), _given(base), *more)


def _given(state: MotionLike | None) -> tuple[Any, Any, Any]:
    """Position and rotation, or what was given instead and None; rates of a motion, or None."""
    if isinstance(state, Pose):
        # of many poses nobody needs the matrices here
        return state.position, state.matrix if state.position.ndim == 1 else None, None
    if isinstance(state, Motion):
        return *_given(state.pose)[:2], rates(state)
    return state, None, None


def states(hexapod: Hexapod, platform: MotionLike | None, base: MotionLike | None = None) -> States:
    """Rows for the core. A single pose that no leg can take raises PoseError; in a batch its row is NaN."""
    as_hexapod(hexapod)
    given = [
        _numbers(platform if isinstance(platform, Motion) else pose_or_home(hexapod, platform)),
        _AT_ORIGIN if base is None else _numbers(base if isinstance(base, Motion) else as_pose(base, "base")),
    ]
    try:
        shape = np.broadcast_shapes(*(rows.shape[:-1] for rows in given))
    except ValueError:
        axes = [rows.shape[:-1] for rows in given]
        raise PoseError(f"pose has batch axes {axes[0]}, base {axes[1]}; they must be equal or 1.") from None
    rows = [np.ascontiguousarray(_spread(rows, shape).reshape(-1, _core.motion_size)) for rows in given]
    length, sine = _core.leg_fit(hexapod.packed, *rows)
    good = taken(hexapod, length, sine)
    if not good.all():
        if not shape:
            _refuse(hexapod, length[0], sine[0])
        rows[0] = np.where(good.all(axis=1, keepdims=True), rows[0], np.nan)
    return States(rows[0], rows[1], shape)


def taken(hexapod: Hexapod, length: Array, sine: Array) -> NDArray[np.bool_]:
    """Whether a leg of such length can be, and its universal joint can turn at such a sine (`_core.leg_fit`)."""
    good: NDArray[np.bool_] = (length >= _core.shortest_leg(hexapod.packed)) & (sine >= LEAST_SINE)
    return good


def _numbers(state: Pose | Motion) -> Array:
    """The core's numbers of a motion (..., n); a pose is at rest."""
    if isinstance(state, Motion):
        return state.packed
    packed = state.packed
    return np.concatenate([packed, np.zeros((*state.shape, _core.motion_size - packed.shape[-1]))], axis=-1)


def _refuse(hexapod: Hexapod, length: Array, sine: Array) -> None:
    """Raises PoseError for the first leg that has no length, or lies along its universal joint's axis."""
    i = int(np.argmin(taken(hexapod, length, sine)))
    if length[i] < _core.shortest_leg(hexapod.packed):
        raise PoseError(
            f"leg {i + 1} has length {length[i]:.3g} m at this pose; its joints must not meet. Move the platform."
        )
    raise PoseError(
        f"base.universal_axes[{i}] is parallel to leg {i + 1} at this pose; a universal joint cannot turn there. "
        "Choose an axis across the leg, or another pose."
    )


def as_joint(joint: str) -> _core.Joint:
    """The core's joint model of that name; raises ArgumentError for an unknown name."""
    found = _JOINTS.get(joint) if isinstance(joint, str) else None
    if found is None:
        raise ArgumentError(
            f"joint is {shown(joint)}; it must be 'universal' (exact) or 'spin_free' (legs that do not spin)."
        )
    return found


def per_leg(value: ArrayLike, name: str, shape: tuple[int, ...]) -> Array:
    """Six numbers for each state, as contiguous rows (n, 6)."""
    return _fitted(vectors(value, name, 6, ArgumentError), name, shape)


def wrench(force: ArrayLike, moment: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Force (N) and moment (N m) in the platform's frame at its reference point, as rows (n, 6)."""
    parts = [
        _fitted(vectors(v, name, 3, ArgumentError), name, shape) for v, name in ((force, "force"), (moment, "moment"))
    ]
    return np.ascontiguousarray(np.concatenate(parts, axis=-1))


def _spread(value: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (..., k) for each state of a batch; most calls are for one state, where there is nothing to spread."""
    return value if value.shape[:-1] == shape else np.broadcast_to(value, (*shape, value.shape[-1]))


def _fitted(value: Array, name: str, shape: tuple[int, ...]) -> Array:
    try:
        spread = _spread(value, shape)
    except ValueError:
        raise ArgumentError(
            f"{name} has shape {value.shape}, which does not fit the batch axes {shape} of the states."
        ) from None
    return np.ascontiguousarray(spread.reshape(-1, value.shape[-1]))
