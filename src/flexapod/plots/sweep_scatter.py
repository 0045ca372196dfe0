"""The cloud of a sweep: index against condition number."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from flexapod.conventions import Array
from flexapod.errors import ArgumentError, PoseError
from flexapod.plots.style import BLUE, VALUES, wide
from flexapod.plots.sweep_axes import LABELS, data_range, entitle, new_axes
from flexapod.workspace.summary import Counted

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

_DOTS = 20_000  # poses up to which each gets its dot
_CELLS = (220, 160)


def index_scatter(
    sweep: xr.Dataset,
    *,
    ax: Axes | None = None,
    colorbar: bool = True,
    most_cond: float | None = None,
    all_poses: bool = False,
) -> Axes:
    """Draw omega_1 against cond(H), one dot a pose; of many poses the shade tells how many lie together.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep of both, in memory or from `open_sweep`, which is read block by block.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.
    colorbar : bool, optional
        Whether a bar says how many poses a shade stands for.
    most_cond : float, optional
        Where the axis of cond(H) ends.
    all_poses : bool, optional
        If True, poses beyond the design's limits are drawn as well. If False (default), they are left out where
        ``within_limits`` was swept.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If a quantity was not swept.
    PoseError
        If no pose has an index, or none of those within the limits.

    Notes
    -----
    The axis of cond(H) is logarithmic where it spans more than a factor of five. Poses without an index are left out.
    The title says how many poses are drawn.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> poses = fx.random_poses(fx.Box.about(fx.home_pose(hexapod), 0.1, 0.2), 200)
    >>> ax = fx.plots.sweep.index_scatter(fx.sweep(hexapod, poses))
    >>> ax.figure.savefig("scatter.png")
    """
    for name in ("omega_1", "cond_H"):
        if name not in sweep:
            raise ArgumentError(f"this figure needs the quantity {name}. Sweep it.")
    cloud = _Cloud(Counted(sweep, all_poses))
    ax = new_axes() if ax is None else ax
    low, high = cloud.low, cloud.high
    high[1] = high[1] if most_cond is None else min(high[1], most_cond)
    logarithmic = high[1] > 5 * low[1]
    if cloud.count <= _DOTS:
        for omega, cond in cloud.pairs():
            ax.plot(cond, omega, ".", color=BLUE, ms=wide(_dot_size(cloud.count)), mew=0, alpha=0.6, rasterized=True)
    else:
        _shaded(cloud, ax, logarithmic, colorbar)
    if logarithmic:
        ax.set_xscale("log")
        _plain_log_ticks(ax, low[1], high[1])
    ax.set_xlim(right=high[1] * 1.01 if most_cond is None else high[1])
    data_range(ax, np.array([low[0], high[0]]))
    ax.set_xlabel(LABELS["cond_H"])
    ax.set_ylabel(LABELS["omega_1"])
    drawn, all_of_them = (f"{count:,}".replace(",", " ") for count in (cloud.count, sweep["omega_1"].size))
    within = f" within the limits, of {all_of_them}" if cloud.counted.within else ""
    entitle(ax, sweep, f"{drawn} poses{within}")
    return ax


class _Cloud:
    """The poses that are drawn: how many, and the ranges of omega_1 and cond(H)."""

    def __init__(self, counted: Counted) -> None:
        self.counted, self.count = counted, 0
        self.low, self.high = np.full(2, np.inf), np.full(2, -np.inf)
        for pair in self.pairs():
            if pair[0].size:
                self.low = np.minimum(self.low, [v.min() for v in pair])
                self.high = np.maximum(self.high, [v.max() for v in pair])
                self.count += pair[0].size
        if not self.count:
            within = " within the design's limits" if counted.within else ""
            raise PoseError(
                f"no pose of this sweep{within} has an index. See the variable `status` for the reasons"
                f"{', or draw all poses (all_poses, on the command line --all-poses)' if within else ''}."
            )

    def pairs(self) -> Iterator[tuple[Array, Array]]:
        """omega_1 and cond(H), block by block."""
        for _, (omega, cond) in self.counted.columns(("omega_1", "cond_H")):
            good = np.isfinite(cond)
            yield omega[good], cond[good]


def _dot_size(count: int) -> float:
    return float(np.clip(400 / np.sqrt(max(count, 1)), 2.5, 9))


def _shaded(cloud: _Cloud, ax: Axes, logarithmic: bool, colorbar: bool) -> None:
    """Counts in cells instead of dots on dots."""
    from matplotlib.colors import LogNorm

    low, high = cloud.low, cloud.high
    space = np.geomspace if logarithmic else np.linspace
    across = space(low[1], high[1] * (1 + 1e-12), _CELLS[0] + 1)
    up = np.linspace(low[0], high[0] * (1 + 1e-12), _CELLS[1] + 1)
    counts = np.zeros(_CELLS)
    for omega, cond in cloud.pairs():
        counts += np.histogram2d(cond, omega, bins=(across, up))[0]
    shown = np.ma.masked_equal(counts, 0).T
    mesh = ax.pcolormesh(across, up, shown, cmap=VALUES, norm=LogNorm(1, max(2.0, counts.max())), rasterized=True)
    if colorbar:
        ax.figure.colorbar(mesh, ax=ax, label="poses per cell", pad=0.02)


def _plain_log_ticks(ax: Axes, low: float, high: float) -> None:
    """40, 100, 400 rather than powers of ten, where the range is less than three decades."""
    from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

    if high > 1000 * low:
        return
    steps = (1, 2, 5) if high < 100 * low else (1, 3)
    ticks = [s * 10.0**e for e in range(-1, 16) for s in steps if low <= s * 10.0**e <= high]
    ax.xaxis.set_major_locator(FixedLocator(ticks))
    ax.xaxis.set_minor_locator(NullLocator())
    ax.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
