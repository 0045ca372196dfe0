"""`flexapod certify`: a bound that is proved at every pose of a box or a path, or checked anew."""

from __future__ import annotations

from typing import Any

import click

from flexapod.cli.options import common
from flexapod.cli.options.certify import Options, claim_options, region_options, run_options
from flexapod.cli.output.interrupt import answer
from flexapod.cli.output.results import emit
from flexapod.cli.output.stages import stages

#: What became of the claim -> exit code.
CODES = {"proved": 0, "refuted": 1, "undecided": 3}


@click.command()
@click.argument("design", type=common.DesignName(), required=False)
@claim_options
@region_options
@run_options
@common.set_option
@common.joint_option
@common.json_option
def command(**given: Any) -> None:
    """Prove a bound on the stability index of DESIGN at every pose of a box or a path, or find a pose that breaks it.

    The exit code is 0 where it is proved, 1 where it is refuted, 3 where the time was up before.

    \b
    flexapod certify motion-base --around 0.05 5 --at-least 4Hz
    flexapod certify motion-base --around 0.05 5 --gap 1%
    flexapod certify --check motion-base-certificate.json
    """
    options = Options(**given)
    place = common.place(options.out, options.as_json)
    with stages(options.as_json, "decided, by volume") as report:
        from flexapod.cli.studies.certify import compute

        found, kept = compute(options, None if options.check else place, report)
    emit(found, place, options.as_json, more=kept)
    answer(CODES[found.data["status"]])
