"""Figures of simulations in time: displacements and leg forces. Each fills a matplotlib Figure or SubFigure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, Array, unit_of
from flexapod.plots.style import (
    BLUE,
    ORANGE,
    OUTPUT_NAMES,
    SIX,
    dress,
    ink,
    legend_below,
    letters,
    moves,
    name_panel,
    note_still,
    panels,
    prefixed,
    wide,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BINS = 400  # of an envelope: as many as a panel has room for
TURNS = 0.5  # turning points in a bin, from which the lines of an oscillation run into one another


def displacements(
    times: ArrayLike,
    displacement: ArrayLike,
    *,
    bound: ArrayLike | None = None,
    bound_name: str = "bound",
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Draw the platform's displacement against time, a panel for each of its six motions.

    Parameters
    ----------
    times : array_like
        (n,) instants, s.
    displacement : array_like
        (n, 6) displacement from equilibrium, m and rad.
    bound : array_like, optional
        (n, 6) bound, drawn on both sides of zero.
    bound_name : str, optional
        Its name in the legend.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    In the form of Figs. 7 and 8 of the paper. Motions below 1e-9 of the largest are rounding and have no panel. Where
    oscillations are too many to be told apart, the least and largest values of short times are drawn.

    Examples
    --------
    >>> run = fx.simulate(fx.load("mukherjee-ii"), duration=0.02, base_motion=fx.harmonic("z", 1e-6, 750))
    >>> fx.plots.simulation.displacements(run.time, run.displacement).savefig("run.png")
    """
    t, moved = np.asarray(times, dtype=float), np.asarray(displacement, dtype=float)
    drawn = moves(moved)
    shown = [i for i in range(6) if drawn[i]]
    page, axes = panels(figure, len(shown), sharex=True)
    for place, (i, ax) in enumerate(zip(shown, axes, strict=False)):
        _trace(ax, t, moved[:, i], BLUE)
        if bound is not None:
            edge = np.asarray(bound)[:, i]
            ax.plot(t, edge, color=ORANGE, lw=wide(1.1), label=bound_name)
            ax.plot(t, -edge, color=ORANGE, lw=wide(1.1))
        dress(ax)
        name_panel(ax, place, AXES[i])
        ax.yaxis.set_major_locator(MaxNLocator(5))
        prefixed(ax, unit_of(AXES[i]))
        ax.margins(x=0)
        ax.set_xlabel("time, s")
    if not shown:
        _nothing(axes[0])
    note_still(page, [OUTPUT_NAMES[axis] for i, axis in enumerate(AXES) if not drawn[i]])
    if bound is not None and shown:
        legend_below(page, 2, *ax.get_legend_handles_labels())
    return page


def _nothing(ax: Axes) -> None:
    ax.set_axis_off()
    ax.text(0.5, 0.5, "nothing moves", transform=ax.transAxes, ha="center", color=ink())


def _trace(ax: Axes, times: Array, values: Array, colour: str) -> None:
    """A curve in time; where its oscillations would run into one another, what lies between its extremes."""
    steps = np.diff(values)
    turning = np.count_nonzero(steps[1:] * steps[:-1] < 0)
    if turning <= TURNS * BINS or times.size <= 2 * BINS:
        ax.plot(times, values, color=colour, lw=wide(0.8))
        return
    edges = np.unique(np.linspace(0, times.size, BINS + 1).astype(int))[:-1]
    low, high = np.minimum.reduceat(values, edges), np.maximum.reduceat(values, edges)
    at = times[edges]
    ax.fill_between(at, low, high, color=colour, alpha=0.3, lw=0, step="mid")
    ax.plot(at, low, color=colour, lw=wide(0.8))
    ax.plot(at, high, color=colour, lw=wide(0.8))


def leg_forces(dataset: xr.Dataset, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw the leg forces against time, a panel a leg with one scale.

    Parameters
    ----------
    dataset : xarray.Dataset
        A simulation: the result of `simulate`.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. Positive forces are compression.

    Notes
    -----
    Where oscillations are too many to be told apart, the least and largest values of short times are drawn.

    Examples
    --------
    >>> run = fx.simulate(fx.load("mukherjee-ii"), duration=0.02, base_motion=fx.harmonic("z", 1e-6, 750))
    >>> fx.plots.simulation.leg_forces(run).savefig("forces.png")
    """
    page, axes = panels(figure, 6, sharex=True, sharey=True)
    for leg, ax, colour in zip(dataset.leg.values, axes, SIX, strict=True):
        _trace(ax, dataset.time.values, dataset.leg_force.sel(leg=leg).values, colour)
        ax.set_title(f"leg {leg}", loc="left", fontsize=letters("axes.titlesize"), color=ink())
        dress(ax)
        ax.margins(x=0)
        ax.set_xlabel("time, s")
    for ax in axes:
        prefixed(ax, "N")
        ax.set_ylabel(f"force, {ax.get_ylabel()} (positive: compression)")
        ax.label_outer(remove_inner_ticks=False)
    return page
