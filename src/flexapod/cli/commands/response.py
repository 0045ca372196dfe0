"""`flexapod response`: what the machine makes of a shaken base, of a wrench and of leg commands, by frequency."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.response import response_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.machine_options
@response_options
@figures.options("--out")
@common.json_option
def command(design: str, pose: tuple[float, ...] | None, changes: tuple[str, ...], as_json: bool, **given: Any) -> None:
    """Frequency response of DESIGN at a pose, from its exact tangent with gravity and damping.

    Amplitude and phase of the platform's six motions per motion of the base along --axis (transmissibility), per wrench
    (compliance) or per leg command. With --amplitude also by the complete non-linear equations; with --psd also the RMS
    on a base that moves at random.
    """
    with stages(as_json, "frequencies") as report:
        from flexapod.cli.studies.response import compute

        found = compute(*common.machine(design, changes, pose), given, report)
    emit(found, given["out"], as_json)
