"""What the legs do along a trajectory: forces, speeds and actuator power."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import LEGS, Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import ZERO
from flexapod.mechanics.joint_limits import check_limits
from flexapod.mechanics.kinematics import LegRates, leg_rates
from flexapod.mechanics.load_limits import load_excess
from flexapod.paths.analysis import check_arguments, singular_times
from flexapod.paths.trajectory import Trajectory


def path_loads(
    hexapod: Hexapod,
    path: Trajectory,
    *,
    samples: int = 400,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute leg forces, leg speeds and actuator power along a trajectory, under the full dynamics.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    path : Trajectory
        The motion of the platform.
    samples : int, optional
        Number of instants, at least 8.
    force, moment : array_like, optional
        Force (N) and moment (N m) on the platform at its reference point, in the platform's axes: (3,), or a row for
        each instant.
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.

    Returns
    -------
    xarray.Dataset
        Over `time` (s) and `leg`: leg_force (N, positive: compression), static_force (N, the same at rest), leg_length
        (m), leg_rate (m/s), leg_acceleration (m/s2), power (W) of each actuator; over `leg`: stroke (m), peak_force
        (N); over `time`: within_limits, of lengths, angles and distances, and loads_within_limits, of forces, speeds,
        accelerations and power.

    Raises
    ------
    SingularPoseError
        If no leg forces can drive the trajectory somewhere.
    ArgumentError
        If there are too few or too many samples, or `path` is not a Trajectory.

    See Also
    --------
    path_index : the dynamic stability index along a trajectory.

    Notes
    -----
    The leg forces solve Eq. 34 of [1]_ at every instant.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> path = fx.Trajectory([[0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0]], times=[0.0, 1.0])
    >>> fx.paths.path_loads(hexapod, path).peak_force.dims
    ('leg',)
    """
    check_arguments(hexapod, path, samples)
    times = path.grid(samples)
    motion = path(times)
    crossings = singular_times(hexapod, path, times)
    leg_force = inverse_dynamics(hexapod, motion, base=None, force=force, moment=moment, joint=joint)
    lost = [*crossings, *times[~np.isfinite(leg_force).all(axis=-1)]]
    if lost:
        raise SingularPoseError(
            f"no leg forces drive the path at t = {lost[0]:.6g} s, {path(lost[0]).pose!r}: H is singular there. "
            "Lead the path round it (plan_path, on "
            "the command line --from and --to)."
        )
    static = inverse_dynamics(hexapod, motion.pose, base=None, force=force, moment=moment, joint=joint)
    legs = leg_rates(hexapod, motion)
    grid = ("time", "leg")
    dataset = xr.Dataset(
        {
            "leg_force": (grid, leg_force, in_unit("N", "leg force")),
            "static_force": (grid, static, in_unit("N", "leg force at rest")),
            "leg_length": (grid, legs.length, in_unit("m", "leg length")),
            "leg_rate": (grid, legs.rate, in_unit("m/s", "leg rate")),
            "leg_acceleration": (grid, legs.acceleration, in_unit("m/s^2", "leg acceleration")),
            "power": (grid, leg_force * legs.rate, in_unit("W", "actuator power")),
            "stroke": ("leg", np.ptp(legs.length, axis=0), in_unit("m", "leg travel")),
            "peak_force": ("leg", np.abs(leg_force).max(axis=0), in_unit("N", "peak leg force")),
            "within_limits": ("time", check_limits(hexapod, motion.pose).ok),
            "loads_within_limits": ("time", _kept(hexapod, leg_force, legs)),
        },
        {"time": ("time", times, in_unit("s")), "leg": list(LEGS)},
    )
    return dataset.assign_attrs(design=hexapod.name, digest=hexapod.digest)


def _kept(hexapod: Hexapod, force: Array, legs: LegRates) -> np.ndarray:
    """Whether the legs keep the limits of loads at each instant, (n,)."""
    ok = np.ones(len(force), dtype=bool)
    for quantity in load_excess(hexapod, force, legs.rate, legs.acceleration):
        ok &= ((quantity.value >= quantity.least) & (quantity.value <= quantity.most)).all(axis=-1)
    return ok
