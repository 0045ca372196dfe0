"""The shortest or quickest spline near a feasible polyline, by gradients."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.kinematics import leg_rates
from flexapod.paths.chart import Chart, turning
from flexapod.paths.curve import Curve, spline
from flexapod.paths.leg_speed import LegSpeed, duration
from flexapod.paths.requirements import Margins, smooth_minimum
from flexapod.workspace.box_minimum import Remembered

_STEP = 1e-6  # of central differences, in scaled coordinates: truncation and rounding both near 1e-10
_ROUGHNESS = 2e-3  # weight of the mean squared acceleration against length: fixes how fast the line is run


class Knots:
    """Splines through n waypoints at even times from 0 to 1, at rest at both ends; linear in the waypoints.

    Sampled at `count` times: value, rate, acceleration = B[0] P, B[1] P, B[2] P.
    """

    def __init__(self, waypoints: int, count: int) -> None:
        self.times = np.linspace(0.0, 1.0, waypoints)
        self.at = np.linspace(0.0, 1.0, count)
        curve = Curve([spline(self.times, np.eye(waypoints), "rest")], self.times[[0, -1]])
        self.B = np.stack([curve(self.at, order) for order in range(3)])


def resampled(points: Array, count: int) -> Array:
    """`count` points on a polyline, spaced as a body that starts and stops gently passes them at even times."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    t = np.linspace(0.0, 1.0, count)
    share = t**3 * (10 - 15 * t + 6 * t**2)
    return np.stack([np.interp(share * along[-1], along, column) for column in points.T], axis=1)


class Smoother:
    """Optimises the inner waypoints of a spline in scaled chart coordinates z: position / size, rotation vector."""

    def __init__(self, margins: Margins, chart: Chart, size: float, speed: LegSpeed | None) -> None:
        self.margins, self.chart, self.speed = margins, chart, speed
        self.scale = np.repeat([size, 1.0], 3)
        self.hexapod: Hexapod = margins.hexapod

    def run(
        self, start: Array, samples: int, margin: float, low: Array, high: Array, report: Callable[[], None]
    ) -> Array:
        """Waypoints (n, 6) from a first guess (n, 6), by SLSQP. The caller checks them: they may miss a bound."""
        from scipy.optimize import minimize

        knots = Knots(len(start), samples)
        ends = np.min(self.margins.smooth(self.chart.poses(start[[0, -1]] * self.scale)), axis=0)
        # A bound that an end just meets cannot be kept with a margin near it.
        room = np.minimum(margin, np.maximum(ends - 1e-6, -np.inf))
        inner = np.tile(np.stack([low, high], axis=1), (len(start) - 2, 1))
        timed = self.speed is not None
        x = start[1:-1].ravel()
        if timed:
            x = np.append(x, self._duration(knots, start))
            inner = np.vstack([inner, [[1e-6, np.inf]]])
        scale = x[-1] if timed else 1.0

        def waypoints(x: Array) -> Array:
            flat = x[:-1] if timed else x
            return np.vstack([start[:1], flat.reshape(-1, 6), start[-1:]])

        def cost(x: Array) -> tuple[float, Array]:
            length, slope = self._length(knots, waypoints(x))
            if not timed:
                return length, slope[1:-1].ravel()
            small = 1e-3  # of length: chooses among paths that take the same time
            return x[-1] / scale + small * length, np.append(small * slope[1:-1].ravel(), 1.0 / scale)

        def bounds(x: Array) -> tuple[Array, Array]:
            values, slopes = self._margins(knots, waypoints(x), room)
            if not timed:
                return values, slopes
            speed, speed_slope = self._speed_margins(knots, waypoints(x), x[-1])
            slopes = np.hstack([slopes, np.zeros((len(slopes), 1))])
            return np.concatenate([values, speed]), np.vstack([slopes, speed_slope])

        last = Remembered(bounds)
        result = minimize(
            cost,
            x,
            jac=True,
            method="SLSQP",
            bounds=inner,
            constraints={"type": "ineq", "fun": lambda x: last(x)[0], "jac": lambda x: last(x)[1]},
            options={"maxiter": 60, "ftol": 1e-5},
            callback=lambda _: report(),
        )
        return waypoints(result.x)

    def _length(self, knots: Knots, P: Array) -> tuple[float, Array]:
        """Length in scaled coordinates with a little roughness, and its derivative by the waypoints."""
        B = knots.B
        q, rate, acceleration = B[0] @ P, B[1] @ P, B[2] @ P
        weight = np.full(len(q), 1.0 / (len(q) - 1))
        weight[[0, -1]] *= 0.5

        def speed(q: Array, rate: Array) -> Array:
            turn = np.einsum("...ij,...j->...i", turning(q[..., 3:]), rate[..., 3:])
            return np.sqrt((rate[..., :3] ** 2).sum(-1) + (turn**2).sum(-1) + 1e-12)

        by_q, by_rate = _differences(speed, (q, rate))
        rough = _ROUGHNESS / max(float(np.linalg.norm(P[-1] - P[0])), 1e-3)
        value = weight @ (speed(q, rate) + rough * (acceleration**2).sum(-1))
        slope = B[0].T @ (weight[:, None] * by_q) + B[1].T @ (weight[:, None] * by_rate)
        return float(value), slope + B[2].T @ (2 * rough * weight[:, None] * acceleration)

    def _margins(self, knots: Knots, P: Array, room: Array) -> tuple[Array, Array]:
        q = (knots.B[0] @ P)[1:-1]

        def margin(q: Array) -> Array:
            shape = q.shape[:-1]
            return self.margins.smooth(self.chart.poses((q * self.scale).reshape(-1, 6))).reshape(*shape, -1)

        values = margin(q)
        (slopes,) = _differences(margin, (q,))  # (samples, kinds, 6)
        inner = knots.B[0][1:-1, 1:-1]
        chained = np.einsum("sw,skc->skwc", inner, slopes)
        return (values - room).ravel(), chained.reshape(values.size, -1)

    def _speed_margins(self, knots: Knots, P: Array, T: float) -> tuple[Array, Array]:
        """1 - |L'| / (rate T) and 1 - |L''| / (acceleration T^2), smooth minima over the legs, derivatives by P, T."""
        assert self.speed is not None
        bound = self.speed

        def margin(q: Array, rate: Array, acceleration: Array, duration: Array) -> Array:
            motion = self.chart.motions(q * self.scale, rate * self.scale, acceleration * self.scale)
            legs = leg_rates(self.hexapod, motion)
            T = duration[..., :1]
            parts = []
            for value, most in ((legs.rate / T, bound.rate), (legs.acceleration / T**2, bound.acceleration)):
                if np.isfinite(most):
                    parts.append(smooth_minimum(np.concatenate([1 - value / most, 1 + value / most], axis=-1)))
            return np.stack(parts, axis=-1)

        q, rate, acceleration = (B @ P for B in knots.B)
        durations = np.full((len(q), 1), T)
        values = margin(q, rate, acceleration, durations)
        slopes = _differences(margin, (q, rate, acceleration, durations))
        by_points = sum(
            np.einsum("sw,skc->skwc", B[:, 1:-1], slope) for B, slope in zip(knots.B, slopes[:3], strict=True)
        )
        flat = np.asarray(by_points).reshape(values.size, -1)
        return values.ravel(), np.hstack([flat, slopes[3].reshape(-1, 1)])

    def _duration(self, knots: Knots, P: Array) -> float:
        """Least time, s, in which the legs can follow the spline at the speeds they have."""
        assert self.speed is not None
        q, rate, acceleration = ((B @ P) * self.scale for B in knots.B)
        return duration(self.hexapod, self.chart.motions(q, rate, acceleration), self.speed)


def _differences(function: Callable[..., Array], arguments: tuple[Array, ...]) -> list[Array]:
    """Derivatives of f((n, k), ...) -> (n, ...) by every argument, appended as last axis; one batched call each."""
    found = []
    for which, argument in enumerate(arguments):
        steps = _STEP * np.eye(argument.shape[-1])
        moved = [argument[:, None, :] + side * steps for side in (1, -1)]
        pair = []
        for shifted in moved:
            spread = [np.broadcast_to(a[:, None, :], (*shifted.shape[:-1], a.shape[-1])) for a in arguments]
            spread[which] = shifted
            pair.append(function(*spread))
        found.append(np.moveaxis((pair[0] - pair[1]) / (2 * _STEP), 1, -1))
    return found
