"""`flexapod statics`: load cases at rest, such as the elevations of a telescope."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.points import point_option
from flexapod.cli.output.results import emit_or_csv
from flexapod.cli.output.stages import stages

if TYPE_CHECKING:
    from flexapod.report.study import Study


@click.command()
@common.design_argument
@click.argument("file", type=common.GIVEN_FILE, required=False)
@common.pose_option
@click.option(
    "--elevation",
    metavar="FIRST:LAST:COUNT",
    help="Angles of the base's z axis above the horizon, degrees, or one: 90 is the zenith. Its y axis goes downhill.",
)
@click.option("--base-roll", metavar="DEG", help="Turn of the base about its z axis, degrees, at these elevations.")
@click.option(
    "--reference",
    metavar="CASE",
    help="Case, by its name, for which the leg lengths are set. Default: without weight and load.",
)
@point_option("Point of the platform whose deflection and stiffness are told")
@click.option(
    "--axes",
    type=click.Choice(["platform", "base"]),
    default="platform",
    show_default=True,
    help="Axes of the forces and moments in FILE: those of the platform, or of the base.",
)
@click.option("--csv", "as_csv", is_flag=True, help="Print the cases as CSV, in SI units.")
@common.set_option
@common.joint_option
@common.out_option("Where to write the report, the figure and the tables. Default: nothing is written.")
@figures.options("--out")
@common.json_option
def command(out: Path | None, as_json: bool, as_csv: bool, **given: Any) -> None:
    """Leg forces, deflections and stiffness of DESIGN at rest in many load cases, from --elevation or FILE.

    FILE is CSV with a row for each case. Columns, each if wanted: case; elevation, base_roll (degrees) or gravity_x,
    gravity_y, gravity_z (m/s2, base frame); force_x, force_y, force_z (N), moment_x, moment_y, moment_z (N m); at_x,
    at_y, at_z (m, platform frame), the point of the force; x, y, z, roll, pitch, yaw (m, degrees), the pose. Titles may
    name other units, as force_x_kN.

    \b
    flexapod statics motion-base --elevation 90:15:6 --reference 90 --point 0 0 0.5 --out statics
    flexapod statics motion-base cases.csv --csv
    """

    def found() -> Study:
        with stages(as_json or as_csv, "load cases"):
            from flexapod.cli.studies.statics import Options, compute

            return compute(Options(**given))

    emit_or_csv(found, out, as_json, "statics.csv" if as_csv else None)
