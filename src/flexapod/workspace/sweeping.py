"""Quantities at many poses, as an xarray Dataset."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.checks import thread_count
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.inputs import as_joint
from flexapod.workspace.pose_sets import GridPoses, PoseSet
from flexapod.workspace.quantities import (
    QUANTITIES,
    PoseNumbers,
    attributes,
    chosen,
    evaluate,
    memory,
    provenance,
    statuses,
)
from flexapod.workspace.region import RegionLike, poses_of

if TYPE_CHECKING:
    import xarray as xr


def sweep(
    hexapod: Hexapod,
    region: RegionLike = None,
    *,
    quantities: str | Iterable[str] | None = None,
    samples: int = 2**14,
    seed: int = 0,
    joint: JointModel = "universal",
    threads: int | None = None,
) -> xr.Dataset:
    """Compute quantities at every pose of a region.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    region : PoseSet, Pose, Box, Workspace, Trajectory or array_like, optional
        The poses: a set made by `random_poses`, `low_discrepancy`, `pose_grid` or `pose_path`; a Pose, one or many;
        rows (..., 6) of x, y, z (m), roll, pitch, yaw (rad); or a Box, a Workspace or a Trajectory, of which `samples`
        poses are taken. All are in the base frame, except a Workspace that is measured from the home pose. Default:
        the home pose.
    quantities : str or iterable of str, optional
        Which of ``omega_1``, ``omega``, ``cond_H``, ``leg_length``, ``universal_angle``, ``spherical_angle``,
        ``universal_moment``, ``spherical_moment``, ``leg_distance``, ``leg_force``, ``lowest_stiffness``,
        ``within_limits``. Default: ``omega_1`` and ``cond_H``,
        and ``within_limits`` of a design that has limits.
    samples : int, optional
        Number of poses of a Box or a Workspace (a Sobol sequence), and least number along a Trajectory.
    seed : int, optional
        Seed of the sequence's scrambling.
    joint : {"universal", "spin_free"}, optional
        Joint model.
    threads : int, optional
        Number of threads, default one for each core. The results do not depend on it.

    Returns
    -------
    xarray.Dataset
        In SI units, over the axes of the set of poses (a grid has an axis for each coordinate that varies):

        - omega_1 (rad/s): lowest natural frequency, the dynamic stability index
        - omega (rad/s), along mode: natural frequencies
        - cond_H (1): condition number of the force transformation H
        - leg_length (m), universal_angle, spherical_angle (rad), along leg: joint angles from neutral
        - universal_moment, spherical_moment (N m), along leg: bending moments of springs in the joints
        - leg_distance (m): least distance between two leg axes
        - leg_force (N): largest static leg force under gravity
        - lowest_stiffness (N/m): lowest stiffness against displacement of the reference point
        - within_limits: whether legs and joints are within the design's limits
        - status: whether a pose could be computed, and if not why (flag_values, flag_meanings)
        - coordinates x, y, z (m), roll, pitch, yaw (rad)

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If a quantity, the joint model, or a number is invalid.
    PoseError
        If the poses have the wrong shape, there is none, or all hold NaN or infinity.

    See Also
    --------
    summarise : Extremes and quantiles of a sweep.
    worst_pose : The least index over all of a region.

    Notes
    -----
    Section 3 of [1]_, for any set of poses. A pose that cannot be computed is NaN, and so are the frequencies and
    stiffnesses of one outside the design's stiffness law; at a singular one omega_1 is zero to rounding. The
    coordinates of poses given as an array are views of it, not copies.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration 307 (2007), 495-512.

    Examples
    --------
    >>> found = fx.sweep(fx.load("motion-base"), fx.Workspace.about_home(0.2, 0.1), samples=1024)
    >>> round(float(found.omega_1.min()), 1), round(float(found.cond_H.max()), 2)
    (27.6, 3.68)
    """
    points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities, hexapod)
    as_joint(joint)
    _check_memory(points.count, wanted)
    poses = points.numbers()
    turned = () if isinstance(poses, np.ndarray) and poses.shape[1] == 6 else ("rpy",)
    found = evaluate(hexapod, poses, (*wanted, *turned), joint, thread_count(threads))
    status = found["status"]
    if status[0] == _not_finite() and (status == status[0]).all():
        raise PoseError(f"all {points.count} poses hold NaN or infinity; at least one must be finite.")
    return dataset(points, _columns(poses, found.pop("rpy", None)), found, provenance(hexapod, joint))


def _check_memory(count: int, quantities: tuple[str, ...]) -> None:
    """Raises ArgumentError where the results are larger than the computer's memory, before any is asked for."""
    try:
        there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError):  # not on Windows
        return
    needed = memory(count, quantities)
    if needed > there:
        raise ArgumentError(
            f"{count} poses take {needed // 2**30} GiB, and this computer has {there // 2**30} GiB of memory. Take "
            "fewer, or stream them to the disk with flexapod.workspace.SweepStore, on the "
            "command line --out NAME.zarr."
        )


def _not_finite() -> int:
    return next(code for code, word in statuses().items() if word == "not_finite")


def _columns(poses: PoseNumbers, rpy: Array | None) -> list[Array]:
    """The six coordinates, (n,) each; rpy: roll, pitch, yaw of poses that have other numbers."""
    position = poses if isinstance(poses, np.ndarray) else poses[0]
    angles = position[:, 3:] if rpy is None else rpy
    return [*position[:, :3].T, *angles.T]


def dataset(points: PoseSet, columns: list[Array], found: dict[str, Any], attrs: dict[str, Any]) -> xr.Dataset:
    """Results in the order of the poses, as a Dataset with units."""
    import xarray as xr

    coords = coordinates(points, columns)
    variables = {}
    for name, values in found.items():
        trailing = QUANTITIES[name].trailing if name in QUANTITIES else ""
        shape = points.shape + values.shape[1:]
        variables[name] = (
            (*points.dims, trailing) if trailing else points.dims,
            values.reshape(shape),
            attributes(name),
        )
        if trailing:
            coords[trailing] = (trailing, np.arange(1, 7))
    attrs = {**attrs, "poses": json.dumps(points.describe())}
    if points.box is not None:
        attrs |= {"box_volume": points.box.volume, "box_volume_unit": points.box.volume_unit}
    return xr.Dataset(variables, coords, attrs)


def coordinates(points: PoseSet, columns: list[Array]) -> dict[str, Any]:
    """The six pose coordinates as xarray takes them: axes of a grid, or one value a pose of each of six columns."""
    if isinstance(points, GridPoses):
        axes = {name: (name if name in points.dims else (), points.axes[name]) for name in AXES}
        return {name: (dims, axis if dims else axis[0], attributes(name)) for name, (dims, axis) in axes.items()}
    return {
        name: (points.dims, column.reshape(points.shape), attributes(name))
        for name, column in zip(AXES, columns, strict=True)
    }
