"""A planned path, and a map of the index around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from flexapod.certificates.certificate import Certificate
from flexapod.checks import whole
from flexapod.conventions import in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, PathError, shown
from flexapod.mechanics.inputs import as_hexapod
from flexapod.paths.requirements import Margins, PathRequirements
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.showing import in_notebooks


@in_notebooks
@dataclass(frozen=True, eq=False)
class Plan:
    """A planned path, as `plan_path` gives it.

    Attributes
    ----------
    path : Trajectory
        The path, smooth and at rest at both ends.
    straight : Trajectory
        The straight line between the same poses, timed in the same way.
    rough : Pose or None
        Corners of the sampling planner's line; None where the straight line was good enough.
    requirements : PathRequirements
        What the path keeps.
    size : float
        RMS radius of the platform's joints, m: one radian counts as this length.
    length, straight_length : float
        Lengths of `path` and `straight`, m.
    least_index, straight_least_index : float
        Least index on `path` and on `straight`, rad/s.
    margin : float
        Least relative margin to any requirement on the path.
    batches : int
        Batches of samples that the search drew.
    certificate : Certificate or None
        Whether the bound on the index is proved all along the path, where that was asked for.

    See Also
    --------
    plan_slice : a map of the index around the path.

    Examples
    --------
    >>> plan = fx.plan_path(fx.load("mukherjee-i"), [0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0], 90.0)
    >>> round(plan.length, 3), plan.batches
    (0.1, 0)
    """

    path: Trajectory
    straight: Trajectory
    rough: Pose | None
    requirements: PathRequirements
    size: float
    length: float
    straight_length: float
    least_index: float
    straight_least_index: float
    margin: float
    batches: int
    certificate: Certificate | None = None


def plan_slice(hexapod: Hexapod, plan: Plan, *, samples: int = 81) -> xr.Dataset:
    """Compute the index on the plane through a plan's start, its goal and the farthest point of its path.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    plan : Plan
        A planned path that is not straight.
    samples : int, optional
        Number of points along each side.

    Returns
    -------
    xarray.Dataset
        Over `aside` and `along` (m, one radian counted as the plan's `size`): index (rad/s), and met, whether all
        requirements are. path_along and path_aside over `step`: the path projected on the plane. Attribute `straight`:
        where the goal lies on `along`.

    Raises
    ------
    PathError
        If the planned path is straight.
    ArgumentError
        If `plan` is not a Plan, or `samples` is less than 2.

    See Also
    --------
    plan_path : plans the path.

    Notes
    -----
    The farthest point is the one farthest from the straight line between start and goal, in position over `size` and
    rotation vector.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> plan = fx.plan_path(hexapod, [0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0], 90.0)
    >>> plan.rough is None  # it is straight, and spans no plane
    True
    """
    as_hexapod(hexapod)
    if not isinstance(plan, Plan):
        raise ArgumentError(f"plan is {shown(plan)}; it must be what flexapod.plan_path gives.")
    whole(samples, "samples", 2)
    scale = np.repeat([1.0, plan.size], 3)
    chart = plan.path.chart
    z = chart.coordinates(plan.path(plan.path.grid(400)).pose) * scale
    line = z[-1] - z[0]
    length = float(np.linalg.norm(line))
    along = (z - z[0]) @ (line / length)
    off = z - z[0] - along[:, None] * (line / length)
    far = int(np.linalg.norm(off, axis=1).argmax())
    reach = float(np.linalg.norm(off[far]))
    if reach < 1e-6 * length:
        raise PathError("the planned path is straight; it spans no plane to show.")
    basis = np.stack([line / length, off[far] / reach])
    place = (z - z[0]) @ basis.T
    room = 0.15 * max(length, reach)
    axes = [np.linspace(place[:, k].min() - room, place[:, k].max() + room, samples) for k in range(2)]
    axes[1] = np.linspace(min(axes[1][0], -0.6 * reach - room), axes[1][-1], samples)
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
    poses = chart.poses((z[0] + grid @ basis) / scale)
    margins = Margins(hexapod, plan.requirements)
    index = margins.frequencies(poses)[:, 0]
    return xr.Dataset(
        {
            "index": (("aside", "along"), index.reshape(samples, samples), in_unit("rad/s")),
            "met": (("aside", "along"), margins.met(poses).reshape(samples, samples)),
            "path_along": ("step", place[:, 0], in_unit("m")),
            "path_aside": ("step", place[:, 1], in_unit("m")),
        },
        {"along": ("along", axes[0], in_unit("m")), "aside": ("aside", axes[1], in_unit("m"))},
        {**origin(hexapod), "bound": plan.requirements.index, "straight": length},
    )
