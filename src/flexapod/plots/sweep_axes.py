"""What figures of sweeps share: the values of a grid, and the words on its axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flexapod.conventions import AXES, ROTATIONS, TRANSLATIONS, Array
from flexapod.errors import ArgumentError
from flexapod.plots import style
from flexapod.workspace.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

LABELS = {
    "omega_1": r"lowest natural frequency $\omega_1$ (rad/s)",
    "cond_H": "cond(H)",
    "leg_distance": "least distance between legs (m)",
    "leg_force": "largest static leg force (N)",
    "lowest_stiffness": "lowest stiffness (N/m)",
}


def grid_values(sweep: xr.Dataset, quantity: str, varied: int) -> xr.DataArray:
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


def axis_of(values: xr.DataArray, name: str) -> tuple[Array, str]:
    """Positions along a coordinate as people read them, and its label; all lengths of a figure have one unit."""
    positions = np.asarray(values[name].values, dtype=float)
    if name in ROTATIONS:
        return np.degrees(positions), f"{name} (°)"
    factor, unit = _length_unit(values)
    return factor * positions, f"{name} ({unit})"


def _length_unit(values: xr.DataArray) -> tuple[float, str]:
    """mm where no coordinate of a figure is beyond a metre, else m."""
    reach = max(np.abs(values.coords[name]).max() for name in TRANSLATIONS if name in values.coords)
    return (1000.0, "mm") if reach <= 1 else (1.0, "m")


def held(values: xr.DataArray) -> str:
    """The coordinates that do not vary."""
    words = []
    for name in AXES:
        if name in values.coords and name not in values.dims:
            position, label = axis_of(values, name)
            unit = label.split("(")[1][:-1]
            words.append(f"{name} {float(position):.4g}{'' if unit == '°' else ' '}{unit}")
    return ", ".join(words)


def entitle(ax: Axes, sweep: xr.Dataset, *lines: str) -> None:
    """The design above the axes, and lines of words."""
    design = str(sweep.attrs.get("design", ""))
    style.entitle(ax, "\n".join(filter(None, (design, *lines))))


def data_range(ax: Axes, values: Array) -> None:
    """The range of the values on the axis of the index: from zero where they go near it, else no empty strip below."""
    good = values[np.isfinite(values)]
    if not good.size:
        return
    low, high = float(good.min()), float(good.max())
    room = 0.06 * (high - low) or 0.05 * high or 1.0
    ax.set_ylim(0.0 if low < 0.35 * high else low - room, high + room)


def new_axes() -> Axes:
    ax = style.new_axes(6.4, 4.8)
    ax.spines[["top", "right"]].set_visible(False)
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set(color=style.ink(), fontsize=style.letters("axes.labelsize"))
    return ax


def beyond_limits(sweep: xr.Dataset, dims: tuple[str, ...]) -> np.ndarray | None:
    """Where poses of a grid are beyond the design's limits; None where that was not swept."""
    if "within_limits" not in sweep:
        return None
    return ~np.asarray(sweep["within_limits"].transpose(*dims).values, dtype=bool)


def spelled(quantity: str) -> str:
    known = QUANTITIES[quantity]
    return f"{known.meaning} ({known.unit})" if known.unit not in ("", "1") else known.meaning


def check_swept(dims: tuple[str, ...], quantities: tuple[str, ...]) -> None:
    """Raises ArgumentError, before a sweep over `dims`, where its figure would lack a quantity."""
    needed = ("omega_1",) if is_grid(dims) else ("omega_1", "cond_H")
    if missing := [name for name in needed if name not in quantities]:
        raise ArgumentError(f"the figure of this sweep needs the quantity {' and '.join(missing)}. Sweep it.")


def is_grid(dims: tuple[str, ...]) -> bool:
    """Whether a line, a map or a surface shows a sweep over these axes."""
    return len(dims) in (1, 2, 3) and all(dim in AXES for dim in dims)
