"""`flexapod report`: everything about a machine at a pose, in the terminal and as one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.output.results import emit

if TYPE_CHECKING:
    from flexapod.conventions import JointModel


@click.command()
@common.machine_options
@common.characteristic_length_option
@common.out_option("Where to write the HTML file; made if it is not there. Default: here; with --json: no file.")
@common.json_option
def command(
    design: str,
    pose: tuple[float, ...] | None,
    changes: tuple[str, ...],
    joint: JointModel,
    characteristic_length: float | None,
    out: Path | None,
    as_json: bool,
) -> None:
    """Report the dynamic stability of DESIGN at a pose: a summary here, and a page for the browser.

    DESIGN is a packaged design's name (see `flexapod designs`) or the path of a .toml file.
    """
    from flexapod.report.findings import gather
    from flexapod.report.studies.machine import study

    hexapod, where = common.machine(design, changes, pose)
    place = common.place(out, as_json)
    found = gather(hexapod, where, joint=joint, characteristic_length=characteristic_length, changes=changes)
    emit(study(found), place, as_json, listed="html")
