"""Summaries of sweeps as people and programs read them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from flexapod.cli.options import common
from flexapod.conventions import AXES, Array

if TYPE_CHECKING:
    from flexapod.workspace.summary import At, SweepSummary
    from flexapod.workspace.worst import WorstPose

POSE_HEAD = ("x m", "y m", "z m", "roll°", "pitch°", "yaw°")


def pose_text(pose: Array) -> str:
    """x, y, z in m and roll, pitch, yaw in degrees."""
    x, y, z, *angles = pose
    return f"({x:.5g}, {y:.5g}, {z:.5g}) m, ({', '.join(f'{math.degrees(a):.4g}' for a in angles)})°"


def print_summary(summary: SweepSummary) -> None:
    """Tables on standard output."""
    from rich.table import Table

    console = common.console()
    statuses = ", ".join(f"{count} {word}" for word, count in summary.statuses.items())
    console.print(f"{summary.poses} poses: {statuses}")
    table = Table("", "ω1 rad/s", "cond(H)", *POSE_HEAD, box=None, pad_edge=False)
    for words, at in (
        ("worst ω1", summary.worst),
        ("best ω1", summary.best),
        ("least cond", summary.best_conditioned),
        ("most cond", summary.worst_conditioned),
    ):
        if at is not None:
            pose = [f"{v:.3g}" for v in (*at.pose[:3], *map(math.degrees, at.pose[3:]))]
            table.add_row(words, f"{at.omega_1:.5g}", f"{at.cond_H:.4g}", *pose)
    console.print(table)
    quantiles = Table(
        *(f"{q:.0%}" for q in summary.quantiles), title="quantiles of ω1, rad/s", box=None, title_justify="left"
    )
    quantiles.add_row(*(f"{value:.5g}" for value in summary.quantiles.values()))
    console.print(quantiles)
    if not math.isnan(summary.correlation):
        console.print(
            f"rank correlation of ω1 with cond(H): {summary.correlation:.3f}; at equal cond(H) the 95 % quantile of ω1 "
            f"is {summary.spread:.3g} times the 5 % quantile"
        )
    if summary.above is not None:
        above = summary.above
        volume = "" if math.isnan(above.volume) else f", {above.volume:.5g} {above.volume_unit}"
        console.print(
            f"ω1 ≥ {above.omega_1:g} rad/s: {above.fraction:.3%} of the workspace "
            f"(± {above.standard_error:.3%}){volume}"
        )


def print_worst(worst: WorstPose) -> None:
    """The refined worst pose on standard output."""
    console = common.console()
    where = f"at {pose_text(worst.pose)}"
    if worst.singular:
        console.print(f"worst of the box: singular, ω1 = 0, {where}")
    else:
        edge = f", at the bounds of {', '.join(worst.at_bounds)}" if worst.at_bounds else ""
        console.print(f"worst of the box: ω1 = {worst.omega_1:.8g} rad/s {where}{edge}")
    console.print(
        f"{worst.agreed} of {worst.starts} descents ended there; {len(worst.minima)} local minima; "
        f"least of the sweep before: {worst.sampled:.6g} rad/s"
    )


def summary_json(summary: SweepSummary) -> dict[str, Any]:
    """A summary in plain numbers, SI."""
    found: dict[str, Any] = summary._asdict()
    for name in ("worst", "best", "best_conditioned", "worst_conditioned"):
        found[name] = _at_json(found[name])
    found["quantiles"] = {f"{q:g}": value for q, value in summary.quantiles.items()}
    found["above"] = None if summary.above is None else summary.above._asdict()
    return found


def _at_json(at: At | None) -> dict[str, Any] | None:
    if at is None:
        return None
    return {**at._asdict(), "pose": dict(zip(AXES, at.pose.tolist(), strict=True))}


def worst_json(worst: WorstPose) -> dict[str, Any]:
    """A refined worst pose in plain numbers, SI."""
    found: dict[str, Any] = worst._asdict()
    found["pose"] = dict(zip(AXES, worst.pose.tolist(), strict=True))
    found["minima"] = [{"omega_1": omega, "pose": pose.tolist()} for omega, pose in worst.minima]
    return found
