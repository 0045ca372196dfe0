"""How far straight motions from home go before a limit stops them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.workspace.travel_limits import NO_LEG, TravelLimits, Ways

_LEAST_STEP = 1e-4  # of the mean leg length, by which joints move: shorter excursions beyond a limit are rounding
_NARROWINGS = 12
_AT = 1e-9  # of the mean leg length, by which joints move past an end: what is exceeded there stops the motion
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


def trace(limits: TravelLimits, rays: Array) -> Ends:
    """Follow rays (n, 6) from home to the first limit of each, by steps in which none can be exceeded.

    Steps are the margins over the greatest slopes that they can have. Near a limit they become small; there the end is
    found between the last pose that keeps all limits and the first that does not, on the side that keeps them.
    """
    most, ways = farthest(limits, rays), Ways.along(rays)
    with np.errstate(divide="ignore"):
        least = _LEAST_STEP * limits.leg / limits.joint_speed(ways).max(axis=1)
    kept, next_ = np.zeros(len(rays)), np.zeros(len(rays))
    beyond = np.full(len(rays), np.nan)  # where a limit is exceeded
    going = np.flatnonzero(rays.any(axis=1))  # a ray of no length stays at home
    while going.size:
        margins, free = limits.free(next_[going, None] * rays[going], ways[going])
        good = (margins >= 0).all(axis=1)
        beyond[going[~good]] = next_[going[~good]]
        going, free = going[good], free[good]
        kept[going] = next_[going]
        going, free = going[kept[going] < most[going]], free[kept[going] < most[going]]
        next_[going] = np.minimum(kept[going] + np.maximum(free, least[going]), most[going])
    return _narrowed(limits, rays, kept, beyond)


def _narrowed(limits: TravelLimits, rays: Array, kept: Array, beyond: Array) -> Ends:
    """Ends between the last displacement that keeps the limits and the first beyond them: by the Illinois method."""
    met = np.flatnonzero(np.isfinite(beyond))
    stops: list[tuple[str, ...]] = [()] * len(rays)
    if not met.size:
        return Ends(kept, stops)
    low, high, rays = kept[met], beyond[met], rays[met]

    ends = limits.margins(low[:, None] * rays), limits.margins(high[:, None] * rays)
    change = np.where(ends[1] < 0, ends[0] - ends[1], ends[0])  # margins are in the units of their limits
    unit = np.where(change > 0, change, 1.0)

    def least(at: Array) -> Array:
        return (limits.margins(at[:, None] * rays) / unit).min(axis=1)

    above, good = (ends[0] / unit).min(axis=1), np.zeros(len(met), dtype=int)
    below = _known((ends[1] / unit).min(axis=1), above)
    for _ in range(_NARROWINGS):
        share = np.where(above > below, above / (above - below), 0.5)
        middle = np.clip(low + share * (high - low), low, high)
        value = least(middle)
        keeps, value = value >= 0, _known(value, above)
        below = np.where(keeps, np.where(good == 1, below / 2, below), value)
        above = np.where(keeps, value, np.where(good == -1, above / 2, above))
        low, high = np.where(keeps, middle, low), np.where(keeps, high, middle)
        good = np.where(keeps, 1, -1)
    kept[met] = low
    near = _AT * limits.leg / limits.joint_speed(Ways.along(rays)).max(axis=1)
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
