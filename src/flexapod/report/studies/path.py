"""The short report of a path, planned or given."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from flexapod.design.hexapod import Hexapod
from flexapod.paths.analysis import PathIndex
from flexapod.paths.planning import Plan
from flexapod.paths.trajectory import Trajectory
from flexapod.plots import path as plots_path
from flexapod.pose import Pose
from flexapod.report import html
from flexapod.report.numbers import DASH, pose_words, shown


class PathFindings(NamedTuple):
    """All that is said about a path. beside, plan, plane: of a planned path, where it is not straight."""

    path: Trajectory
    along: PathIndex
    loads: xr.Dataset
    size: float
    beside: PathIndex | None = None
    plan: Plan | None = None
    plane: xr.Dataset | None = None


def page(hexapod: Hexapod, f: PathFindings) -> str:
    """The page as HTML."""
    bound = f.along.bound
    cards = [
        ("Least index on the path", shown(f.along.minimum), "rad/s"),
        ("Bound", shown(bound) if bound else DASH, "rad/s" if bound else "none given"),
        ("Weighted mean index", shown(f.along.weighted_mean), "rad/s"),
        ("Duration", shown(f.path.duration, 3), "s"),
        ("Length", shown(f.path.length(f.size), 3), "m"),
        ("Largest leg force", shown(float(f.loads.peak_force.max())), "N"),
    ]
    what = f"planned from {pose_words(_end(f.path, 0))} to {pose_words(_end(f.path, -1))}" if f.plan else "as given"
    subtitle = f"A path of {len(f.path.times)} waypoints, {what}. One radian counts as {shown(f.size, 3)} m of length."
    sections = [html.beware(cautions(f)), _index(f), _plane(f), _loads(f), _legs(f)]
    return html.short(hexapod, "path", subtitle, cards, sections)


def cautions(f: PathFindings) -> list[str]:
    """What to beware of on the path."""
    found = []
    if f.along.below and f.along.bound is not None:
        spans = ", ".join(f"{a:.4g} to {b:.4g} s" for a, b in f.along.below)
        found.append(f"The index lies below the bound of {f.along.bound:.5g} rad/s from {spans}.")
    outside = ~f.loads.within_limits.values
    if outside.any():
        first = float(f.loads.time.values[outside][0])
        found.append(f"The path leaves the design's limits for {outside.mean():.0%} of it, first at {first:.4g} s.")
    return found


def _index(f: PathFindings) -> str:
    where = f"The least, {shown(f.along.minimum)} rad/s, is at {f.along.minimum_time:.4g} s. "
    note = "Dashed: the straight line between the same poses." if f.beside else ""
    return html.drawing(
        lambda: plots_path.index_along(f.along, f.beside), "index", "The stability index along the path", where + note
    )


def _plane(f: PathFindings) -> str:
    if f.plane is None:
        return ""
    plane = f.plane
    words = (
        "The plane through start, goal and the point of the path that lies farthest from the straight line; elsewhere "
        "the path is shown projected on it. Rotations count as length."
    )
    return html.drawing(lambda: plots_path.plan_map(plane), "plane", "Round the weak region", words)


def _loads(f: PathFindings) -> str:
    words = "Forces from the full dynamics; positive pushes the platform from the base. Thin lines: the forces at rest."
    return html.drawing(lambda: plots_path.loads(f.loads), "loads", "Leg forces and travel", words)


def _legs(f: PathFindings) -> str:
    loads = f.loads
    rows = [
        [
            str(leg),
            shown(1e3 * float(loads.stroke[i])),
            shown(float(np.abs(loads.leg_rate[:, i]).max())),
            shown(float(np.abs(loads.leg_acceleration[:, i]).max())),
            shown(float(loads.peak_force[i])),
            shown(float(np.abs(loads.power[:, i]).max())),
        ]
        for i, leg in enumerate(loads.leg.values)
    ]
    head = ["leg", "travel, mm", "fastest, m/s", "acceleration, m/s\u00b2", "peak force, N", "peak power, W"]
    return "<h2>Legs</h2>\n" + html.table(head, rows)


def _end(path: Trajectory, which: int) -> Pose:
    return path.waypoints[which]
