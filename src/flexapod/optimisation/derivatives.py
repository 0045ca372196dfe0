"""Quantities of a design at some poses with their derivatives by the variables, and smooth extremes of them."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.layout import HOME
from flexapod.pose import Motion, Pose
from flexapod.workspace.coordinates import twist_of_coordinates
from flexapod.workspace.static_forces import static_forces

_NO_HOME = np.zeros((0, _core.motion_size)), np.zeros((0, 6))


class DesignDerivatives:
    """Quantities of a design at k poses, each with its derivatives by the n variables of a search.

    Every quantity is computed when it is first asked for, and is a pair of value (k, ...) and derivatives (k, ..., n).

    Parameters
    ----------
    numbers : ndarray, shape (m,)
        The numbers of the design, in the order of `flexapod.design.layout`.
    derivatives : ndarray, shape (m, n)
        Their derivatives by the variables.
    rows : ndarray, shape (k, 6)
        The poses: x, y, z in m, roll, pitch, yaw in rad.
    from_home : bool
        Whether the poses move with the home pose of the design.
    joint : _core.Joint
        Model of the joints between base and legs.
    """

    def __init__(self, numbers: Array, derivatives: Array, rows: Array, from_home: bool, joint: _core.Joint) -> None:
        self.numbers, self.jacobian, self.rows, self.from_home, self.joint = (
            numbers,
            derivatives,
            rows,
            from_home,
            joint,
        )

    @cached_property
    def omega(self) -> tuple[Array, Array]:
        """Six frequencies (k, 6), rad/s, and v_a^T (dK - lambda dJ) v_b (k, 6, 6, n)."""
        return self._directions.frequencies()

    @cached_property
    def H(self) -> tuple[Array, Array]:
        """Force transformation (k, 6, 6) and its derivatives (k, 6, 6, n)."""
        return _matrices(*self._directions.force_transformation())

    @cached_property
    def stiffness(self) -> tuple[Array, Array]:
        """Of the unloaded machine at the platform, (k, 6, 6) and (k, 6, 6, n)."""
        return _matrices(*self._directions.stiffness())

    @property
    def leg_length(self) -> tuple[Array, Array]:
        """Of the legs, (k, 6) m and (k, 6, n)."""
        return self._legs[0]

    @property
    def leg_distance(self) -> tuple[Array, Array]:
        """Of every pair of legs, (k, 15) m and (k, 15, n): each is smooth, where the least of them is not."""
        return self._legs[1]

    @property
    def joint_cosine(self) -> tuple[Array, Array]:
        """Cosines of the angles of universal, then of spherical joints, (k, 12) and (k, 12, n)."""
        return self._legs[2]

    @property
    def joint_moment(self) -> tuple[Array, Array]:
        """Squares of the bending moments of universal, then of spherical joints, (k, 12) N2 m2 and (k, 12, n)."""
        return self._legs[3]

    @cached_property
    def static_force(self) -> tuple[Array, Array]:
        """Of the legs at rest under the weight, compression > 0, (k, 6) N and (k, 6, n)."""
        return static_forces(self._directions)

    @cached_property
    def _legs(self) -> tuple[tuple[Array, Array], ...]:
        return self._directions.legs()

    @cached_property
    def _directions(self) -> _core.DesignDirections:
        home, by_home = self.numbers[HOME], self.jacobian[HOME]
        k, n = len(self.rows), self.jacobian.shape[1]
        displacement = np.zeros((k, n, 6))
        if self.from_home:
            for i, six in enumerate(self.rows):
                displacement[i] = (twist_of_coordinates(six) @ by_home).T
        motion, home_displacement = _NO_HOME
        if np.isfinite(home).all():
            motion = Motion(Pose.from_rpy(*home)).packed[None]
            home_displacement = (twist_of_coordinates(home) @ by_home).T
        return _core.DesignDirections(
            design=self.numbers[: HOME.start],
            joint=self.joint,
            platform=Motion(Pose.from_rpy(*self.rows.T)).packed,
            directions=np.ascontiguousarray(self.jacobian[: HOME.start].T),
            displacements=displacement,
            home=motion,
            home_displacements=np.ascontiguousarray(home_displacement),
        )


def _matrices(value: Array, slope: Array) -> tuple[Array, Array]:
    """Rows of 36 numbers as 6 x 6 matrices."""
    return value.reshape(-1, 6, 6), slope.reshape(-1, 6, 6, slope.shape[-1])


def soft_least(values: Array, slopes: Array, sharpness: float) -> tuple[Array, Array]:
    """Logarithm of (sum v^-s)^(-1/s) over the last axis of positive values (..., m), slopes (..., m, n).

    Below the logarithm of the least by at most log(m)/s. It is a symmetric function of the values, so that it is smooth
    where they are eigenvalues that meet, whatever vectors are chosen there.
    """
    safe = np.maximum(values, 1e-300)
    least = safe.min(axis=-1, keepdims=True)
    with np.errstate(under="ignore"):  # what is far above the least has no part in it
        weight = (least / safe) ** sharpness
        total = weight.sum(axis=-1)
        logarithm = np.log(least[..., 0]) - np.log(total) / sharpness
        share = weight / total[..., None] / safe
        return logarithm, np.einsum("...m,...mn->...n", share, slopes)


def soft_most(values: Array, slopes: Array, sharpness: float) -> tuple[Array, Array]:
    """The same for the largest: above its logarithm by at most log(m)/s."""
    safe = np.maximum(values, 1e-300)
    logarithm, slope = soft_least(1 / safe, -slopes / safe[..., None] ** 2, sharpness)
    return -logarithm, -slope


def index_derivatives(at: DesignDerivatives, sharpness: float) -> tuple[Array, Array]:
    """Logarithm of the smooth least frequency at each pose, (k,) and (k, n)."""
    omega, rayleigh = at.omega
    safe = np.maximum(omega, 1e-9 * omega[:, -1:])
    diagonal = np.einsum("kaan->kan", rayleigh) / (2 * safe[..., None])
    return soft_least(safe, diagonal, sharpness)
