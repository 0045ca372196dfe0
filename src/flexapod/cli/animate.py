"""`flexapod animate`: a mode as a moving picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from flexapod.cli import common

if TYPE_CHECKING:
    from flexapod.states import JointModel


@click.command()
@common.design_argument
@common.pose_option
@common.set_option
@common.joint_option
@click.option(
    "--mode", type=click.IntRange(1, 6), default=1, show_default=True, help="Number of the mode, lowest first."
)
@click.option(
    "--exaggeration",
    type=click.FloatRange(min=0, min_open=True),
    default=None,
    help="How many times larger a joint motion of 1 um is shown. Default: so that it is seen well.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
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
    """Animate a mode of DESIGN at a pose. (A simulation: `animate_simulation` of the library.)"""
    hexapod = common.load_design(design, changes)
    where = common.chosen_pose(hexapod, pose)
    from flexapod.animate import animate_mode

    path = Path(f"{hexapod.name}-mode-{mode}.gif") if out is None else out
    factor = animate_mode(hexapod, where, mode, path, joint=joint, exaggeration=exaggeration)
    if as_json:
        found = {"design": hexapod.name, "mode": mode, "exaggeration": factor, "file": str(path)}
        common.print_json({**found, "pose_m_deg": common.pose_numbers(where)})
    else:
        click.echo(f"Wrote {path}: mode {mode}, motion shown {factor:,.6g} times larger")
