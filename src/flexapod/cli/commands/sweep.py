"""`flexapod sweep`: the stability index and other quantities over many poses."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.sweep import Options, machine_options, output_options, poses_options, reading_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.design_argument
@poses_options
@output_options
@machine_options
@reading_options
@figures.options("--figure")
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """Stability index, cond(H) and more over many poses of DESIGN.

    \b
    flexapod sweep mukherjee-i --around 0.1 20 --points 1000000
    flexapod sweep mukherjee-i --grid x=-0.1:0.3:81,y=0:0.4:81 --figure map.png
    flexapod sweep mukherjee-i --around 0.1 20 --points 100000000 --out map.zarr
    """
    options = Options(**given)
    with stages(options.as_json, "" if options.streamed else "sweep") as report:  # a store has a bar of its own
        from flexapod.cli.studies.sweep import compute

        found = compute(options, report)
    emit(found, None, options.as_json, listed="")
