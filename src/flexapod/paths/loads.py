"""What legs and platform do along a trajectory: forces, speeds and actuator power, and the motion of a point."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from flexapod.conventions import LEGS, TRANSLATIONS, Array, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import SingularPoseError
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import ZERO, PointLike, as_point, point_attributes
from flexapod.mechanics.joint_limits import limit_excess
from flexapod.mechanics.joint_springs import joint_moments
from flexapod.mechanics.kinematics import leg_rates
from flexapod.mechanics.limited import LimitedQuantity
from flexapod.mechanics.load_limits import load_excess
from flexapod.mechanics.point_motion import at_point
from flexapod.paths.analysis import check_arguments, singular_times
from flexapod.paths.rest import rest_words
from flexapod.paths.trajectory import Trajectory
from flexapod.pose import Motion

EXTREMES = ("leg_force", "leg_rate", "power")  #: of which least, greatest and root mean square are told


def path_loads(
    hexapod: Hexapod,
    path: Trajectory,
    *,
    samples: int = 400,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
    point: PointLike = ZERO,
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
    point : array_like or str, optional
        Point of the platform whose motion is told, in its frame, m, (3,), or the name of a point of the design.

    Returns
    -------
    xarray.Dataset
        Over `time` (s) and `leg`:

        - leg_force (N, positive: compression), static_force (N, the same at rest), leg_length (m), leg_rate (m/s),
          leg_acceleration (m/s2), power (W) of each actuator, positive where it drives
        - position (m), velocity (m/s) and acceleration (m/s2) of the point, and angular_velocity (rad/s) and
          angular_acceleration (rad/s2) of the platform, over `time` and `axis`, in the base frame
        - universal_moment, bending_moment, torsion_moment (N m), where the joints have springs: of a base joint about
          both axes together, and of a platform joint across and about the leg

        Over `leg`: stroke (m), peak_force (N, without its sign), and the least and greatest value and the root mean
        square over the time of leg_force, leg_rate and power: least_force, greatest_force, rms_force, least_rate, and
        so on. Over `time`: within_limits, of lengths, angles, distances and moments, and loads_within_limits, of the
        forces, speeds, accelerations and power of this motion. The attribute ``caution`` tells where rest at the ends
        of the path multiplies its acceleration.

    Raises
    ------
    SingularPoseError
        If no leg forces can drive the trajectory somewhere.
    ArgumentError
        If there are too few or too many samples, or `path` is not a Trajectory.

    See Also
    --------
    payload_loads : the same with loads on the platform, side by side.
    path_index : the dynamic stability index along a trajectory.

    Notes
    -----
    The leg forces solve Eq. 34 of [1]_ at every instant. Means over the time are integrals by trapezoids over the
    samples.

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
    of_poses = limit_excess(hexapod, motion.pose, joint=joint, forces=False)
    of_loads = load_excess(hexapod, leg_force, legs.rate, legs.acceleration)
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
            "within_limits": ("time", _kept(of_poses, times.size)),
            "loads_within_limits": ("time", _kept(of_loads, times.size)),
        },
        {"time": ("time", times, in_unit("s")), "leg": list(LEGS), "axis": list(TRANSLATIONS)},
    )
    dataset = dataset.assign(_motion(motion, as_point(hexapod, point)) | _joint_moments(hexapod, motion, joint))
    told = {**origin(hexapod), **point_attributes(hexapod, point)}
    told["caution"] = rest_words(path)
    return dataset.assign(_extremes(dataset)).assign_attrs(told)


def _motion(motion: Motion, point: Array) -> dict[str, Any]:
    """Motion of a point of the platform, in the base frame."""
    told, grid = at_point(motion, point), ("time", "axis")
    return {
        "position": (grid, told.pose.position, in_unit("m", "position of the point")),
        "velocity": (grid, told.velocity, in_unit("m/s", "velocity of the point")),
        "acceleration": (grid, told.acceleration, in_unit("m/s^2", "acceleration of the point")),
        "angular_velocity": (grid, told.angular_velocity, in_unit("rad/s", "angular velocity")),
        "angular_acceleration": (grid, told.angular_acceleration, in_unit("rad/s^2", "angular acceleration")),
    }


def _extremes(loads: xr.Dataset) -> dict[str, xr.DataArray]:
    """The least and greatest value and the root mean square of force, rate and power of each leg."""
    found = {}
    for name in EXTREMES:
        values = loads[name]
        short = name.removeprefix("leg_")
        for word, reduced in {
            "least": values.min("time"),
            "greatest": values.max("time"),
            "rms": root_mean_square(values),
        }.items():
            words = f"{word} {values.attrs['long_name']}".replace("rms", "root mean square of")
            found[f"{word}_{short}"] = reduced.assign_attrs(values.attrs | {"long_name": words})
    return found


def root_mean_square(values: xr.DataArray) -> xr.DataArray:
    """Over the time, by trapezoids."""
    time = values.time.values
    return np.sqrt((values**2).integrate("time") / (time[-1] - time[0]))


def _joint_moments(hexapod: Hexapod, motion: Motion, joint: JointModel) -> dict[str, Any]:
    """Moments of the springs in the joints, where there are any."""
    if not hexapod.legs.joint_stiffness.any:
        return {}
    found = joint_moments(hexapod, motion.pose, joint=joint)
    grid = ("time", "leg")
    base = np.linalg.norm(found.universal_moment, axis=-1)
    return {
        "universal_moment": (grid, base, in_unit("N m", "moment of the base joint")),
        "bending_moment": (grid, found.bending_moment, in_unit("N m", "bending moment of the platform joint")),
        "torsion_moment": (grid, found.torsion_moment, in_unit("N m", "torsional moment of the platform joint")),
    }


def _kept(limited: Iterable[LimitedQuantity], count: int) -> NDArray[np.bool_]:
    """Whether quantities keep their limits at each of `count` instants."""
    ok = np.ones(count, dtype=bool)
    for quantity in limited:
        ok &= quantity.kept.reshape(count, -1).all(axis=1)
    return ok
