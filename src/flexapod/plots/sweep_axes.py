"""What figures of sweeps share: the values of a grid, and the words on its axes."""

from __future__ import annotations

import numpy as np
import xarray as xr

from flexapod.conventions import AXES, ROTATIONS, Array
from flexapod.errors import ArgumentError
from flexapod.workspace.quantities import QUANTITIES

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
    """Positions along a coordinate as people read them, and its label."""
    positions = np.asarray(values[name].values, dtype=float)
    if name in ROTATIONS:
        return np.degrees(positions), f"{name} (°)"
    if np.abs(positions).max() <= 1:
        return 1000 * positions, f"{name} (mm)"
    return positions, f"{name} (m)"


def held(values: xr.DataArray) -> str:
    """The coordinates that do not vary."""
    words = []
    for name in AXES:
        if name in values.coords and name not in values.dims:
            number = float(values[name])
            words.append(f"{name} {np.degrees(number):.4g}°" if name in ROTATIONS else f"{name} {1000 * number:.4g} mm")
    return ", ".join(words)


def spelled(quantity: str) -> str:
    known = QUANTITIES[quantity]
    return f"{known.meaning} ({known.unit})" if known.unit not in ("", "1") else known.meaning
