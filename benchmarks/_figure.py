"""The figure of all tools: how many times as long as Flexapod each takes, task by task, on a logarithmic axis."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from benchmarks._contest import OURS
from benchmarks._results import FIGURE, Results, duration, times
from flexapod.plots.style import FAINT, INK, PLATFORM, STRETCHED

SLOWER, QUICKER, OWN = "#6b7785", STRETCHED, PLATFORM
STYLE = {"svg.hashsalt": "flexapod", "svg.fonttype": "none", "font.size": 9, "font.family": "sans-serif"}
BLANK = {"facecolor": "white", "lw": 0, "pad": 1.5}  # behind words, so that no line runs through them
ROW, TITLE, GAP = 0.62, 0.6, 0.35  # heights in the axes' units: a bar, a task's title, the room below a task


def save(results: Results, directory: Path) -> None:
    """Write the figure as PNG and SVG; nothing, if there is nothing to compare."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    tasks = [(task, records) for task, records in results.tasks() if len(records) > 1]
    if not tasks:
        return
    height = sum(TITLE + GAP + ROW * (len(records) - 1) for _, records in tasks)
    with rc_context(STYLE):
        figure = Figure(figsize=(8.2, 0.36 * height + 0.9), layout="constrained")
        ax = figure.subplots()
        y = 0.0
        for task, records in tasks:
            y = _task(ax, y, task, records)
        _frame(ax, results, y)
        for kind in ("png", "svg"):
            metadata = {"Date": None} if kind == "svg" else None
            path = directory / f"{FIGURE}.{kind}"
            figure.savefig(path, dpi=160, facecolor="white", bbox_inches="tight", metadata=metadata)


def _task(ax: Any, y: float, task: str, records: list[Any]) -> float:
    """Bars of one task from height y downwards; where they end."""
    own, unit = records[0], records[0].unit
    y -= TITLE
    words = f"{task}: {duration(own.time)} a {unit} ({own.how})"
    ax.text(0, y, words, transform=ax.get_yaxis_transform(), color=OWN, fontweight="bold", va="center", bbox=BLANK)
    for r in records[1:]:  # Flexapod's own is the blue line
        y -= ROW
        colour = OWN if r.tool == OURS else SLOWER if r.ratio >= 1 else QUICKER
        ax.barh(y, r.ratio - 1, left=1, height=0.75 * ROW, color=colour, lw=0)
        label = f"{times(r.ratio)} ×   {duration(r.time)}   {r.how}"
        ax.text(1.05 * max(r.ratio, 1), y, label, color=INK, va="center", fontsize=7.5, bbox={**BLANK, "pad": 0.5})
        ax.text(-0.01, y, r.tool, transform=ax.get_yaxis_transform(), color=INK, ha="right", va="center")
    return y - GAP


def _frame(ax: Any, results: Results, bottom: float) -> None:
    ratios = [r.ratio for r in results.records]
    ax.set_xscale("log")
    ax.set_xlim(min(0.5, 0.8 * min(ratios)), 300 * max(10, *ratios))  # room for the words to the right of the bars
    ax.set_ylim(bottom, 0)
    ax.axvline(1, color=OWN, lw=1.5)
    powers = range(0, 8)
    ax.set_xticks([10.0**p for p in powers if 10**p <= 3 * max(ratios)], minor=False)
    ax.xaxis.set_major_formatter(lambda x, _: f"{x:g} ×")
    ax.minorticks_off()
    ax.grid(axis="x", color=FAINT, lw=0.4, alpha=0.6)
    ax.set_axisbelow(True)
    ax.set_yticks([])
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)
    ax.set_xlabel(f"time over Flexapod's, which is written in blue; {results.machine['processor']}")
