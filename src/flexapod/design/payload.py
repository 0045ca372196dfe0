"""Loads that a platform carries beside those of its design."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.packing import PLACES


def add_payload(designs: Array, mass: Array, at: Array) -> None:
    """Adds point masses (s,) at places (s, 3) to the platforms of designs (s, n): mass, mass centre, and inertia."""
    M, R = designs[:, PLACES["platform.mass"]].copy(), designs[:, PLACES["platform.mass_center"]].copy()
    total = M + mass
    designs[:, PLACES["platform.mass"]] = total
    designs[:, PLACES["platform.mass_center"]] = (M[:, None] * R + mass[:, None] * at) / total[:, None]
    d = at - R
    reduced = M * mass / total  # two point masses about their common centre
    inertia, (i, j) = PLACES["platform.inertia"], np.triu_indices(3, 1)
    designs[:, inertia.diagonal()] += reduced[:, None] * ((d**2).sum(axis=1, keepdims=True) - d**2)
    designs[:, inertia[i, j]] -= reduced[:, None] * d[:, i] * d[:, j]


def with_payload(hexapod: Hexapod, mass: float, at: Array, inertia: Array) -> Hexapod:
    """The design whose platform carries a body: mass, kg, its centre, m (3,), its inertia about that, kg m2 (3, 3)."""
    numbers = hexapod.packed[None].copy()
    add_payload(numbers, np.array([mass]), at[None])
    total = {key: numbers[0][PLACES[key]] for key in ("platform.mass", "platform.mass_center", "platform.inertia")}
    total["platform.inertia"] = total["platform.inertia"] + inertia
    return hexapod.replace(total)
