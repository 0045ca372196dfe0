"""Surfaces of equal index in a volume of the workspace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.optional import needed
from flexapod.plots.style import BLUE, NARROW, across, new_axes, wide
from flexapod.plots.sweep_axes import LABELS, axis_of, beyond_limits, entitle, grid_values, held, spelled

if TYPE_CHECKING:
    import xarray as xr
    from mpl_toolkits.mplot3d.axes3d import Axes3D


def iso_surface(
    sweep: xr.Dataset,
    level: float | None = None,
    *,
    quantity: str = "omega_1",
    ax: Axes3D | None = None,
    all_poses: bool = False,
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
    all_poses : bool, optional
        If True, the surface goes on beyond the design's limits. If False (default), it ends at them where
        ``within_limits`` was swept.

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
    Marching cubes of scikit-image. The surface is lit from one side.

    Examples
    --------
    >>> fx.plots.sweep.iso_surface(sweep, 150.0).figure.savefig("surface.png")  # doctest: +SKIP
    """
    from matplotlib.ticker import MaxNLocator

    values = grid_values(sweep, quantity, 3)
    numbers = np.asarray(values.values, dtype=float)
    beyond = None if all_poses else beyond_limits(sweep, tuple(map(str, values.dims)))
    if beyond is not None:
        numbers = np.where(beyond, np.nan, numbers)
    if not np.isfinite(numbers).any():
        where = "in this volume" if beyond is None else "within the limits in this volume"
        raise ArgumentError(f"{quantity} has no value {where}. Choose another volume.")
    level = float(np.nanmedian(numbers)) if level is None else level
    if not np.nanmin(numbers) < level < np.nanmax(numbers):
        raise ArgumentError(
            f"{quantity} is between {np.nanmin(numbers):.6g} and {np.nanmax(numbers):.6g} in this slice, so no surface "
            f"of {level:.6g} passes through it. Choose a level between them."
        )
    axes = [axis_of(values, str(dim)) for dim in values.dims]
    points, faces = _marching_cubes(numbers, level, [positions for positions, _ in axes])
    if not len(faces):
        raise ArgumentError(
            f"the poses that count are too few for a surface of {quantity} = {level:.6g}. Take a finer grid."
        )
    ax = _axes_3d() if ax is None else ax
    ax.plot_trisurf(*points.T, triangles=faces, color=BLUE, lw=wide(0.1), edgecolor=(1, 1, 1, 0.25), antialiased=True)
    for name, (positions, label) in zip("xyz", axes, strict=True):
        getattr(ax, f"set_{name}lim")(positions.min(), positions.max())
        getattr(ax, f"set_{name}label")(label, labelpad=8)
        getattr(ax, f"{name}axis").set_major_locator(MaxNLocator(5, prune="both"))
    title = f"{LABELS.get(quantity, spelled(quantity))} = {level:.4g}"
    entitle(ax, sweep, title + (", within the limits" if beyond is not None else ""), held(values))
    return ax


def _marching_cubes(numbers: Array, level: float, axes: list[Array]) -> tuple[Array, np.ndarray]:
    measure = needed("skimage.measure", "sweep", "a surface of equal index needs scikit-image")
    inside = np.isfinite(numbers)
    filled = np.where(inside, numbers, numbers[inside].max())
    points, faces, _, _ = measure.marching_cubes(filled, level)
    faces = faces[_whole_cells(inside)[tuple(np.floor(points[faces].mean(axis=1)).astype(int).T)]]
    placed = [np.interp(p, np.arange(len(axis)), axis) for p, axis in zip(points.T, axes, strict=True)]
    return np.stack(placed, axis=-1), faces


def _whole_cells(inside: np.ndarray) -> np.ndarray:
    """Cells of a grid all of whose eight corners have a value."""
    for axis in range(inside.ndim):
        inside = np.logical_and(*(inside.take(range(k, inside.shape[axis] - 1 + k), axis) for k in (0, 1)))
    return inside


def _axes_3d() -> Axes3D:
    ax: Any = new_axes(6.4, 5.6, projection="3d")
    ax.figure.subplots_adjust(left=0.02, right=0.92, bottom=0.06, top=0.88)
    if across(ax) < NARROW:
        ax.set_box_aspect(None, zoom=0.85)
    return ax
