"""Figures of sweeps: index against condition number, maps of workspace slices, surfaces of equal index.

    fx.plots.sweep.index_scatter(fx.sweep(hexapod, fx.random_poses(box, 100_000)))
    fx.plots.sweep.index_map(fx.sweep(hexapod, fx.pose_grid(x=..., y=..., z=0.8)))

Without `ax` a new figure is made. Colour maps are even in lightness and safe for colour-blind readers.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import AXES, Array
from flexapod.errors import ArgumentError, OutputError
from flexapod.plots.style import BLUE, INK, NO_VALUE, ORANGE, VALUES
from flexapod.plots.sweep_axes import LABELS, axis_of, grid_values, held, spelled
from flexapod.plots.sweep_surface import iso_surface
from flexapod.workspace.summary import columns

__all__ = ["auto", "index_line", "index_map", "index_scatter", "iso_surface", "save"]

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

DENSITY = "viridis_r"
_DOTS = 20_000  # poses up to which each gets its dot
_CELLS = (220, 160)


def index_scatter(
    sweep: xr.Dataset, *, ax: Axes | None = None, colorbar: bool = True, most_cond: float | None = None
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

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If a quantity was not swept, or no pose has an index.

    Notes
    -----
    The axis of cond(H) is logarithmic where it spans more than a factor of five. Poses without an index are left out.

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
    ax = _axes() if ax is None else ax
    low, high, count = _ranges(sweep)
    high[1] = high[1] if most_cond is None else min(high[1], most_cond)
    logarithmic = high[1] > 5 * low[1]
    if count <= _DOTS:
        for _, (omega, cond) in columns(sweep, ("omega_1", "cond_H")):
            ax.plot(cond, omega, ".", color=BLUE, ms=_dot_size(count), mew=0, alpha=0.6, rasterized=True)
    else:
        _shaded(sweep, ax, (low, high, logarithmic), colorbar)
    if logarithmic:
        ax.set_xscale("log")
        _plain_log_ticks(ax, low[1], high[1])
    ax.set_xlim(right=high[1])
    ax.set_ylim(bottom=0)
    ax.set_xlabel(LABELS["cond_H"])
    ax.set_ylabel(LABELS["omega_1"])
    return ax


def _dot_size(count: int) -> float:
    return float(np.clip(400 / np.sqrt(max(count, 1)), 2.5, 9))


def _pairs(sweep: xr.Dataset) -> Any:
    for _, (omega, cond) in columns(sweep, ("omega_1", "cond_H")):
        good = np.isfinite(omega) & np.isfinite(cond)
        yield omega[good], cond[good]


def _ranges(sweep: xr.Dataset) -> tuple[Array, Array, int]:
    low, high, count = np.full(2, np.inf), np.full(2, -np.inf), 0
    for pair in _pairs(sweep):
        if pair[0].size:
            low = np.minimum(low, [v.min() for v in pair])
            high = np.maximum(high, [v.max() for v in pair])
            count += pair[0].size
    if not count:
        raise ArgumentError("no pose of this sweep has an index. See the variable `status` for the reasons.")
    return low, high, count


def _shaded(sweep: xr.Dataset, ax: Axes, frame: tuple[Array, Array, bool], colorbar: bool) -> None:
    """Counts in cells instead of dots on dots."""
    from matplotlib.colors import LogNorm

    low, high, logarithmic = frame
    space = np.geomspace if logarithmic else np.linspace
    across = space(low[1], high[1] * (1 + 1e-12), _CELLS[0] + 1)
    up = np.linspace(0.0, high[0] * (1 + 1e-12), _CELLS[1] + 1)
    counts = np.zeros(_CELLS)
    for omega, cond in _pairs(sweep):
        counts += np.histogram2d(cond, omega, bins=(across, up))[0]
    shown = np.ma.masked_equal(counts, 0).T
    mesh = ax.pcolormesh(across, up, shown, cmap=DENSITY, norm=LogNorm(1, max(2.0, counts.max())), rasterized=True)
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


def index_map(sweep: xr.Dataset, quantity: str = "omega_1", *, ax: Axes | None = None) -> Axes:
    """Draw a quantity over the two axes of a grid as a map with contours; a cross at its least.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep of a `pose_grid` with two varied coordinates, or one taken out of more: ``sweep.isel(z=0)``.
    quantity : str, optional
        What is drawn.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

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
    Grey: no value. Where `within_limits` was swept, hatched: outside the limits.

    Examples
    --------
    >>> grid = fx.pose_grid(x=[-0.05, 0, 0.05], y=[0, 0.1, 0.2], z=0.89)
    >>> ax = fx.plots.sweep.index_map(fx.sweep(fx.load("mukherjee-i"), grid))
    >>> ax.figure.savefig("map.png")
    """
    values = grid_values(sweep, quantity, 2)
    ax = _axes() if ax is None else ax
    across, down = values.dims
    values = values.transpose(down, across)
    (x, x_label), (y, y_label) = (axis_of(values, str(dim)) for dim in (across, down))
    numbers = np.ma.masked_invalid(np.asarray(values.values, dtype=float))
    ax.set_facecolor(NO_VALUE)
    mesh = ax.pcolormesh(x, y, numbers, cmap=VALUES, shading="nearest", rasterized=True)
    if numbers.count() and numbers.max() > numbers.min():
        lines = ax.contour(x, y, numbers, 7, colors="white", linewidths=0.9)
        _label_contours(ax, lines)
        worst = np.unravel_index(np.ma.argmin(numbers), numbers.shape)
        ax.plot(x[worst[1]], y[worst[0]], "X", color=ORANGE, mec="white", ms=10, zorder=5, clip_on=False)
    if "within_limits" in sweep:
        outside = ~np.asarray(sweep["within_limits"].transpose(down, across).values, dtype=bool)
        if outside.any():
            levels = [-0.5, 0.5, 1.5]
            ax.contourf(x, y, outside.astype(float), levels, hatches=[None, "///"], colors="none")
    ax.figure.colorbar(mesh, ax=ax, label=LABELS.get(quantity, spelled(quantity)), pad=0.02)
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)
    ax.set_title(held(values), fontsize=10, color=INK)
    return ax


def _label_contours(ax: Axes, lines: Any) -> None:
    from matplotlib.patheffects import withStroke

    for text in ax.clabel(lines, fmt="%.4g", fontsize=8):
        text.set_path_effects([withStroke(linewidth=2, foreground=INK)])


def save(ax: Axes, path: str | Path) -> None:
    """Write the figure of some axes to a file.

    Parameters
    ----------
    ax : Axes
        The axes.
    path : str or Path
        The file; its name says the format.

    Returns
    -------
    None
        Nothing; the file is written.

    Raises
    ------
    OutputError
        If the file cannot be written, or its format is unknown.

    Notes
    -----
    At 160 dots per inch.

    Examples
    --------
    >>> fx.plots.sweep.save(fx.plots.frequencies(np.arange(1.0, 7.0)), "six.png")
    """
    try:
        ax.figure.savefig(path, dpi=160)  # type: ignore[union-attr]
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror or error}. Choose another place.") from error
    except ValueError as error:
        if "not supported" not in str(error):
            raise
        raise OutputError(f"{path} cannot be written: {error}. Choose .png, .pdf or .svg.") from error


def _axes() -> Axes:
    from matplotlib.figure import Figure

    ax: Axes = Figure(figsize=(6.4, 4.6), layout="constrained").add_subplot()
    ax.spines[["top", "right"]].set_visible(False)
    return ax


def auto(sweep: xr.Dataset, level: float | None = None) -> Axes:
    """Draw the figure that fits a sweep: a line, a map, a surface, or else the scatter.

    Parameters
    ----------
    sweep : xarray.Dataset
        The sweep.
    level : float, optional
        The value of a surface. Default: the median.

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
    dims = [str(dim) for dim in sweep["omega_1"].dims] if "omega_1" in sweep else []
    if all(dim in AXES for dim in dims):
        if len(dims) == 2:
            return index_map(sweep)
        if len(dims) == 3:
            return iso_surface(sweep, level)
        if len(dims) == 1:
            return index_line(sweep)
    return index_scatter(sweep)


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
    The coordinates that are held stand above.

    Examples
    --------
    >>> grid = fx.pose_grid(x=[-0.05, 0, 0.05], z=0.89)
    >>> ax = fx.plots.sweep.index_line(fx.sweep(fx.load("mukherjee-i"), grid))
    >>> ax.figure.savefig("line.png")
    """
    values = grid_values(sweep, "omega_1", 1)
    ax = _axes() if ax is None else ax
    positions, label = axis_of(values, str(values.dims[0]))
    ax.plot(positions, values.values, color=BLUE, lw=1.8)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(label)
    ax.set_ylabel(LABELS["omega_1"])
    ax.set_title(held(values), fontsize=10, color=INK)
    return ax
