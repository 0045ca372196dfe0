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
from flexapod.optional import needed
from flexapod.plots.style import BLUE, INK, NO_VALUE, ORANGE, VALUES
from flexapod.workspace.quantities import QUANTITIES
from flexapod.workspace.summary import columns

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d.axes3d import Axes3D

DENSITY = "viridis_r"
_DOTS = 20_000  # poses up to which each gets its dot
_CELLS = (220, 160)
LABELS = {
    "omega_1": r"lowest natural frequency $\omega_1$ (rad/s)",
    "cond_H": "cond(H)",
    "leg_distance": "least distance between legs (m)",
    "leg_force": "largest static leg force (N)",
    "lowest_stiffness": "lowest stiffness (N/m)",
}


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
    values = _grid(sweep, quantity, 2)
    ax = _axes() if ax is None else ax
    across, down = values.dims
    values = values.transpose(down, across)
    (x, x_label), (y, y_label) = (_axis(values, str(dim)) for dim in (across, down))
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
    ax.figure.colorbar(mesh, ax=ax, label=LABELS.get(quantity, _spelled(quantity)), pad=0.02)
    ax.set_xlabel(x_label)
    ax.set_ylabel(y_label)
    ax.set_title(_held(values), fontsize=10, color=INK)
    return ax


def _label_contours(ax: Axes, lines: Any) -> None:
    from matplotlib.patheffects import withStroke

    for text in ax.clabel(lines, fmt="%.4g", fontsize=8):
        text.set_path_effects([withStroke(linewidth=2, foreground=INK)])


def iso_surface(
    sweep: xr.Dataset, level: float | None = None, *, quantity: str = "omega_1", ax: Axes3D | None = None
) -> Axes3D:
    """Draw the surface in a volume of the workspace where a quantity has one value.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep of a `pose_grid` with three varied coordinates.
    level : float, optional
        The value. Default: the median.
    quantity : str, optional
        What is drawn.
    ax : Axes3D, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If the quantity was not swept, the sweep is not over three coordinates, or no value is at the level.
    MissingExtraError
        If the extra "sweep" is not installed.

    Notes
    -----
    Marching cubes of scikit-image. The surface is shaded by its height.

    Examples
    --------
    >>> fx.plots.sweep.iso_surface(sweep, 150.0).figure.savefig("surface.png")  # doctest: +SKIP
    """
    from matplotlib.ticker import MaxNLocator

    values = _grid(sweep, quantity, 3)
    numbers = np.asarray(values.values, dtype=float)
    level = float(np.nanmedian(numbers)) if level is None else level
    if not np.nanmin(numbers) < level < np.nanmax(numbers):
        raise ArgumentError(
            f"{quantity} is between {np.nanmin(numbers):.6g} and {np.nanmax(numbers):.6g} in this slice, so no surface "
            f"of {level:.6g} passes through it. Choose a level between them."
        )
    axes = [_axis(values, str(dim)) for dim in values.dims]
    points, faces = _marching_cubes(numbers, level, [positions for positions, _ in axes])
    ax = _axes_3d() if ax is None else ax
    ax.plot_trisurf(*points.T, triangles=faces, cmap=VALUES, lw=0.1, edgecolor=(1, 1, 1, 0.25), antialiased=True)
    for name, (positions, label) in zip("xyz", axes, strict=True):
        getattr(ax, f"set_{name}lim")(positions.min(), positions.max())
        getattr(ax, f"set_{name}label")(label, labelpad=8)
        getattr(ax, f"{name}axis").set_major_locator(MaxNLocator(5, prune="both"))
    title = f"{LABELS.get(quantity, _spelled(quantity))} = {level:.4g}"
    ax.set_title("\n".join(filter(None, [title, _held(values)])), fontsize=10, color=INK)
    return ax


def _marching_cubes(numbers: Array, level: float, axes: list[Array]) -> tuple[Array, np.ndarray]:
    measure = needed("skimage.measure", "sweep", "a surface of equal index needs scikit-image")
    filled = np.where(np.isfinite(numbers), numbers, np.nanmax(numbers[np.isfinite(numbers)]))
    inside = np.isfinite(numbers)
    points, faces, _, _ = measure.marching_cubes(filled, level, mask=inside)
    placed = [np.interp(p, np.arange(len(axis)), axis) for p, axis in zip(points.T, axes, strict=True)]
    return np.stack(placed, axis=-1), faces


def _grid(sweep: xr.Dataset, quantity: str, varied: int) -> xr.DataArray:
    if quantity not in sweep:
        raise ArgumentError(f"this sweep has no {quantity}; it has {', '.join(map(str, sweep.data_vars))}.")
    values = sweep[quantity]
    dims = [str(dim) for dim in values.dims]
    if len(dims) != varied or any(dim not in AXES for dim in dims):
        raise ArgumentError(
            f"this figure needs a grid with {varied} varied coordinates; {quantity} here has the axes {dims}. "
            "Sweep such a pose_grid, or select one value of the others (sweep.isel)."
        )
    return values


def _axis(values: xr.DataArray, name: str) -> tuple[Array, str]:
    """Positions along a coordinate as people read them, and its label."""
    positions = np.asarray(values[name].values, dtype=float)
    if name in AXES[3:]:
        return np.degrees(positions), f"{name} (°)"
    if np.abs(positions).max() <= 1:
        return 1000 * positions, f"{name} (mm)"
    return positions, f"{name} (m)"


def _held(values: xr.DataArray) -> str:
    """The coordinates that do not vary."""
    words = []
    for name in AXES:
        if name in values.coords and name not in values.dims:
            number = float(values[name])
            words.append(f"{name} {np.degrees(number):.4g}°" if name in AXES[3:] else f"{name} {1000 * number:.4g} mm")
    return ", ".join(words)


def _spelled(quantity: str) -> str:
    known = QUANTITIES[quantity]
    return f"{known.meaning} ({known.unit})" if known.unit not in ("", "1") else known.meaning


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


def _axes_3d() -> Axes3D:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 5.6))
    figure.subplots_adjust(left=0.02, right=0.92, bottom=0.06, top=0.92)
    ax: Any = figure.add_subplot(projection="3d")
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
    values = _grid(sweep, "omega_1", 1)
    ax = _axes() if ax is None else ax
    positions, label = _axis(values, str(values.dims[0]))
    ax.plot(positions, values.values, color=BLUE, lw=1.8)
    ax.set_ylim(bottom=0)
    ax.set_xlabel(label)
    ax.set_ylabel(LABELS["omega_1"])
    ax.set_title(_held(values), fontsize=10, color=INK)
    return ax
