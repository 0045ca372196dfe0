"""Figures of a simulation that need its whole Dataset."""

from __future__ import annotations

import xarray as xr
from matplotlib.figure import Figure

INK = "#20262d"
FAINT = "#8a929b"
LEG_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # Okabe and Ito


def leg_forces(dataset: xr.Dataset) -> Figure:
    """Leg forces (N, positive: compression) against time, a panel a leg with one scale."""
    figure = Figure(figsize=(10.5, 6.2), layout="constrained", dpi=130)
    axes = figure.subplots(2, 3, sharex=True, sharey=True)
    for leg, ax, colour in zip(dataset.leg.values, axes.ravel(), LEG_COLOURS, strict=True):
        ax.plot(dataset.time.values, dataset.leg_force.sel(leg=leg).values, color=colour, lw=0.5)
        ax.set_title(f"leg {leg}", loc="left", fontsize=10, color=INK)
        ax.grid(True, color=FAINT, lw=0.3, alpha=0.6)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(color=FAINT, labelcolor=INK, labelsize=9)
        ax.margins(x=0)
    for ax in axes[1]:
        ax.set_xlabel("time, s", color=INK)
    for ax in axes[:, 0]:
        ax.set_ylabel("force, N (positive: compression)", color=INK)
    return figure
