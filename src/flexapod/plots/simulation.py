"""Figures of simulations in time: displacements and leg forces. Each is a new matplotlib Figure."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, MaxNLocator
from numpy.typing import ArrayLike

from flexapod.conventions import unit_of
from flexapod.plots.style import BLUE, INK, ORANGE, OUTPUT_NAMES, SIX, dress, name_panel, new_figure


def displacements(
    times: ArrayLike, displacement: ArrayLike, *, bound: ArrayLike | None = None, bound_name: str = "bound"
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

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Notes
    -----
    In the form of Figs. 7 and 8 of the paper.

    Examples
    --------
    >>> run = fx.simulate(fx.load("mukherjee-ii"), duration=0.02, base_motion=fx.harmonic("z", 1e-6, 750))
    >>> fx.plots.simulation.displacements(run.time, run.displacement).savefig("run.png")
    """
    moved = np.asarray(displacement)
    figure = new_figure(10.5, 6.2)
    for i, (name, ax) in enumerate(zip(OUTPUT_NAMES, figure.subplots(2, 3, sharex=True).ravel(), strict=True)):
        ax.plot(times, moved[:, i], color=BLUE, lw=0.5)
        if bound is not None:
            edge = np.asarray(bound)[:, i]
            ax.plot(times, edge, color=ORANGE, lw=1.1, label=bound_name)
            ax.plot(times, -edge, color=ORANGE, lw=1.1)
        dress(ax)
        name_panel(ax, i, name)
        ax.yaxis.set_major_formatter(EngFormatter(unit=unit_of(name)))
        ax.yaxis.set_major_locator(MaxNLocator(5))
        ax.margins(x=0)
        if i > 2:
            ax.set_xlabel("time, s")
    if bound is not None:
        figure.legend(*ax.get_legend_handles_labels(), loc="outside lower right", frameon=False, labelcolor=INK)
    return figure


def leg_forces(dataset: xr.Dataset) -> Figure:
    """Draw the leg forces against time, a panel a leg with one scale.

    Parameters
    ----------
    dataset : xarray.Dataset
        A simulation: the result of `simulate`.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. Positive forces are compression.

    Notes
    -----
    Draws every sample: choose some of a long run with ``dataset.isel(time=slice(None, None, 10))``.

    Examples
    --------
    >>> run = fx.simulate(fx.load("mukherjee-ii"), duration=0.02, base_motion=fx.harmonic("z", 1e-6, 750))
    >>> fx.plots.simulation.leg_forces(run).savefig("forces.png")
    """
    figure = new_figure(10.5, 6.2)
    axes = figure.subplots(2, 3, sharex=True, sharey=True)
    for leg, ax, colour in zip(dataset.leg.values, axes.ravel(), SIX, strict=True):
        ax.plot(dataset.time.values, dataset.leg_force.sel(leg=leg).values, color=colour, lw=0.5)
        ax.set_title(f"leg {leg}", loc="left", fontsize=10, color=INK)
        dress(ax)
        ax.margins(x=0)
    for ax in axes[1]:
        ax.set_xlabel("time, s")
    for ax in axes[:, 0]:
        ax.set_ylabel("force, N (positive: compression)")
    return figure
