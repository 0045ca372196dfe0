"""Axes of the universal joints for a design that names none: tangents of the base circle, or across the legs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.design.home import home_of
from flexapod.errors import DesignError
from flexapod.pose import Pose

ACROSS = np.radians(15.0)  # a tangent that is nearer to its leg at home does not lie across it


def default_axes(base_joints: Array, platform_joints: Array, home: Pose | None) -> Array:
    """Unit vectors (6, 3): the tangents, but for legs that these do not lie across at home.

    Such a leg, which is nearly horizontal, gets the axis across it that is nearest to z. Without a home pose the legs'
    directions are not known, and all axes are tangents. Raises DesignError where a joint has no tangent either.
    """
    tangent, exists = tangent_axes(base_joints)
    leg = None if home is None else _legs(base_joints, platform_joints, home)
    if leg is None:
        if not exists.all():
            number = int(np.argmin(exists))
            raise DesignError(
                f"base.universal_axes is left out, but base.joints[{number}] is at {base_joints[number].tolist()} m, "
                "straight above or below the centroid of the base joints, where no tangent exists. Give "
                "base.universal_axes, or [home], which tells the legs' directions."
            )
        return tangent
    fits = exists & lies_across(tangent, leg)
    upright = np.abs(leg[:, 2]) > np.sqrt(0.5)
    near = np.where(upright[:, None], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
    across = near - (near * leg).sum(axis=1, keepdims=True) * leg
    across = across / np.linalg.norm(across, axis=1, keepdims=True)
    return np.where(fits[:, None], tangent, across) + 0.0


def default_axes_of(values: Mapping[str, Any]) -> Array:
    """The same of a design by its values."""
    return default_axes(values["base.joints"], values["platform.joints"], home_of(values))


def keeps_tangents(base_joints: Array, platform_joints: Array, home: Pose | None) -> NDArray[np.bool_]:
    """Which legs have the tangent as their default axis, (6,)."""
    tangent, exists = tangent_axes(base_joints)
    leg = None if home is None else _legs(base_joints, platform_joints, home)
    return exists if leg is None else exists & lies_across(tangent, leg)


def lies_across(axis: Array, leg: Array) -> NDArray[np.bool_]:
    """Whether unit vectors are farther from the legs' directions than `ACROSS`, (6,)."""
    return np.asarray(np.linalg.norm(np.cross(axis, leg), axis=1) > np.sin(ACROSS))


def tangent_axes(base_joints: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Unit vectors z x (b_i - centroid), (6, 3), and whether each exists: above the centroid there is none."""
    out = base_joints - base_joints.mean(axis=0)
    out = np.ldexp(out, -np.frexp(np.abs(out).max())[1])  # a power of two: exact, and squares do not vanish
    axes = np.stack([-out[:, 1], out[:, 0], np.zeros(len(out))], axis=1)
    length = np.linalg.norm(axes, axis=1)
    exists = length >= 1e-9
    return np.asarray(axes / np.where(exists, length, 1.0)[:, None] + 0.0), exists


def legs_at(base_joints: Array, platform_joints: Array, pose: Pose) -> Array:
    """The legs from base joint to platform joint at a pose, which no leg need be able to take, (6, 3)."""
    return pose.position + platform_joints @ pose.matrix.T - base_joints


def _legs(base_joints: Array, platform_joints: Array, home: Pose) -> Array | None:
    """Directions of the legs at home, (6, 3); None where a leg has no length there."""
    leg = legs_at(base_joints, platform_joints, home)
    length = np.linalg.norm(leg, axis=1, keepdims=True)
    return leg / length if (length > 0).all() else None
