"""How fast a controller has to sample: the paper's conclusion 3, at a pose, along a path, or over a box of poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize, minimize_scalar

from flexapod.checks import thread_count
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.modes import advised_sampling_time as rule
from flexapod.mechanics.modes import natural_modes
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.workspace.pose_sets import Box, low_discrepancy
from flexapod.workspace.quantities import evaluate

_POINTS = 2**14
_STARTS = 4


def sampling_time(
    source: Hexapod | float, where: Pose | Trajectory | Box | None = None, joint: JointModel = "universal"
) -> float:
    """Largest sensible sampling time of a controller, s: 2 pi/(20 omega_max).

    source: a highest natural frequency omega_max, rad/s; or a Hexapod, of which omega_max is found `where`: at a Pose
    (one or many), along a Trajectory, or over a Box of poses, refined between samples and from the best of a Sobol
    sweep.

    Raises: PoseError where no pose can be computed; ArgumentError for a frequency that is not > 0, or what is no place.
    Source: conclusion 3.
    """
    if not isinstance(source, Hexapod):
        if where is not None:
            raise ArgumentError(f"{source!r} is a frequency and takes no place; give a Hexapod with {where!r}")
        if not (np.isfinite(source) and source > 0):
            raise ArgumentError(f"omega_max is {source} rad/s; it must be finite and > 0")
        return rule(source)
    if isinstance(where, Trajectory):
        highest = _on_path(lambda poses: natural_modes(source, poses, joint=joint).omega[..., 5], where)
    elif isinstance(where, Box):
        highest = _in_box(source, where, joint)
    elif isinstance(where, Pose):
        values = natural_modes(source, where, joint=joint).omega[..., 5]
        highest = float(np.nanmax(values)) if np.isfinite(values).any() else np.nan
    else:
        raise ArgumentError(f"where is {type(where).__name__}; give a Pose, a Trajectory or a Box")
    if not np.isfinite(highest):
        raise PoseError("no leg can take any of these poses, so there is no highest frequency. Move them.")
    return rule(highest)


def _on_path(highest: Callable[[Pose], Array], path: Trajectory) -> float:
    times = path.grid(400)
    values = highest(path(times).pose)
    if not np.isfinite(values).any():
        return np.nan
    peak = int(np.nanargmax(values))
    span = (times[max(peak - 1, 0)], times[min(peak + 1, len(times) - 1)])
    refined = minimize_scalar(lambda t: -highest(path([t]).pose)[0], bounds=span, method="bounded")
    return float(max(values[peak], -refined.fun))


def _in_box(hexapod: Hexapod, box: Box, joint: JointModel) -> float:
    rows = low_discrepancy(box, _POINTS).rows(0, _POINTS)
    values = evaluate(hexapod, rows, ("omega",), joint, thread_count(None))["omega"][:, 5]
    if not np.isfinite(values).any():
        return np.nan
    free = box.high > box.low
    best = float(np.nanmax(values))

    def lower(u: Array, row: Array) -> float:
        trial = row.copy()
        trial[free] = u * (box.high - box.low)[free] + box.low[free]
        value = evaluate(hexapod, trial[None], ("omega",), joint, 1)["omega"][0, 5]
        return -float(value) if np.isfinite(value) else 0.0

    for i in np.argsort(-np.nan_to_num(values))[:_STARTS]:
        if free.any():
            start = ((rows[i] - box.low) / np.where(free, box.high - box.low, 1.0))[free]
            options = {"xatol": 1e-7, "fatol": 1e-9 * best, "maxfev": 800, "adaptive": True}
            bounds = [(0.0, 1.0)] * start.size
            end = minimize(lower, start, args=(rows[i],), method="Nelder-Mead", bounds=bounds, options=options)
            best = max(best, -float(end.fun))
    return best
