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

from flexapod.cli.options.given import needed
from flexapod.cli.options.quantities import read
from flexapod.cli.options.spectra import Spectra, read_load, read_spectra
from flexapod.conventions import AXES, LEGS, ROTATIONS, TWO_PI, Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import Pose
from flexapod.report.studies.response import ResponseFindings, study
from flexapod.report.study import Study
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.grid import band, grid_around
from flexapod.vibration.harmonic import complex_poles, losses
from flexapod.vibration.random_sources import RandomLoad
from flexapod.vibration.random_vibration import random_response
from flexapod.vibration.stepped import stepped_sine


def compute(hexapod: Hexapod, pose: Pose, given: dict[str, Any], quiet: bool) -> Study:
    """The response to what the options say, and, where asked for, that of the non-linear machine and to random motion.

    quiet: without progress.
    """
    _check(given)
    linear = linearise(hexapod, pose, joint=given["joint"])
    poles = complex_poles(linear, losses(hexapod, linear, given["loss_factor"]))
    ends = given["omega_min"], given["omega_max"]
    try:
        low, high = band(poles, *ends)
    except ArgumentError as error:
        raise click.UsageError(f"--omega-min and --omega-max: {error}") from error
    options = {key: given[key] for key in ("point", "loss_factor", "joint")}
    response = transmissibility(hexapod, pose, omega=grid_around(poles, *ends, given["points"]), **options)
    stepped = None if given["amplitude"] is None else _stepped(hexapod, pose, given, (low, high), quiet)
    random, notes = _random(hexapod, pose, given, options, poles)
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
        notes=notes,
    )
    at_modes = None
    moving = poles.imag > 0
    if moving.any():
        at_modes = transmissibility(hexapod, pose, omega=poles.imag[moving], **options)
    return study(found, _peaks(found, moving, at_modes))


def _random(
    hexapod: Hexapod, pose: Pose, given: dict[str, Any], options: dict[str, Any], poles: Complex
) -> tuple[xr.Dataset | None, list[str]]:
    """The response to random motion of the base and random loads, where either is given, and what to say of them."""
    base: dict[str, Any] = {}
    loads, notes = [], []
    if given["psd"] is not None:
        spectra = read_spectra(given["psd"])
        notes += [*spectra.notes, *_outside(given["psd"], spectra, poles)]
        base = {"psd": spectra.density, "frequency": spectra.frequency, "of": spectra.of}
    files, places = given["loads"], given["at"] or ((0.0, 0.0, 0.0),)
    if given["at"] and not files:
        raise click.UsageError("--at is where a load acts, and there is none. Give its spectra with --load.")
    if len(places) not in (1, len(files)):
        raise click.UsageError(
            f"--at gives {len(places)} places for {len(files)} load{'s' * (len(files) > 1)}. Give one for all, or one "
            "for each --load in turn."
        )
    for file, place in zip(files, places * len(files) if len(places) == 1 else places, strict=False):
        spectra = read_load(file)
        notes += [*spectra.notes, *_outside(file, spectra, poles)]
        loads.append(RandomLoad(spectra.density, frequency=spectra.frequency, point=place, name=file.stem))
    if not base and not loads:
        return None, notes
    return random_response(hexapod, pose, loads=loads, **base, **options), notes


def _outside(file: Path, spectra: Spectra, poles: Complex) -> list[str]:
    """That a file says nothing of frequencies at which the machine vibrates, where it does not."""
    natural, (low, high) = np.sort(poles.imag[poles.imag > 0]) / TWO_PI, spectra.frequency[[0, -1]]
    missed = natural[(natural < low) | (natural > high)]
    if not missed.size:
        return []
    told = ", ".join(f"{f:.4g}" for f in missed)
    return [
        f"{file} is from {low:.4g} to {high:.4g} Hz; outside it counts as no excitation, and there lie modes, at "
        f"{told} Hz. Where they are excited too, more moves than is told here: extend the spectra."
    ]


def _check(given: dict[str, Any]) -> None:
    needed(given["amplitude"], "the non-linear machine, which --amplitude asks for", "steps")
    axis, legs = given["axis"], given["source"] == "command"
    if axis is not None and (axis in LEGS) != legs:
        allowed = ", ".join(LEGS if legs else AXES)
        raise click.UsageError(f"--axis {axis} does not go with --from {given['source']}; choose one of {allowed}.")
    if given["relative"] and given["source"] != "base":
        raise click.UsageError("--relative is for --from base; wrenches and commands act on a base at rest.")
    if given["psd"] is not None and given["source"] != "base":
        raise click.UsageError(
            f"--psd gives spectra of the base's motion: it goes with --from base, not --from {given['source']}. "
            "Spectra of forces and moments on the platform are given by --load."
        )
    if given["amplitude"] is not None and (given["source"] != "base" or given["loss_factor"] is not None):
        raise click.UsageError(
            "--amplitude shakes the base of the non-linear machine, whose loss factors are those of the design: use it "
            "with --from base and without --loss-factor."
        )


def _axis(given: dict[str, Any]) -> str:
    return given["axis"] or ("1" if given["source"] == "command" else "z")


def _variable(given: dict[str, Any]) -> str:
    if given["source"] == "base":
        return "relative" if given["relative"] else "absolute"
    return {"wrench": "compliance", "command": "command"}[given["source"]]


def _stepped(hexapod: Hexapod, pose: Pose, given: dict[str, Any], ends: tuple[float, float], quiet: bool) -> xr.Dataset:
    omega = np.geomspace(*ends, given["steps"])
    dimension = "angle" if _axis(given) in ROTATIONS else "length"
    with Progress(console=Console(stderr=True), disable=quiet, transient=True) as bar:
        task = bar.add_task(f"stepped sine, {omega.size} frequencies", total=1.0)
        return stepped_sine(
            hexapod,
            pose,
            omega=omega,
            amplitude=read(given["amplitude"], dimension, "--amplitude", need="> 0"),
            axis=_axis(given),
            point=given["point"],
            joint=given["joint"],
            progress=lambda done: bar.update(task, completed=done),
        )


def _peaks(found: ResponseFindings, moving: NDArray[np.bool_], at_modes: xr.Dataset | None) -> Array:
    """(6 modes, 6 outputs): amplitude at each mode's damped frequency; NaN for a mode that does not vibrate."""
    peaks = np.full((6, 6), np.nan)
    if at_modes is not None:
        peaks[moving] = np.abs(at_modes[found.variable].sel({found.dimension: found.axis}).values)
    return peaks
