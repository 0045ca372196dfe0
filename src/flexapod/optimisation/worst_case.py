"""The least index over the ranges of uncertain parameters, a function of the unit cube without a gradient."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flexapod.conventions import Array
from flexapod.workspace.box_minimum import apart, pattern_minima

Index = Callable[[Array], Array]  # points (k, p) of the unit cube to values (k,)
_EVERY_CORNER = 10  # parameters up to which all corners are computed
_CORNERS = (16, 64)  # fewest and most random corners from which ends of ranges are exchanged
_EFFORT = 2  # evaluations that they may take, in numbers of samples
_ROUNDS = 12  # of exchanges that one corner takes on the way, about
_STARTS = 16  # of pattern searches
_AGREE = 1e-6  # relative difference of indices that count as the same


@dataclass(frozen=True, eq=False)
class WorstCase:
    """The least index that was found, where in the cube, and how many of how many searches ended at it."""

    index: float
    at: Array
    searches: int
    agreed: int


def worst_case(index: Index, u: Array, values: Array, seed: int) -> WorstCase:
    """The least index over the cube, from samples u (n, p) with their values.

    The index is monotonic in stiffness and, mostly, in mass, so that the worst case is at a corner of the ranges, or
    near one. Corners are searched first, then the whole cube from the lowest corners and samples that are apart.
    """
    p = u.shape[1]
    lowest = np.argsort(values, kind="stable")
    if p <= _EVERY_CORNER:
        corners = np.array(np.meshgrid(*[[0.0, 1.0]] * p)).reshape(p, -1).T
        at_corners = index(corners)
        searched = np.zeros(0)
    else:
        count = int(np.clip(_EFFORT * len(u) // (_ROUNDS * p), *_CORNERS))
        chance = np.random.default_rng([seed, p]).integers(0, 2, (count, p)).astype(float)
        near = np.round(u[lowest[: count // 2]])
        corners, at_corners = _exchanged(index, np.concatenate([chance, near]))
        searched = at_corners
    corners, u = corners[np.argsort(at_corners, kind="stable")], u[lowest]
    starts = [corners[apart(corners, _STARTS // 4)], u[apart(u, _STARTS)]]
    ends, places = pattern_minima(index, np.concatenate(starts))
    best = int(np.argmin(ends))
    every = np.concatenate([ends, searched])
    agreed = int((every <= ends[best] + _AGREE * abs(ends[best])).sum())
    return WorstCase(float(ends[best]), places[best], len(every), agreed)


def _exchanged(index: Index, corners: Array) -> tuple[Array, Array]:
    """Corners (k, p), of which the end of one range after the other is exchanged as long as this lowers the index."""
    corner, value = corners.copy(), index(corners)
    p = corner.shape[1]
    live = np.arange(len(corner))
    while live.size:
        trial = np.repeat(corner[live][:, None], p, axis=1)
        trial[:, range(p), range(p)] = 1 - trial[:, range(p), range(p)]
        found = index(trial.reshape(-1, p)).reshape(-1, p)
        chosen = found.argmin(axis=1)
        least = found[np.arange(len(live)), chosen]
        better = least < value[live]
        corner[live[better]], value[live[better]] = trial[better, chosen[better]], least[better]
        live = live[better]
    return corner, value
