"""Gain scheduling: the gain of a feedback at many poses."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import positive
from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.controllers import GAIN_UNIT, Feedback, damping_law
from flexapod.control.gain_search import ascending_gains, best_gain, default_gains
from flexapod.control.linear_controller import ControlLaw, controller_for
from flexapod.control.losses import warn_of_losses
from flexapod.control.plant import Plant, poles
from flexapod.conventions import Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, PoseError, SingularPoseError
from flexapod.mechanics.inputs import ZERO, as_hexapod, as_joint, single_base, wrench
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import Pose, PoseLike
from flexapod.progress import ProgressLike, with_progress
from flexapod.rotations import rpy_matrix
from flexapod.workspace.pose_sets import PoseSet, six_numbers
from flexapod.workspace.region import RegionLike, poses_of
from flexapod.workspace.sweeping import coordinates

Law = Callable[[float], ControlLaw]


@with_progress("gain schedule")
def gain_schedule(
    hexapod: Hexapod,
    region: RegionLike = None,
    feedback: Feedback | Law = "force",
    *,
    gains: ArrayLike | None = None,
    damping: float | None = None,
    leak: float = 0.0,
    samples: int = 64,
    seed: int = 0,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
    progress: ProgressLike = None,
) -> xr.Dataset:
    """Find the gain of a feedback at every pose of a region.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    region : PoseSet, Pose, array_like of shape (..., 6), Box, Workspace or Trajectory, optional
        The poses, such as ``pose_grid(x=..., yaw=...)``; numbers are x, y, z in m, roll, pitch, yaw in rad. The home
        pose by default.
    feedback : {"force", "velocity"} or callable, optional
        Integral force feedback (gain in rad/s), direct velocity feedback (gain in N s/m), or a function from a gain to
        a control law, such as ``lambda gain: fx.control.PID(kp=1e5, kd=gain)``.
    gains : array_like, shape (n,), optional
        Ascending gains > 0 to search, at least three; needed if `feedback` is a function.
    damping : float, optional
        Damping ratio between 0 and 1: the smallest gain is sought that gives it to every mode. By default the gain with
        the most damping is sought.
    leak : float, optional
        Leak of the force feedback, rad/s.
    samples : int, optional
        Number of poses taken from a box, a workspace or a trajectory.
    seed : int, optional
        Seed of the poses in a box.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.
    progress : callable or False, optional
        Called with the share done, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

    Returns
    -------
    xarray.Dataset
        Over the dimensions of the region: ``gain``; ``least_damping`` with it; ``fixed_damping``, with the median gain
        at all poses; and ``status``: "ok", "no_rest" (no leg forces hold the pose) or "no_gain" (no gain is stable, or
        gives the damping asked for). Other values are NaN where the status is not "ok". The attribute ``fixed_gain`` is
        the median gain. On a grid, ``found.gain.interp(x=..., yaw=...)`` interpolates between the poses.

    Raises
    ------
    ArgumentError
        If the gains do not ascend, the damping ratio is not between 0 and 1, or another argument is invalid.
    PoseError
        If the region or the base is not a pose, or the region is empty.

    Notes
    -----
    At each pose the damping of the linearised closed loop is evaluated over the gains and refined between them; active
    damping after A. Preumont, Vibration Control of Active Structures (2011).

    Loss factors of the design are left out, with a warning, for poles and motions in time have viscous friction only:
    `mechanics.viscous_equivalent` makes friction of them.

    Examples
    --------
    >>> poses = fx.pose_grid(z=[2.2, 2.6])
    >>> found = fx.control.gain_schedule(fx.load("motion-base"), poses, "velocity", damping=0.3)
    >>> found.least_damping.values.round(3)
    array([0.3, 0.3])
    """
    base = _checked(hexapod, base, force, moment, joint)
    warn_of_losses(hexapod)
    poses = poses_of(hexapod, region, samples, seed)
    if damping is not None and not positive(damping, "damping") < 1:
        raise ArgumentError(f"damping is {damping}; a damping ratio between 0 and 1 is needed")
    if callable(feedback) and gains is None:
        raise ArgumentError("a control law of your own needs `gains`, a row of gains to choose from")
    law = feedback if callable(feedback) else partial(damping_law, feedback, leak=leak)
    law(1.0)  # an unknown feedback or a wrong leak shows here
    given = None if gains is None else ascending_gains(gains, 3)
    rows = poses.rows(0, poses.count)
    matrix = rpy_matrix(rows[:, 3:]) if rows.shape[1] == 6 else rows[:, 3:].reshape(-1, 3, 3)
    plants: dict[int, Plant] = {}
    gain, achieved, with_fixed = np.full((3, len(rows)), np.nan)
    status = np.full(len(rows), "ok", "U8")
    for i in range(len(rows)):
        try:
            pose = Pose(rows[i, :3], matrix[i])
            plant = Plant(linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint))
        except (PoseError, SingularPoseError):  # all other arguments have been checked
            status[i] = "no_rest"
        else:
            plants[i] = plant
            row = default_gains(plant, feedback)[::8] if given is None else given  # type: ignore[arg-type]
            gain[i], achieved[i] = _choose(plant, law, row, damping)
            if not np.isfinite(gain[i]):
                status[i] = "no_gain"
        if progress:
            progress((i + 1) / len(rows))
    fixed = float(np.nanmedian(gain)) if np.isfinite(gain).any() else np.nan
    if np.isfinite(fixed):
        for i, plant in plants.items():
            with_fixed[i] = _damping(plant, law, fixed)
    dataset = _dataset(poses, rows, {"gain": gain, "least_damping": achieved, "fixed_damping": with_fixed}, status)
    if not callable(feedback):
        dataset.gain.attrs |= in_unit(GAIN_UNIT[feedback])
    return dataset.assign_attrs(
        **origin(hexapod),
        law="own" if callable(feedback) else feedback,
        leak_rad_s=leak,
        fixed_gain=fixed,
    )


def _checked(
    hexapod: Hexapod, base: PoseLike | None, force: ArrayLike, moment: ArrayLike, joint: JointModel
) -> Pose | None:
    """Raises an error for whatever is wrong at every pose, and would else be taken for a fault of the pose."""
    as_hexapod(hexapod)
    as_joint(joint)
    wrench(force, moment, ())
    return single_base(hexapod, base)


def _damping(plant: Plant, law: Law, gain: float) -> float:
    return least_damping(poles(plant, controller_for(plant.linear, law(gain))))


def _choose(plant: Plant, law: Law, gains: Array, damping: float | None) -> tuple[float, float]:
    """The gain at one pose and the least damping with it, or NaN twice."""
    if damping is None:
        gain, most = best_gain(plant, law, gains)
        return (gain, most) if most > 0 else (np.nan, np.nan)
    values = np.array([_damping(plant, law, g) for g in gains])
    reached = np.flatnonzero(values >= damping)
    if not reached.size:
        return np.nan, np.nan
    first = int(reached[0])
    if first == 0:
        return float(gains[0]), float(values[0])
    from scipy.optimize import brentq

    gain = brentq(lambda g: _damping(plant, law, g) - damping, gains[first - 1], gains[first])
    return float(gain), damping


def _dataset(poses: PoseSet, rows: Array, values: dict[str, Array], status: np.ndarray) -> xr.Dataset:
    about = {
        "gain": {"long_name": "gain"},  # of an own law: in its unit
        "least_damping": in_unit("1", "least damping ratio with it"),
        "fixed_damping": in_unit("1", "least damping ratio with one gain for all poses"),
    }
    variables: dict[str, Any] = {
        name: (poses.dims, values[name].reshape(poses.shape), attrs) for name, attrs in about.items()
    }
    variables["status"] = (poses.dims, status.reshape(poses.shape))
    return xr.Dataset(variables, coordinates(poses, list(six_numbers(rows).T)))
