"""The study of `flexapod response`."""

from __future__ import annotations

from typing import Any

import click
import numpy as np
import xarray as xr
from numpy.typing import NDArray

from flexapod.cli.options.given import needed
from flexapod.cli.options.quantities import read
from flexapod.cli.output.stages import Report
from flexapod.cli.studies.shaking import read_shaking
from flexapod.conventions import AXES, LEGS, ROTATIONS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import Pose
from flexapod.report.studies.response import ResponseFindings, study
from flexapod.report.study import Study
from flexapod.vibration.frequency_response import transmissibility
from flexapod.vibration.grid import band, grid_around
from flexapod.vibration.harmonic import complex_poles, losses
from flexapod.vibration.random_vibration import random_response
from flexapod.vibration.stepped import stepped_sine


def compute(hexapod: Hexapod, pose: Pose, given: dict[str, Any], report: Report) -> Study:
    """The response, and where asked for that of the non-linear machine and to random motion."""
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
    stepped = None if given["amplitude"] is None else _stepped(hexapod, pose, given, (low, high), report)
    shaking = read_shaking(given["psd"], given["loads"], given["at"])
    random = None if shaking is None else random_response(hexapod, pose, **shaking.given, **options)
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
        notes=[] if shaking is None else shaking.notes,
    )
    at_modes = None
    moving = poles.imag > 0
    if moving.any():
        at_modes = transmissibility(hexapod, pose, omega=poles.imag[moving], **options)
    return study(found, _peaks(found, moving, at_modes))


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


def _stepped(
    hexapod: Hexapod, pose: Pose, given: dict[str, Any], ends: tuple[float, float], report: Report
) -> xr.Dataset:
    omega = np.geomspace(*ends, given["steps"])
    dimension = "angle" if _axis(given) in ROTATIONS else "length"
    stage = f"stepped sine, {omega.size} frequencies"
    report(stage, 0.0)
    return stepped_sine(
        hexapod,
        pose,
        omega=omega,
        amplitude=read(given["amplitude"], dimension, "--amplitude", need="> 0"),
        axis=_axis(given),
        point=given["point"],
        joint=given["joint"],
        progress=lambda share: report(stage, share),
    )


def _peaks(found: ResponseFindings, moving: NDArray[np.bool_], at_modes: xr.Dataset | None) -> Array:
    """(6 modes, 6 outputs): amplitude at each mode's damped frequency; NaN for a mode that does not vibrate."""
    peaks = np.full((6, 6), np.nan)
    if at_modes is not None:
        peaks[moving] = np.abs(at_modes[found.variable].sel({found.dimension: found.axis}).values)
    return peaks
