"""Gains that follow the pose: what a feedback's gain should be over the workspace."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Unpack

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.controllers import GAIN_UNIT, best_gain, default_gains, make
from flexapod.control.plant import Law, Plant, poles
from flexapod.conventions import AXES, Array, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError, SingularPoseError
from flexapod.mechanics.linearisation import RestOptions, linearise
from flexapod.pose import Pose, rpy_matrix
from flexapod.workspace.pose_sets import GridPoses, PoseSet
from flexapod.workspace.region import RegionLike, poses_of

STATUS = ("ok", "no_rest", "no_gain")
Rule = str | Callable[[float], Law]


def gain_schedule(
    hexapod: Hexapod,
    region: RegionLike = None,
    law: Rule = "force",
    *,
    samples: int = 64,
    seed: int = 0,
    gains: ArrayLike | None = None,
    damping: float | None = None,
    leak: float = 0.0,
    progress: Callable[[float], Any] | None = None,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """The gain of a feedback at every pose of a region, such as `pose_grid(x=..., yaw=...)`.

    region: poses, or a Box, Workspace or Trajectory, of which `samples` poses are taken (seed: of a box).
    law: "force" or "velocity" (decentralised damping, gain in rad/s or N s/m), or a function from a gain to a law, as
    `lambda g: PID(kp=1e5, kd=g)`; gains: ascending row to search, needed for a function. damping: the least gain that
    gives every mode this damping ratio; None: the gain with the most damping. leak: rad/s, of "force".

    Dataset over the set's axes: `gain`; `least_damping` with it; `fixed_damping`, with the one gain that suits the
    median pose; `status`: "ok", "no_rest" (no leg forces hold the pose), "no_gain" (none is stable, or gives the
    damping asked for); other values are NaN there. On a grid, `schedule.gain.interp(x=..., yaw=...)` reads it between
    poses. Attributes: fixed_gain.

    Raises: ArgumentError for gains that do not ascend or a damping ratio not between 0 and 1; PoseError for a wrong or
    empty set of poses.
    Source: own; A. Preumont (2011) for the laws.
    """
    points = poses_of(hexapod, region, samples, seed)
    if damping is not None and not 0 < damping < 1:
        raise ArgumentError(f"damping is {damping}; a damping ratio between 0 and 1 is needed")
    if callable(law) and gains is None:
        raise ArgumentError("a law of your own needs `gains`, a row of gains to choose from")
    rule = _Rule(law, None if gains is None else _ascending(gains), damping, leak)
    rows = points.rows(0, points.count)
    found = _search(hexapod, rows, rule, progress or (lambda share: None), rest)
    gain = found.gain
    fixed = float(np.nanmedian(gain)) if np.isfinite(gain).any() else np.nan
    dataset = _dataset(points, rows, found)
    if isinstance(law, str):
        dataset.gain.attrs["units"] = GAIN_UNIT[law]
    return dataset.assign_attrs(
        design=hexapod.name,
        digest=hexapod.digest,
        law=law if isinstance(law, str) else "own",
        leak_rad_s=leak,
        fixed_gain=fixed,
    )


class _Found(NamedTuple):
    gain: Array
    least_damping: Array
    fixed_damping: Array
    status: np.ndarray


def _search(hexapod: Hexapod, rows: Array, rule: _Rule, progress: Callable[[float], Any], rest: RestOptions) -> _Found:
    matrix = rpy_matrix(rows[:, 3:]) if rows.shape[1] == 6 else rows[:, 3:].reshape(-1, 3, 3)
    plants: dict[int, Plant] = {}
    gain, achieved, with_fixed = np.full((3, len(rows)), np.nan)
    status = np.full(len(rows), STATUS[0], "U8")
    for i in range(len(rows)):
        try:
            plants[i] = Plant(linearise(hexapod, Pose(rows[i, :3], matrix[i]), **rest))
        except (PoseError, SingularPoseError):
            status[i] = STATUS[1]
        else:
            gain[i], achieved[i] = rule.choose(plants[i])
            if not np.isfinite(gain[i]):
                status[i] = STATUS[2]
        progress((i + 1) / len(rows))
    if np.isfinite(gain).any():
        fixed = float(np.nanmedian(gain))
        for i, plant in plants.items():
            with_fixed[i] = rule.damping_with(plant, fixed)
    return _Found(gain, achieved, with_fixed, status)


class _Rule:
    """How the gain at one pose is chosen."""

    def __init__(self, law: Rule, gains: Array | None, damping: float | None, leak: float) -> None:
        self.law, self.gains, self.damping, self.leak = law, gains, damping, leak

    def law_of(self, gain: float) -> Law:
        return self.law(gain) if callable(self.law) else make(self.law, gain, self.leak)  # type: ignore[arg-type]

    def damping_with(self, plant: Plant, gain: float) -> float:
        return least_damping(poles(plant, self.law_of(gain).on(plant.linear)))

    def choose(self, plant: Plant) -> tuple[float, float]:
        """Gain and least damping, or NaN twice."""
        row = default_gains(plant, self.law)[::8] if self.gains is None else self.gains  # type: ignore[arg-type]
        if self.damping is None:
            gain, damping = best_gain(plant, self.law_of, row)
            return (gain, damping) if damping > 0 else (np.nan, np.nan)
        enough = self.damping
        values = np.array([self.damping_with(plant, g) for g in row])
        reached = np.flatnonzero(values >= enough)
        if not reached.size:
            return np.nan, np.nan
        first = int(reached[0])
        if first == 0:
            return float(row[0]), float(values[0])
        gain = brentq(lambda g: self.damping_with(plant, g) - enough, row[first - 1], row[first])
        return float(gain), enough


def _ascending(gains: ArrayLike) -> Array:
    row = np.asarray(gains, dtype=np.float64)
    if row.ndim != 1 or row.size < 3 or not np.isfinite(row).all() or not (row > 0).all() or (np.diff(row) <= 0).any():
        raise ArgumentError(f"gains has shape {row.shape}; give at least three ascending gains > 0")
    return row


def _dataset(points: PoseSet, rows: Array, found: _Found) -> xr.Dataset:
    words = {
        "gain": "gain",
        "least_damping": "least damping ratio with it",
        "fixed_damping": "least damping ratio with one gain for all poses",
    }
    variables: dict[str, Any] = {
        name: (points.dims, getattr(found, name).reshape(points.shape), {"long_name": text})
        for name, text in words.items()
    }
    variables["status"] = (points.dims, found.status.reshape(points.shape))
    coordinates: dict[str, Any] = {}
    if isinstance(points, GridPoses):
        for name in AXES:
            axis = points.axes[name]
            value = (name, axis) if name in points.dims else ((), axis[0])
            coordinates[name] = (*value, {"units": unit_of(name)})
    elif rows.shape[1] == 6:
        for k, name in enumerate(AXES):
            coordinates[name] = (points.dims, rows[:, k].reshape(points.shape), {"units": unit_of(name)})
    return xr.Dataset(variables, coordinates)
