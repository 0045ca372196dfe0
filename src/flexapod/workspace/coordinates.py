"""How the six coordinates of a pose move the platform."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array


def twist_of_coordinates(six: Array) -> Array:
    """(6, 6): translation and rotation vector (inertial axes) for each change of x, y, z, roll, pitch, yaw."""
    pitch, yaw = six[4], six[5]
    cp, sp, cy, sy = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    jacobian = np.eye(6)
    jacobian[3:, 3:] = [[cy * cp, -sy, 0.0], [sy * cp, cy, 0.0], [-sp, 0.0, 1.0]]
    return jacobian
