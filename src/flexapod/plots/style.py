"""Colours, axes and titles of all figures.

The colours of curves are those of Okabe and Ito: colour-blind readers tell them apart, on light and dark paper.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
