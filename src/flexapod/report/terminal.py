"""The report in the terminal: the same findings, in short."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table
from rich.text import Text

from flexapod.conventions import TWO_PI
from flexapod.report.findings import Findings
from flexapod.report.influence import leading
from flexapod.report.numbers import percent, pose_words, shown

if TYPE_CHECKING:
    from rich.console import Console

SHOWN = {"geometry": 2, "mass": 2, "stiffness": 1}  # so many sensitivities of each kind


def summary(f: Findings, out: Console) -> None:
    """Print the summary."""
    changed = f" with {', '.join(f.changes)}" if f.changes else ""
    out.print(Text.assemble((f.hexapod.name, "bold"), f"{changed} at {pose_words(f.pose)}, joint model {f.joint}"))
    out.print()
    out.print(_key(f))
    out.print(_frequencies(f))
    out.print(_legs(f))
    if f.influences:
        out.print(Text("What matters most for the index", style="bold"))
        out.print(_influences(f))
    for caution in f.cautions:
        out.print(Text.assemble(("Warning: ", "bold yellow"), caution.text))


def _key(f: Findings) -> Table:
    table = Table.grid(padding=(0, 2))
    index = f"{shown(f.omega[0], 6)} rad/s = {shown(f.omega[0] / TWO_PI, 5)} Hz"
    c = f.conditioning
    table.add_row("Dynamic stability index", Text(index, style="bold"))
    table.add_row(
        "Condition number of H",
        f"{shown(c.metres, 5)} in metres, {shown(c.scaled)} with moments over {shown(c.length, 3)} m",
    )
    table.add_row("Sampling time at most", f"{shown(1e3 * f.sampling_time, 3)} ms")
    return table


def _frequencies(f: Findings) -> Table:
    table = Table()
    for title in ("mode", "rad/s", "Hz", "tangent\nrad/s", "damping\nratio"):
        table.add_column(title, justify="right", no_wrap=True)
    table.add_column("motion")
    for i, description in enumerate(f.descriptions):
        tangent, ratio = (f.damped.omega[i], f.damped.damping_ratio[i]) if f.damped else (None, None)
        numbers = (shown(f.omega[i], 6), shown(f.omega[i] / TWO_PI, 5), shown(tangent, 6), shown(ratio, 3))
        table.add_row(str(i + 1), *numbers, Text(description.text.split(", turning")[0]))
    return table


def _legs(f: Findings) -> Table:
    table = Table()
    for title in ("leg", "length\nmm", "static force\nN", "universal\ndeg", "spherical\ndeg"):
        table.add_column(title, justify="right", no_wrap=True)
    angles = np.degrees([f.angles.universal, f.angles.spherical])
    for i in range(6):
        force = f.rest.leg_force[i] if f.rest else None
        degrees = (f"{angles[0, i]:.2f}", f"{angles[1, i]:.2f}")
        table.add_row(str(i + 1), shown(1e3 * f.leg_length[i], 6), shown(force), *degrees)
    return table


def _influences(f: Findings) -> Table:
    table = Table.grid(padding=(0, 2))
    for one in leading(f.influences or [], SHOWN):
        table.add_row("  " + one.change, Text(percent(one.effect, 3), justify="right"))
    return table
