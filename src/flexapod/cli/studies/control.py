"""The study of `flexapod control`."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from inspect import signature
from typing import Any, NamedTuple

import click
import numpy as np
import xarray as xr

from flexapod.cli.options import common
from flexapod.cli.options.control import Options
from flexapod.cli.options.given import needed
from flexapod.cli.output.stages import Report
from flexapod.cli.studies.shaking import read_shaking
from flexapod.control.active_damping import root_locus
from flexapod.control.closed_loop_poles import loop_sampling_time
from flexapod.control.controlled_random import controlled_random_response
from flexapod.control.controlled_response import controlled_transmissibility
from flexapod.control.controllers import GAIN_UNIT, PID, damping_law, pid_units
from flexapod.control.gain_search import best_gain, default_gains
from flexapod.control.isolation import h_infinity, lqg
from flexapod.control.linear_controller import ControlLaw, Controller
from flexapod.control.losses import assumptions
from flexapod.control.plant import Plant
from flexapod.control.position_control import closed_loop, gain_map
from flexapod.control.sampled_simulation import Hardware, simulate_control
from flexapod.control.sampling_rate import sampling_time
from flexapod.conventions import ROTATIONS, TWO_PI, Array, printed_unit
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation
from flexapod.excitation.random_phases import random_motion
from flexapod.excitation.spectra import flat_spectrum
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.viscous_losses import viscous_equivalent
from flexapod.pose import Pose
from flexapod.report.studies.control import ControlFindings, Fact, RandomWithControl, study
from flexapod.report.study import Study
from flexapod.vibration.random_vibration import random_response

_MEASURED = {
    "acceleration": "acceleration of the platform",
    "leg_force": "force in each leg",
    "leg_length": "length of each leg",
    "leg_rate": "rate of each leg's length",
    "position": "position of the platform seen from the base",
    "velocity": "velocity of the platform seen from the base",
}
_COMMANDED = {"force": "forces in the legs", "command": "changes of leg length"}
_WEIGHTS = {
    "effort": "weight of leg forces",
    "stroke": "weight of displacement from the base",
    "depth": "weight of acceleration above the corner",
    "noise": "sensor noise expected, over the signal",
}


@dataclass(frozen=True)
class _Made:
    """A law with what was looked at to choose it."""

    law: ControlLaw
    facts: list[Fact]
    gains: xr.Dataset | None = None
    locus: xr.Dataset | None = None
    gain: float | None = None


#: Options -> the laws that they are of.
_OF_LAWS = {
    ("kp", "kd", "ki", "space", "actuator", "bandwidth"): ("pid",),
    ("gain",): ("force", "velocity"),
    ("leak",): ("force",),
    ("measure", "effort", "noise"): ("lqg", "h-infinity"),
}
_OF_RUNS = ("axes", "band", "duration", "force_limit", "sensor_noise", "seed")


def compute(options: Options, report: Report) -> Study:
    """The law of the options on their machine: its loop, with and without sampling, and its run."""
    for names, laws in _OF_LAWS.items():
        needed(options.law in laws, f"the law {' or '.join(laws)}, and the law is {options.law}", *names)
    needed(options.shake, "a run on a base that moves, which --shake asks for", *_OF_RUNS)
    hexapod, pose = common.machine(options.design, options.changes, options.pose)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the study says what the library warns of
        omega = options.loss_frequency
        machine = hexapod if omega is None else viscous_equivalent(hexapod, omega, pose, joint=options.joint)
        model = assumptions(hexapod, omega)
        return study(hexapod, _find(machine, pose, model, options, report))


def _find(hexapod: Hexapod, pose: Pose, model: str, options: Options, report: Report) -> ControlFindings:
    report("design", 0.0)
    tangent = linearise(hexapod, pose, joint=options.joint)
    machine_alone = sampling_time(hexapod, pose, joint=options.joint)
    made = _made(hexapod, pose, tangent, options, options.dt or machine_alone)
    report("design", 1.0)
    continuous = made.law.on(tangent)
    recommended = loop_sampling_time(Plant(tangent), continuous, machine_alone, options.delay)
    dt = options.dt or recommended
    sampled = continuous.sampled(dt, delay=options.delay)
    ideal = closed_loop(hexapod, pose, continuous, joint=options.joint)
    real = closed_loop(hexapod, pose, sampled, joint=options.joint)
    omega = tangent.modes().omega
    top = min(30 * omega[-1], 0.98 * np.pi / dt)
    response = controlled_transmissibility(
        hexapod,
        pose,
        controller=sampled,
        omega=np.geomspace(0.03 * omega[0], top, 500),
        point=options.point,
        joint=options.joint,
    )
    run, shaking = None, []
    if options.shake is not None:
        shaken = _shaken(natural_modes(hexapod, pose, joint=options.joint).omega, options)
        run, shaking = _run(hexapod, pose, sampled, shaken, options, report), _shaking(shaken, options)
    random, notes = _random(hexapod, pose, sampled, options)
    return ControlFindings(
        pose=pose,
        assumptions=model,
        ideal=ideal,
        sampled=real,
        recommended=recommended,
        response=response,
        gains=made.gains,
        locus=made.locus,
        run=run,
        random=random,
        notes=notes,
        axis=options.axes.split(",")[0].strip(),
        law=[Fact("measures", "measured", ", ".join(_MEASURED[name] for name in continuous.measures)), *made.facts],
        shaking=shaking,
        gain=made.gain,
    )


def _made(hexapod: Hexapod, pose: Pose, tangent: Linearisation, options: Options, dt: float) -> _Made:
    if options.law == "pid":
        return _pid(hexapod, pose, options)
    if options.law in ("force", "velocity"):
        return _damping(hexapod, pose, tangent, options, dt)

    weights = {name: value for name, value in (("effort", options.effort), ("noise", options.noise)) if value}
    measure = tuple(options.measure.split(","))
    design: Any = lqg if options.law == "lqg" else h_infinity
    used = {name: weights.get(name, p.default) for name, p in signature(design).parameters.items() if name in _WEIGHTS}
    facts = [Fact(name, _WEIGHTS[name], value) for name, value in used.items()]
    return _Made(design(hexapod, pose, measure=measure, joint=options.joint, **weights), facts)


def _damping(hexapod: Hexapod, pose: Pose, tangent: Linearisation, options: Options, dt: float) -> _Made:
    """A decentralised law; without a gain, that with the most damping when sampled."""
    kind: Any = options.law
    leak = options.leak
    if leak is None:
        leak = 0.1 * float(tangent.modes().omega[0]) if kind == "force" else 0.0
    gain = options.gain
    if gain is None:
        plant = Plant(tangent)
        gain, _ = best_gain(
            plant,
            lambda g: damping_law(kind, g, leak).on(tangent).sampled(dt, delay=options.delay),
            default_gains(plant, kind)[::5],
        )
    how = "gain" if options.gain is not None else "gain, that with the most damping when sampled"
    facts = [Fact("gain", how, gain, GAIN_UNIT[kind])]
    if kind == "force":
        facts.append(Fact("leak_rad_s", "leak", leak, "rad/s"))
    locus = root_locus(hexapod, pose, kind, leak=leak, joint=options.joint)
    return _Made(damping_law(kind, gain, leak), facts, locus=locus, gain=gain)


def _pid(hexapod: Hexapod, pose: Pose, options: Options) -> _Made:
    if options.kp is None or options.kd is None:
        raise click.UsageError("pid needs its gains. Give --kp and --kd.")
    law = PID(
        options.kp,
        options.kd,
        options.ki,
        options.space,  # type: ignore[arg-type]
        options.actuator,  # type: ignore[arg-type]
        options.bandwidth,
    )
    rows = [
        np.linspace(min(0.0, 2.5 * g), max(0.0, 2.5 * g), 41) if g else np.zeros(1) for g in (options.kp, options.kd)
    ]
    gains = (
        gain_map(hexapod, pose, kp=rows[0], kd=rows[1], controller=law, joint=options.joint)
        if all(r.size > 1 for r in rows)
        else None
    )
    return _Made(law, _pid_facts(law), gains=gains)


def _pid_facts(law: PID) -> list[Fact]:
    names = {"kp": "proportional gain", "kd": "derivative gain", "ki": "integral gain"}
    facts = [
        Fact(key, words, float(getattr(law, key)), "" if unit == "1" else printed_unit(unit))
        for (key, words), unit in zip(names.items(), pid_units(law), strict=True)
    ]
    facts += [Fact("space", "acts in", f"{law.space} space"), Fact("actuator", "commands", _COMMANDED[law.actuator])]
    if law.bandwidth is not None:
        facts.append(Fact("bandwidth_rad_s", "filter of the derivative", law.bandwidth, "rad/s"))
    return facts


def _random(
    hexapod: Hexapod, pose: Pose, controller: Controller, options: Options
) -> tuple[RandomWithControl | None, Sequence[str]]:
    """The random response with and without the controller, where spectra are given, and what to say of them."""
    shaking = read_shaking(options.psd, options.loads, options.at)
    if shaking is None:
        return None, ()
    given = {**shaking.given, "point": options.point, "joint": options.joint}
    controlled = controlled_random_response(hexapod, pose, controller=controller, **given)
    try:
        return RandomWithControl(controlled, random_response(hexapod, pose, **given)), shaking.notes
    except ArgumentError as error:  # it needs the controller: without it, it falls over or nothing damps it
        return RandomWithControl(controlled, None), [*shaking.notes, f"Without control: {error}"]


class _Shaken(NamedTuple):
    """The band of the base's acceleration, rad/s, its axes, and how long it lasts, s."""

    low: float
    high: float
    axes: list[str]
    duration: float


def _shaken(omega: Array, options: Options) -> _Shaken:
    low, high = (0.2 * omega[0], 2.0 * omega[-1]) if options.band is None else (TWO_PI * hz for hz in options.band)
    axes = [axis.strip() for axis in options.axes.split(",")]
    return _Shaken(float(low), float(high), axes, options.duration or 60 * TWO_PI / float(omega[0]))


def _shaking(shaken: _Shaken, options: Options) -> list[Fact]:
    """What the run was, in words and numbers."""
    turning = any(axis in ROTATIONS for axis in shaken.axes)
    found = [
        Fact("rms_acceleration", "RMS acceleration of each axis", options.shake or 0.0,
             "m/s\u00b2, rad/s\u00b2" if turning else "m/s\u00b2"),
        Fact("axes", "axes of the base", ", ".join(shaken.axes)),
        Fact("band_hz_from", "flat from", shaken.low / TWO_PI, "Hz"),
        Fact("band_hz_to", "to", shaken.high / TWO_PI, "Hz"),
        Fact("duration_s", "duration", shaken.duration, "s"),
        Fact("seed", "seed", options.seed),
    ]  # fmt: skip
    if options.force_limit:
        found.append(Fact("force_limit_N", "largest force of an actuator", options.force_limit, "N"))
    if options.sensor_noise:
        found.append(Fact("sensor_noise", "RMS noise of the measurement, in its unit", options.sensor_noise))
    return found


def _run(
    hexapod: Hexapod, pose: Pose, controller: Controller, shaken: _Shaken, options: Options, report: Report
) -> xr.Dataset:
    spectrum = flat_spectrum(options.shake, shaken.low, shaken.high)  # type: ignore[arg-type]
    base = Excitation()
    for number, axis in enumerate(shaken.axes):
        base = base + random_motion(axis, spectrum, seed=options.seed + number)
    noise: dict[str, Any] = {str(controller.measures[0]): options.sensor_noise} if options.sensor_noise else {}
    hardware = Hardware(options.force_limit or float("inf"), noise, options.seed)
    return simulate_control(
        hexapod,
        pose,
        controller=controller,
        base_motion=base,
        duration=shaken.duration,
        hardware=hardware,
        point=options.point,
        progress=lambda share: report("run on the moving base", share),
        joint=options.joint,
    )
