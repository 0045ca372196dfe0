"""Where the core keeps each number of a design, and a design's values in that order."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import Array
from flexapod.rotations import rpy_matrix

#: Name -> numbers of its entries, in its shape; symmetric matrices name some of them twice. Names are keys of the
#: design file but for those below.
PLACES: dict[str, NDArray[np.int64]] = {field.name: field.index for field in _core.DESIGN_LAYOUT}
#: What the core keeps and a design file says in other words.
DERIVED = frozenset(
    ("legs.series_compliance", "legs.stiffness_law.kind", "legs.stiffness_law.count", "legs.joint_rest.matrix")
)
_LAW = "legs.stiffness_law"
_REST = "legs.joint_rest"


def packed(values: Mapping[str, Any]) -> Array:
    """The design as the core takes it, read-only, from its values by file key."""
    numbers = np.zeros(_core.design_size)
    for key, value in {**values, **_law(values), **_rest(values)}.items():
        if key in PLACES:
            numbers[PLACES[key]] = value
    if "legs.series_stiffness" in values:
        numbers[PLACES["legs.series_compliance"]] = series_compliance(values["legs.series_stiffness"])
    numbers.flags.writeable = False
    return numbers


def series_compliance(stiffness: Any) -> Any:
    """Of springs in series, (..., n) to (...), m/N; complex numbers keep their derivatives."""
    return (1.0 / stiffness).sum(axis=-1)


def compliance_slope(stiffness: Array) -> Array:
    """Derivative of that compliance by each of the stiffnesses, of their shape."""
    step = 1e-200
    slope: Array = series_compliance((stiffness + 1j * step)[..., None]).imag / step
    return slope


def _law(values: Mapping[str, Any]) -> dict[str, Any]:
    """Which law there is, and a table with its last node repeated; a constant stiffness that is not there is 1."""
    kind = values.get(f"{_LAW}.kind")
    if kind is None:
        return {}
    found: dict[str, Any] = {f"{_LAW}.kind": _core.Law[kind].value, "legs.stiffness": 1.0}
    if f"{_LAW}.lengths" in values:
        found[f"{_LAW}.count"] = count = len(values[f"{_LAW}.lengths"])
        for key in (f"{_LAW}.lengths", f"{_LAW}.stiffnesses"):
            found[key] = np.pad(values[key], (0, PLACES[key].size - count), mode="edge")
    return found


def _rest(values: Mapping[str, Any]) -> dict[str, Any]:
    """The pose of rest: the design's own, else home, else none, which is at the origin."""
    start = _REST if f"{_REST}.position" in values else "home"
    angles = values.get(f"{start}.orientation", np.zeros(3))
    return {
        f"{_REST}.position": values.get(f"{start}.position", np.zeros(3)),
        f"{_REST}.matrix": rpy_matrix(angles),
    }
