"""Quantities at many poses, as an xarray Dataset."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import thread_count
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.mechanics.inputs import is_universal
from flexapod.pose import Pose
from flexapod.workspace.pose_sets import GridPoses, PoseSet, pose_set
from flexapod.workspace.quantities import (
    DEFAULT,
    QUANTITIES,
    attributes,
    chosen,
    evaluate,
    provenance,
    statuses,
)

if TYPE_CHECKING:
    import xarray as xr


def sweep(
    hexapod: Hexapod,
    poses: PoseSet | Pose | ArrayLike,
    quantities: Iterable[str] = DEFAULT,
    joint: JointModel = "universal",
    threads: int | None = None,
) -> xr.Dataset:
    """Quantities at every pose of a set, as a Dataset in SI units with a status for each pose.

    poses: `random_poses`, `low_discrepancy`, `pose_grid`, `pose_path`, a batch `Pose`, or rows (..., 6) of x, y, z (m),
    roll, pitch, yaw (rad). quantities: of `omega_1`, `omega`, `cond_H`, `leg_length`, `universal_angle`,
    `spherical_angle`, `leg_distance`, `leg_force`, `lowest_stiffness`, `within_limits`. threads: default all cores; the
    numbers do not depend on it. A pose that cannot be computed is NaN, with the reason in `status` (flag_values,
    flag_meanings); a singular one has omega_1 zero to rounding. The pose coordinates of an array are views of it, not
    copies. The axes of a grid are dimensions. Frequencies are in rad/s.

    Raises: PoseError for wrong or empty sets, an unknown quantity, or when no pose is finite.
    Source: Section 3, for any set of poses.
    """
    wanted = chosen(quantities)
    is_universal(joint)
    points = pose_set(poses)
    rows = points.rows(0, points.count)
    found = evaluate(hexapod, rows, wanted, joint, thread_count(threads))
    status = found["status"]
    if status[0] == _not_finite() and (status == status[0]).all():
        raise PoseError(f"all {points.count} poses hold NaN or infinity; at least one must be finite.")
    return dataset(points, rows, found, provenance(hexapod, joint))


def _not_finite() -> int:
    return next(code for code, word in statuses().items() if word == "not_finite")


def dataset(points: PoseSet, rows: Array, found: dict[str, Any], attrs: dict[str, Any]) -> xr.Dataset:
    """Results in the order of the poses, as a Dataset with units."""
    import xarray as xr

    coords = coordinates(points, rows)
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


def coordinates(points: PoseSet, rows: Array) -> dict[str, Any]:
    """The six pose coordinates as xarray takes them: axes of a grid, or one value a pose."""
    if isinstance(points, GridPoses):
        axes = {name: (name if name in points.dims else (), points.axes[name]) for name in AXES}
        return {name: (dims, axis if dims else axis[0], attributes(name)) for name, (dims, axis) in axes.items()}
    if rows.shape[1] == 12:
        from flexapod.pose import Pose

        pose = Pose(np.nan_to_num(rows[:, :3]), rows[:, 3:].reshape(-1, 3, 3))
        rows = np.concatenate([rows[:, :3], pose.rpy], axis=1)
    return {name: (points.dims, rows[:, k].reshape(points.shape), attributes(name)) for k, name in enumerate(AXES)}
