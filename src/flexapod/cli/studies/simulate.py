"""The study of `flexapod simulate`."""

from __future__ import annotations

import time
import warnings
from typing import Any

import click
import xarray as xr

from flexapod.cli.options.drives import drives
from flexapod.cli.options.given import needed
from flexapod.cli.output.results import write
from flexapod.cli.output.stages import Report
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SimulationError
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.output_files import make_directory
from flexapod.plots import animation
from flexapod.pose import Pose
from flexapod.report.studies.simulation import study
from flexapod.report.study import Study
from flexapod.simulation.time_simulation import simulate


def compute(hexapod: Hexapod, pose: Pose, given: dict[str, Any], report: Report) -> Study:
    """The motion that the options ask for, and its moving picture."""
    needed(given["random"], "random motion, which --random asks for", "seed")
    needed(given["animate"], "the moving picture, which --animate asks for", "exaggeration")
    if given["animate"] is not None:
        animation.check_path(given["animate"])
    began = time.perf_counter()
    try:
        dataset = _simulate(hexapod, pose, given, report)
    except SimulationError as error:
        if error.result is not None and given["out"] is not None:
            write(study(hexapod, pose, error.result), make_directory(given["out"]))
            raise SimulationError(f"{error} The motion so far is in {given['out']}.") from error
        raise
    took = time.perf_counter() - began
    if given["animate"] is not None:
        animation.animate_simulation(
            dataset,
            hexapod,
            given["animate"],
            exaggeration=given["exaggeration"],
            progress=lambda share: report("frames", share),
        )
    idle = "Nothing drives the machine: what moves is rounding. Give --harmonic, --shock or the like."
    driven = drives(given) or given["unloaded"]
    return study(hexapod, pose, dataset, took, [] if driven else [Caution("idle", idle)])


def _simulate(hexapod: Hexapod, pose: Pose, given: dict[str, Any], report: Report) -> xr.Dataset:
    if given["duration"] is None and not given["recording"]:
        raise click.UsageError("Missing option '--duration': how long is simulated, as 0.5, 500ms or 2min.")
    settings: dict[str, Any] = {
        name: given[name] for name in ("joint", "start", "rtol", "reactions", "loss_frequency", "point")
    }
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
    settings["progress"] = lambda share: report("simulation", share)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # they are in the result, and shown with it
        return simulate(hexapod, pose, duration=given["duration"], **loads, **settings)
