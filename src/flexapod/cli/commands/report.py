"""`flexapod report`: everything about a machine at a pose, in the terminal and as one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common

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
    hexapod, where = common.machine(design, changes, pose)
    from flexapod.report import findings

    found = findings.gather(hexapod, where, joint, characteristic_length, changes)
    file = None
    if out is not None or not as_json:
        directory = common.output_directory(Path() if out is None else out)
        file = directory / f"{common.file_name(hexapod.name)}.html"
    if not as_json:
        from flexapod.report.terminal import summary

        summary(found, common.console())
    if file is not None:
        from flexapod.report.page import page

        common.write_file(file, page(found))
    if as_json:
        common.print_json({**findings.as_dict(found), "html": None if file is None else str(file)})
    else:
        click.echo(f"Report: {file}")
