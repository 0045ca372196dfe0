"""Figures of sweeps: index against condition number, maps of workspace slices, surfaces of equal index.

    fx.plots.sweep.index_scatter(fx.sweep(hexapod, fx.random_poses(box, 100_000)))
    fx.plots.sweep.index_map(fx.sweep(hexapod, fx.pose_grid(x=..., y=..., z=0.8)))

Without `ax` a new figure is made. Colour maps are even in lightness and safe for colour-blind readers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import Array
from flexapod.plots.printing import save
from flexapod.plots.style import BLUE, FAINT, NO_VALUE, ORANGE, VALUES, ink, legend, letters, wide
from flexapod.plots.sweep_axes import (
    LABELS,
    axis_of,
    beyond_limits,
    data_range,
    entitle,
    grid_values,
    held,
    is_grid,
    new_axes,
    spelled,
)
from flexapod.plots.sweep_scatter import index_scatter
from flexapod.plots.sweep_surface import iso_surface

__all__ = ["auto", "index_line", "index_map", "index_scatter", "iso_surface", "save"]

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def index_map(sweep: xr.Dataset, quantity: str = "omega_1", *, ax: Axes | None = None, all_poses: bool = False) -> Axes:
    """Draw a quantity over the two axes of a grid as a map with contours; a cross at its least.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep of a `pose_grid` with two varied coordinates, or one taken out of more: ``sweep.isel(z=0)``.
    quantity : str, optional
        What is drawn.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.
    all_poses : bool, optional
        If True, the cross is at the least of all poses. If False (default), at the least of those within the design's
        limits, where ``within_limits`` was swept.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If the quantity was not swept, or the sweep is not over two coordinates.

    Notes
    -----
    Grey: no value. Where ``within_limits`` was swept, hatched: beyond the limits. A legend names the marks.

    Examples
    --------
    >>> grid = fx.pose_grid(x=[-0.05, 0, 0.05], y=[0, 0.1, 0.2], z=0.89)
    >>> ax = fx.plots.sweep.index_map(fx.sweep(fx.load("mukherjee-i"), grid))
    >>> ax.figure.savefig("map.png")
    """
    values = grid_values(sweep, quantity, 2)
    ax = new_axes() if ax is None else ax
    across, down = map(str, values.dims)
    values = values.transpose(down, across)
    (x, x_label), (y, y_label) = (axis_of(values, dim) for dim in (across, down))
    numbers = np.ma.masked_invalid(np.asarray(values.values, dtype=float))
    ax.set_facecolor(NO_VALUE)
    mesh = ax.pcolormesh(x, y, numbers, cmap=VALUES, shading="nearest", rasterized=True)
    if numbers.count() and numbers.max() > numbers.min():
        lines = ax.contour(x, y, numbers, 7, colors="white", linewidths=wide(0.9))
        _label_contours(ax, lines)
    beyond = beyond_limits(sweep, (down, across))
    _marks(ax, (x, y), numbers, beyond, all_poses)
    ax.figure.colorbar(mesh, ax=ax, label=LABELS.get(quantity, spelled(quantity)), pad=0.02)
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)
    entitle(ax, sweep, held(values))
    return ax


def _marks(
    ax: Axes, axes: tuple[Array, Array], numbers: np.ma.MaskedArray, beyond: np.ndarray | None, all_poses: bool
) -> None:
    """A cross at the least of the numbers that count, hatches beyond the limits, and a legend of both."""
    from matplotlib.patches import Patch

    shown: list[Any] = []
    counted = numbers if beyond is None or all_poses else np.ma.masked_where(beyond, numbers)
    if counted.count() and numbers.max() > numbers.min():
        worst = np.unravel_index(np.ma.argmin(counted), counted.shape)
        words = "least of all" if beyond is None or all_poses else "least within the limits"
        style: dict[str, Any] = {"color": ORANGE, "mec": "white", "ms": wide(10), "zorder": 5, "clip_on": False}
        place = axes[0][worst[1]], axes[1][worst[0]]
        shown += ax.plot(*place, "X", ls="none", label=f"{words}: {counted.min():.5g}", **style)
    if beyond is not None and beyond.any():
        levels = [-0.5, 0.5, 1.5]
        ax.contourf(*axes, beyond.astype(float), levels, hatches=[None, "///"], colors="none")
        shown.append(Patch(facecolor="none", edgecolor=ink(), hatch="///", label="beyond the limits"))
    if np.ma.is_masked(numbers):
        shown.append(Patch(color=NO_VALUE, label="no value"))
    if shown:
        under = 3.6 * letters("axes.labelsize") / 72 / (ax.bbox.height / ax.figure.dpi)  # numbers and label
        below: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -under), "ncols": 3}
        ax.legend(handles=shown, fontsize=letters(), frameon=False, **below)


def _label_contours(ax: Axes, lines: Any) -> None:
    from matplotlib.patheffects import withStroke

    for text in ax.clabel(lines, fmt="%.4g", fontsize=letters()):
        text.set_path_effects([withStroke(linewidth=wide(2), foreground=ink())])


def auto(sweep: xr.Dataset, level: float | None = None, *, ax: Axes | None = None, all_poses: bool = False) -> Axes:
    """Draw the figure that fits a sweep: a line, a map, a surface, or else the scatter.

    Parameters
    ----------
    sweep : xarray.Dataset
        The sweep.
    level : float, optional
        The value of a surface. Default: the median.
    ax : Axes, optional
        Axes to draw on, of three dimensions for a surface. Default: those of a new figure.
    all_poses : bool, optional
        If True, poses beyond the design's limits count as well.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    A grid with one, two or three varied coordinates gives the first three.

    Examples
    --------
    >>> grid = fx.pose_grid(x=[-0.05, 0, 0.05], z=0.89)
    >>> ax = fx.plots.sweep.auto(fx.sweep(fx.load("mukherjee-i"), grid))
    >>> ax.get_xlabel()
    'x (mm)'
    """
    dims = tuple(str(dim) for dim in sweep["omega_1"].dims) if "omega_1" in sweep else ()
    if not is_grid(dims):
        return index_scatter(sweep, ax=ax, all_poses=all_poses)
    if len(dims) == 1:
        return index_line(sweep, ax=ax)
    if len(dims) == 2:
        return index_map(sweep, ax=ax, all_poses=all_poses)
    return iso_surface(sweep, level, ax=ax, all_poses=all_poses)


def index_line(sweep: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw omega_1 along the one varied coordinate of a grid.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep of a `pose_grid` with one varied coordinate.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If the index was not swept, or the sweep is not over one coordinate.

    Notes
    -----
    The coordinates that are held stand above. Where ``within_limits`` was swept, poses beyond the limits are dotted.

    Examples
    --------
    >>> grid = fx.pose_grid(x=[-0.05, 0, 0.05], z=0.89)
    >>> ax = fx.plots.sweep.index_line(fx.sweep(fx.load("mukherjee-i"), grid))
    >>> ax.figure.savefig("line.png")
    """
    values = grid_values(sweep, "omega_1", 1)
    ax = new_axes() if ax is None else ax
    across = str(values.dims[0])
    positions, label = axis_of(values, across)
    beyond = beyond_limits(sweep, (across,))
    if beyond is None or not beyond.any():
        ax.plot(positions, values.values, color=BLUE, lw=wide(1.8))
    else:
        ax.plot(positions, values.values, color=FAINT, lw=wide(1.2), ls=":", label="beyond the limits")
        ax.plot(positions, np.where(beyond, np.nan, values.values), color=BLUE, lw=wide(1.8), label="within the limits")
        legend(ax)
    data_range(ax, np.asarray(values.values))
    ax.set_xlabel(label)
    ax.set_ylabel(LABELS["omega_1"])
    entitle(ax, sweep, held(values))
    return ax
