"""Sizes of a machine, and poses in the units of the page: x, y, z in m, roll, pitch, yaw in degrees."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.universal_axes import legs_at
from flexapod.pose import Pose

_RADIANS = np.repeat([1.0, np.pi / 180], 3)


def in_radians(six: ArrayLike) -> Array:
    """Coordinates (..., 6) in m and rad, of those in m and degrees."""
    return np.asarray(six, dtype=float) * _RADIANS


def in_degrees(six: Sequence[float] | Array) -> list[float]:
    """The coordinates of one pose in m and degrees, of those in m and rad, without rounding errors."""
    return [*map(float, six[:3]), *np.round(np.degrees(six[3:]), 12).tolist()]


def pose_at(six: ArrayLike) -> Pose:
    """The pose of coordinates in m and degrees."""
    return Pose.from_rpy(*np.asarray(six, dtype=float), degrees=True)


def mean_radius(joints: Array) -> float:
    """Mean distance of joints from the plate's z axis, m."""
    return float(np.hypot(joints[:, 0], joints[:, 1]).mean())


def mean_leg_length(hexapod: Hexapod, six: list[float]) -> float:
    """Mean distance between the joints of a leg at a pose in m and degrees: how long to draw the parts of a leg."""
    return float(np.linalg.norm(legs_at(hexapod.base_joints, hexapod.platform_joints, pose_at(six)), axis=1).mean())


def farthest(joints: Array) -> float:
    """Distance of the farthest joint from the plate's reference point, m."""
    return float(np.linalg.norm(joints, axis=1).max())
