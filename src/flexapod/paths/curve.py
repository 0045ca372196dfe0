"""Curves of six numbers over time: splines through given values, and several joined into one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from flexapod.checks import one_of
from flexapod.conventions import Array
from flexapod.errors import PathError

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

Ends = Literal["rest", "free", "periodic"]


class Curve:
    """Splines one after another, each from one of `times` (n + 1,) to the next; `curve(t)` is of shape (..., 6)."""

    def __init__(self, splines: Sequence[BSpline], times: Array) -> None:
        self.splines, self.times = tuple(splines), times
        self._derived = [self.splines, *([one.derivative(order) for one in splines] for order in (1, 2))]

    def __call__(self, t: Array, order: int = 0) -> Array:
        """The values at times t (...), or their first or second derivatives."""
        splines = self._derived[order]
        if len(splines) == 1:
            return np.asarray(splines[0](t))
        which = np.searchsorted(self.times[1:-1], t, side="right")
        found = np.empty((*np.shape(t), *splines[0].c.shape[1:]))
        for i, one in enumerate(splines):
            found[which == i] = one(t[which == i])
        return found

    def polynomials(self) -> tuple[Array, Array]:
        """Coefficients of each piece (n, 6, k + 1) by the time since it begins, lowest power first; its length (n,)."""
        most = max(one.k for one in self.splines)
        parts, lengths = [], []
        for one, first, last in zip(self.splines, self.times[:-1], self.times[1:], strict=True):
            knots = np.unique(np.clip(one.t, first, last))
            powers = [one(knots[:-1], nu=m) / math.factorial(m) for m in range(most + 1)]
            parts.append(np.stack(powers, axis=-1))
            lengths.append(np.diff(knots))
        return np.concatenate(parts), np.concatenate(lengths)

    def retimed(self, factor: float) -> Curve:
        """The same values, run through in `factor` times the time from the same beginning."""
        first = self.times[0]
        splines = [type(one)(first + (one.t - first) * factor, one.c, one.k, one.extrapolate) for one in self.splines]
        return Curve(splines, first + (self.times - first) * factor)

    def between(self, values: Array, lead: float) -> Curve:
        """This curve, from rest at `values` (6,) and back there, each by one quintic that takes the time `lead`."""
        first, last = self.times[[0, -1]]
        begin, end = ([(order, self(at, order)) for order in (1, 2)] for at in (first, last))
        still = _still(values.shape)
        there = _quintic([first - lead, first], [values, self(first)], still, begin)
        back = _quintic([last, last + lead], [self(last), values], end, still)
        return Curve([there, *self.splines, back], np.concatenate([[first - lead], self.times, [last + lead]]))


def spline(times: Array, values: Array, ends: Ends) -> BSpline:
    """The interpolating spline of (n, k) values. It is linear in the values."""
    from scipy.interpolate import make_interp_spline

    one_of(ends, "ends", get_args(Ends))
    still = _still(values.shape[1:])
    if ends == "rest":
        return _quintic(times, values, still, still)
    if ends == "free":
        return make_interp_spline(times, values, k=3, bc_type=(still[1:], still[1:]))
    return _periodic(times, values)


def _still(width: tuple[int, ...]) -> list[tuple[int, Array]]:
    return [(1, np.zeros(width)), (2, np.zeros(width))]


def _quintic(times: Any, values: Any, begin: list[tuple[int, Array]], end: list[tuple[int, Array]]) -> BSpline:
    """The quintic spline through values, with these derivatives at its ends."""
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(times, values, k=5, bc_type=(begin, end))


def _periodic(times: Array, values: Array) -> BSpline:
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
