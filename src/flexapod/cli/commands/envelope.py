"""`flexapod envelope`: how far a machine moves from home, what stops it, and how fast it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.points import point_option
from flexapod.cli.options.quantities import FREQUENCY, POSITIVE_LENGTH, SIX
from flexapod.cli.output.results import emit_or_csv
from flexapod.cli.output.stages import stages

if TYPE_CHECKING:
    from flexapod.report.study import Study


@click.command()
@common.design_argument
@common.pose_option
@point_option("Point of the platform that is moved and turned about")
@click.option(
    "--proportions",
    type=SIX,
    default=None,
    metavar="X Y Z ROLL PITCH YAW",
    help="Half ranges (m, degrees) of the box whose largest multiple is sought. Default: the travels of the axes.",
)
@click.option("--index", type=FREQUENCY, metavar="RAD_S", help="Least natural frequency that motions may have.")
@click.option("--condition", type=common.POSITIVE, metavar="C", help="Most that cond(H) may be.")
@click.option(
    "--characteristic-length",
    type=POSITIVE_LENGTH,
    default=None,
    metavar="M",
    help="Divide the moment rows of H by this length before --condition is applied.",
)
@click.option("--csv", "as_csv", is_flag=True, help="Print the table of the axes as CSV, in m and rad.")
@common.set_option
@common.joint_option
@common.out_option("Where to write the report, the figure and the tables. Default: nothing is written.")
@figures.options("--out")
@common.json_option
def command(**given: Any) -> None:
    """How far DESIGN moves from home along each axis, each two, and all in combination, and what stops it.

    Strokes, joint angles, distances of legs, static leg forces, singular poses, and the bounds given stop motions. With
    limits of leg rate, acceleration, force or power in the design: how fast it is along each axis.

    \b
    flexapod envelope motion-base --out envelope
    flexapod envelope motion-base --proportions 0.25 0.25 0.2 20 20 25 --index 20
    flexapod envelope motion-base --csv > specification.csv
    """
    as_json, as_csv = given["as_json"], given["as_csv"]

    def found() -> Study:
        with stages(as_json or as_csv, "motions from home"):
            from flexapod.cli.studies.envelope import Options, compute

            return compute(Options(**given))

    emit_or_csv(found, given["out"], as_json, "envelope.csv" if as_csv else None)
