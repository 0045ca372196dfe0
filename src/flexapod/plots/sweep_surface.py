"""Surfaces of equal index in a volume of the workspace."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.optional import needed
from flexapod.plots.style import INK, VALUES
from flexapod.plots.sweep_axes import LABELS, axis_of, grid_values, held, spelled

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d.axes3d import Axes3D


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

    values = grid_values(sweep, quantity, 3)
    numbers = np.asarray(values.values, dtype=float)
    level = float(np.nanmedian(numbers)) if level is None else level
    if not np.nanmin(numbers) < level < np.nanmax(numbers):
        raise ArgumentError(
            f"{quantity} is between {np.nanmin(numbers):.6g} and {np.nanmax(numbers):.6g} in this slice, so no surface "
            f"of {level:.6g} passes through it. Choose a level between them."
        )
    axes = [axis_of(values, str(dim)) for dim in values.dims]
    points, faces = _marching_cubes(numbers, level, [positions for positions, _ in axes])
    ax = _axes_3d() if ax is None else ax
    ax.plot_trisurf(*points.T, triangles=faces, cmap=VALUES, lw=0.1, edgecolor=(1, 1, 1, 0.25), antialiased=True)
    for name, (positions, label) in zip("xyz", axes, strict=True):
        getattr(ax, f"set_{name}lim")(positions.min(), positions.max())
        getattr(ax, f"set_{name}label")(label, labelpad=8)
        getattr(ax, f"{name}axis").set_major_locator(MaxNLocator(5, prune="both"))
    title = f"{LABELS.get(quantity, spelled(quantity))} = {level:.4g}"
    ax.set_title("\n".join(filter(None, [title, held(values)])), fontsize=10, color=INK)
    return ax


def _marching_cubes(numbers: Array, level: float, axes: list[Array]) -> tuple[Array, np.ndarray]:
    measure = needed("skimage.measure", "sweep", "a surface of equal index needs scikit-image")
    filled = np.where(np.isfinite(numbers), numbers, np.nanmax(numbers[np.isfinite(numbers)]))
    inside = np.isfinite(numbers)
    points, faces, _, _ = measure.marching_cubes(filled, level, mask=inside)
    placed = [np.interp(p, np.arange(len(axis)), axis) for p, axis in zip(points.T, axes, strict=True)]
    return np.stack(placed, axis=-1), faces


def _axes_3d() -> Axes3D:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 5.6))
    figure.subplots_adjust(left=0.02, right=0.92, bottom=0.06, top=0.92)
    ax: Any = figure.add_subplot(projection="3d")
    return ax
