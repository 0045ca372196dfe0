"""`flexapod path`: the stability index along a path, or a path that keeps it above a bound."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.path import Options, path_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.design_argument
@path_options
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """The stability index, leg forces and travel along a path of DESIGN, from FILE or planned.

    FILE is CSV with the columns t, x, y, z, roll, pitch, yaw (s, m, degrees) and, if wanted, weight.

    \b
    flexapod path mukherjee-i waypoints.csv --bound 150
    flexapod path mukherjee-i --from 0 0 0.89 0 -33 -10 --to 0 0 0.89 0 45 53 --bound 110 --out path
    """
    from flexapod.cli.studies.path import compute

    options = Options(**given)
    with stages(options.as_json) as report:
        found = compute(options, report)
    emit(found, options.out, options.as_json)
