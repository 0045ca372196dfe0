"""Trajectories: waypoints with times, joined by a smooth motion on SE(3)."""

from __future__ import annotations

from copy import copy

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import numbers, positive, whole
from flexapod.conventions import Array
from flexapod.errors import ArgumentError, PathError, PoseError
from flexapod.paths.chart import Chart
from flexapod.paths.curve import Curve, Ends, spline
from flexapod.pose import Motion, Pose, PoseLike, as_pose

_SHORTEST, _LONGEST = 1e-9, 1e12  # of a path, s: accelerations beyond would be no numbers
_LEAST_GAP = 1e-6  # between waypoints, of the mean: closer ones leave no digits for the spline


class Trajectory:
    """A smooth motion of the platform through waypoints: ``trajectory(t)`` is its Motion at times t.

    Parameters
    ----------
    waypoints : Pose or array_like
        At least two poses in the base frame, a Pose of shape (n,), or rows (n, 6) of x, y, z (m), roll, pitch, yaw
        (rad).
    times : array_like
        Time of each waypoint, (n,) s, increasing.
    ends : {"rest", "free", "periodic"}, optional
        Whether the motion starts and stops with no velocity and acceleration ("rest"), has no acceleration at its ends
        ("free"), or goes on smoothly from the last waypoint, which is the first again ("periodic").
    weights : array_like, optional
        How much each waypoint matters in the means of `path_index`, (n,), >= 0; 1 by default.
    origin : Pose or array_like, optional
        Pose that the waypoints are measured from, such as `home_pose(hexapod)` for a motion about home: positions add,
        and angles turn it about the base's axes. Left out, waypoints are poses in the base frame.

    Attributes
    ----------
    waypoints : Pose
        The waypoints, of shape (n,).
    times, weights : ndarray
        Times (s) and weights of the waypoints, (n,).
    ends : str
        As given.
    joined : str or None
        Of a path that `between` made, the ends of the one within: all waypoints but the first and the last.
    start, duration : float
        Time of the first waypoint, and from the first to the last, s.

    Raises
    ------
    PathError
        If the waypoints or times make no path, or the waypoints' orientations lie too far apart.
    PoseError
        If the origin is not one pose.
    ArgumentError
        If `times`, `ends` or `weights` has a wrong shape or value.

    See Also
    --------
    path_index : the dynamic stability index along a trajectory.
    plan_path : a trajectory that keeps requirements.

    Notes
    -----
    Positions and rotation vectors about the waypoints' mean orientation are B-splines: quintic, or cubic with free
    ends. Velocity and acceleration are continuous throughout. `between` joins such a path to rest poses.

    Examples
    --------
    >>> trajectory = fx.Trajectory([[0, 0, 1.0, 0, 0, 0], [0.1, 0, 1.1, 0, 0, 0.2]], times=[0.0, 2.0])
    >>> trajectory(1.0).pose.position.round(3)
    array([0.05, 0.  , 1.05])
    """

    def __init__(
        self,
        waypoints: PoseLike,
        times: ArrayLike,
        *,
        ends: Ends = "rest",
        weights: ArrayLike | None = None,
        origin: PoseLike | None = None,
    ) -> None:
        poses = as_pose(waypoints, "waypoints")
        if origin is not None:
            poses = _single(origin, "origin").displaced(poses)
        if len(poses.shape) != 1 or poses.shape[0] < 2:
            raise PathError(f"waypoints has batch axes {poses.shape}; a row of at least two poses is needed.")
        self.waypoints = poses
        self.times = _times(times, poses.shape[0])
        self.weights = _weights(weights, poses.shape[0])
        self.ends = ends
        self.joined: Ends | None = None
        self.chart = Chart.about(poses)
        self._curve = Curve([spline(self.times, self.chart.coordinates(poses), ends)], self.times[[0, -1]])

    @property
    def start(self) -> float:
        """Time of the first waypoint, s."""
        return float(self.times[0])

    @property
    def duration(self) -> float:
        """From the first waypoint to the last, s."""
        return float(self.times[-1] - self.times[0])

    def __call__(self, t: ArrayLike) -> Motion:
        """Give the motion at times t (...), s; raises PathError outside the path's times."""
        when = np.asarray(t, dtype=np.float64)
        slack = 1e-12 * (abs(self.times[0]) + abs(self.times[-1]))
        if when.size and not (when.min() >= self.times[0] - slack and when.max() <= self.times[-1] + slack):
            raise PathError(
                f"t runs from {when.min():.6g} to {when.max():.6g} s; the path runs from {self.times[0]:.6g} to "
                f"{self.times[-1]:.6g} s"
            )
        return self.chart.motions(*(self._curve(when, order) for order in range(3)))

    def grid(self, samples: int) -> Array:
        """Give at least `samples` times over the path, evenly within each piece, with every waypoint among them."""
        whole(samples, "samples")
        share = np.diff(self.times) / self.duration
        counts = np.maximum(2, np.ceil(share * samples)).astype(int)
        pieces = zip(self.times[:-1], self.times[1:], counts, strict=True)
        return np.concatenate([*(np.linspace(a, b, n, endpoint=False) for a, b, n in pieces), self.times[-1:]])

    def poses(self, samples: int) -> Pose:
        """Give at least `samples` poses of the path, with every waypoint among them: the path as a region."""
        return self(self.grid(samples)).pose

    def polynomials(self) -> tuple[Array, Array, Array]:
        """Give the pieces of the path as polynomials, for `flexapod.certify`.

        Returns
        -------
        pieces : ndarray, shape (n, 6, k + 1)
            Coefficients of position (m) and rotation vector (rad) by the time (s) since the piece's beginning, lowest
            power first.
        middle : ndarray, shape (3, 3)
            The orientation that the rotation vector turns, about the base's axes.
        spans : ndarray, shape (n, 3)
            Number of the piece, and the least and largest time since its beginning, s.
        """
        pieces, length = self._curve.polynomials()
        spans = np.stack([np.arange(len(length), dtype=np.float64), np.zeros(len(length)), length], axis=1)
        return pieces, self.chart.middle, spans

    def length(self, characteristic_length: float = 1.0) -> float:
        """Integrate the speed, m; one radian of rotation counts as `characteristic_length`, m."""
        radius = positive(characteristic_length, "characteristic_length", "m")
        nodes, weights = np.polynomial.legendre.leggauss(12)
        a, b = self.times[:-1, None], self.times[1:, None]
        motion = self(((a + b) + (b - a) * nodes) / 2)
        speed, turning = (np.linalg.norm(v, axis=-1) for v in (motion.velocity, motion.angular_velocity))
        return float((np.hypot(speed, radius * turning) * weights * (b - a) / 2).sum())

    def retimed(self, duration: float) -> Trajectory:
        """Give the same curve in space, run in another time, s."""
        factor = positive(duration, "duration", "s") / self.duration
        run = copy(self)
        run.times = _lasting(self.times[0] + (self.times - self.times[0]) * factor)
        run._curve = self._curve.retimed(factor)
        return run

    def between(self, pose: PoseLike, lead: float) -> Trajectory:
        """Give the path with a rest pose before and after it, joined smoothly.

        Parameters
        ----------
        pose : Pose or array_like
            Where it begins and ends, at rest, in the base frame, such as `home_pose(hexapod)`.
        lead : float
            Time from there to the first waypoint, and from the last one back, s.

        Returns
        -------
        Trajectory
            From the first waypoint to the last exactly this path, and before and after it a quintic each, which takes
            over position, velocity and acceleration of its end. So a path with ends at rest stops at its first and its
            last waypoint, and a free or periodic one is joined in motion.

        Raises
        ------
        PoseError
            If `pose` is not one pose.
        PathError
            If `pose` is turned too far from the path's orientations, or `lead` is no time beside the path's.
        ArgumentError
            If `lead` is not > 0.

        Notes
        -----
        A path that is fast at its ends makes a long quintic swing out, by up to some 0.2 of its speed times `lead`.

        Examples
        --------
        >>> inner = fx.Trajectory([[0, 0, 1.0, 0, 0, 0], [0.1, 0, 1.1, 0, 0, 0.2]], times=[0.0, 2.0])
        >>> whole = inner.between([0, 0, 0.9, 0, 0, 0], 1.5)
        >>> whole.start, whole.duration, bool((whole(0.7).pose.position == inner(0.7).pose.position).all())
        (-1.5, 5.0, True)
        """
        rest = _single(pose, "pose")
        self.chart.check(rest, "pose is turned by")
        wanted = positive(lead, "lead", "s")
        own, joined = self.waypoints, copy(self)
        joined.waypoints = Pose(
            np.concatenate([rest.position[None], own.position, rest.position[None]]),
            np.concatenate([rest.matrix[None], own.matrix, rest.matrix[None]]),
        )
        times = np.concatenate([[self.times[0] - wanted], self.times, [self.times[-1] + wanted]])
        joined.times = _lasting(times)
        joined.weights = np.concatenate([self.weights[:1], self.weights, self.weights[-1:]])
        joined.ends, joined.joined = "rest", self.ends
        joined._curve = self._curve.between(self.chart.coordinates(rest), wanted)
        return joined

    def __repr__(self) -> str:
        return f"<Trajectory of {len(self.times)} waypoints, {self.duration:.6g} s, ends {self.ends}>"


def _single(value: PoseLike, name: str) -> Pose:
    pose = as_pose(value, name)
    if pose.shape:
        raise PoseError(f"{name} has batch axes {pose.shape}; a path has one {name}. Index it first.")
    return pose


def _times(value: ArrayLike, count: int) -> Array:
    times = _lasting(numbers(value, "times", (count,)))
    gaps = np.diff(times)
    if gaps.min() < _LEAST_GAP * gaps.mean():
        i = int(gaps.argmin())
        raise PathError(
            f"times[{i + 1}] is {gaps[i]:.3g} s after times[{i}], where the mean is {gaps.mean():.3g} s; that is too "
            "soon for a smooth path. Leave one of the two out."
        )
    return times


def _lasting(times: Array) -> Array:
    """Times as they are, which increase and make a path of a sensible duration."""
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        i = int(late[0])
        raise PathError(f"times[{i + 1}] is {times[i + 1]:.6g} s, after {times[i]:.6g} s; times must increase.")
    duration = times[-1] - times[0]
    if not _SHORTEST <= duration <= _LONGEST:
        raise PathError(
            f"the path lasts {duration:.3g} s; it must last at least {_SHORTEST:g} s and at most {_LONGEST:g} s. Give "
            "other times, or leg speeds that lead to them."
        )
    return times


def _weights(value: ArrayLike | None, count: int) -> Array:
    if value is None:
        return np.ones(count)
    weights = numbers(value, "weights", (count,))
    if weights.min() < 0 or not weights.max() > 0:
        raise ArgumentError(f"weights is {weights.tolist()}; weights must be >= 0, and one of them > 0.")
    return weights
