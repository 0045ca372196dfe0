"""How fast a machine moves along an axis, as far as rate, acceleration, force and power of its legs allow."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.kinematics import leg_rates
from flexapod.pose import Motion
from flexapod.workspace.travel_limits import Displacements


class Fastest(NamedTuple):
    """The greatest velocity or acceleration along an axis, and what stops it; infinite and "" if nothing does.

    Attributes
    ----------
    value : float
        At home, m/s or rad/s, m/s2 or rad/s2: the lesser of both directions.
    stops : str
        What stops it at home.
    least : float
        The least of it over the travel along the axis.
    """

    value: float
    stops: str
    least: float


def fastest(
    hexapod: Hexapod, displacements: Displacements, axis: int, rows: Array, joint: JointModel
) -> tuple[Fastest, Fastest]:
    """Velocity and acceleration along an axis at displacements, rows (n, 6), of which the first is home.

    Velocity is steady: as far as the rates of the legs allow, and their power with the forces at rest. Acceleration is
    from rest: as far as the legs' acceleration allows, and their forces together with those at rest.
    """
    poses = displacements.poses(rows)
    lever = -np.einsum("nij,j->ni", poses.matrix, displacements.point)  # from the point to the reference point
    along = np.zeros((len(rows), 6))
    along[:, axis] = 1.0
    linear, angular = along[:, :3] + np.cross(along[:, 3:], lever), along[:, 3:]
    rate = leg_rates(hexapod, Motion(poses, linear, angular)).rate
    rest = inverse_dynamics(hexapod, poses, joint=joint)
    moved = inverse_dynamics(hexapod, Motion(poses, acceleration=linear, angular_acceleration=angular), joint=joint)
    return _least(_velocities(hexapod, rate, rest)), _least(_accelerations(hexapod, rate, rest, moved - rest))


def _velocities(hexapod: Hexapod, rate: Array, rest: Array) -> dict[str, Array]:
    limits, found = hexapod.limits, {}
    with np.errstate(divide="ignore"):
        if limits.leg_rate is not None:
            found["rate"] = limits.leg_rate / np.abs(rate)
        if limits.leg_power is not None:
            found["power"] = limits.leg_power / np.abs(rate * rest)
    return found


def _accelerations(hexapod: Hexapod, rate: Array, rest: Array, by: Array) -> dict[str, Array]:
    limits, found = hexapod.limits, {}
    with np.errstate(divide="ignore"):
        if limits.leg_acceleration is not None:
            found["acceleration"] = limits.leg_acceleration / np.abs(rate)
        for bound, words, sign in ((limits.leg_compression, "compression", 1), (limits.leg_tension, "tension", -1)):
            if bound is not None:  # by acceleration one way or the other, the leg's force grows
                found[words] = np.maximum(bound - sign * rest, 0.0) / np.abs(by)
    return found


def _least(found: dict[str, Array]) -> Fastest:
    """The least of what each limit of each leg (n, 6) allows."""
    if not found:
        return Fastest(np.inf, "", np.inf)
    all_ = np.stack(list(found.values()))  # (limits, n, 6)
    kind, leg = np.unravel_index(int(np.argmin(all_[:, 0])), all_[:, 0].shape)
    stops = f"{list(found)[kind]} of leg {LEGS[leg]}"
    return Fastest(float(all_[kind, 0, leg]), stops, float(np.nanmin(all_)))
