"""Colours and axes of all figures. The colours are told apart by colour-blind readers and on light and dark paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

INK = "#20262d"  # words and numbers
FAINT = "#8a929b"  # what is there for orientation only
BASE = "#6b7785"
PLATFORM = "#0072b2"  # from here on: the palette of Okabe and Ito
LEG = "#4a5460"
STRETCHED = "#d55e00"
SHORTENED = "#56b4e9"
AXES = (("x", "#d55e00"), ("y", "#009e73"), ("z", "#0072b2"))
VIEW = {"elev": 20.0, "azim": -62.0}


def dress(ax: Axes) -> None:
    """Quiet axes, as in all figures."""
    ax.grid(True, which="major", color=FAINT, lw=0.3, alpha=0.6)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.tick_params(which="both", color=FAINT, labelcolor=INK, labelsize=9)
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_color(INK)
