"""How fast actuators are, and the time that a motion takes with them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexapod.checks import positive
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import Limits
from flexapod.errors import ArgumentError
from flexapod.mechanics.kinematics import leg_rates
from flexapod.pose import Motion
from flexapod.showing import in_notebooks


@in_notebooks
@dataclass(frozen=True)
class LegSpeed:
    """What the actuators can do: a path timed with it takes the least time that they allow.

    Parameters
    ----------
    rate : float, optional
        Largest leg rate, m/s; no bound by default.
    acceleration : float, optional
        Largest leg acceleration, m/s2; no bound by default.

    Raises
    ------
    ArgumentError
        If a bound is not > 0, or there is none.

    See Also
    --------
    plan_path : takes it as `timing`.

    Examples
    --------
    >>> fx.paths.LegSpeed(rate=0.5, acceleration=2.0)
    LegSpeed(rate=0.5, acceleration=2.0)
    """

    rate: float = np.inf
    acceleration: float = np.inf

    def __post_init__(self) -> None:
        for name, unit in (("rate", "m/s"), ("acceleration", "m/s2")):
            value = getattr(self, name)
            if not (isinstance(value, float) and value == np.inf):
                positive(value, f"{name} of the leg speed", unit)
        if not (np.isfinite(self.rate) or np.isfinite(self.acceleration)):
            raise ArgumentError("leg speed has no bound; give a rate (m/s), an acceleration (m/s2), or both.")

    def within(self, limits: Limits) -> LegSpeed:
        """The lesser of these speeds and those that a design allows."""
        allowed = (limits.leg_rate or np.inf, limits.leg_acceleration or np.inf)
        return LegSpeed(min(self.rate, allowed[0]), min(self.acceleration, allowed[1]))


def duration(hexapod: Hexapod, motions: Motion, speed: LegSpeed) -> float:
    """Least time, s, for a path given by motions that run through it in one second."""
    legs = leg_rates(hexapod, motions)
    by_rate = np.abs(legs.rate).max() / speed.rate
    return float(max(by_rate, np.sqrt(np.abs(legs.acceleration).max() / speed.acceleration)))
