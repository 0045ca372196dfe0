"""Paths: waypoints with times, joined by a smooth motion on SE(3)."""

from __future__ import annotations

from math import factorial, pi
from typing import Any, Literal, get_args

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.errors import PathError
from flexapod.pose import Motion, Pose, skew

Ends = Literal["rest", "free", "periodic"]
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
        middle = poses.rotation.mean().as_matrix()
        chart = cls(middle)
        turn = np.linalg.norm(chart.coordinates(poses)[..., 3:], axis=-1)
        if turn.max(initial=0.0) > _WIDEST:
            raise PathError(
                f"orientations lie up to {np.degrees(turn.max()):.4g} deg from their mean; at most "
                f"{np.degrees(_WIDEST):.4g} deg can be joined. Split the path into parts."
            )
        return chart

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


class Trajectory:
    """A smooth motion through waypoints: `path(t)` is the platform's Motion at times t.

    waypoints: Pose of shape (n,), n >= 2, in the base frame. times: (n,) s, increasing. ends: "rest" (starts and stops
    with no velocity and acceleration), "free" (natural spline, no acceleration at the ends), "periodic" (the last
    waypoint is the first again, and the motion goes on smoothly).

    Positions and rotation vectors about the mean orientation are splines: quintic, or cubic with free ends; velocity
    and acceleration are continuous throughout. weights: (n,) >= 0, how much each waypoint matters, for `path_index`.

    Raises: PathError for waypoints, times or weights that make no path.
    Source: own: B-splines of rotation vectors.
    """

    def __init__(
        self, waypoints: Pose, times: ArrayLike, ends: Ends = "rest", weights: ArrayLike | None = None
    ) -> None:
        if not isinstance(waypoints, Pose) or len(waypoints.shape) != 1 or waypoints.shape[0] < 2:
            what = f"shape {waypoints.shape}" if isinstance(waypoints, Pose) else type(waypoints).__name__
            raise PathError(f"waypoints is {what}; a Pose of shape (n,) with at least two poses is needed")
        self.waypoints = waypoints
        self.times = _times(times, waypoints.shape[0])
        self.weights = _weights(weights, waypoints.shape[0])
        self.ends = ends
        self.chart = Chart.about(waypoints)
        self._splines = spline(self.times, self.chart.coordinates(waypoints), ends)

    @property
    def start(self) -> float:
        """Time of the first waypoint, s."""
        return float(self.times[0])

    @property
    def duration(self) -> float:
        """From the first waypoint to the last, s."""
        return float(self.times[-1] - self.times[0])

    def __call__(self, t: ArrayLike) -> Motion:
        """Motion at times t (...), s. Raises PathError outside the path's times."""
        when = np.asarray(t, dtype=np.float64)
        slack = 1e-12 * (abs(self.times[0]) + abs(self.times[-1]))
        if when.size and not (when.min() >= self.times[0] - slack and when.max() <= self.times[-1] + slack):
            raise PathError(
                f"t runs from {when.min():.6g} to {when.max():.6g} s; the path runs from {self.times[0]:.6g} to "
                f"{self.times[-1]:.6g} s"
            )
        return self.chart.motions(*(curve(when) for curve in self._splines))

    def grid(self, samples: int) -> Array:
        """At least `samples` times over the path, evenly within each piece, with every waypoint among them."""
        share = np.diff(self.times) / self.duration
        counts = np.maximum(2, np.ceil(share * samples)).astype(int)
        pieces = zip(self.times[:-1], self.times[1:], counts, strict=True)
        return np.concatenate([*(np.linspace(a, b, n, endpoint=False) for a, b, n in pieces), self.times[-1:]])

    def poses(self, samples: int) -> Pose:
        """At least `samples` poses of the path, with every waypoint among them: the path as a region."""
        return self(self.grid(samples)).pose

    def length(self, characteristic_length: float = 1.0) -> float:
        """Integral of the speed, m; one radian of rotation counts as `characteristic_length`, m."""
        nodes, weights = np.polynomial.legendre.leggauss(12)
        a, b = self.times[:-1, None], self.times[1:, None]
        motion = self(((a + b) + (b - a) * nodes) / 2)
        speed2 = (motion.velocity**2).sum(-1) + characteristic_length**2 * (motion.angular_velocity**2).sum(-1)
        return float((np.sqrt(speed2) * weights * (b - a) / 2).sum())

    def retimed(self, duration: float) -> Trajectory:
        """The same curve in space, run in another time, s.

        Raises: PathError for a duration that is not > 0.
        """
        if not (np.isfinite(duration) and duration > 0):
            raise PathError(f"duration is {duration} s; it must be > 0")
        times = self.times[0] + (self.times - self.times[0]) * (duration / self.duration)
        return Trajectory(self.waypoints, times, self.ends, self.weights)

    def __repr__(self) -> str:
        return f"<Trajectory of {len(self.times)} waypoints, {self.duration:.6g} s, ends {self.ends}>"


def spline(times: Array, values: Array, ends: Ends) -> tuple[Any, Any, Any]:
    """The interpolating spline of (n, k) values and its first two derivatives. It is linear in the values."""
    from scipy.interpolate import make_interp_spline

    if ends not in get_args(Ends):
        raise PathError(f"ends is {ends!r}; it must be 'rest', 'free' or 'periodic'")
    width = values.shape[1:]
    still = [(1, np.zeros(width)), (2, np.zeros(width))]
    if ends == "rest":
        curve = make_interp_spline(times, values, k=5, bc_type=(still, still))
    elif ends == "free":
        curve = make_interp_spline(times, values, k=3, bc_type=(still[1:], still[1:]))
    else:
        curve = _periodic(times, values)
    return curve, curve.derivative(1), curve.derivative(2)


def _periodic(times: Array, values: Array) -> Any:
    from scipy.interpolate import make_interp_spline

    gap = np.abs(values[-1] - values[0]).max()
    if gap > 1e-9 * max(1.0, np.abs(values).max()):
        raise PathError(
            f"a periodic path must end where it starts; its last waypoint is {gap:.3g} (m or rad) away from its first. "
            "Repeat the first waypoint at the end."
        )
    if len(times) < 3:
        raise PathError("a periodic path needs at least three waypoints, the last equal to the first")
    closed = np.concatenate([values[:-1], values[:1]])
    return make_interp_spline(times, closed, k=5 if len(times) > 5 else 3, bc_type="periodic")


def _times(value: ArrayLike, count: int) -> Array:
    times = _row(value, "times", count, "s")
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        i = int(late[0])
        raise PathError(f"times[{i + 1}] is {times[i + 1]:.6g} s, after {times[i]:.6g} s; times must increase")
    return times


def _weights(value: ArrayLike | None, count: int) -> Array:
    if value is None:
        return np.ones(count)
    weights = _row(value, "weights", count, "")
    if weights.min() < 0 or not weights.max() > 0:
        raise PathError(f"weights is {weights.tolist()}; weights must be >= 0, and one of them > 0")
    return weights


def _row(value: ArrayLike, name: str, count: int, unit: str) -> Array:
    try:
        row = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise PathError(f"{name} is {value!r}; {count} numbers are needed") from error
    if row.shape != (count,):
        raise PathError(f"{name} has shape {row.shape}; one number for each of the {count} waypoints is needed")
    if not np.isfinite(row).all():
        raise PathError(f"{name} holds NaN or infinity; all must be finite{', in ' + unit if unit else ''}")
    return row.copy()
