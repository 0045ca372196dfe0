"""What the motors of the legs do along a trajectory: speed, torque and power behind screw and gear."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from flexapod.checks import instance, not_negative
from flexapod.conventions import LEGS, Array, Unit, in_unit
from flexapod.design.drive import Drive, Motor
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.springs import axial_stiffness

_GRID = ("time", "leg")
_NEEDED = ("leg_force", "leg_length", "leg_rate", "leg_acceleration")
_STILL = 1e-10  # of a leg's length in the time of the path: slower is rest, and rounding


def motor_loads(hexapod: Hexapod, dataset: xr.Dataset, *, hold: float = 0.0) -> xr.Dataset:
    """Compute speed, torque and power of the motors along a trajectory, and compare them with the motors' curve.

    Parameters
    ----------
    hexapod : Hexapod
        The design, with a `drive`.
    dataset : xarray.Dataset
        What `path_loads` or `payload_loads` gives for it, or for the same design without a drive.
    hold : float, optional
        Time at rest at the end of the path in every cycle, s, in which the motors hold the load.

    Returns
    -------
    xarray.Dataset
        With `case` before, where the dataset has it. Over `time` (s) and `leg`:

        - motor_speed (rad/s), motor_torque (N m), both positive where the leg gets longer
        - motor_power (W), positive where the motor drives; drive_loss (W), what friction in screw and gear takes

        Over `time`: total_power (W) of all six motors.
        Over `leg`: peak_speed and rms_speed (rad/s), peak_torque and rms_torque (N m), driving_energy and
        returned_energy (J) of a cycle, that the motor gives and gets back, reflected_mass (kg) of rotor, gear and screw
        along the leg, and yield_rate (m/s), the fastest that the leg's spring gives way under the changing force.
        With a motor's curve, over `leg` too: peak_factor, the least ratio of the peak torque at the speed to the
        torque, at peak_time (s), continuous_factor, of the continuous torque at rms_speed to rms_torque, and
        speed_factor, of max_speed (rad/s), the greatest allowed, to peak_speed. All must be at least 1; beyond the
        greatest speed peak_factor is 0. The curve is over `curve_speed` (rad/s): peak_curve, continuous_curve (N m).

    Raises
    ------
    ArgumentError
        If the design has no drive, the dataset is of another one, or the path does not end at rest where it is to hold.

    See Also
    --------
    path_loads : the forces, rates and accelerations of the legs.
    flexapod.design.Drive : screw, gear and motor.

    Notes
    -----
    The screw turns with the leg lengths of the path, as a controller commands them. Springs between screw and platform
    turn nothing: where they give way fast beside the leg rates (`yield_rate`), a platform that is kept on the path
    itself needs that speed as well. The inertia of what rotates is added here, and not in the leg forces, which have
    that of the legs' parts. Friction in screw and gear is in proportion to the load: it is divided by the efficiency
    where the motor drives, and multiplied by the efficiency backwards where the leg drives. At rest friction helps to
    hold, and a screw that locks itself needs no torque. Means are over the path and `hold`, integrals by trapezoids.
    Losses in the motor itself are in its continuous torque, and not in the powers.

    Examples
    --------
    >>> drive = {"lead_mm": 5, "efficiency": 0.9, "rotor_inertia_kg_cm2": 0.5}
    >>> hexapod = fx.load("mukherjee-i").replace({"drive": drive})
    >>> path = fx.Trajectory([[0, 0, 0.89, 0, 0, 0], [0.1, 0, 0.89, 0, 0, 0]], times=[0.0, 1.0])
    >>> found = fx.paths.motor_loads(hexapod, fx.paths.path_loads(hexapod, path), hold=2.0)
    >>> bool((found.rms_torque < found.peak_torque).all())
    True
    """
    drive = as_hexapod(hexapod).drive
    if drive is None:
        raise ArgumentError(f"{hexapod.name!r} has no drive. Add [drive] with lead and efficiency to the design.")
    hold = not_negative(hold, "hold", "s")
    _check_dataset(hexapod, dataset)
    if hold:
        _check_end(dataset)
    force, length, rate, acceleration = xr.broadcast(*(dataset[name] for name in _NEEDED))
    dims = force.dims
    still = _STILL * float(length.max()) / float(np.ptp(dataset.time.values))
    moved = np.where(np.abs(rate.values) > still, rate.values, 0.0)
    shaft = _shaft(drive, force.values, moved, acceleration.values)
    found = xr.Dataset(
        {
            "motor_speed": (dims, shaft.speed, in_unit("rad/s", "motor speed")),
            "motor_torque": (dims, shaft.torque, in_unit("N m", "motor torque")),
            "motor_power": (dims, shaft.torque * shaft.speed, in_unit("W", "motor power")),
            "drive_loss": (dims, shaft.loss, in_unit("W", "friction in screw and gear")),
            "reflected_mass": ("leg", drive.reflected_mass, in_unit("kg", "mass that rotating parts stand for")),
        },
        {name: dataset[name] for name in (*dims, *_GRID)},
    )
    found["total_power"] = found.motor_power.sum("leg").assign_attrs(in_unit("W", "power of all motors"))
    found["yield_rate"] = _yield_rate(hexapod, force, length)
    found = found.assign(_of_cycle(found, hold))
    if drive.motor is not None:
        found = found.assign(_beside_curve(found, drive.motor))
    return found.assign_attrs(**origin(hexapod), hold_s=hold)


class _Shaft(NamedTuple):
    """Of each motor's shaft: speed, rad/s, torque, N m, and the loss between it and the leg, W."""

    speed: Array
    torque: Array
    loss: Array


def _shaft(drive: Drive, force: Array, rate: Array, acceleration: Array) -> _Shaft:
    """From the legs (..., 6), through screw and gear, to the motors."""
    per_travel = drive.turning / drive.gear_ratio  # rad/m of the screw
    screw_speed, motor_speed = per_travel * rate, drive.turning * rate
    at_screw = _through(force / per_travel, screw_speed, drive.efficiency, drive.backwards)
    behind_gear = at_screw + drive.screw_inertia * per_travel * acceleration
    at_motor = _through(behind_gear, screw_speed, drive.gear_efficiency, drive.gear_efficiency) / drive.gear_ratio
    of_motor = (drive.rotor_inertia + drive.gear_inertia) * drive.turning * acceleration
    screw_loss = at_screw * screw_speed - force * rate
    gear_loss = at_motor * motor_speed - behind_gear * screw_speed
    return _Shaft(motor_speed, at_motor + of_motor, screw_loss + gear_loss)


def _through(torque: Array, speed: Array, forwards: Array, backwards: Array) -> Array:
    """The torque that a stage takes to give one: it drives, is driven, or stands, where friction helps it to hold."""
    driven = np.where(speed == 0, np.maximum(backwards, 0.0), backwards)
    return np.where(torque * speed > 0, torque / forwards, torque * driven)


def _yield_rate(hexapod: Hexapod, force: xr.DataArray, length: xr.DataArray) -> xr.DataArray:
    """The fastest change of what each leg's spring gives way under the force."""
    stiffness = axial_stiffness(hexapod, length.values)[0]
    yielded = force.copy(data=force.values / stiffness)
    rate: xr.DataArray = np.abs(yielded.differentiate("time"))  # type: ignore[assignment]
    return rate.max("time").assign_attrs(in_unit("m/s", "rate of the leg's spring"))


def _of_cycle(found: xr.Dataset, hold: float) -> dict[str, xr.DataArray]:
    """The largest, and means and energies over a cycle, of each motor."""
    time = found.time.values
    cycle = time[-1] - time[0] + hold
    speed, torque, power = found.motor_speed, found.motor_torque, found.motor_power

    def rms(values: xr.DataArray) -> xr.DataArray:
        return np.sqrt(((values**2).integrate("time") + hold * values.isel(time=-1, drop=True) ** 2) / cycle)

    words: dict[str, tuple[Any, Unit, str]] = {
        "peak_speed": (np.abs(speed).max("time"), "rad/s", "greatest speed"),
        "rms_speed": (rms(speed), "rad/s", "root mean square of speed"),
        "peak_torque": (np.abs(torque).max("time"), "N m", "greatest torque"),
        "rms_torque": (rms(torque), "N m", "root mean square of torque"),
        "driving_energy": (power.clip(min=0.0).integrate("time"), "J", "work of the motor where it drives"),
        "returned_energy": ((-power).clip(min=0.0).integrate("time"), "J", "work that the motor gets back"),
    }
    return {name: values.assign_attrs(in_unit(unit, text)) for name, (values, unit, text) in words.items()}


def _beside_curve(found: xr.Dataset, motor: Motor) -> dict[str, Any]:
    """What the motor's curve allows beside what is asked of it; infinite where nothing is asked."""
    fastest = xr.DataArray(motor.fastest, dims="leg")
    speed, torque = np.abs(found.motor_speed), np.abs(found.motor_torque)
    with np.errstate(divide="ignore", invalid="ignore"):
        peak = (found.motor_speed.copy(data=motor.peak(speed.values)) / torque).where(torque > 0, np.inf)
        peak = peak.where(speed <= fastest, 0.0)
        continuous = found.rms_speed.copy(data=motor.continuous(found.rms_speed.values)) / found.rms_torque
        factors: dict[str, tuple[xr.DataArray, Unit, str]] = {
            "peak_factor": (peak.min("time"), "1", "least ratio of peak torque to torque"),
            "peak_time": (peak.idxmin("time"), "s", "time of the least ratio of peak torque to torque"),
            "continuous_factor": (
                continuous.where(found.rms_torque > 0, np.inf),
                "1",
                "ratio of continuous torque to root mean square of torque",
            ),
            "speed_factor": (
                fastest / found.peak_speed,
                "1",
                "ratio of the greatest speed allowed to the greatest speed",
            ),
        }
    curve = {"curve_speed": ("curve_speed", motor.speeds, in_unit("rad/s", "speed of the curve"))}
    return {
        "max_speed": fastest.assign_attrs(in_unit("rad/s", "greatest speed allowed")),
        "peak_curve": xr.DataArray(motor.peak_torques, curve, "curve_speed", attrs=in_unit("N m", "peak torque")),
        "continuous_curve": xr.DataArray(
            motor.continuous_torques, curve, "curve_speed", attrs=in_unit("N m", "continuous torque")
        ),
        **{name: values.assign_attrs(in_unit(unit, text)) for name, (values, unit, text) in factors.items()},
    }


def _check_dataset(hexapod: Hexapod, dataset: xr.Dataset) -> None:
    """Raises ArgumentError for what is no result of `path_loads` of the design."""
    instance(dataset, xr.Dataset, "dataset", "as flexapod.paths.path_loads gives it")
    missing = [name for name in _NEEDED if name not in dataset]
    if missing or dataset.leg_force.dims[-2:] != _GRID or list(map(str, dataset.leg.values)) != list(LEGS):
        lacks = f"lacks {missing[0]}" if missing else "is not over time and six legs"
        raise ArgumentError(f"dataset {lacks}; it must be as flexapod.paths.path_loads or payload_loads gives it.")
    given = dataset.attrs.get("digest")
    if given not in (hexapod.digest, hexapod.replace({"drive": None}).digest):
        raise ArgumentError(
            f"dataset is of another design, {dataset.attrs.get('design')!r} with the digest {given}; {hexapod.name!r} "
            f"has {hexapod.digest}. Compute path_loads of this one."
        )


def _check_end(dataset: xr.Dataset) -> None:
    """Raises ArgumentError where the legs still move at the end of the path, and so cannot hold."""
    length, duration = float(dataset.leg_length.max()), float(np.ptp(dataset.time.values))
    speed = np.abs(dataset.leg_rate.isel(time=-1)).values.reshape(-1, 6).max(axis=0)
    acceleration = np.abs(dataset.leg_acceleration.isel(time=-1)).values.reshape(-1, 6).max(axis=0)
    moving = np.flatnonzero((speed > _STILL * length / duration) | (acceleration > 1e4 * _STILL * length / duration**2))
    if moving.size:
        i = int(moving[0])
        motion = f"leg {LEGS[i]} has {speed[i]:.3g} m/s and {acceleration[i]:.3g} m/s2"
        raise ArgumentError(
            f"hold is for a path that ends at rest; {motion} at its "
            ' end. Give the path ends="rest" (on the command line --ends rest), or no time to hold.'
        )
