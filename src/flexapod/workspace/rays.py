"""How far straight motions from home go before a limit stops them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.workspace.travel_limits import NO_LEG, TravelLimits, Ways

_LEAST_STEP = 1e-4  # of the mean leg length, by which joints move: shorter excursions beyond a limit are rounding
_NARROWINGS = 120  # at most
_EXACT = 1e-12  # of the mean leg length, by which joints move: an end is known as well, and lies as far inside
_AT = 1e-9  # of the mean leg length, by which joints move past an end: what is exceeded there stops the motion
_TOGETHER = 16  # of the longest steps, looked at together
_ROUNDING = 1e-12  # of a step
_FARTHEST = 4.0  # mean leg lengths that a motion is followed at most, and half a turn


class Ends(NamedTuple):
    """Where rays end: their lengths (n,), in their own units, and what stops each, in words; () if nothing does."""

    reach: Array
    stops: list[tuple[str, ...]]


def farthest(limits: TravelLimits, rays: Array) -> Array:
    """How far rays, rows (n, 6) of displacement, are followed at most (n,)."""
    ways = Ways.along(rays)
    with np.errstate(divide="ignore"):
        return np.minimum(_FARTHEST * limits.leg / ways.speed, np.pi / ways.turn)


def trace(limits: TravelLimits, rays: Array, most: Array | None = None) -> Ends:
    """Follow rays (n, 6) from home to the first limit of each, by steps in which none can be exceeded.

    Steps are the margins over the greatest slopes that they can have. Near a limit they become small; there the end is
    found between the last pose that keeps all limits and the first that does not, on the side that keeps them.
    most: how far (n,) rays are followed where that is nearer than `farthest`.
    """
    ways, far = Ways.along(rays), farthest(limits, rays)
    far = far if most is None else np.minimum(far, most)
    with np.errstate(divide="ignore"):
        least = _LEAST_STEP * limits.leg / limits.joint_speed(ways).max(axis=1)
    longest = limits.longest_step(ways)
    kept, next_, room = np.zeros(len(rays)), np.zeros(len(rays)), longest.copy()
    beyond = np.full(len(rays), np.nan)  # where a limit is exceeded
    going = np.flatnonzero(rays.any(axis=1))  # a ray of no length stays at home
    while going.size:
        places, looked = _ahead(next_[going], longest[going], far[going], room[going] >= longest[going])
        ray = going[np.nonzero(looked)[0]]
        margins, free = limits.free(places[looked][:, None] * rays[ray], ways[ray])
        good, safe = np.zeros(looked.shape, dtype=bool), np.zeros(looked.shape)
        good[looked], safe[looked] = (margins >= 0).all(axis=1), np.maximum(free, least[ray])
        count, wrong = _held(places, good, safe, looked)
        held, last = going[count > 0], (np.flatnonzero(count), count[count > 0] - 1)
        kept[held], room[held] = places[last], safe[last]
        beyond[going[wrong]] = places[wrong, count[wrong]]
        going = going[~wrong & (kept[going] < far[going])]
        next_[going] = np.minimum(kept[going] + room[going], far[going])
    return _narrowed(limits, rays, kept, beyond)


def _ahead(start: Array, step: Array, far: Array, clear: NDArray[np.bool_]) -> tuple[Array, NDArray[np.bool_]]:
    """Places (n, k) on rays to be looked at together, and which of them are: the first, and more where all is clear."""
    places = np.minimum(start[:, None] + step[:, None] * np.arange(_TOGETHER if clear.any() else 1), far[:, None])
    looked = np.zeros(places.shape, dtype=bool)
    looked[:, 0] = True
    looked[:, 1:] = clear[:, None] & (places[:, :-1] < far[:, None])
    return places, looked


def _held(
    places: Array, good: NDArray[np.bool_], safe: Array, looked: NDArray[np.bool_]
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """How many places of each ray (n,) hold, as far as each lies within the safe step from the one before.

    And whether the next of them, so reached, is beyond a limit.
    """
    near = np.diff(places, axis=1) <= safe[:, :-1] * (1 + _ROUNDING)
    reached = np.ones(places.shape, dtype=bool)
    reached[:, 1:] = np.logical_and.accumulate(good[:, :-1] & near & looked[:, 1:], axis=1)
    return np.count_nonzero(reached & good, axis=1), np.any(reached & ~good, axis=1)


def _narrowed(limits: TravelLimits, rays: Array, kept: Array, beyond: Array) -> Ends:
    """Ends between the last displacement that keeps the limits and the first beyond them.

    By the Illinois method, with every third step a halving: where a margin has a multiple zero, it alone is slow. No
    place is nearer to an end of its bracket than half of what is exact enough: beside a zero that is met to rounding,
    the other end would else stay where it is.
    """
    met = np.flatnonzero(np.isfinite(beyond))
    stops: list[tuple[str, ...]] = [()] * len(rays)
    if not met.size:
        return Ends(kept, stops)
    low, high, rays = kept[met], beyond[met], rays[met]

    ends = limits.margins(low[:, None] * rays), limits.margins(high[:, None] * rays)
    change = np.subtract(ends[0], ends[1], out=ends[0].copy(), where=ends[1] < 0)  # in the units of their limits
    unit = np.where((change > 0) & np.isfinite(change), change, 1.0)

    speed = limits.joint_speed(Ways.along(rays)).max(axis=1)
    above, good = (ends[0] / unit).min(axis=1), np.zeros(len(met), dtype=int)
    below = _known((ends[1] / unit).min(axis=1), above)
    for step in range(_NARROWINGS):
        i = np.flatnonzero((high - low) * speed > _EXACT * limits.leg)
        if not i.size:
            break
        share = np.where((above[i] > below[i]) & (step % 3 < 2), above[i] / (above[i] - below[i]), 0.5)
        least = 0.5 * _EXACT * limits.leg / speed[i]
        middle = np.clip(low[i] + share * (high[i] - low[i]), low[i] + least, high[i] - least)
        value = (limits.margins(middle[:, None] * rays[i]) / unit[i]).min(axis=1)
        keeps, value = value >= 0, _known(value, above[i])
        below[i] = np.where(keeps, np.where(good[i] == 1, below[i] / 2, below[i]), value)
        above[i] = np.where(keeps, value, np.where(good[i] == -1, above[i] / 2, above[i]))
        low[i], high[i] = np.where(keeps, middle, low[i]), np.where(keeps, high[i], middle)
        good[i] = np.where(keeps, 1, -1)
    kept[met] = np.maximum(low - _EXACT * limits.leg / speed, 0.0)
    near = _AT * limits.leg / speed
    past, far = (limits.margins(at[:, None] * rays) for at in (low + near, high))
    for place, near_by, farther in zip(met, past, far, strict=True):
        stops[place] = _words(limits, near_by, farther)
    return Ends(kept, stops)


def _known(value: Array, other: Array) -> Array:
    """A margin beyond a limit; where it cannot be computed, as large as that on the other side, for a halving."""
    return np.where(np.isfinite(value), value, -other)


def _words(limits: TravelLimits, past: Array, far: Array) -> tuple[str, ...]:
    """The limits that are exceeded just past an end, or else a little farther."""
    if np.isnan(far).all():
        return (NO_LEG,)
    met = ~(past >= 0)
    met = met if met.any() else ~(far >= 0)
    return tuple(name for name, here in zip(limits.names, met, strict=True) if here)
