"""A sampled controller on the non-linear hexapod over a moving base, beside the linear prediction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import instance, not_negative, number
from flexapod.control.actuators_and_sensors import Hardware
from flexapod.control.closed_loop_poles import assess, instability_message
from flexapod.control.linear_controller import MEASUREMENTS, Controller, signals, static
from flexapod.control.losses import warn_of_losses
from flexapod.control.plant import Plant
from flexapod.control.point_recording import prediction_at, recording_at
from flexapod.control.sampled_prediction import Clock, Recording, predict
from flexapod.conventions import AXES, LEGS, Array, JointModel, in_mixed_units, in_unit, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, SimulationError, UnstableError, shown
from flexapod.excitation.excitation import Excitation
from flexapod.mechanics.inputs import ZERO, PointLike, as_point, point_attributes, single_base, single_pose
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import Motion, Pose, PoseLike
from flexapod.progress import ProgressLike, with_progress
from flexapod.simulation.batch import MOST_ASKED
from flexapod.simulation.integrator import prepare
from flexapod.simulation.run import SimulationRun

CASES = ("controlled", "passive")
_SIGNALS = 6 * len(MEASUREMENTS)
_TURN_A_STEP = 0.5  # rad of the fastest mode: the method of order 8 then errs by less than 1e-8 a step


IDEAL_HARDWARE = Hardware()


@with_progress("sampled simulation")
def simulate_control(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    controller: Controller,
    base_motion: Excitation,
    duration: float,
    hardware: Hardware = IDEAL_HARDWARE,
    after: float = 0.0,
    point: PointLike = ZERO,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
    progress: ProgressLike = None,
) -> xr.Dataset:
    """Simulate the non-linear hexapod on a moving base with a sampled controller and without control.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    controller : Controller
        A sampled controller (see ``Controller.sampled``), whose forces are held between samples.
    base_motion : Excitation
        Motion of the base from its pose at rest. At t = 0 the platform moves with it.
    duration : float
        Duration, s.
    hardware : Hardware, optional
        Force limits and sensor noise. None of either by default.
    after : float, optional
        Time, s, from which root mean squares are taken.
    point : array_like or str, optional
        Point of the platform whose motion is told, (3,) m, in its frame, or the name of a point of the design. The
        controller measures at the reference point all the same.
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
        Of the point, over (case, time, axis), with the cases "controlled" and "passive": ``acceleration``, absolute,
        m/s2 and rad/s2; ``displacement`` from rest in inertial axes, m and rad; ``relative``, the same seen from the
        base. Over (sample_time, leg): ``force``, N. Over (case, axis): ``rms_acceleration`` and ``rms_displacement``,
        and ``predicted_rms_acceleration`` and ``predicted_rms_displacement``, which the linearised hexapod has for the
        same base motion, sampling and noise, but without force limits. Attributes: ``saturated``, the share of samples
        at which a force was limited; ``steps`` of the integrator in each sample; ``dt_s``, the sampling time;
        ``point_m`` and ``point``, the place and name of the point.

    Raises
    ------
    ArgumentError
        If the controller is not sampled, or a time or another argument is invalid.
    UnstableError
        If the linearised loop is unstable.
    SimulationError
        If the platform passes a singular pose, or its motion grows without bound.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    Notes
    -----
    Both cases integrate the full equations of motion (Eq. 35) with the Runge-Kutta method of order 8 of Dormand and
    Prince at a fixed step.

    Loss factors of the design are left out, with a warning, for poles and motions in time have viscous friction only:
    `mechanics.viscous_equivalent` makes friction of them.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> controller = fx.control.VelocityFeedback(300.0).on(fx.linearise(hexapod)).sampled(2e-3)
    >>> base = fx.harmonic("z", 1e-6, 30.0)
    >>> found = fx.control.simulate_control(hexapod, controller=controller, base_motion=base, duration=2.0)
    >>> rms = found.rms_acceleration.sel(axis="z")
    >>> round(float(rms.sel(case="controlled") / rms.sel(case="passive")), 2)
    0.19
    """
    where, place = single_pose(hexapod, pose), as_point(hexapod, point)
    base = single_base(hexapod, base)
    plant = Plant(linearise(hexapod, where, base=base, force=force, moment=moment, joint=joint))
    warn_of_losses(hexapod)
    clock = _clock(plant, controller, duration, after)
    if not isinstance(base_motion, Excitation):
        raise ArgumentError(f"base_motion is {shown(base_motion)}; it must be an Excitation, such as fx.harmonic(...)")
    instance(hardware, Hardware, "hardware", "such as fx.control.Hardware(force_limit=100.0)")
    noise, limits = hardware.drawn(clock.samples), hardware.limits()
    run = SimulationRun(hexapod, where, base_motion=base_motion, force=force, moment=moment, base=base, start="carried")
    idle = static(np.zeros((6, 6)), ("leg_rate",), "no control")
    found, predicted = {}, {}
    still, moved = Motion.fixed(base).pose, base_motion.motion(clock.times, base)
    for number_, (case, law) in enumerate(zip(CASES, (controller, idle), strict=True)):
        report = _part(progress, 0.5 * number_, 0.5) if progress else None
        record = simulate_sampled(run, law, clock, joint, limits, noise=noise, progress=report)
        found[case] = recording_at(record, where, still, moved, place)
        predicted[case] = prediction_at(predict(plant, law, base_motion, clock, noise), where, place)
    return _dataset(where, clock, found, predicted, after).assign_attrs(
        **origin(hexapod),
        controller=controller.name,
        **point_attributes(hexapod, point),
        dt_s=clock.dt,
        steps=clock.steps,
        saturated=float(found["controlled"].limited.mean()),
    )


def _clock(plant: Plant, controller: Controller, duration: float, after: float) -> Clock:
    """The samples and steps of a run; raises an error for a controller that cannot be run."""
    if not isinstance(controller, Controller):
        raise ArgumentError(
            f"controller is {shown(controller)}; it must be a sampled Controller: law.on(linearisation).sampled(dt)"
        )
    dt = controller.dt
    if dt is None:
        raise ArgumentError(f"{controller.name} is continuous; sample it first: controller.sampled(dt)")
    number(duration, "duration", "s")
    not_negative(after, "after", "s")
    if not (duration > after and duration >= dt):
        raise ArgumentError(
            f"duration is {duration} s and after is {after} s; a sample of {dt:.5g} s must fit, and "
            "duration must be > after >= 0"
        )
    if duration > MOST_ASKED * dt:
        raise ArgumentError(
            f"duration is {duration:.6g} s, and a sample {dt:.5g} s; at most {MOST_ASKED} samples are simulated. "
            "Shorten it."
        )
    loop = assess(plant, controller)
    if not loop.stable:
        raise UnstableError(instability_message(loop, plant))
    return Clock(dt, round(duration / dt), max(1, int(np.ceil(dt * plant.omega_0 / _TURN_A_STEP))))


def _part(progress: Callable[[float], Any], first: float, share: float) -> Callable[[float], Any]:
    return lambda done: progress(first + share * done)


def simulate_sampled(
    run: SimulationRun,
    controller: Controller,
    clock: Clock,
    joint: JointModel,
    limits: Array,
    *,
    noise: Array,
    progress: Callable[[float], Any] | None = None,
) -> Recording:
    """The simulation in the core."""
    ready = prepare(run, clock.samples * clock.dt, joint)
    record = _core.control_loop(ready.setup, _wide(controller, limits), noise, clock.dt, clock.steps, progress)
    found = Recording(record.measured, record.displacement, record.force, record.cut)
    how = record.outcome.name
    if record.outcome != _core.Outcome.complete:
        end = float(clock.times[int(np.isfinite(found.displacement[:, 0]).sum()) - 1])
        raise SimulationError(
            f"the simulation of {controller.name} ended at t = {end:.6g} s: {how.replace('_', ' ')}. Shake the base "
            "less, or lower the gains.",
            time=end,
        )
    return found


def _wide(controller: Controller, limit: Array) -> _core.ControllerMatrices:
    """The controller as it is shown all measurements."""
    rows = signals(*controller.measures)
    B, D = np.zeros((controller.order, _SIGNALS)), np.zeros((6, _SIGNALS))
    B[:, rows], D[:, rows] = controller.B, controller.D
    A, C = np.ascontiguousarray(controller.A), np.ascontiguousarray(controller.C)
    return _core.ControllerMatrices(A=A, B=B, C=C, D=D, limit=limit)


def _dataset(
    pose: Pose, clock: Clock, found: dict[str, Recording], predicted: dict[str, Recording], after: float
) -> xr.Dataset:
    times = clock.times
    kept = times >= after
    parts = {
        "acceleration": (lambda f: f.measured[:, signals("acceleration")], "absolute acceleration"),
        "displacement": (lambda f: f.displacement, "displacement from rest"),
        "relative": (lambda f: f.measured[:, signals("position")], "displacement relative to the base"),
    }
    variables: dict[str, Any] = {}
    for name, (take, words) in parts.items():
        unit = "acceleration_unit" if name == "acceleration" else "displacement_unit"
        values = np.stack([take(found[case]) for case in CASES])
        variables[name] = (("case", "time", "axis"), values, in_mixed_units(unit, words))
        if name == "relative":
            continue
        about = in_mixed_units(unit, f"root mean square {words}")
        for prefix, source in (("", found), ("predicted_", predicted)):
            rms = np.stack([np.sqrt((take(source[case])[kept] ** 2).mean(axis=0)) for case in CASES])
            variables[f"{prefix}rms_{name}"] = (("case", "axis"), rms, about)
    variables["force"] = (
        ("sample_time", "leg"),
        found["controlled"].force,
        in_unit("N", "leg force of the controller"),
    )
    return xr.Dataset(
        variables,
        {
            "case": list(CASES),
            "time": ("time", times, in_unit("s")),
            "sample_time": ("sample_time", times[:: clock.steps][:-1], in_unit("s")),
            "axis": list(AXES),
            "leg": list(LEGS),
            "acceleration_unit": ("axis", [unit_of(axis, "m/s^2", "rad/s^2") for axis in AXES]),
            "displacement_unit": ("axis", [unit_of(axis) for axis in AXES]),
        },
        {"position_m": pose.position.tolist(), "rpy_rad": pose.rpy.tolist()},
    )
