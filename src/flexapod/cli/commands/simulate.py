"""`flexapod simulate`: the complete machine in time, driven by its base, loads and leg commands."""

from __future__ import annotations

import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.drives import QUANTITY, drive_options, drives
from flexapod.conventions import AXES
from flexapod.report.numbers import pose_numbers

if TYPE_CHECKING:
    import xarray as xr

    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose

MOST_PLOTTED = 20_000

_options = common.stack(
    drive_options,
    click.option("--duration", type=QUANTITY, required=True, metavar="SECONDS", help="As 0.5, 500ms or 2min."),
    click.option("--force", type=QUANTITY, nargs=3, default=(0, 0, 0), metavar="X Y Z", help="Constant, N."),
    click.option("--moment", type=QUANTITY, nargs=3, default=(0, 0, 0), metavar="X Y Z", help="Constant, N m."),
    click.option(
        "--start",
        type=click.Choice(("rest", "carried")),
        default="rest",
        show_default=True,
        help="The platform is at rest in the room, or moves with the base, when it begins.",
    ),
    click.option("--unloaded", is_flag=True, help="Let gravity ring: the legs are unstretched at the pose."),
    click.option("--samples", type=click.IntRange(2), default=None, help="Default: 20 a period of the highest mode."),
    click.option("--rtol", type=float, default=1e-9, show_default=True, help="Relative error of a step."),
    click.option("--reactions", is_flag=True, help="Forces and moments in all joints too."),
    common.out_option("Write figures, .csv and .nc here."),
    click.option(
        "--animate",
        type=click.Path(path_type=Path, dir_okay=False),
        default=None,
        metavar="FILE",
        help="Write a moving picture of the last periods: a .gif, or an .mp4 with the extra 'video'.",
    ),
    common.exaggeration_option,
)


@click.command()
@common.machine_options
@_options
@common.json_option
def command(design: str, pose: tuple[float, ...] | None, changes: tuple[str, ...], as_json: bool, **given: Any) -> None:
    """Motion of DESIGN in time from rest at a pose, by its complete non-linear equations.

    CHANNEL is x, y, z, roll, pitch or yaw of the base; force:x to force:z and moment:x to moment:z on the platform;
    leg:1 to leg:6 for a leg's length command. Numbers are SI (m, rad, N, s, rad/s) unless a unit follows: 1um, 0.5deg,
    20Hz, 3g, 10ms. Options that drive may be repeated, and add up.

    Example: flexapod simulate mukherjee-ii --harmonic z 1um 750 --duration 0.5 --out run
    """
    from flexapod.errors import SimulationError

    hexapod, where = common.machine(design, changes, pose)
    import flexapod.simulation.time_simulation  # noqa: F401  # loading it takes longer than most runs: not part of the time told

    if given["animate"] is not None:
        from flexapod.plots.animation import check_path

        check_path(given["animate"])
    began = time.perf_counter()
    try:
        dataset = _simulate(hexapod, where, given, quiet=as_json)
    except SimulationError as error:
        if error.result is not None and given["out"] is not None:
            _write(error.result, given["out"])
            raise SimulationError(f"{error} The motion so far is in {given['out']}.") from error
        raise
    took = time.perf_counter() - began
    files = [] if given["out"] is None else _write(dataset, given["out"])
    if given["animate"] is not None:
        files.append(_animate(hexapod, dataset, given))
    if as_json:
        common.print_json(_as_json(hexapod, where, dataset, took, files))
        return
    _show(hexapod, where, dataset, took)
    if not drives(given) and not given["unloaded"]:
        common.print_warnings(
            ["Nothing drives the machine: what moves is rounding. Give --harmonic, --shock or the like."]
        )
    for file in files:
        click.echo(f"Wrote {file}")


def _simulate(hexapod: Hexapod, pose: Pose, given: dict[str, Any], quiet: bool) -> xr.Dataset:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    from flexapod.mechanics.kinematics import inverse_kinematics
    from flexapod.simulation.time_simulation import simulate

    settings: dict[str, Any] = {name: given[name] for name in ("joint", "start", "rtol", "reactions")}
    if given["samples"] is not None:
        settings["samples"] = given["samples"]
    if given["unloaded"]:
        settings["unstretched_length"] = inverse_kinematics(hexapod, pose)
    loads: dict[str, Any] = dict(drives(given))
    for name in ("force", "moment"):
        if any(given[name]):
            if name in loads:
                raise click.UsageError(f"--{name} and a drive of {name} were given; a {name} is constant or driven.")
            loads[name] = given[name]
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:.0f} %"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), disable=quiet, transient=True) as bar:
        task = bar.add_task("simulating", total=1.0)
        settings["progress"] = lambda done: bar.update(task, completed=done)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # they are in the result, and shown with it
            return simulate(hexapod, pose, duration=given["duration"], **loads, **settings)


def _write(dataset: xr.Dataset, directory: Path) -> list[Path]:
    from flexapod.plots.response import displacements
    from flexapod.plots.simulation import leg_forces

    out = common.output_directory(directory)
    few = dataset.isel(time=slice(None, None, max(1, dataset.sizes["time"] // MOST_PLOTTED)))
    figures = {
        "displacement": displacements(few.time.values, few.displacement.values),
        "relative_displacement": displacements(few.time.values, few.relative_displacement.values),
        "leg_forces": leg_forces(few),
    }
    for name, figure in figures.items():
        common.save_figure(figure, out / f"{name}.png")
    stored = dataset.copy()
    stored.attrs = {key: "; ".join(value) if isinstance(value, list) else value for key, value in dataset.attrs.items()}
    common.save_netcdf(stored, out / "simulation.nc")
    common.write_file(out / "simulation.csv", _table(dataset))
    return [out / "simulation.nc", out / "simulation.csv", *(out / f"{name}.png" for name in figures)]


def _animate(hexapod: Hexapod, dataset: xr.Dataset, given: dict[str, Any]) -> Path:
    from flexapod.plots.animation import animate_simulation

    animate_simulation(dataset, hexapod, given["animate"], exaggeration=given["exaggeration"])
    path: Path = given["animate"]
    return path


def _table(dataset: xr.Dataset) -> str:
    """Displacements, leg lengths and forces as CSV, one line a sample."""
    import io

    import numpy as np

    names = ["time_s"]
    columns = [dataset.time.values[:, None]]
    for variable, unit in (("displacement", "m"), ("relative_displacement", "m")):
        columns.append(dataset[variable].values)
        names += [f"{variable}_{axis}_{unit if axis in AXES[:3] else 'rad'}" for axis in AXES]
    for variable, unit in (("leg_length", "m"), ("leg_force", "N")):
        columns.append(dataset[variable].values)
        names += [f"{variable}_{leg}_{unit}" for leg in dataset.leg.values]
    text = io.StringIO()
    np.savetxt(text, np.hstack(columns), fmt="%.12g", delimiter=",", header=",".join(names), comments="")
    return text.getvalue()


def _summary(dataset: xr.Dataset) -> dict[str, dict[str, list[float]]]:
    """Largest and RMS values of the two displacements, by axis."""
    import numpy as np

    return {
        name: {
            "largest": np.abs(dataset[name].values).max(axis=0).tolist(),
            "rms": np.sqrt((dataset[name].values ** 2).mean(axis=0)).tolist(),
        }
        for name in ("displacement", "relative_displacement")
    }


def _as_json(hexapod: Hexapod, pose: Pose, dataset: xr.Dataset, took: float, files: list[Path]) -> dict[str, Any]:
    force = dataset.leg_force.values
    return {
        "design": hexapod.name,
        "digest": hexapod.digest,
        "pose_m_deg": pose_numbers(pose),
        "joint": dataset.attrs["joint"],
        "duration_s": float(dataset.time[-1]),
        "samples": dataset.sizes["time"],
        "axes": list(AXES),
        **_summary(dataset),
        "leg_force_N": {"least": force.min(axis=0), "largest": force.max(axis=0)},
        "energy_error": dataset.attrs["energy_error"],
        "steps": dataset.attrs["steps"],
        "evaluations": dataset.attrs["evaluations"],
        "seconds": took,
        "warnings": dataset.attrs["warnings"],
        "files": [str(file) for file in files],
    }


def _show(hexapod: Hexapod, pose: Pose, dataset: xr.Dataset, took: float) -> None:
    from rich.table import Table
    from rich.text import Text

    console = common.console()
    console.print(Text(f"{hexapod.name} at {pose!r}, joint model {dataset.attrs['joint']}"), soft_wrap=True)
    table = Table()
    for heading in ("", "largest displacement", "RMS", "largest seen from the base", "RMS"):
        table.add_column(heading, justify="left" if not heading else "right")
    summary = _summary(dataset)
    for i, axis in enumerate(AXES):
        unit = "m" if i < 3 else "rad"
        cells = [summary[name][kind][i] for name in summary for kind in ("largest", "rms")]
        table.add_row(axis, *(f"{cell:.4g} {unit}" for cell in cells))
    console.print(table)
    force = dataset.leg_force.values
    click.echo(f"Leg forces from {force.min():.5g} to {force.max():.5g} N (positive: compression)")
    error = f"{dataset.attrs['energy_error']:.1e} of the largest of kinetic energy and works"
    click.echo(f"{dataset.attrs['steps']} steps in {took:.2f} s; energy balance error {error}")
    for warning in dataset.attrs["warnings"]:
        click.echo(f"Warning: {warning}", err=True)
