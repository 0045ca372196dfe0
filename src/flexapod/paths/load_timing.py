"""Whether a path keeps the limits of forces, speeds, accelerations and power, and the time in which it does."""

from __future__ import annotations

from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.kinematics import leg_rates
from flexapod.mechanics.load_limits import load_excess
from flexapod.paths.trajectory import Trajectory

_SAMPLES = 800
_SLOWEST = 2.0**20  # times the duration asked for: slower is at rest
_HALVINGS = 40


def exceeded(hexapod: Hexapod, path: Trajectory, joint: JointModel) -> list[str]:
    """What the legs exceed on the way, "rate" or "force", at many instants and at waypoints."""
    motion = path(path.grid(_SAMPLES))
    legs, force = leg_rates(hexapod, motion), inverse_dynamics(hexapod, motion, joint=joint)
    limited = load_excess(hexapod, force, legs.rate, legs.acceleration)
    return [quantity.name for quantity in limited if not quantity.kept.all()]


def least_duration(hexapod: Hexapod, path: Trajectory, joint: JointModel) -> float | None:
    """The shortest time, s, at least the path's own, in which it keeps these limits; None where no time is enough."""
    if not exceeded(hexapod, path, joint):
        return path.duration
    low = high = path.duration
    while exceeded(hexapod, path.retimed(high), joint):
        low, high = high, 2 * high
        if high > _SLOWEST * path.duration:
            return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if exceeded(hexapod, path.retimed(middle), joint):
            low = middle
        else:
            high = middle
        if high - low < 1e-9 * high:
            break
    return high
