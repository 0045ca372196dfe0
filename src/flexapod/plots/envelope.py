"""The figure of an envelope: how far the machine moves along two axes at once."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Rectangle

from flexapod.conventions import TRANSLATIONS
from flexapod.plots.style import BLUE, FAINT, ORANGE, across, dress, entitle, ink, stage, wide
from flexapod.workspace.envelope import AxisTravel, Envelope, PairTravel


def pairs(found: Envelope, name: str = "", *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw the boundary of every two axes, and the part of their travels that may be combined in any way.

    Parameters
    ----------
    found : Envelope
        The result of `envelope`.
    name : str, optional
        What the machine is called, for the title.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Examples
    --------
    >>> fx.plots.envelope.pairs(fx.envelope(fx.load("motion-base"), directions=12)).savefig("pairs.png")
    """
    page, panels = stage(figure, (13.0, 8.2), (3, 5), least=1.1)
    axes = {axis.axis: axis for axis in found.axes}
    for ax, pair in zip(panels, found.pairs, strict=True):
        _pair(ax, pair, axes[pair.axes[0]], axes[pair.axes[1]])
    rectangle = "orange: the part of both travels that may be combined in any way"
    entitle(page, f"{name + ': ' if name else ''}motions along two axes from home; {rectangle}")
    return page


def _pair(ax: Axes, pair: PairTravel, first: AxisTravel, second: AxisTravel) -> None:
    scale = np.array([_shown(name)[0] for name in pair.axes])
    x, y = (np.concatenate([pair.boundary, pair.boundary[:1]]) * scale).T
    ax.fill(x, y, color=BLUE, alpha=0.15, lw=0)
    ax.plot(x, y, color=BLUE, lw=wide(1.2))
    low = pair.share * scale * [first.least, second.least]
    width, height = pair.share * scale * [first.most, second.most] - low
    ax.add_patch(Rectangle((low[0], low[1]), width, height, fill=False, color=ORANGE, lw=wide(1.2)))
    ax.plot(0, 0, "+", color=ink(), ms=wide(6))
    ax.axhline(0, color=FAINT, lw=wide(0.4), zorder=0)
    ax.axvline(0, color=FAINT, lw=wide(0.4), zorder=0)
    ax.set(xlabel=f"{pair.axes[0]}, {_shown(pair.axes[0])[1]}", ylabel=f"{pair.axes[1]}, {_shown(pair.axes[1])[1]}")
    dress(ax)
    if across(ax) < 1.5:  # room for two numbers side by side; home is marked
        ax.locator_params(nbins=2)
        ax.tick_params(axis="x", labelsize="small")
        ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}".replace("-", "\u2212") if value else "")


def _shown(axis: str) -> tuple[float, str]:
    """The factor and the unit of an axis as specifications give it: mm or degrees."""
    return (1e3, "mm") if axis in TRANSLATIONS else (float(np.degrees(1.0)), "deg")
