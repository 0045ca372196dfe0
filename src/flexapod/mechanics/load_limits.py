"""Whether forces, speeds, accelerations and power of the legs keep the design's limits."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.joint_limits import LimitedQuantity


def load_excess(
    hexapod: Hexapod, force: Array, rate: Array | None = None, acceleration: Array | None = None
) -> list[LimitedQuantity]:
    """Every quantity of the legs, (..., 6), that the design limits, with its bounds; forces > 0 are compression."""
    limits = hexapod.limits
    found = []
    if limits.leg_compression is not None or limits.leg_tension is not None:
        least = -np.inf if limits.leg_tension is None else -limits.leg_tension
        most = np.inf if limits.leg_compression is None else limits.leg_compression
        found.append(LimitedQuantity("force", "N", force, least, most))
    both = [("rate", "m/s", rate, limits.leg_rate), ("acceleration", "m/s2", acceleration, limits.leg_acceleration)]
    both.append(("power", "W", None if rate is None else force * rate, limits.leg_power))
    for name, unit, value, most_of_it in both:
        if value is not None and most_of_it is not None:
            found.append(LimitedQuantity(name, unit, np.abs(value), -np.inf, most_of_it))
    return found
