"""Poses near a middle orientation as six numbers, in which splines and straight lines are drawn."""

from __future__ import annotations

from math import factorial, pi

import numpy as np
from numpy.polynomial import polynomial

from flexapod.conventions import Array
from flexapod.errors import PathError
from flexapod.pose import Motion, Pose
from flexapod.rotations import skew

_WIDEST = 0.9 * pi  # of a turn from the middle orientation: the rotation vector's chart ends at pi

# a = (1 - cos t)/t^2 and b = (t - sin t)/t^3 as power series in t^2. Within the chart, t < pi, 18 terms are exact.
_A = np.array([(-1) ** k / factorial(2 * k + 2) for k in range(18)])
_B = np.array([(-1) ** k / factorial(2 * k + 3) for k in range(18)])


class Chart:
    """Poses near a middle orientation as six numbers: position (m), and the rotation vector (rad) that turns it.

    R = exp(e) R_0, in outer axes. Straight lines of these numbers are the "straight" motions of paths and plans.
    """

    def __init__(self, middle: Array) -> None:
        self.middle = middle

    @classmethod
    def about(cls, poses: Pose) -> Chart:
        """The chart about the mean orientation of poses. Raises PathError where one is turned too far from it."""
        chart = cls(poses.rotation.mean().as_matrix())
        chart.check(poses, "orientations lie up to")
        return chart

    def check(self, poses: Pose, what: str) -> None:
        """Raises PathError where a pose is turned too far from the middle; what: how the message begins."""
        turn = np.linalg.norm(self.coordinates(poses)[..., 3:], axis=-1)
        if turn.max(initial=0.0) > _WIDEST:
            raise PathError(
                f"{what} {np.degrees(turn.max()):.4g} deg from the mean orientation of the waypoints; at most "
                f"{np.degrees(_WIDEST):.4g} deg can be joined. Split the path into parts."
            )

    def coordinates(self, poses: Pose) -> Array:
        """(..., 6) numbers of poses."""
        from scipy.spatial.transform import Rotation

        turned = (poses.matrix @ self.middle.T).reshape(-1, 3, 3)
        vectors = Rotation.from_matrix(turned).as_rotvec().reshape(*poses.shape, 3)
        return np.concatenate([poses.position, vectors], axis=-1)

    def poses(self, coordinates: Array) -> Pose:
        """Poses of (..., 6) numbers."""
        from scipy.spatial.transform import Rotation

        flat = coordinates[..., 3:].reshape(-1, 3)
        matrix = Rotation.from_rotvec(flat).as_matrix() @ self.middle
        return Pose(coordinates[..., :3], matrix.reshape(*coordinates.shape[:-1], 3, 3))

    def motions(self, q: Array, q_dot: Array, q_ddot: Array) -> Motion:
        """Motions of (..., 6) numbers and their two time derivatives."""
        e, e_dot, e_ddot = q[..., 3:], q_dot[..., 3:], q_ddot[..., 3:]
        jacobian, rate = turning(e), _turning_rate(e, e_dot)
        angular = np.einsum("...ij,...j->...i", jacobian, e_dot)
        angular_rate = np.einsum("...ij,...j->...i", jacobian, e_ddot) + np.einsum("...ij,...j->...i", rate, e_dot)
        return Motion(self.poses(q), q_dot[..., :3], angular, q_ddot[..., :3], angular_rate)


def turning(e: Array) -> Array:
    """(..., 3, 3), angular velocity (outer axes) from the rate of the rotation vector e: E + a e~ + b e~ e~."""
    x = (e * e).sum(axis=-1)[..., None, None]
    cross = skew(e)
    return np.eye(3) + polynomial.polyval(x, _A) * cross + polynomial.polyval(x, _B) * cross @ cross


def _turning_rate(e: Array, e_dot: Array) -> Array:
    x = (e * e).sum(axis=-1)[..., None, None]
    x_dot = 2 * (e * e_dot).sum(axis=-1)[..., None, None]
    cross, cross_dot = skew(e), skew(e_dot)
    a, b = polynomial.polyval(x, _A), polynomial.polyval(x, _B)
    a_dot, b_dot = (x_dot * polynomial.polyval(x, polynomial.polyder(series)) for series in (_A, _B))
    return a_dot * cross + a * cross_dot + b_dot * cross @ cross + b * (cross_dot @ cross + cross @ cross_dot)
