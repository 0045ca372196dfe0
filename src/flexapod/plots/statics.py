"""Figures of load cases: leg forces and deflections over elevation, or case by case."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import EngFormatter, MaxNLocator

from flexapod.conventions import Array
from flexapod.mechanics.point_motion import of_point
from flexapod.plots.path import STYLES
from flexapod.plots.style import FAINT, SIX, TRIAD, dress, entitle, legend, legend_below, stage, wide


def load_cases(
    found: xr.Dataset, elevation: Array | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Draw leg forces, and the deflection and the rotation of the point, over elevation or over the cases.

    Parameters
    ----------
    found : xarray.Dataset
        The result of `load_cases`.
    elevation : ndarray, optional
        The elevation of each case, rad, (n,).
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Examples
    --------
    >>> elevation = np.radians([90, 60, 30])
    >>> cases = fx.load_cases(fx.load("motion-base"), gravity=fx.mechanics.gravity_at(elevation), reference=0)
    >>> fx.plots.statics.load_cases(cases, elevation).savefig("elevation.png")
    """
    page, (forces, moved, turned) = stage(figure, (12.0, 4.6), (1, 3))
    over = found.case.values + 1 if elevation is None else np.degrees(elevation)
    marks: dict[str, Any] = {"marker": "o", "ms": 4, "lw": 0} if elevation is None else {"lw": wide(1.4)}
    for i in range(6):
        forces.plot(over, found.leg_force.values[:, i], color=SIX[i], ls=STYLES[i], label=f"leg {i + 1}", **marks)
    for k, (axis, color) in enumerate(TRIAD):
        moved.plot(over, found.deflection.values[:, k], color=color, label=axis, **marks)
        turned.plot(over, found.rotation.values[:, k], color=color, label=f"about {axis}", **marks)
    forces.axhline(0, color=FAINT, lw=wide(0.8))
    forces.set(ylabel="leg force, N (positive: compression)")
    moved.set(ylabel="deflection, m")
    turned.set(ylabel="rotation, rad")
    for ax in (forces, moved, turned):
        ax.set_xlabel("case" if elevation is None else "elevation, deg")
        ax.yaxis.set_major_formatter(EngFormatter())
        if elevation is None:
            ax.xaxis.set_major_locator(MaxNLocator(integer=True))
        dress(ax)
    legend(moved)
    legend(turned)
    legend_below(page, 6, *forces.get_legend_handles_labels())
    entitle(page, f"{found.attrs['design']}: load cases at rest{of_point(found.attrs)}")
    return page
