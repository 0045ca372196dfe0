"""Rotation matrices, and the angles and vectors that stand for them."""

from __future__ import annotations

import warnings
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import floats, thread_count
from flexapod.conventions import Array
from flexapod.errors import PoseError, shown

FIXED = "xyz"  # roll, pitch, yaw: the order in which six numbers are a pose


_ROTATION = (
    "give a scipy Rotation or matrices of shape (..., 3, 3). From angles: Pose.from_rpy(x, y, z, roll, pitch, yaw)."
)


def threads_for(count: int) -> int:
    """Threads for work on so many rotations: one where there are few."""
    return thread_count(None) if count > 20_000 else 1


def checked_matrices(rotation: Any) -> Array:
    """A copy of rotations as matrices (..., 3, 3); raises PoseError for what does not rotate."""
    made = hasattr(rotation, "as_matrix")
    matrix = rotation.as_matrix() if made else rotation
    try:
        # a copy, unless it was just made: a pose does not change with its maker's arrays
        matrix = floats(matrix, copy=not made)
    except (TypeError, ValueError) as error:
        raise PoseError(f"rotation is {shown(rotation)}; {_ROTATION}") from error
    if matrix.ndim < 2 or matrix.shape[-2:] != (3, 3):
        raise PoseError(f"rotation has shape {matrix.shape}; {_ROTATION}")
    matrix = np.ascontiguousarray(matrix)
    if not _core.all_rotate(matrix, threads_for(matrix.size // 9)):
        raise PoseError("rotation is not a rotation matrix: R R^T must be the identity to 1e-9 and det R be +1.")
    return matrix


def many_quaternions(rotation: Any) -> Array | None:
    """Quaternions (..., 4) of many rotations of SciPy, scalar last; None for one rotation, and for all else."""
    if not hasattr(rotation, "as_quat") or not hasattr(rotation, "as_matrix"):
        return None
    try:
        found = np.ascontiguousarray(floats(rotation.as_quat(), copy=False))
    except (TypeError, ValueError):
        return None
    if found.ndim < 2 or found.shape[-1] != 4 or not _core.all_of_length_one(found, threads_for(found.size // 4)):
        return None
    return found


def matrices_of_quaternions(quaternions: Array) -> Array:
    """Rotation matrices (..., 3, 3) of quaternions (..., 4) of length one with their scalar last."""
    rows = np.ascontiguousarray(quaternions)
    found: Array = _core.matrices_of_quaternions(rows, threads_for(rows.size // 4))
    return found.reshape(*quaternions.shape[:-1], 3, 3)


def rpy_of_matrices(matrices: Array) -> Array:
    """Roll, pitch, yaw (..., 3) of rotation matrices (..., 3, 3), rad; yaw is 0 where pitch is +-pi/2."""
    rows = np.ascontiguousarray(matrices)
    found: Array = _core.angles_of_matrices(rows, threads_for(rows.size // 9))
    return found.reshape(*matrices.shape[:-2], 3)


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
    angles = np.asarray(rpy)
    if angles.dtype.kind != "c":
        numbers = np.ascontiguousarray(angles, dtype=np.float64)
        found: Array = _core.matrices_of_angles(numbers, threads_for(numbers.size // 3))
        return found.reshape(*angles.shape[:-1], 3, 3)
    # complex ones keep their derivatives
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


def vector_from_rotation(matrix: Array) -> Array:
    """Rotation vectors (..., 3) in rad, of length up to pi, of rotation matrices (..., 3, 3), without loading SciPy."""
    sines = 0.5 * np.stack([matrix[..., k, j] - matrix[..., j, k] for j, k in ((1, 2), (2, 0), (0, 1))], axis=-1)
    sine, cosine = np.linalg.norm(sines, axis=-1, keepdims=True), 0.5 * (np.trace(matrix, axis1=-2, axis2=-1) - 1.0)
    angle = np.arctan2(sine, cosine[..., None])
    near = sines * np.where(sine > 0, angle / np.where(sine > 0, sine, 1.0), 1.0)
    # Near half a turn the sine has no digits left: the axis is the largest column of (R + R^T) / 2 - cos(angle) 1.
    outer = 0.5 * (matrix + np.swapaxes(matrix, -1, -2)) - cosine[..., None, None] * np.eye(3)
    largest = np.argmax(np.diagonal(outer, axis1=-2, axis2=-1), axis=-1)
    axis = np.take_along_axis(outer, largest[..., None, None], axis=-1)[..., 0]
    length = np.linalg.norm(axis, axis=-1, keepdims=True)
    turned = np.where(np.sum(axis * sines, axis=-1, keepdims=True) < 0, -angle, angle)
    return np.where(cosine[..., None] > -0.9, near, axis * turned / np.where(length > 0, length, 1.0))


def orthonormal(matrix: Array) -> Array:
    """The rotation nearest to a matrix that is one to rounding."""
    u, _, vt = np.linalg.svd(matrix)
    return u @ vt
