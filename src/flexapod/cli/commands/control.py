"""`flexapod control`: a control law on a machine at a pose: poles, gains, isolation, and a run on a moving base."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.control import Options, law_options, run_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.machine_options
@law_options
@run_options
@figures.options("--out")
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
    with stages(options.as_json, "design") as report:
        from flexapod.cli.studies.control import compute

        found = compute(options, report)
    emit(found, options.out, options.as_json)
