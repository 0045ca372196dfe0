"""The largest boxes of given shapes about home, all of whose poses keep the limits."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.workspace.box_minimum import pattern_minima
from flexapod.workspace.rays import trace
from flexapod.workspace.sobol import Sobol
from flexapod.workspace.travel_limits import TravelLimits

_MOST_POINTS = 512  # of a box, and of its faces; 2^(m + 3) of one with m free coordinates
_STARTS = 2  # of a search for each limit
_NEAR = 0.3  # of a margin's range in the box: where the least sample is above it, the limit is not met in between
_ROUNDS = 30
_PAST = 1e-9  # of a box's share, by which rays are followed past it
_SAME = 1e-12  # of the share, by which a round no longer lowers it


class Share(NamedTuple):
    """The share of a box that holds, the displacement (6,) that keeps it from being larger, and what stops it there."""

    share: float
    at: Array
    stops: tuple[str, ...]


class Boxes:
    """Boxes of displacements about home with m free coordinates each: which (b, m), and their ranges (b, m)."""

    def __init__(self, free: NDArray[np.intp], low: Array, high: Array) -> None:
        self.free, self.low, self.high = free, low, high

    def displaced(self, which: NDArray[np.intp], cube: Array) -> Array:
        """Displacements (n, 6) of points of the unit cube (n, m), each in its own box."""
        rows = np.zeros((len(cube), 6))
        spread = self.low[which] + cube * (self.high - self.low)[which]
        np.put_along_axis(rows, self.free[which], spread, axis=1)
        return rows

    def gauge(self, which: NDArray[np.intp], rows: Array) -> Array:
        """The share of its box on whose face a displacement is, (n,); infinite for none at all."""
        offset = np.take_along_axis(rows, self.free[which], axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            to_face = np.where(offset > 0, offset / self.high[which], offset / self.low[which])
        found = np.where(offset == 0, 0.0, to_face).max(axis=1)
        return np.where(found > 0, found, np.inf)

    def faces(self, which: NDArray[np.intp], cube: Array) -> Array:
        """Points of the unit cube, seen from home, on its faces."""
        rows = self.displaced(which, cube)
        offset = np.take_along_axis(rows / self.gauge(which, rows)[:, None], self.free[which], axis=1)
        width = (self.high - self.low)[which]
        return np.clip((offset - self.low[which]) / np.where(width > 0, width, 1.0), 0.0, 1.0)


def largest_shares(limits: TravelLimits, boxes: Boxes, seed: int = 0) -> list[Share]:
    """The largest share of each box within which all limits hold.

    Rays to the corners and to points of the faces give a first share. Then the least margin of each limit is sought
    inside the box of that share; a pose beyond a limit makes it smaller, until there is none.
    """
    count, m = boxes.free.shape
    if m == 0:
        return [Share(0.0, np.zeros(6), ())] * count
    corners = np.array(list(product((0.0, 1.0), repeat=m)))
    points = Sobol(m, seed, 32).points(0, min(2 ** (m + 3), _MOST_POINTS))
    inside = np.tile(np.concatenate([corners, points]), (count, 1))
    which = np.repeat(np.arange(count), len(corners) + len(points))
    faces = boxes.faces(which, inside)
    found = [Share(np.inf, np.zeros(6), ())] * count
    rows = boxes.displaced(which, faces)
    is_corner = np.tile(np.arange(len(inside) // count) < len(corners), count)
    for first in (is_corner, ~is_corner):  # most boxes end at corners; other rays are followed no farther
        _lower(limits, boxes, which[first], rows[first], found)
    found = [share if np.isfinite(share.share) else Share(0.0, np.zeros(6), ()) for share in found]  # of no width
    cube, which = np.concatenate([inside, faces]), np.concatenate([which, which])
    going = np.ones(count, dtype=bool)
    for _ in range(_ROUNDS):
        mine = going[which]
        shares = np.array([share.share for share in found])
        at, rows = _beyond(limits, boxes, which[mine], cube[mine], shares)
        _lower(limits, boxes, at, rows, found)
        going &= np.array([share.share for share in found]) < shares * (1 - _SAME)
        if not going.any():
            break
    return found


def _lower(limits: TravelLimits, boxes: Boxes, which: NDArray[np.intp], rows: Array, found: list[Share]) -> None:
    """Lower the shares of boxes to where rays through displacements (n, 6) in them meet a limit."""
    moved = rows.any(axis=1)
    which, rows = which[moved], rows[moved]
    gauge = boxes.gauge(which, rows)
    rays = trace(limits, rows, np.array([found[box].share for box in which]) / gauge * (1 + _PAST))
    shares = rays.reach * gauge
    for k in np.argsort(shares)[::-1]:
        if shares[k] < found[which[k]].share:
            found[which[k]] = Share(float(shares[k]), rays.reach[k] * rows[k], rays.stops[k])


def _beyond(
    limits: TravelLimits, boxes: Boxes, which: NDArray[np.intp], cube: Array, shares: Array
) -> tuple[NDArray[np.intp], Array]:
    """Displacements (k, 6) that exceed limits in shares of boxes, and the box of each: the worst of each limit."""

    def rows(box: NDArray[np.intp], points: Array) -> Array:
        return shares[box, None] * boxes.displaced(box, points)

    margins = limits.margins(rows(which, cube))
    starts: list[tuple[int, int]] = []
    for box in np.unique(which):
        own = np.flatnonzero(which == box)
        least, most = margins[own].min(axis=0), margins[own].max(axis=0)
        spread = np.subtract(most, least, out=np.zeros_like(most), where=np.isfinite(least))
        for column in np.flatnonzero(~(least > _NEAR * spread)):
            starts += [(int(k), int(column)) for k in own[np.argsort(margins[own, column])[:_STARTS]]]
    if not starts:
        return which[:0], np.zeros((0, 6))
    place, column = np.array(starts).T
    box = which[place]

    def margin(points: Array) -> Array:
        each = len(points) // len(box)
        found = limits.margins(rows(np.repeat(box, each), points))
        return np.nan_to_num(found[np.arange(len(points)), np.repeat(column, each)], nan=-np.inf)

    worst, at = pattern_minima(margin, cube[place])
    return box[worst < 0], rows(box, at)[worst < 0]
