"""The study of `flexapod control`."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import click
import numpy as np
import xarray as xr

from flexapod.cli.options import common
from flexapod.cli.options.control import Options
from flexapod.cli.output.stages import Report
from flexapod.control.active_damping import root_locus
from flexapod.control.controlled_response import controlled_transmissibility
from flexapod.control.controllers import PID, damping_law
from flexapod.control.gain_search import best_gain, default_gains
from flexapod.control.isolation import h_infinity, lqg
from flexapod.control.linear_controller import ControlLaw, Controller
from flexapod.control.plant import Plant
from flexapod.control.position_control import closed_loop, gain_map
from flexapod.control.sampled_simulation import Hardware, simulate_control
from flexapod.control.sampling_rate import sampling_time
from flexapod.conventions import TWO_PI
from flexapod.design.hexapod import Hexapod
from flexapod.excitation.excitation import Excitation
from flexapod.excitation.random_phases import random_motion
from flexapod.excitation.spectra import flat_spectrum
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.modes import natural_modes
from flexapod.pose import Pose
from flexapod.report.studies.control import ControlFindings, study
from flexapod.report.study import Study


@dataclass(frozen=True)
class _Made:
    """A law with what was looked at to choose it."""

    law: ControlLaw
    gains: xr.Dataset | None = None
    locus: xr.Dataset | None = None


def compute(options: Options, report: Report) -> Study:
    """The law of the options on their machine: its loop, with and without sampling, and its run."""
    hexapod, pose = common.machine(options.design, options.changes, options.pose)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the study says what the library warns of
        return study(hexapod, _find(hexapod, pose, options, report))


def _find(hexapod: Hexapod, pose: Pose, options: Options, report: Report) -> ControlFindings:
    report("design", 0.0)
    tangent = linearise(hexapod, pose, joint=options.joint)
    recommended = sampling_time(hexapod, pose, joint=options.joint)
    dt = options.dt or recommended
    made = _made(hexapod, pose, tangent, options, dt)
    report("design", 1.0)
    continuous = made.law.on(tangent)
    sampled = continuous.sampled(dt, delay=options.delay)
    ideal = closed_loop(hexapod, pose, continuous, joint=options.joint)
    real = closed_loop(hexapod, pose, sampled, joint=options.joint)
    omega = tangent.modes().omega
    top = min(30 * omega[-1], 0.98 * np.pi / dt)
    response = controlled_transmissibility(
        hexapod, pose, controller=sampled, omega=np.geomspace(0.03 * omega[0], top, 500), joint=options.joint
    )
    run = None if options.shake is None else _run(hexapod, pose, sampled, options, report)
    return ControlFindings(
        pose, ideal, real, recommended, response, made.gains, made.locus, run, options.axes.split(",")[0]
    )


def _made(hexapod: Hexapod, pose: Pose, tangent: Linearisation, options: Options, dt: float) -> _Made:
    if options.law == "pid":
        return _pid(hexapod, pose, options)
    if options.law in ("force", "velocity"):
        return _damping(hexapod, pose, tangent, options, dt)

    weights = {name: value for name, value in (("effort", options.effort), ("noise", options.noise)) if value}
    measure = tuple(options.measure.split(","))
    design: Any = lqg if options.law == "lqg" else h_infinity
    return _Made(design(hexapod, pose, measure=measure, joint=options.joint, **weights))


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
    return _Made(damping_law(kind, gain, leak), locus=root_locus(hexapod, pose, kind, leak=leak, joint=options.joint))


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
    return _Made(law, gains=gains)


def _run(hexapod: Hexapod, pose: Pose, controller: Controller, options: Options, report: Report) -> xr.Dataset:
    omega = natural_modes(hexapod, pose, joint=options.joint).omega
    low, high = (0.2 * omega[0], 2.0 * omega[-1]) if options.band is None else (TWO_PI * hz for hz in options.band)
    spectrum = flat_spectrum(options.shake, float(low), float(high))  # type: ignore[arg-type]
    base = Excitation()
    for number, axis in enumerate(options.axes.split(",")):
        base = base + random_motion(axis.strip(), spectrum, seed=options.seed + number)
    duration = options.duration or 60 * TWO_PI / float(omega[0])
    noise: dict[str, Any] = {str(controller.measures[0]): options.sensor_noise} if options.sensor_noise else {}
    hardware = Hardware(options.force_limit or float("inf"), noise, options.seed)
    return simulate_control(
        hexapod,
        pose,
        controller=controller,
        base_motion=base,
        duration=duration,
        hardware=hardware,
        progress=lambda share: report("run on the moving base", share),
        joint=options.joint,
    )
