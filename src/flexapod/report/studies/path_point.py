"""The motion of a point of the platform along a path, as a table, as results, and instant by instant."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from flexapod.conventions import TRANSLATIONS
from flexapod.mechanics.point_motion import in_columns, point_words
from flexapod.report.numbers import without_rounding
from flexapod.report.study import Column, Table
from flexapod.workspace.quantities import titled

_SERIES = ("position", "velocity", "acceleration")


def table(loads: xr.Dataset) -> Table:
    """Travel, and the greatest speed and acceleration of the point, along each axis and altogether."""
    point = point_words(loads.attrs["point_m"], loads.attrs["point"])
    position = loads.position.values
    columns = [
        Column("", [*TRANSLATIONS, "together"]),
        Column("least", [*without_rounding(1e3 * position.min(axis=0)), None], "mm"),
        Column("greatest", [*without_rounding(1e3 * position.max(axis=0)), None], "mm"),
    ]
    columns += [
        Column(f"greatest {'speed' if name == 'velocity' else name}", _largest(loads[name].values), unit)
        for name, unit in (("velocity", "m/s"), ("acceleration", "m/s\u00b2"))
    ]
    turning = (float(np.linalg.norm(loads[f"angular_{name}"], axis=-1).max()) for name in ("velocity", "acceleration"))
    words = "Seen from the base. The platform turns at up to {:.4g} rad/s, with up to {:.4g} rad/s\u00b2."
    return Table(columns, words.format(*turning), title=f"Motion of {point or 'the platform'}")


def _largest(values: np.ndarray) -> np.ndarray:
    """Without sign, along each axis and of the vector."""
    each = np.concatenate([np.abs(values), np.linalg.norm(values, axis=1, keepdims=True)], axis=1)
    return without_rounding(each.max(axis=0))


def data(loads: xr.Dataset) -> dict[str, Any]:
    """Results by name."""
    norms = {
        f"peak_{kind}{name}_{unit}": float(np.linalg.norm(loads[f"{kind}{name}"], axis=-1).max())
        for kind, units in (("", ("m_s", "m_s2")), ("angular_", ("rad_s", "rad_s2")))
        for name, unit in zip(("velocity", "acceleration"), units, strict=True)
    }
    return {
        "point_m": loads.attrs["point_m"],
        "point": loads.attrs["point"],
        "least_position_m": loads.position.min("time").values,
        "greatest_position_m": loads.position.max("time").values,
        **norms,
    }


def point_columns(loads: xr.Dataset) -> dict[str, Any]:
    """Position, where the point is not the platform's origin, velocity and acceleration at each instant, by title."""
    of = in_columns(loads.attrs)
    return {
        titled(f"{name}{of}_{axis}", loads[name].attrs["units"]): loads[name].values[:, k]
        for name in (_SERIES if of else _SERIES[1:])
        for k, axis in enumerate(TRANSLATIONS)
    }
