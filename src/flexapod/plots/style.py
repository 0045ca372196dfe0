"""Colours, axes and titles of all figures.

The colours of curves are those of Okabe and Ito: colour-blind readers tell them apart, on light and dark paper.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

INK = "#20262d"  # words and numbers
FAINT = "#8a929b"  # what is there for orientation only
NO_VALUE = "#d5d9de"
BASE = "#6b7785"
LEG = "#4a5460"

BLUE, ORANGE, GREEN = "#0072b2", "#d55e00", "#009e73"
PURPLE, SKY, AMBER = "#cc79a7", "#56b4e9", "#e69f00"
SIX = (BLUE, ORANGE, GREEN, PURPLE, SKY, AMBER)  # modes, legs
PLATFORM, STRETCHED, SHORTENED = BLUE, ORANGE, SKY
TRIAD = (("x", ORANGE), ("y", GREEN), ("z", BLUE))
DASHED = (0, (5, 2))

VALUES = "viridis"  # even in lightness
VIEW = {"elev": 20.0, "azim": -62.0}
LEGEND: dict[str, Any] = {"fontsize": 9, "framealpha": 0.9, "edgecolor": "none"}
OUTSIDE: dict[str, Any] = {"loc": "outside lower center", "fontsize": 9, "frameon": False}

#: Of the largest curve beside it: what is smaller is symmetry broken by rounding, and is not drawn.
ROUNDING = 1e-9
_PREFIXES = {-15: "f", -12: "p", -9: "n", -6: "\u00b5", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}

#: Titles of the panels of the platform's six motions.
OUTPUT_NAMES = {
    "x": "translation x",
    "y": "translation y",
    "z": "translation z",
    "roll": "rotation about x",
    "pitch": "rotation about y",
    "yaw": "rotation about z",
}


def new_figure(width: float, height: float) -> Figure:
    """A figure of a size in inches, without pyplot."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained", dpi=130)


def entitle(figure: Figure, title: str) -> None:
    """The title above all axes."""
    figure.suptitle(title, color=INK, fontsize=11)


def state_words(attributes: Mapping[str, Any]) -> str:
    """What the title of a response adds where the machine, or its loop, does not stay at rest."""
    state = attributes.get("stability", "stable")
    return "" if state == "stable" else f" ({state}: no motion approaches this)"


def dress(ax: Axes) -> None:
    """Quiet axes, as in all figures."""
    ax.set_axisbelow(True)
    ax.grid(True, which="major", color=FAINT, lw=0.3, alpha=0.6)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.tick_params(which="both", color=FAINT, labelcolor=INK, labelsize=9)
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_color(INK)


def name_panel(ax: Axes, i: int, output: str) -> None:
    ax.set_title(f"({'abcdef'[i]}) {OUTPUT_NAMES[output]}", loc="left", fontsize=10, color=INK)


def moves(curves: NDArray[Any]) -> NDArray[Any]:
    """Which of some curves, the columns of (n, k), are more than rounding beside the largest."""
    import numpy as np

    size = np.abs(curves)
    largest = np.where(np.isfinite(size), size, 0.0).max(axis=0, initial=0.0)
    return largest > ROUNDING * largest.max(initial=0.0)


def panels(figure: Figure, count: int, sharex: bool = False) -> list[Axes]:
    """So many axes, in one row or in two."""
    rows = 1 if count <= 3 else 2
    columns = math.ceil(max(count, 1) / rows)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=sharex).ravel()
    for ax in axes[max(count, 1) :]:
        ax.remove()
    above = axes[:count][-columns:]
    for ax in above:  # with shared axes only the last row has ticks of its own
        ax.tick_params(labelbottom=True)
    return list(axes[: max(count, 1)])


def note_still(figure: Figure, names: Iterable[str], what: str = "no motion") -> None:
    """Names below all panels what has none because it does not move."""
    if names := list(names):
        figure.supxlabel(f"{what}: {', '.join(names)}", x=0.01, ha="left", fontsize=9, color=FAINT)


def prefixed(ax: Axes, unit: str) -> None:
    """Plain numbers along the vertical axis, and its unit with the prefix that makes them so beside it."""
    from matplotlib.ticker import FuncFormatter

    largest = max(map(abs, ax.get_ylim()))
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-9) if largest > 0 else 0
    power = min(max(power, min(_PREFIXES)), max(_PREFIXES))
    ax.yaxis.set_major_formatter(
        FuncFormatter(lambda value, _: f"{value / 10.0**power + 0.0:.6g}".replace("-", "\N{MINUS SIGN}"))
    )
    ax.set_ylabel(f"{_PREFIXES[power]}{unit}")
