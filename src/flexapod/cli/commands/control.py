"""`flexapod control`: a control law on a machine at a pose: poles, gains, isolation, and a run on a moving base."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.control import Options, law_options, run_options
from flexapod.cli.output.stages import Report, stages

if TYPE_CHECKING:
    import xarray as xr

    from flexapod.control.linear_controller import ControlLaw, Controller
    from flexapod.design.hexapod import Hexapod
    from flexapod.mechanics.linearisation import Linearisation
    from flexapod.pose import Pose
    from flexapod.report.studies.control import ControlFindings


@click.command()
@common.machine_options
@law_options
@run_options
@common.json_option
def command(**given: Any) -> None:
    """A control law on DESIGN at a pose: its poles, how near they come to the natural frequencies, how it isolates.

    LAW: pid (needs --kp, --kd), force (integral force feedback), velocity (direct velocity feedback), lqg, h-infinity.

    \b
    flexapod control cubic-isolator lqg --shake 0.01 --out control
    flexapod control precision-positioner velocity --gain 20000
    flexapod control motion-base pid --kp 2e6 --kd 2e5 --out control
    """
    options = Options(**given)
    hexapod, pose = common.machine(options.design, options.changes, options.pose)
    with stages(options.as_json) as report, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the findings say what the library warns of
        found = _find(hexapod, pose, options, report)
    files = [] if options.out is None else _write(hexapod, found, common.output_directory(options.out))
    if options.as_json:
        common.print_json(_result(hexapod, found, files))
    else:
        _show(hexapod, found, files)


@dataclass(frozen=True)
class _Made:
    """A law with what was looked at to choose it."""

    law: ControlLaw
    gains: xr.Dataset | None = None
    locus: xr.Dataset | None = None


def _find(hexapod: Hexapod, pose: Pose, options: Options, report: Report) -> ControlFindings:
    import numpy as np

    from flexapod.control.controlled_response import controlled_transmissibility
    from flexapod.control.position_control import closed_loop
    from flexapod.control.sampling_rate import sampling_time
    from flexapod.mechanics.linearisation import linearise
    from flexapod.report.studies.control import ControlFindings

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
        hexapod, pose, sampled, np.geomspace(0.03 * omega[0], top, 500), joint=options.joint
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
    from flexapod.control.isolation import h_infinity, lqg

    weights = {name: value for name, value in (("effort", options.effort), ("noise", options.noise)) if value}
    measure = tuple(options.measure.split(","))
    design: Any = lqg if options.law == "lqg" else h_infinity
    return _Made(design(hexapod, pose, measure=measure, joint=options.joint, **weights))


def _damping(hexapod: Hexapod, pose: Pose, tangent: Linearisation, options: Options, dt: float) -> _Made:
    """A decentralised law; without a gain, that with the most damping when sampled."""
    from flexapod.control.active_damping import root_locus
    from flexapod.control.controllers import damping_law
    from flexapod.control.gain_search import best_gain, default_gains
    from flexapod.control.plant import Plant

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
    import numpy as np

    from flexapod.control.controllers import PID
    from flexapod.control.position_control import gain_map

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
        gain_map(hexapod, pose, *rows, controller=law, joint=options.joint) if all(r.size > 1 for r in rows) else None
    )
    return _Made(law, gains=gains)


def _run(hexapod: Hexapod, pose: Pose, controller: Controller, options: Options, report: Report) -> xr.Dataset:
    from flexapod.control.sampled_simulation import Hardware, simulate_control
    from flexapod.excitation.excitation import Excitation
    from flexapod.excitation.spectra import flat_spectrum, random_motion
    from flexapod.mechanics.modes import natural_modes

    omega = natural_modes(hexapod, pose, joint=options.joint).omega
    turn = 6.283185307179586
    low, high = (0.2 * omega[0], 2.0 * omega[-1]) if options.band is None else (turn * hz for hz in options.band)
    spectrum = flat_spectrum(options.shake, float(low), float(high))  # type: ignore[arg-type]
    base = Excitation()
    for number, axis in enumerate(options.axes.split(",")):
        base = base + random_motion(axis.strip(), spectrum, seed=options.seed + number)
    duration = options.duration or 60 * turn / float(omega[0])
    noise: dict[str, Any] = {str(controller.measures[0]): options.sensor_noise} if options.sensor_noise else {}
    hardware = Hardware(options.force_limit or float("inf"), noise, options.seed)
    return simulate_control(
        hexapod,
        pose,
        controller,
        base,
        duration,
        hardware=hardware,
        progress=lambda share: report("run on the moving base", share),
        joint=options.joint,
    )


def _write(hexapod: Hexapod, found: ControlFindings, directory: Path) -> list[str]:
    from flexapod.report.studies.control import figures, page

    files = []
    for name, draw in figures(found).items():
        files.append(directory / f"control-{name}.png")
        common.save_figure(draw(), files[-1])
    files.append(directory / "control.html")
    common.write_file(files[-1], page(hexapod, found))
    return [str(file) for file in files]


def _result(hexapod: Hexapod, found: ControlFindings, files: list[str]) -> dict[str, Any]:
    from flexapod.report.studies.control import cautions

    loop = found.sampled
    result: dict[str, Any] = {
        "design": hexapod.name,
        "digest": hexapod.digest,
        "pose_m_deg": common.pose_numbers(found.pose),
        "controller": loop.controller.name,
        "order": loop.controller.order,
        "natural_frequencies_rad_s": loop.omega,
        "sampling_time_s": loop.controller.dt,
        "recommended_sampling_time_s": found.recommended,
        "poles_rad_s": [[p.real, p.imag] for p in loop.pole],
        "damping_ratio": loop.damping_ratio,
        "distance": loop.distance,
        "near": [int(k) for k in loop.near],
        "worst_damping": loop.worst_damping,
        "worst_damping_continuous": found.continuous.worst_damping,
        "cautions": cautions(found),
        "files": files,
    }
    if found.locus is not None:
        result |= {key: found.locus.attrs[key] for key in ("best_gain", "best_damping", "leak_rad_s")}
    if found.run is not None:
        run = found.run
        result["run"] = {
            "axis": run.axis.values.tolist(),
            "saturated": run.attrs["saturated"],
            **{
                f"{name}_{case}": run[name].sel(case=case).values
                for name in ("rms_acceleration", "predicted_rms_acceleration", "rms_displacement")
                for case in ("controlled", "passive")
            },
        }
    return result


def _show(hexapod: Hexapod, found: ControlFindings, files: list[str]) -> None:
    from flexapod.report.studies.control import cautions

    out, loop = common.console(), found.sampled
    dt = loop.controller.dt or 0.0
    out.print(f"{hexapod.name} at {found.pose!r}: {loop.controller.name}", markup=False, soft_wrap=True)
    out.print("  natural frequencies " + "  ".join(f"{w:.5g}" for w in loop.omega) + " rad/s")
    out.print(
        f"  sampled every {1e3 * dt:.4g} ms (at most {1e3 * found.recommended:.4g} ms advised), "
        f"order {loop.controller.order}"
    )
    out.print(f"  worst damping ratio {loop.worst_damping:.4g} (without sampling {found.continuous.worst_damping:.4g})")
    if found.locus is not None:
        attrs = found.locus.attrs
        unit = found.locus.gain.attrs["units"]
        out.print(
            f"  most damping without sampling {attrs['best_damping']:.4g} at gain {attrs['best_gain']:.5g} {unit}"
        )
    if found.run is not None:
        from rich.table import Table

        table = Table(
            "axis", "no control", "control", "tangent says", title="RMS absolute acceleration", title_justify="left"
        )
        for axis in found.run.axis.values:
            at = found.run.sel(axis=axis)
            cells = [
                at.rms_acceleration.sel(case="passive"),
                at.rms_acceleration.sel(case="controlled"),
                at.predicted_rms_acceleration.sel(case="controlled"),
            ]
            table.add_row(str(axis), *(f"{float(cell):.4g} {at.acceleration_unit.values}" for cell in cells))
        out.print(table)
    common.print_warnings(cautions(found))
    for file in files:
        click.echo(f"Wrote {file}")
