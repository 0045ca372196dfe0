"""Whether forces, speeds, accelerations and power of the legs keep the design's limits."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import Limits
from flexapod.errors import SingularPoseError
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import pose_or_home
from flexapod.mechanics.limited import LimitedQuantity
from flexapod.pose import PoseLike


def motion_limits_words(limits: Limits) -> str:
    """What is said of limits that only a motion can exceed, where poses at rest are judged; "" without such limits."""
    if not limits.of_motions:
        return ""
    names = ", ".join(f"limits.{name}" for name in limits.of_motions)
    return (
        f"{names}: of a motion, and not judged at poses at rest. `flexapod path` and `flexapod envelope` judge "
        f"{'them' if len(limits.of_motions) > 1 else 'it'}."
    )


def force_bounds(limits: Limits) -> tuple[float, float] | None:
    """Least and greatest leg force, N, compression > 0; infinite where not limited, None where neither is."""
    if limits.leg_compression is None and limits.leg_tension is None:
        return None
    least = -np.inf if limits.leg_tension is None else -limits.leg_tension
    return least, np.inf if limits.leg_compression is None else limits.leg_compression


def static_force_excess(
    hexapod: Hexapod, pose: PoseLike | None, base: PoseLike | None = None, joint: JointModel = "universal"
) -> list[LimitedQuantity]:
    """The forces that hold poses at rest under the weight, where the design limits them; NaN where none do."""
    bounds = force_bounds(hexapod.limits)
    if bounds is None:
        return []
    try:
        force = inverse_dynamics(hexapod, pose_or_home(hexapod, pose), base=base, joint=joint)
    except SingularPoseError:
        force = np.full(6, np.nan)
    return [LimitedQuantity("force at rest", "N", force, *bounds)]


def load_excess(
    hexapod: Hexapod, force: Array, rate: Array | None = None, acceleration: Array | None = None
) -> list[LimitedQuantity]:
    """Every quantity of the legs, (..., 6), that the design limits, with its bounds; forces > 0 are compression."""
    limits = hexapod.limits
    found = []
    bounds = force_bounds(limits)
    if bounds is not None:
        found.append(LimitedQuantity("force", "N", force, *bounds))
    both = [("rate", "m/s", rate, limits.leg_rate), ("acceleration", "m/s2", acceleration, limits.leg_acceleration)]
    both.append(("power", "W", None if rate is None else force * rate, limits.leg_power))
    for name, unit, value, most_of_it in both:
        if value is not None and most_of_it is not None:
            found.append(LimitedQuantity(name, unit, np.abs(value), -np.inf, most_of_it))
    return found
