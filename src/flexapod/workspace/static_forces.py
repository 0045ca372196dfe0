"""The leg forces that hold poses at rest, with exact derivatives."""

from __future__ import annotations

import numpy as np

from flexapod import _core
from flexapod.conventions import Array

_MOST = 1e30  # N, in place of the infinite forces of a singular pose


def static_forces(at: _core.DesignDirections) -> tuple[Array, Array]:
    """Forces (n, 6), N, compression > 0, and their derivatives (n, 6, m): H f = w gives H df = dw - dH f."""
    wrench, by = at.held_wrench()
    H, dH = (part.reshape(-1, 6, 6, *part.shape[2:]) for part in at.force_transformation())
    held = np.abs(np.linalg.det(H)) > 0
    safe = np.where(held[:, None, None], H, np.eye(6))
    force = np.linalg.solve(safe, wrench[..., None])[..., 0]
    slope = np.linalg.solve(safe, by - np.einsum("nijm,nj->nim", dH, force))
    return np.where(held[:, None], force, _MOST), np.where(held[:, None, None], slope, 0.0)
