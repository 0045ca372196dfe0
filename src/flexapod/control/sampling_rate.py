"""The sampling time that a controller needs: at poses, along a trajectory, or over a box of poses."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import positive, thread_count, whole
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.modes import advised_sampling_time, natural_modes
from flexapod.paths.analysis import dips
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Pose
from flexapod.workspace.descents import BoxSearch, SquaredFrequency, starts_of
from flexapod.workspace.limit_margins import margins_to_keep
from flexapod.workspace.region import RegionLike, as_region, home_of

_STARTS = 4


def sampling_time(
    hexapod: Hexapod | float,
    region: Trajectory | RegionLike = None,
    *,
    joint: JointModel = "universal",
    samples: int = 2**14,
    threads: int | None = None,
    all_poses: bool = False,
) -> float:
    """Compute the largest sensible sampling time of a controller.

    Parameters
    ----------
    hexapod : Hexapod or float
        The design, or its highest natural frequency in rad/s.
    region : Pose, array_like of shape (n, 6), Trajectory, Box, Workspace or PoseSet, optional
        Where the highest natural frequency is sought; numbers are x, y, z in m, roll, pitch, yaw in rad. The home pose
        by default.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.
    samples : int, optional
        Number of poses of a box that are sampled, before the highest are refined.
    threads : int, optional
        Number of threads. All cores by default.
    all_poses : bool, optional
        If True, poses of a box beyond the design's limits count as well. If False (default), they do not.

    Returns
    -------
    float
        Sampling time, s.

    Raises
    ------
    ArgumentError
        If the frequency is not positive, or the region or another argument is invalid.
    DesignError
        If `hexapod` is neither a Hexapod nor a number.
    PoseError
        If no pose of the region can be taken, or none of a box is within the limits.

    Notes
    -----
    The sampling time is 2 pi/(20 omega_max) after the paper's conclusion 3, with omega_max the highest natural
    frequency. Along a trajectory it is refined between samples; over a box, as by `flexapod.worst_pose`, from poses of
    a Sobol sequence that are high and lie apart, and from corners.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> print(f"{fx.control.sampling_time(hexapod):.3g}")
    0.00615
    """
    if isinstance(hexapod, float | int | np.number):
        if region is not None:
            raise ArgumentError(f"{hexapod!r} is a frequency and takes no region; give a Hexapod with {shown(region)}")
        return advised_sampling_time(positive(hexapod, "omega_max", "rad/s"))
    as_hexapod(hexapod)
    if isinstance(region, Trajectory):
        highest = _on_path(lambda poses: natural_modes(hexapod, poses, joint=joint).omega[..., 5], region)
    else:
        where = as_region(region)
        home = home_of(hexapod, where)
        box = where.box(home)
        if box is not None:
            search = BoxSearch(
                SquaredFrequency(hexapod, joint, mode=6, highest=True),
                box,
                margins_to_keep(hexapod, all_poses, joint),
                whole(samples, "samples"),
                seed=0,
                threads=thread_count(threads),
            )
            ends = [search.descend(start) for start in starts_of(search.sample(), box, _STARTS)]
            highest = max(search.index.root(end) for end in ends)
        else:
            values = natural_modes(hexapod, Pose.from_rpy(*where.rows(home, 0).T), joint=joint).omega[..., 5]
            highest = float(np.nanmax(values)) if np.isfinite(values).any() else np.nan
    if not np.isfinite(highest):
        raise PoseError("no leg can take any of these poses, so there is no highest frequency. Move them.")
    return advised_sampling_time(highest)


def _on_path(highest: Callable[[Pose], Array], path: Trajectory) -> float:
    """The highest frequency on a path, its maxima refined; infinite below zero where no leg can take a pose of it."""

    def lowered(times: ArrayLike) -> Array:
        found = highest(path(times).pose)
        return np.where(np.isnan(found), np.inf, -found)

    times = path.grid(400)
    values = lowered(times)
    return -min([float(values.min()), *(value for _, value in dips(lowered, times, values))])
