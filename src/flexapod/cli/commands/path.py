"""`flexapod path`: the stability index along a path, or a path that keeps it above a bound."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.path import Options, path_options
from flexapod.cli.output.results import emit_or_csv
from flexapod.cli.output.stages import stages

if TYPE_CHECKING:
    from flexapod.report.study import Study


@click.command()
@common.design_argument
@path_options
@figures.options("--out")
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """The stability index, and what the legs do, along a path of DESIGN, from FILE or planned.

    FILE is CSV with the columns t, x, y, z, roll, pitch, yaw (s, m, degrees) and, if wanted, weight.

    \b
    flexapod path mukherjee-i waypoints.csv --bound 150
    flexapod path motion-base motion.csv --from-home --payload 200 0 0 0.5 --payload 400 0 0 0.6 --csv > legs.csv
    flexapod path mukherjee-i --from 0 0 0.89 0 -33 -10 --to 0 0 0.89 0 45 53 --bound 110 --out path
    """
    options = Options(**given)

    def found() -> Study:
        with stages(options.as_json or options.as_csv, "along the path" if options.file else "planning") as report:
            from flexapod.cli.studies.path import compute

            return compute(options, report)

    emit_or_csv(found, options.out, options.as_json, "path.csv" if options.as_csv else None)
