"""Short reports of an optimal design, of a Pareto front, and of robustness."""

from __future__ import annotations

from html import escape

import numpy as np

from flexapod.conventions import TWO_PI
from flexapod.design.hexapod import Hexapod
from flexapod.optimisation.design_search import Check, OptimalDesign
from flexapod.optimisation.pareto import ParetoFront
from flexapod.optimisation.uncertainty import Robustness
from flexapod.plots import optimisation
from flexapod.report.html import beware, drawing, short, table
from flexapod.report.numbers import brief, percent, shown


def optimal_page(found: OptimalDesign, objective: str) -> str:
    """What was found, from what, and how it was verified."""
    cards = [
        ("Index, verified", shown(found.index, 5), f"rad/s = {shown(found.index / TWO_PI, 4)} Hz"),
        ("Design begun with", shown(found.start_index, 5), "rad/s"),
        ("Gain", percent(found.gain), "of the index"),
        ("Trials", str(found.history.sizes["trial"]), f"in {brief(found.seconds, 3)} s"),
    ]
    bounds = [
        [
            escape(name),
            shown(value, 6) + (" (on its bound)" if name in found.at_bounds else ""),
        ]
        for name, value in found.variables.items()
    ]
    worst = found.verification.pose
    where = "" if worst is None else f" It is least at {_six(worst)}."
    sections = [
        beware(_cautions(found)),
        drawing(
            lambda: optimisation.plan(found), "plan", "The two designs", f"Both at home. Raised: {objective}.{where}"
        ),
        f"<h2>Variables</h2>\n{table(['variable', 'value'], bounds, 'In the unit of each key; SI where it has none.')}",
        _constraints(found.verification.checks, found.start_checks, found.verification.points),
        drawing(lambda: optimisation.search(found), "search", "The search", "One mark a trial; constraints as above."),
    ]
    return short(found.hexapod, "optimal design", f"Better than {found.start.name}: {objective}.", cards, sections)


def _cautions(found: OptimalDesign) -> list[str]:
    words = []
    if not found.verification.holds:
        broken = ", ".join(c.name for c in found.verification.checks if not c.kept)
        words.append(f"The dense sweep breaks: {broken}. Search with more poses.")
    if found.coincident > 1:
        words.append(
            f"{found.coincident} frequencies meet at the worst pose: to raise the index, all of them must rise."
        )
    if found.at_bounds:
        words.append(f"On their bounds: {', '.join(found.at_bounds)}. Wider bounds may give more.")
    return words


def _constraints(checks: tuple[Check, ...], before: tuple[Check, ...], points: int) -> str:
    if not checks:
        return ""
    rows = []
    for check, was in zip(checks, before, strict=True):
        value = shown(check.value, 5)
        rows.append(
            [
                escape(check.name),
                escape(check.unit),
                shown(was.value, 5),
                value if check.kept else f'<td class="over">{value}</td>',
                f"at {check.side} {shown(check.bound, 5)}",
                percent(check.margin, 1),
            ]
        )
    note = f"Extremes over {points} poses of every workspace that the search has not seen."
    head = ["constraint", "unit", "before", "now", "bound", "margin"]
    return f"<h2>Constraints</h2>\n{table(head, rows, note)}"


def front_page(found: ParetoFront, objective: str) -> str:
    """A Pareto front, its figure and its designs."""
    best = int(np.argmax(found.index))
    cards = [
        ("Highest index", shown(found.index[best], 5), f"rad/s at {shown(found.against[best], 4)} {found.unit}"),
        ("Design begun with", shown(found.start[0], 5), f"rad/s at {shown(found.start[1], 4)} {found.unit}"),
        ("Designs on the front", str(len(found.designs)), ""),
        ("Trials", str(found.history.sizes["trial"]), ""),
    ]
    rows = [
        [str(k + 1), shown(found.index[k], 5), shown(found.against[k], 5), *(shown(v, 5) for v in found.variables[k])]
        for k in range(len(found.designs))
    ]
    head = [
        "design",
        "index, rad/s",
        escape(", ".join(filter(None, (found.name, found.unit)))),
        *map(escape, found.names),
    ]
    sections = [
        drawing(
            lambda: optimisation.front(found),
            "front",
            f"Index against {found.name}",
            "Of the designs on the line none is better in both.",
        ),
        f"<h2>Designs</h2>\n{table(head, rows, 'Variables in the unit of each key; SI where it has none.')}",
    ]
    return short(found.hexapod, "Pareto front", f"Index against {found.name}: {objective}.", cards, sections)


def robust_page(found: Robustness, hexapod: Hexapod, objective: str) -> str:
    """Distribution, worst case, and what matters most."""
    cards = [
        ("Index as designed", shown(found.nominal, 5), "rad/s"),
        ("99 % of designs are above", shown(found.quantiles[0.01], 5), "rad/s"),
        ("Worst case", shown(found.worst, 5), f"rad/s, {percent(found.worst / found.nominal - 1)}"),
        ("Mean and deviation", shown(found.mean, 5), f"± {shown(found.deviation, 3)} rad/s"),
    ]
    worst = [[escape(name), shown(value, 5)] for name, value in found.worst_at.items()]
    sections = [
        drawing(
            lambda: optimisation.spread(found),
            "spread",
            "How the index strays",
            f"{found.samples.sizes['sample']} designs; {objective}.",
        ),
    ]
    if found.sensitivity is not None:
        sections.append(
            drawing(
                lambda: optimisation.importance(found),
                "importance",
                "What matters most",
                "Sobol indices: shares of the variance of the index, with 95 % confidence.",
            )
        )
    sections.append(f"<h2>The worst case</h2>\n{table(['parameter', 'value'], worst, 'In SI units.')}")
    return short(hexapod, "robustness", f"The index where parameters are uncertain: {objective}.", cards, sections)


def _six(pose: np.ndarray) -> str:
    x, y, z = (brief(1e3 * v) for v in pose[:3])
    roll, pitch, yaw = (brief(float(v)) for v in np.degrees(pose[3:]))
    return f"x {x}, y {y}, z {z} mm, roll {roll}, pitch {pitch}, yaw {yaw} deg"
