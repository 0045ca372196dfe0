"""A sweep over poses, its summary and its worst pose, as a study."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod import plots
from flexapod.conventions import AXES, Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.cautions import Caution
from flexapod.mechanics.load_limits import motion_limits_words
from flexapod.report.studies import least_index
from flexapod.report.study import Column, Drawing, Row, Section, Study, Table
from flexapod.workspace.summary import At, SweepSummary
from flexapod.workspace.worst import WorstPose

if TYPE_CHECKING:
    import xarray as xr

POSE_HEAD = ("x m", "y m", "z m", "roll°", "pitch°", "yaw°")


def study(
    hexapod: Hexapod,
    sweep: xr.Dataset,
    out: Path | None,
    summary: SweepSummary | None,
    worst: WorstPose | None,
    *,
    all_poses: bool = False,
    notes: Sequence[str] = (),
) -> Study:
    """The study of a sweep. out: where it was written; summary, worst: where asked for; all_poses: see `summarise`;
    notes: what of these there is not, and why."""
    data: dict[str, Any] = {"attributes": dict(sweep.attrs), "out": None if out is None else str(out)}
    rows, tables = [], []
    within = " within the limits" if "within_limits" in sweep and not all_poses else ""
    if summary is not None:
        data["summary"] = {**_summary_data(summary), "all_poses": all_poses}
        rows += _summary_rows(summary, within)
        tables += [_extremes(summary, within), _quantiles(summary, within)]
    if worst is not None:
        data["worst_pose"] = _worst_data(worst)
        rows += _worst_rows(worst, within)
    drawing = Drawing(
        "sweep", f"The index over the poses{within}", lambda: plots.sweep.auto(sweep, all_poses=all_poses)
    )
    return Study(
        hexapod=hexapod,
        subject="sweep",
        about=f"A sweep over {next(iter(sweep.data_vars.values())).size} poses.",
        data=data,
        rows=rows,
        sections=[Section(drawing.title, [drawing, *tables])],
        cautions=[*(Caution("no_pose_counts", note) for note in notes), *_cautions(hexapod, sweep, summary, worst)],
        dataset=sweep,
    )


def _cautions(
    hexapod: Hexapod, sweep: xr.Dataset, summary: SweepSummary | None, worst: WorstPose | None
) -> list[Caution]:
    least = worst.pose if worst is not None else None if summary is None else summary.worst.pose
    words = motion_limits_words(hexapod.limits)
    unjudged = [Caution("motion_limits", words)] if words else []
    return [*unjudged, *([] if least is None else least_index.cautions(hexapod, least, sweep.attrs["joint"]))]


def pose_text(pose: Array) -> str:
    """x, y, z in m and roll, pitch, yaw in degrees."""
    x, y, z, *angles = pose
    return f"({x:.5g}, {y:.5g}, {z:.5g}) m, ({', '.join(f'{math.degrees(a):.4g}' for a in angles)})°"


def _summary_rows(summary: SweepSummary, within: str) -> list[Row]:
    """within: what the poses that count are called, after "poses"."""
    statuses = ", ".join(f"{count} {word}" for word, count in summary.statuses.items())
    rows = [Row(f"{summary.poses} poses:", statuses)]
    if summary.within_limits is not None:
        share = f"{summary.within_limits} of {summary.poses} poses ({summary.within_limits / summary.poses:.3%});"
        rest = "what follows is of these" if within else "what follows is of all poses, also of those beyond the limits"
        rows.append(Row("within the design's limits:", share, note=rest))
    if not math.isnan(summary.correlation):
        spread = f"; at equal cond(H) the 95 % quantile of ω1 is {summary.spread:.3g} times the 5 % quantile"
        told = f"{summary.correlation:.3f}{spread if math.isfinite(summary.spread) else ''}"
        rows.append(Row("rank correlation of ω1 with cond(H):", told))
    if summary.above is not None:
        above = summary.above
        volume = "" if math.isnan(above.volume) else f", {above.volume:.5g} {above.volume_unit}"
        whole = f"the poses{within}" if within else "the workspace"
        share = f"{above.fraction:.3%} of {whole} (± {above.standard_error:.3%}){volume}"
        rows.append(Row(f"ω1 ≥ {above.omega_1:g} rad/s:", share))
    return rows


def _worst_rows(worst: WorstPose, within: str) -> list[Row]:
    where, label = f"at {pose_text(worst.pose)}", f"worst of the box{within}:"
    if worst.singular:
        first = Row(label, f"singular, ω1 = 0, {where}")
    else:
        edge = f", at the bounds of {', '.join(worst.at_bounds)}" if worst.at_bounds else ""
        limits = f", at limits: {', '.join(worst.at_limits)}" if worst.at_limits else ""
        first = Row(label, f"ω1 = {worst.omega_1:.8g}", "rad/s", note=where + edge + limits)
    told = (
        f"descents ended there; {len(worst.minima)} local minima; least of the sweep before: {worst.sampled:.6g} rad/s"
    )
    return [first, Row(f"{worst.agreed} of {worst.starts}", told)]


def _extremes(summary: SweepSummary, within: str) -> Table:
    all_of_them = {
        "worst ω1": summary.worst,
        "best ω1": summary.best,
        "least cond": summary.best_conditioned,
        "most cond": summary.worst_conditioned,
    }
    found = {words: at for words, at in all_of_them.items() if at is not None}
    poses = [[f"{v:.3g}" for v in (*at.pose[:3], *np.degrees(at.pose[3:]))] for at in found.values()]
    columns = [
        Column("", list(found)),
        Column("ω1 rad/s", [f"{at.omega_1:.5g}" for at in found.values()]),
        Column("cond(H)", [f"{at.cond_H:.4g}" for at in found.values()]),
        *(Column(title, [pose[i] for pose in poses]) for i, title in enumerate(POSE_HEAD)),
    ]
    return Table(columns, title=f"Extremes{within}")


def _quantiles(summary: SweepSummary, within: str) -> Table:
    columns = [Column(f"{q:.0%}", [f"{value:.5g}"]) for q, value in summary.quantiles.items()]
    return Table(columns, title=f"Quantiles of ω1{within}, rad/s")


def _summary_data(summary: SweepSummary) -> dict[str, Any]:
    """A summary in plain numbers, SI."""
    found: dict[str, Any] = summary._asdict()
    for name in ("worst", "best", "best_conditioned", "worst_conditioned"):
        found[name] = _at_data(found[name])
    found["quantiles"] = {f"{q:g}": value for q, value in summary.quantiles.items()}
    found["above"] = None if summary.above is None else summary.above._asdict()
    return found


def _at_data(at: At | None) -> dict[str, Any] | None:
    if at is None:
        return None
    return {**at._asdict(), "pose": dict(zip(AXES, at.pose.tolist(), strict=True))}


def _worst_data(worst: WorstPose) -> dict[str, Any]:
    """A refined worst pose in plain numbers, SI."""
    found: dict[str, Any] = worst._asdict()
    found["pose"] = dict(zip(AXES, worst.pose.tolist(), strict=True))
    found["minima"] = [{"omega_1": omega, "pose": pose.tolist()} for omega, pose in worst.minima]
    return found
