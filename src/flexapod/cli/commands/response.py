"""`flexapod response`: what the machine makes of a shaken base, of a wrench and of leg commands, by frequency."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from flexapod.cli.options import common
from flexapod.conventions import AXES, LEGS, unit_of
from flexapod.errors import ArgumentError
from flexapod.report.numbers import pose_numbers

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure
    from rich.table import Table

    from flexapod.conventions import Array, Complex
    from flexapod.design.hexapod import Hexapod
    from flexapod.pose import Pose

POSITIVE = click.FloatRange(min=0, min_open=True)
_PSD = f"It must have frequency_hz and one or more of {', '.join(AXES)}."

_response_options = common.stack(
    click.option(
        "--from",
        "source",
        type=click.Choice(("base", "wrench", "command")),
        default="base",
        show_default=True,
        help="What shakes: the base, a wrench at the output point, or a leg's length command.",
    ),
    click.option(
        "--axis", type=click.Choice(AXES + LEGS), default=None, help="Axis, or leg for commands. Default: z, 1."
    ),
    click.option("--relative", is_flag=True, help="Motion relative to the base instead of absolute motion."),
    click.option(
        "--omega-min", type=POSITIVE, default=None, metavar="RAD/S", help="Default: a fifth of the lowest mode."
    ),
    click.option(
        "--omega-max", type=POSITIVE, default=None, metavar="RAD/S", help="Default: 1.5 times the highest mode."
    ),
    click.option(
        "--points",
        type=click.IntRange(2, 1_000_000),
        default=500,
        show_default=True,
        help="Frequencies, equally spaced by logarithm; 13 more are put around each resonance.",
    ),
    click.option(
        "--point",
        type=float,
        nargs=3,
        default=(0.0, 0.0, 0.0),
        metavar="X Y Z",
        help="Output point, m, platform frame.",
    ),
    click.option(
        "--loss-factor", type=click.FloatRange(min=0), default=0.0, show_default=True, help="Of the legs' springs."
    ),
    click.option(
        "--amplitude",
        type=POSITIVE,
        default=None,
        metavar="M",
        help="Shake the base of the non-linear machine too, by this amplitude (m or rad), at --steps frequencies.",
    ),
    click.option("--steps", type=click.IntRange(2, 100_000), default=100, show_default=True, help="See --amplitude."),
    click.option(
        "--psd",
        type=click.Path(path_type=Path, exists=True, dir_okay=False),
        default=None,
        metavar="CSV",
        help="Base acceleration spectra for RMS values: column frequency_hz and one or more of x, y, z (m/s2)^2/Hz, "
        "roll, pitch, yaw (rad/s2)^2/Hz, one-sided.",
    ),
    common.out_option("Write figures, .csv and .nc here."),
)


class _Case(NamedTuple):
    hexapod: Hexapod
    pose: Pose
    given: dict[str, Any]
    poles: Complex

    @property
    def variable(self) -> str:
        if self.given["source"] == "base":
            return "relative" if self.given["relative"] else "absolute"
        return {"wrench": "compliance", "command": "command"}[self.given["source"]]

    @property
    def dimension(self) -> str:
        return {"base": "base", "wrench": "wrench", "command": "leg"}[self.given["source"]]

    @property
    def axis(self) -> str:
        return self.given["axis"] or ("1" if self.given["source"] == "command" else "z")

    @property
    def ends(self) -> tuple[float | None, float | None]:
        return self.given["omega_min"], self.given["omega_max"]

    @property
    def options(self) -> dict[str, Any]:
        keys = ("point", "loss_factor", "joint")
        return {key: self.given[key] for key in keys}


@click.command()
@common.machine_options
@_response_options
@common.json_option
def command(design: str, pose: tuple[float, ...] | None, changes: tuple[str, ...], as_json: bool, **given: Any) -> None:
    """Frequency response of DESIGN at a pose, from its exact tangent with gravity and damping.

    Amplitude and phase of the platform's six motions per motion of the base along --axis (transmissibility), per wrench
    (compliance) or per leg command. With --amplitude also by the complete non-linear equations; with --psd also the RMS
    on a base that moves at random.
    """
    case = _case(*common.machine(design, changes, pose), given)
    studies: dict[str, xr.Dataset] = {"response": _linear(case)}
    if given["amplitude"] is not None:
        studies["stepped"] = _stepped(case, quiet=as_json)
    if given["psd"] is not None:
        studies["random"] = _random(case)
    files = [] if given["out"] is None else _write(case, studies, common.output_directory(given["out"]))
    if as_json:
        common.print_json(_as_json(case, studies, files))
    else:
        _show(case, studies)
        for file in files:
            click.echo(f"Wrote {file}")


def _case(hexapod: Hexapod, pose: Pose, given: dict[str, Any]) -> _Case:
    from flexapod.mechanics.linearisation import linearise
    from flexapod.vibration.grid import band
    from flexapod.vibration.harmonic import complex_poles

    axis, legs = given["axis"], given["source"] == "command"
    if axis is not None and (axis in LEGS) != legs:
        allowed = ", ".join(LEGS if legs else AXES)
        raise click.UsageError(f"--axis {axis} does not go with --from {given['source']}; choose one of {allowed}.")
    if given["relative"] and given["source"] != "base":
        raise click.UsageError("--relative is for --from base; wrenches and commands act on a base at rest.")
    if given["amplitude"] is not None and (given["source"] != "base" or given["loss_factor"] or any(given["point"])):
        raise click.UsageError(
            "--amplitude shakes the base of the non-linear machine, whose friction is viscous: use it with --from base "
            "and without --loss-factor and --point."
        )
    poles = complex_poles(linearise(hexapod, pose, joint=given["joint"]), given["loss_factor"])
    case = _Case(hexapod, pose, given, poles)
    try:
        band(poles, *case.ends)
    except ArgumentError as error:
        raise click.UsageError(f"--omega-min and --omega-max: {error}") from error
    return case


def _linear(case: _Case) -> xr.Dataset:
    from flexapod.vibration.frequency_response import transmissibility
    from flexapod.vibration.grid import grid_around

    omega = grid_around(case.poles, *case.ends, case.given["points"])
    return transmissibility(case.hexapod, case.pose, omega=omega, **case.options)


def _stepped(case: _Case, quiet: bool) -> xr.Dataset:
    import numpy as np
    from rich.console import Console
    from rich.progress import Progress

    from flexapod.vibration.grid import band
    from flexapod.vibration.stepped import stepped_sine

    omega = np.geomspace(*band(case.poles, *case.ends), case.given["steps"])
    amplitude, joint = case.given["amplitude"], case.given["joint"]
    with Progress(console=Console(stderr=True), disable=quiet, transient=True) as bar:
        task = bar.add_task(f"stepped sine, {omega.size} frequencies", total=1.0)
        return stepped_sine(
            case.hexapod,
            case.pose,
            omega=omega,
            amplitude=amplitude,
            axis=case.axis,
            joint=joint,
            progress=lambda done: bar.update(task, completed=done),
        )


def _random(case: _Case) -> xr.Dataset:
    from flexapod.vibration.random_vibration import random_response

    frequency, psd = _read_psd(case.given["psd"])
    return random_response(case.hexapod, case.pose, psd=psd, frequency=frequency, **case.options)


def _read_psd(path: Path) -> tuple[Array, Array]:
    """Frequencies in Hz and densities per Hz (n, 6) of a CSV file."""
    import numpy as np

    from flexapod.tables import naming, parse_table, read_text

    text = read_text(path)
    with naming(path):
        table = parse_table(text, {"frequency": "frequency", "f": "frequency", **{axis: axis for axis in AXES}}, _PSD)
        frequency = table.column("frequency")
        if frequency is None or len(table.columns) < 2:
            raise ArgumentError(f"it has columns {', '.join(column.title for column in table.columns)}. {_PSD}")
        hertz = table.numbers(frequency, {"Hz": (1, 1), "hz": (1, 1), "kHz": (1e3, 1)}, finite=False)
        density = np.zeros((len(hertz), 6))
        for column in table.columns:
            if column.name in AXES:
                density[:, AXES.index(column.name)] = table.numbers(column, _density_units(column.name), finite=False)
    return hertz, density


def _density_units(axis: str) -> dict[str, tuple[float, float]]:
    """What people write for (m/s2)2/Hz, or with rad."""
    unit = unit_of(axis)
    return dict.fromkeys((f"{unit}2_per_s4_per_Hz", f"{unit}_per_s22_per_Hz", f"{unit}2_per_s3"), (1.0, 1.0))


def _write(case: _Case, studies: dict[str, xr.Dataset], directory: Path) -> list[Path]:
    files = []
    for name, dataset in studies.items():
        table = {
            "response": lambda: _response_table(case, dataset),  # noqa: B023
            "stepped": lambda: dataset.ratio.to_pandas(),  # noqa: B023
            "random": lambda: _random_table(dataset),  # noqa: B023
        }[name]()
        common.write_file(directory / f"{name}.csv", table.to_csv())
        common.save_netcdf(real_parts(dataset), directory / f"{name}.nc")
        common.save_figure(_figure(case, name, dataset, studies["response"]), directory / f"{name}.png")
        files += [directory / f"{name}.{kind}" for kind in ("csv", "nc", "png")]
    return files


def real_parts(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with every complex variable as two real ones, <name>_re and <name>_im, as netCDF wants it."""
    import numpy as np

    parts = {}
    for name, variable in dataset.data_vars.items():
        if np.iscomplexobj(variable):
            parts[f"{name}_re"], parts[f"{name}_im"] = variable.real, variable.imag
            parts[f"{name}_re"].attrs = parts[f"{name}_im"].attrs = variable.attrs
        else:
            parts[str(name)] = variable
    return dataset.drop_vars(list(dataset.data_vars)).assign(parts)


def _response_table(case: _Case, dataset: xr.Dataset) -> Any:
    import numpy as np
    import pandas as pd

    chosen = dataset[case.variable].sel({case.dimension: case.axis})
    table = pd.DataFrame({"omega_rad_s": dataset.omega.values, "frequency_hz": dataset.omega.values / (2 * np.pi)})
    for output in AXES:
        values = chosen.sel(output=output).values
        table[f"{output}_amplitude"] = np.abs(values)
        table[f"{output}_phase_deg"] = np.degrees(np.angle(values))
    return table.set_index("omega_rad_s")


def _random_table(dataset: xr.Dataset) -> Any:
    import pandas as pd

    table = pd.DataFrame({"omega_rad_s": dataset.omega.values})
    for name, values in dataset.data_vars.items():
        if "omega" in values.dims:
            for label in dataset[values.dims[1]].values:
                table[f"{name}_{label}"] = values.sel({values.dims[1]: label}).values
    return table.set_index("omega_rad_s")


def _figure(case: _Case, name: str, dataset: xr.Dataset, response: xr.Dataset) -> Figure:
    from flexapod.plots import response as plots

    natural = case.poles.imag
    if name == "response":
        return plots.frequency_response(dataset, case.variable, case.axis, natural)
    if name == "random":
        return plots.random_spectra(dataset)
    figure = plots.stepped_ratio(dataset, natural, response.absolute.sel(base=case.axis), scale="log")
    amplitude = f"{dataset.attrs['amplitude']:g} {dataset.attrs['amplitude_unit']}"
    figure.suptitle(
        f"{case.hexapod.name}: non-linear stepped sine, base {case.axis}, amplitude {amplitude}", fontsize=12
    )
    return figure


def _peaks(case: _Case) -> Array:
    """(6 modes, 6 outputs): amplitude at each mode's damped frequency; NaN for a mode that does not vibrate."""
    import numpy as np

    from flexapod.vibration.frequency_response import transmissibility

    found = np.full((6, 6), np.nan)
    moving = case.poles.imag > 0
    if moving.any():
        at = transmissibility(case.hexapod, case.pose, omega=case.poles.imag[moving], **case.options)
        found[moving] = np.abs(at[case.variable].sel({case.dimension: case.axis}).values)
    return found


def _show(case: _Case, studies: dict[str, xr.Dataset]) -> None:
    import numpy as np

    unit = {"base": ("rad" if case.axis in AXES[3:] else "m"), "wrench": "N (N m)", "leg": "m"}[case.dimension]
    source = f"{case.dimension} {case.axis}"
    click.echo(f"{case.hexapod.name} at {case.pose!r}")
    table = _table("mode", "rad/s", "Hz", "damping", *AXES)
    for i, (pole, row) in enumerate(zip(case.poles, _without_rounding(_peaks(case)), strict=True)):
        numbers = (f"{pole.imag:.5g}", f"{pole.imag / (2 * np.pi):.4g}", f"{-pole.real / abs(pole):.2g}")
        table.add_row(str(i + 1), *numbers, *(f"{peak:.2g}" for peak in row))
    click.echo(f"{case.variable.capitalize()} response at each damped frequency, m and rad per {unit} of {source}:")
    common.console().print(table)
    if "stepped" in studies:
        click.echo(_stepped_words(studies["stepped"]))
    if "random" in studies:
        _show_random(studies["random"])


def _table(*headings: str) -> Table:
    from rich.table import Table

    table = Table(box=None, padding=(0, 1, 0, 0))
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def _without_rounding(values: Array) -> Array:
    """Zero for what is nothing but rounding beside the largest: symmetry that floating point breaks."""
    import numpy as np

    return np.where(np.abs(values) < 1e-12 * np.nanmax(np.abs(values), initial=0.0), 0.0, values)


def _stepped_words(stepped: xr.Dataset) -> str:
    import numpy as np

    found = stepped.status.values == "found"
    words = f"Non-linear stepped sine, amplitude {stepped.attrs['amplitude']:g} {stepped.attrs['amplitude_unit']}: "
    if not found.any():
        return words + "no periodic motion found at any frequency."
    linear, response = stepped.linear.values[found], stepped.response.values[found]
    apart = np.linalg.norm(response - linear, axis=1) / np.linalg.norm(linear, axis=1)
    words += f"{found.sum()} of {found.size} frequencies; apart from the tangent by {np.median(apart):.2g} (median), "
    return words + f"{apart.max():.2g} at most, at {stepped.omega.values[found][apart.argmax()]:.5g} rad/s."


def _show_random(dataset: xr.Dataset) -> None:
    table = _table("", "displacement", "relative", "acceleration", "leg", "force, N")
    click.echo("RMS on the base that moves at random, m and rad, m/s2 and rad/s2:")
    columns = [
        _without_rounding(dataset[f"rms_{name}"].values) for name in ("displacement", "relative", "acceleration")
    ]
    for i, (axis, force) in enumerate(zip(AXES, dataset.rms_leg_force.values, strict=True)):
        table.add_row(axis, *(f"{column[i]:.4g}" for column in columns), LEGS[i], f"{force:.4g}")
    common.console().print(table)


def _as_json(case: _Case, studies: dict[str, xr.Dataset], files: list[Path]) -> dict[str, Any]:
    import numpy as np

    dataset = studies["response"]
    chosen = dataset[case.variable].sel({case.dimension: case.axis})
    result: dict[str, Any] = {
        "design": case.hexapod.name,
        "digest": case.hexapod.digest,
        "pose_m_deg": pose_numbers(case.pose),
        **{key: case.given[key] for key in ("joint", "loss_factor")},
        "point_m": case.given["point"],
        "from": case.given["source"],
        "axis": case.axis,
        "variable": case.variable,
        "damped_omega_rad_s": case.poles.imag,
        "damping_ratio": -case.poles.real / np.abs(case.poles),
        "amplitude_at_modes": _peaks(case),
        "omega_rad_s": dataset.omega.values,
        "amplitude": {name: np.abs(chosen.sel(output=name).values) for name in AXES},
        "phase_rad": {name: np.angle(chosen.sel(output=name).values) for name in AXES},
    }
    if "stepped" in studies:
        stepped = studies["stepped"]
        ratio = {name: stepped.ratio.sel(output=name).values for name in AXES}
        status = {"amplitude": stepped.attrs["amplitude"], "status": stepped.status.values}
        result["stepped"] = {"omega_rad_s": stepped.omega.values, "ratio": ratio, **status}
    if "random" in studies:
        rms = ("displacement", "relative", "acceleration", "leg_force")
        result["random_rms"] = {name: studies["random"][f"rms_{name}"].values for name in rms}
    return {**result, "files": [str(file) for file in files]}
