"""`flexapod simulate`: the complete machine in time, driven by its base, loads and leg commands."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.simulate import simulate_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.machine_options
@simulate_options
@figures.options("--out")
@common.json_option
def command(design: str, pose: tuple[float, ...] | None, changes: tuple[str, ...], as_json: bool, **given: Any) -> None:
    """Motion of DESIGN in time from rest at a pose, by its complete non-linear equations.

    CHANNEL is x, y, z, roll, pitch or yaw of the base; force:x to force:z and moment:x to moment:z on the platform;
    leg:1 to leg:6 for a leg's length command. Numbers are SI (m, rad, N, s, rad/s) unless a unit follows: 1um, 0.5deg,
    20Hz, 3g, 10ms. Options that drive may be repeated, and add up.

    Example: flexapod simulate mukherjee-ii --harmonic z 1um 750 --duration 0.5 --out run
    """
    with stages(as_json, "simulation") as report:
        from flexapod.cli.studies.simulate import compute

        found = compute(*common.machine(design, changes, pose), given, report)
    emit(found, given["out"], as_json, more=[given["animate"]] if given["animate"] else [])
