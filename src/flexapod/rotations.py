"""Rotation matrices, and the angles and vectors that stand for them."""

from __future__ import annotations

import warnings
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats
from flexapod.conventions import Array
from flexapod.errors import PoseError, shown

FIXED = "xyz"  # roll, pitch, yaw: the order in which six numbers are a pose


_ROTATION = (
    "give a scipy Rotation or matrices of shape (..., 3, 3). From angles: Pose.from_rpy(x, y, z, roll, pitch, yaw)."
)


def checked_matrices(rotation: Any) -> Array:
    """A copy of rotations as matrices (..., 3, 3); raises PoseError for what does not rotate."""
    matrix = rotation.as_matrix() if hasattr(rotation, "as_matrix") else rotation
    try:
        matrix = floats(matrix)  # a copy: a pose does not change with its maker's arrays
    except (TypeError, ValueError) as error:
        raise PoseError(f"rotation is {shown(rotation)}; {_ROTATION}") from error
    if matrix.ndim < 2 or matrix.shape[-2:] != (3, 3):
        raise PoseError(f"rotation has shape {matrix.shape}; {_ROTATION}")
    skew = np.abs(matrix @ np.swapaxes(matrix, -1, -2) - np.eye(3)).max(initial=0.0)
    if not skew < 1e-9 or np.any(np.linalg.det(matrix) < 0):
        raise PoseError("rotation is not a rotation matrix: R R^T must be the identity to 1e-9 and det R be +1.")
    return matrix


def check_order(order: Any) -> str:
    """An order of rotations in SciPy's words; raises PoseError for another."""
    known = isinstance(order, str) and len(order) == 3 and (set(order) <= set("xyz") or set(order) <= set("XYZ"))
    if not known or order[0] == order[1] or order[1] == order[2]:
        raise PoseError(
            f"the rotation order is {shown(order)}; it must be three letters of x, y, z, such as 'xyz' (about fixed "
            "axes: roll, pitch, yaw), or of X, Y, Z, such as 'XYZ' or 'ZXZ' (about moving axes), none twice in a row."
        )
    return str(order)


def matrix_of_angles(angles: ArrayLike, order: str = FIXED) -> Array:
    """Rotation matrices (..., 3, 3) of three angles (..., 3) in rad, each about its axis of the order, in turn."""
    if check_order(order) == FIXED:
        return rpy_matrix(angles)
    each = np.moveaxis(np.asarray(angles, dtype=np.float64), -1, 0)
    turns = [
        rotation_from_vector(angle[..., None] * np.eye(3)["xyz".index(axis)])
        for angle, axis in zip(each, order.lower(), strict=True)
    ]
    return reduce(np.matmul, turns if order.isupper() else turns[::-1])


def angles_of_matrix(matrix: Array, order: str = FIXED) -> Array:
    """The three angles (..., 3) in rad of rotation matrices (..., 3, 3); NaN where a matrix is."""
    from scipy.spatial.transform import Rotation

    check_order(order)
    flat = matrix.reshape(-1, 3, 3)
    good = np.isfinite(flat).all(axis=(-2, -1))
    found = np.full((len(flat), 3), np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # gimbal lock: the third angle is zero then
        found[good] = Rotation.from_matrix(flat[good]).as_euler(order) if good.any() else 0.0
    return found.reshape(*matrix.shape[:-2], 3) + 0.0


def rpy_matrix(rpy: ArrayLike) -> Array:
    """Rotation matrices (..., 3, 3) of roll, pitch, yaw (..., 3) in rad about the fixed axes x, y, z, in this order."""
    angles = np.asarray(rpy)  # complex ones keep their derivatives
    angles = angles.astype(np.result_type(angles, np.float64))
    (cr, cp, cy), (sr, sp, sy) = (np.moveaxis(f(angles), -1, 0) for f in (np.cos, np.sin))
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def skew(vector: ArrayLike) -> Array:
    """Matrices (..., 3, 3) with skew(a) b = a x b, of vectors (..., 3)."""
    x, y, z = np.moveaxis(np.asarray(vector, dtype=np.float64), -1, 0)
    zero = np.zeros_like(x)
    rows = ([zero, -z, y], [z, zero, -x], [-y, x, zero])
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def rotation_from_vector(vector: ArrayLike) -> Array:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) in rad (Rodrigues), without loading SciPy."""
    v = np.asarray(vector, dtype=np.float64)
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    K = skew(v / np.where(angle > 0, angle, 1.0))
    turned = angle[..., None]
    return np.eye(3) + np.sin(turned) * K + (1 - np.cos(turned)) * K @ K


def orthonormal(matrix: Array) -> Array:
    """The rotation nearest to a matrix that is one to rounding."""
    u, _, vt = np.linalg.svd(matrix)
    return u @ vt
