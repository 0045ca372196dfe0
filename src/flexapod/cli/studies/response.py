"""The study of `flexapod response`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np
import xarray as xr
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import Progress

from flexapod.conventions import AXES, LEGS, Array, unit_of
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import Pose
from flexapod.report.studies.response import ResponseFindings, study
from flexapod.report.study import Study
from flexapod.tables import naming, parse_table, read_text
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.grid import band, grid_around
from flexapod.vibration.harmonic import complex_poles
from flexapod.vibration.random_vibration import random_response
from flexapod.vibration.stepped import stepped_sine

_PSD = f"It must have frequency_hz and one or more of {', '.join(AXES)}."


def compute(hexapod: Hexapod, pose: Pose, given: dict[str, Any], quiet: bool) -> Study:
    """The response to what the options say, and, where asked for, that of the non-linear machine and to random motion.

    quiet: without progress.
    """
    _check(given)
    poles = complex_poles(linearise(hexapod, pose, joint=given["joint"]), given["loss_factor"])
    ends = given["omega_min"], given["omega_max"]
    try:
        low, high = band(poles, *ends)
    except ArgumentError as error:
        raise click.UsageError(f"--omega-min and --omega-max: {error}") from error
    options = {key: given[key] for key in ("point", "loss_factor", "joint")}
    response = transmissibility(hexapod, pose, omega=grid_around(poles, *ends, given["points"]), **options)
    stepped = None if given["amplitude"] is None else _stepped(hexapod, pose, given, (low, high), quiet)
    random = None
    if given["psd"] is not None:
        frequency, psd = _read_psd(given["psd"])
        random = random_response(hexapod, pose, psd=psd, frequency=frequency, **options)
    found = ResponseFindings(
        hexapod=hexapod,
        pose=pose,
        options=options,
        source=given["source"],
        axis=_axis(given),
        variable=_variable(given),
        poles=poles,
        response=response,
        stepped=stepped,
        random=random,
    )
    at_modes = None
    moving = poles.imag > 0
    if moving.any():
        at_modes = transmissibility(hexapod, pose, omega=poles.imag[moving], **options)
    return study(found, _peaks(found, moving, at_modes))


def _check(given: dict[str, Any]) -> None:
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


def _axis(given: dict[str, Any]) -> str:
    return given["axis"] or ("1" if given["source"] == "command" else "z")


def _variable(given: dict[str, Any]) -> str:
    if given["source"] == "base":
        return "relative" if given["relative"] else "absolute"
    return {"wrench": "compliance", "command": "command"}[given["source"]]


def _stepped(hexapod: Hexapod, pose: Pose, given: dict[str, Any], ends: tuple[float, float], quiet: bool) -> xr.Dataset:
    omega = np.geomspace(*ends, given["steps"])
    with Progress(console=Console(stderr=True), disable=quiet, transient=True) as bar:
        task = bar.add_task(f"stepped sine, {omega.size} frequencies", total=1.0)
        return stepped_sine(
            hexapod,
            pose,
            omega=omega,
            amplitude=given["amplitude"],
            axis=_axis(given),
            joint=given["joint"],
            progress=lambda done: bar.update(task, completed=done),
        )


def _peaks(found: ResponseFindings, moving: NDArray[np.bool_], at_modes: xr.Dataset | None) -> Array:
    """(6 modes, 6 outputs): amplitude at each mode's damped frequency; NaN for a mode that does not vibrate."""
    peaks = np.full((6, 6), np.nan)
    if at_modes is not None:
        peaks[moving] = np.abs(at_modes[found.variable].sel({found.dimension: found.axis}).values)
    return peaks


def _read_psd(path: Path) -> tuple[Array, Array]:
    """Frequencies in Hz and densities per Hz (n, 6) of a CSV file."""
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
