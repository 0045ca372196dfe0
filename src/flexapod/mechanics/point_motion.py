"""The motion of a point of the rigid platform, from that of its reference point."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.pose import Motion, Pose
from flexapod.rotations import skew


def point_words(place: Iterable[float], name: str = "") -> str:
    """A point of the platform as people read it, with its name in the design; "" for an origin without a name."""
    numbers = [float(x) for x in place]
    if not any(numbers) and not name:
        return ""
    told = f"({', '.join(f'{x:.6g}' for x in numbers)}) m"
    return f"{name} {told}" if name else told


def of_point(attributes: Mapping[Any, Any]) -> str:
    """What the attributes of a Dataset say of its point, for titles: ", at vertex (0, 0, -0.15) m", or nothing."""
    words = point_words(attributes.get("point_m", ()), attributes.get("point", ""))
    return f", at {words}" if words else ""


def in_columns(attributes: Mapping[Any, Any]) -> str:
    """The same as the end of a column's name: "_of_vertex", "_of_point" for one without a name, or nothing."""
    return f"_of_{attributes.get('point') or 'point'}" if of_point(attributes) else ""


def shift(pose: Pose, point: Array) -> Array:
    """(..., 6, 6): small displacement of a point of the platform (platform frame, m) from that of the reference point.

    Its transpose takes a wrench at the point to the reference point.
    """
    matrix = np.zeros((*pose.shape, 6, 6))
    matrix[...] = np.eye(6)
    matrix[..., :3, 3:] = -skew(pose.matrix @ point)
    return matrix


def at_point(motion: Motion, point: Array) -> Motion:
    """The same motion told of a point of the body (body frame, m) in place of its reference point."""
    if not point.any():
        return motion
    arm, w, turning = motion.pose.matrix @ point, motion.angular_velocity, motion.angular_acceleration
    return Motion(
        Pose.trusted(motion.pose.position + arm, motion.pose.matrix),
        motion.velocity + np.cross(w, arm),
        w,
        motion.acceleration + acceleration_by_turning(arm, w, turning),
        turning,
    )


def acceleration_by_turning(arm: Array, velocity: Array, acceleration: Array) -> Array:
    """(..., 3) m/s2: what a rotation (rad/s, rad/s2) adds to the acceleration at the end of an arm, m."""
    return np.asarray(np.cross(acceleration, arm) + np.cross(velocity, np.cross(velocity, arm)), dtype=np.float64)


def displacement_at(displacement: Array, arm: Array) -> Array:
    """Displacement (..., 6) from rest, a translation and a rotation vector, of a point at `arm` (3,) m at rest.

    Small rotations keep their digits: no arm is subtracted from itself.
    """
    if not arm.any():
        return displacement
    turn = displacement[..., 3:]
    angle = np.linalg.norm(turn, axis=-1, keepdims=True)
    sine, half = np.sinc(angle / np.pi), np.sinc(angle / (2 * np.pi))  # sin(a)/a, and that of half the angle
    across = np.cross(turn, arm)
    moved = displacement[..., :3] + sine * across + 0.5 * half**2 * np.cross(turn, across)
    return np.concatenate([moved, turn], axis=-1)
