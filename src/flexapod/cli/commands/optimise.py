"""`flexapod optimise`: a better design, or the front of the best ones."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.optimise import Options, optimise_options
from flexapod.cli.output.results import emit


@click.command()
@common.design_argument
@optimise_options
@figures.options()
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """Raise the stability index of DESIGN within constraints, and verify the result on a denser sweep.

    \b
    flexapod optimise mukherjee-ii --around 0.005 5 --keep footprint --keep stroke \\
        --vary base.circle.radius_mm=20:32 --vary platform.circle.radius_mm=30:60 \\
        --vary base.circle.half_angle_deg=5:55 --vary home.position_mm[2]=70:100
    """
    from flexapod.cli.studies.optimise import compute

    options = Options(**given)
    place = common.place(options.out, options.as_json)
    emit(compute(options), place, options.as_json)
