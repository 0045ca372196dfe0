"""Figures of load cases: leg forces and deflections over elevation, or case by case."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import EngFormatter, MaxNLocator

from flexapod.conventions import Array, metric
from flexapod.mechanics.point_motion import of_point
from flexapod.plots.path import STYLES
from flexapod.plots.style import FAINT, SIX, TRIAD, dress, entitle, legend, legend_below, stage, wide

_APART = 3e-3  # of what a panel spans: curves nearer than that lie under one another


def _together(values: Array) -> list[list[int]]:
    """The columns of values (n, k) in groups that would hide each other in a panel, each in the order of the first."""
    span = np.ptp(values[np.isfinite(values)]) if np.isfinite(values).any() else 0.0
    groups: list[list[int]] = []
    for k in range(values.shape[1]):
        for group in groups:
            if np.allclose(values[:, k], values[:, group[0]], rtol=0, atol=_APART * span, equal_nan=True):
                group.append(k)
                break
        else:
            groups.append([k])
    return groups


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
    marks: dict[str, Any] = {"marker": "o", "ms": wide(4), "lw": 0} if elevation is None else {"lw": wide(1.4)}
    for legs in _together(found.leg_force.values):
        i, named = legs[0], ", ".join(str(leg + 1) for leg in legs)
        style = {"color": SIX[i], "ls": STYLES[i], "label": f"leg{'s' * (len(legs) > 1)} {named}", **marks}
        forces.plot(over, found.leg_force.values[:, i], **style)
    for ax, name, unit, words in ((moved, "deflection", "m", ""), (turned, "rotation", "rad", "about ")):
        values = found[name].values
        factor, told = metric(float(np.nanmax(np.abs(values), initial=0.0)), unit)
        for k, (axis, color) in enumerate(TRIAD):
            ax.plot(over, factor * values[:, k], color=color, label=f"{words}{axis}", **marks)
        ax.set(ylabel=f"{name}, {told}")
    forces.axhline(0, color=FAINT, lw=wide(0.8))
    forces.set(ylabel="leg force, N (positive: compression)")
    forces.yaxis.set_major_formatter(EngFormatter())
    for ax in (forces, moved, turned):
        ax.set_xlabel("case" if elevation is None else "elevation, deg")
        if elevation is None:
            ax.xaxis.set_major_locator(MaxNLocator(integer=True))
        dress(ax)
    legend(moved)
    legend(turned)
    legend_below(page, 6, *forces.get_legend_handles_labels())
    entitle(page, f"{found.attrs['design']}: load cases at rest{of_point(found.attrs)}")
    return page
