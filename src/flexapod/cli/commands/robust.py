"""`flexapod robust`: how far the stability index strays when parts of the design are uncertain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from flexapod.cli.options import common, figures
from flexapod.cli.options.optimise import out_option, threads_option, where_options
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages


@click.command()
@common.design_argument
@click.option(
    "--uncertain",
    multiple=True,
    metavar="KEY=SPREAD[%][,DISTRIBUTION][,together]",
    help="A number of the design that strays: legs.stiffness=10% or platform.mass=50,normal. Uniform by default: plus "
    "and minus the spread; also normal, lognormal, triangular. Legs stray one by one, unless `together`. Repeatable.",
)
@click.option("--payload", metavar="LEAST:LARGEST", help="Mass (kg) of a load on the platform beyond the design's.")
@click.option(
    "--payload-at",
    nargs=3,
    metavar="X Y Z",
    help="Where it is in the platform frame (m): each a number or LEAST:LARGEST. Default: its origin.",
)
@where_options
@click.option("--samples", type=common.count(2), default=2**14, show_default=True, help="Designs to draw.")
@click.option("--poses", type=common.count(1, 10**6), default=256, show_default=True, help="Poses of a workspace.")
@click.option(
    "--sensitivity",
    type=common.count(0, 10**6),
    default=1024,
    show_default=True,
    help="Base samples of the Sobol analysis, a power of two; 0 leaves it out.",
)
@click.option("--all-poses", is_flag=True, help="Let poses beyond the design's limits count as well.")
@click.option("--seed", type=common.SEED, default=0, show_default=True)
@threads_option
@out_option
@figures.options()
@common.set_option
@common.joint_option
@common.json_option
def command(design: str, changes: tuple[str, ...], out: Path | None, as_json: bool, **given: Any) -> None:
    """Distribution and worst case of the stability index of DESIGN, and which uncertain parameter matters most.

    \b
    flexapod robust motion-base --uncertain legs.stiffness_law.bulk_modulus=15% --uncertain platform.mass=5%,normal
    flexapod robust motion-base --payload 0:500 --payload-at -0.5:0.5 -0.5:0.5 0.5:1.5
    """
    place = common.place(out, as_json)
    with stages(as_json, "designs") as report:
        from flexapod.cli.studies.robust import compute

        found = compute(common.load_design(design, changes), given, report)
    emit(found, place, as_json)
