"""How fast a controller has to sample: the paper's conclusion 3, at a pose, along a path, or over a box of poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize_scalar

from flexapod.checks import positive, thread_count
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.modes import advised_sampling_time as rule
from flexapod.mechanics.modes import natural_modes
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.workspace.box import Box
from flexapod.workspace.box_minimum import smooth_minimum
from flexapod.workspace.pose_sets import low_discrepancy
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.region import RegionLike, as_region, home_of
from flexapod.workspace.worst import SquaredFrequency

_POINTS = 2**14
_STARTS = 4


def sampling_time(
    source: Hexapod | float, region: Trajectory | RegionLike = None, *, joint: JointModel = "universal"
) -> float:
    """Largest sensible sampling time of a controller, s: 2 pi/(20 omega_max).

    source: a highest natural frequency omega_max, rad/s; or a Hexapod, of which omega_max is found in a region: at a
    Pose (one or many; default: home), along a Trajectory, or over a Box or Workspace, refined between samples and from
    the best of a Sobol sweep.

    Raises: PoseError where no pose can be computed; ArgumentError for a frequency that is not > 0.
    Source: conclusion 3.
    """
    if not isinstance(source, Hexapod):
        if region is not None:
            raise ArgumentError(f"{source!r} is a frequency and takes no region; give a Hexapod with {region!r}")
        return rule(positive(source, "omega_max", "rad/s"))
    if isinstance(region, Trajectory):
        highest = _on_path(lambda poses: natural_modes(source, poses, joint=joint).omega[..., 5], region)
    else:
        where = as_region(region)
        home = home_of(source, where)
        box = where.box(home)
        if box is None:
            poses = Pose.from_rpy(*where.rows(home, 0).T)
            values = natural_modes(source, poses, joint=joint).omega[..., 5]
            highest = float(np.nanmax(values)) if np.isfinite(values).any() else np.nan
        else:
            highest = _in_box(source, box, joint)
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
    values = np.nan_to_num(evaluate(hexapod, rows, ("omega",), joint, thread_count(None))["omega"][:, 5])
    if not values.any():
        return np.nan
    square = SquaredFrequency(hexapod, joint, mode=6)

    def lower(six: Array) -> tuple[float, Array]:
        value, slope = square(six)
        return -value, -slope

    starts = rows[np.argsort(-values)[:_STARTS]]
    ends = [smooth_minimum(lower, start, box.low, box.high) for start in starts]
    return float(max(values.max(), *(square.root(end) for end in ends)))
