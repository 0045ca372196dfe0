"""The least value of a function over a box: which starts, and from these exactly, within constraints, or quickly.

Coordinates whose range is one number are held.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from flexapod.conventions import Array

_CANDIDATES = 2048  # lowest points among which starts are chosen
_APART, _CLOSEST = 0.15, 1e-6  # distance of two starts, in diagonals of the cube, and what is left of it at the least
_RESTARTS = 3
_CONSTRAINED_RESTARTS = 8
_INSIDE = 1e-9  # by which a search keeps within its constraints, so that rounding does not break them

Smooth = Callable[[Array], tuple[float, Array]]  # value and gradient
T = TypeVar("T")


class Remembered(Generic[T]):
    """A function of a point that keeps its last result: a search asks for value and derivative one after the other."""

    def __init__(self, function: Callable[[Array], T]) -> None:
        self.function = function
        self.point: Array | None = None

    def __call__(self, point: Array) -> T:
        if self.point is None or not np.array_equal(point, self.point):
            self.point, self.result = point.copy(), self.function(point)
        return self.result


def apart(points: Array, count: int) -> list[int]:
    """Starts: the first of some points (n, p) of the unit cube that lie apart from those before them.

    points: the lowest first. Where there are too few, they may be nearer to one another.
    """
    points = points[:_CANDIDATES]
    reach = _APART * np.sqrt(points.shape[1])
    chosen: list[int] = []
    away = np.full(len(points), np.inf)
    while len(chosen) < min(count, len(points)) and reach > _CLOSEST:
        left = np.flatnonzero(away > reach)
        if left.size:
            chosen.append(int(left[0]))
            away = np.minimum(away, np.linalg.norm(points - points[left[0]], axis=1))
        else:
            reach /= 2
    return chosen


class _FreeShares:
    """The free coordinates of a box as shares of their ranges, from 0 to 1."""

    def __init__(self, low: Array, high: Array) -> None:
        self.low, self.high, self.width = low, high, high - low
        self.free = high > low

    def of(self, point: Array) -> Array:
        return ((point - self.low) / np.where(self.free, self.width, 1.0))[self.free]

    def place(self, u: Array) -> Array:
        """The point at shares u, with both ends exact."""
        spread = np.zeros(len(self.low))
        spread[self.free] = u
        point = self.low.copy()
        point[self.free] = np.clip(self.low + spread * self.width, self.low, self.high)[self.free]
        point[spread >= 1.0] = self.high[spread >= 1.0]
        return point

    def slope(self, slope: Array) -> Array:
        """Derivatives by the shares, from those by the coordinates (..., n)."""
        return (slope * self.width)[..., self.free]

    def unit(self, value: float, slope: Array) -> float:
        """What values are measured in: this one, or its change over the box where it is nothing beside that."""
        changes = np.abs(self.slope(slope))
        change = changes[np.isfinite(changes)].max(initial=0.0)
        return float(abs(value) if abs(value) > 1e-12 * change else change) or 1.0


def smooth_minimum(function: Smooth, start: Array, low: Array, high: Array) -> Array:
    """Where a descent from `start` ends: L-BFGS-B on a smooth function that gives its value and gradient."""
    from scipy.optimize import minimize

    shares = _FreeShares(low, high)
    if not shares.free.any():
        return low
    unit = shares.unit(*function(start))

    def scaled(u: Array) -> tuple[float, Array]:
        value, slope = function(shares.place(u))
        return value / unit, shares.slope(slope) / unit

    u = shares.of(start)
    options = {"ftol": 0, "gtol": 1e-10, "maxiter": 500}
    for _ in range(_RESTARTS):  # anew where a ridge between two modes has spoilt the curvature it has learnt
        end = minimize(scaled, u, jac=True, method="L-BFGS-B", bounds=[(0.0, 1.0)] * len(u), options=options)
        still = np.abs(end.x - u).max() < 1e-9
        u = end.x
        if still:
            break
    return shares.place(u)


def constrained_minimum(
    function: Smooth, margins: Callable[[Array], tuple[Array, Array]], start: Array, low: Array, high: Array
) -> Array:
    """The same where `margins`, (m,) with gradients (m, n), must not be negative: by SLSQP, the lowest point it meets.

    start: a point that keeps them; nothing worse than it is returned.
    """
    from scipy.optimize import minimize

    shares, function, margins = _FreeShares(low, high), Remembered(function), Remembered(margins)
    best, least = start, function(start)[0]

    def scaled(u: Array) -> tuple[float, Array]:
        value, slope = function(shares.place(u))
        return value / unit, shares.slope(slope) / unit

    def kept(u: Array) -> Array:
        return margins(shares.place(u))[0] - _INSIDE

    def by_shares(u: Array) -> Array:
        return shares.slope(margins(shares.place(u))[1])

    def note(u: Array) -> None:
        nonlocal best, least
        point = shares.place(u)
        value = function(point)[0]
        if value < least and margins(point)[0].min(initial=0.0) >= 0:
            best, least = point, value

    constraint = {"type": "ineq", "fun": kept, "jac": by_shares}
    for _ in range(_CONSTRAINED_RESTARTS):  # each measures values anew, so that one that goes to zero gets there
        before, unit = least, shares.unit(*function(best))
        u = shares.of(best)
        end = minimize(
            scaled,
            u,
            jac=True,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * len(u),
            constraints=constraint,
            callback=note,
            options={"ftol": 1e-14, "maxiter": 200},
        )
        if np.isfinite(end.x).all():
            note(end.x)
        if least > before - 1e-10 * unit:
            break
    return best


def quick_minimum(
    function: Callable[[Array], tuple[Array, Array]], starts: Array, low: Array, high: Array, steps: int = 14
) -> float:
    """The lowest value of projected steps along gradients, from all starts (k, n) at once.

    function: points (k, n) to values (k,) and gradients (k, n). Good to a few parts in a thousand where
    `smooth_minimum` is exact: for comparing many functions, at one call a step.
    """
    width = high - low
    point = starts.copy()
    value, slope = function(point)
    reach = np.full(len(point), 0.05)  # of a step, in widths of the box
    for _ in range(steps):
        downhill = -slope * width
        size = np.linalg.norm(downhill, axis=1)
        step = downhill * width * (reach / np.where(size > 0, size, 1.0))[:, None]
        trial = np.clip(point + step, low, high)
        new, new_slope = function(trial)
        better = new < value
        point[better], value[better], slope[better] = trial[better], new[better], new_slope[better]
        reach = np.where(better, reach * 1.6, reach * 0.35)
    return float(value.min())


def pattern_minima(function: Callable[[Array], Array], starts: Array, steps: int = 60) -> tuple[Array, Array]:
    """Low values (k,) and their places of a function of the unit cube without a gradient, from starts (k, n) at once.

    A pattern search: each coordinate is moved both ways, and then all to their better sides. Steps are cut off at the
    faces of the cube, so that a minimum at a corner is reached exactly. function: points (m, n) to values (m,).
    """
    point = starts.copy()
    best = function(point)
    k, n = point.shape
    reach = np.full(k, 0.5)
    directions = np.concatenate([np.eye(n), -np.eye(n)])
    for _ in range(steps):
        trial = np.clip(point[:, None] + reach[:, None, None] * directions, 0.0, 1.0)
        found = function(trial.reshape(-1, n)).reshape(k, 2 * n)
        lower = np.minimum(found[:, :n], found[:, n:]) < best[:, None]
        side = np.where(found[:, :n] < found[:, n:], 1.0, -1.0) * lower
        together = np.clip(point + reach[:, None] * side, 0.0, 1.0)
        all_found = np.concatenate([found, function(together)[:, None]], axis=1)
        all_trial = np.concatenate([trial, together[:, None]], axis=1)
        chosen = np.argmin(all_found, axis=1)
        least = all_found[np.arange(k), chosen]
        better = least < best
        point[better], best[better] = all_trial[better, chosen[better]], least[better]
        reach = np.where(better, reach, reach / 2)
        if reach.max() < 1e-4:
            break
    return best, point
