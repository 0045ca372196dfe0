"""What it costs a path to begin and end at rest, where its waypoints are those of a motion that goes on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array, Unit, printed_unit
from flexapod.paths.trajectory import Trajectory

_FEWEST = 8  # waypoints: fewer are drawn by hand, for a motion that begins and ends
_TIMES = 2.0  # the acceleration, beyond which rest at the ends is hardly meant
_NOTHING = 1e-6  # m/s2 or rad/s2
_SAMPLES = 2000


class RestCost(NamedTuple):
    """Greatest acceleration of a path with rest at its ends, and of its waypoints with free ends, in a unit."""

    rest: float
    free: float
    unit: Unit


def rest_cost(path: Trajectory) -> RestCost | None:
    """What rest at both ends adds to a path's acceleration, or angular one; None where that is little, or no rest.

    Of a path that is joined to rest poses it is that of the path within.
    """
    ends, within = (path.ends, slice(None)) if path.joined is None else (path.joined, slice(1, -1))
    marks = path.times[within]
    if ends != "rest" or len(marks) < _FEWEST:
        return None
    free = Trajectory(path.waypoints[within], marks, ends="free")
    times = np.linspace(marks[0], marks[-1], _SAMPLES)
    rest, goes_on = path(times), free(times)
    found = [
        RestCost(_most(rest.acceleration), _most(goes_on.acceleration), "m/s^2"),
        RestCost(_most(rest.angular_acceleration), _most(goes_on.angular_acceleration), "rad/s^2"),
    ]
    costly = [cost for cost in found if cost.rest > max(_TIMES * cost.free, _NOTHING)]
    return max(costly, key=lambda cost: cost.rest / max(cost.free, _NOTHING), default=None)


def rest_words(path: Trajectory) -> str:
    """The same in words; "" where there is nothing to say."""
    cost = rest_cost(path)
    if cost is None:
        return ""
    unit = printed_unit(cost.unit)
    return (
        "The waypoints are those of a motion that goes on at their ends, and the path begins and ends at rest: its "
        f"greatest acceleration is {cost.rest:.3g} {unit}, and {cost.free:.3g} {unit} with free ends. If the motion is "
        "cut out of a longer one, let its ends be free or periodic."
    )


def _most(vectors: Array) -> float:
    return float(np.linalg.norm(vectors, axis=-1).max())
