"""`flexapod animate`: a mode as a moving picture."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli.options import common
from flexapod.cli.output.stages import stages
from flexapod.output_files import check_file
from flexapod.report.numbers import file_name, pose_numbers

if TYPE_CHECKING:
    from flexapod.conventions import JointModel


@click.command()
@common.machine_options
@click.option(
    "--mode", type=click.IntRange(1, 6), default=1, show_default=True, help="Number of the mode, lowest first."
)
@common.exaggeration_option
@click.option(
    "--out",
    type=common.FILE,
    default=None,
    metavar="FILE",
    help="A .gif, or an .mp4 with the extra 'video'. Default: <design>-mode-<number>.gif here.",
)
@common.json_option
def command(
    design: str,
    pose: tuple[float, ...] | None,
    changes: tuple[str, ...],
    joint: JointModel,
    mode: int,
    exaggeration: float | None,
    out: Path | None,
    as_json: bool,
) -> None:
    """Animate a mode of DESIGN at a pose, its largest joint motion taken as 1 um. (In time: simulate --animate.)"""
    hexapod, where = common.machine(design, changes, pose)
    path = Path(f"{file_name(hexapod.name)}-mode-{mode}.gif") if out is None else out
    check_file(path)
    with stages(as_json, "frames") as report:
        from flexapod.plots.animation import animate_mode  # and with it Matplotlib

        told = partial(report, "frames")
        factor = animate_mode(hexapod, where, mode, path, joint=joint, exaggeration=exaggeration, progress=told)
    if as_json:
        found = {"design": hexapod.name, "mode": mode, "exaggeration": factor, "file": str(path)}
        common.print_json({**found, "pose_m_deg": pose_numbers(where)})
    else:
        click.echo(f"Wrote {path}: mode {mode}, motion shown {factor:.6g} times larger")
