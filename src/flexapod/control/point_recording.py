"""Recordings of a controlled run told of a point of the platform in place of its reference point."""

from __future__ import annotations

import numpy as np

from flexapod.control.linear_controller import signals
from flexapod.control.sampled_prediction import Recording
from flexapod.conventions import Array
from flexapod.mechanics.point_motion import acceleration_by_turning, displacement_at, shift
from flexapod.pose import Motion, Pose
from flexapod.rotations import rotation_from_vector

_POSITION, _VELOCITY, _ACCELERATION = (signals(name) for name in ("position", "velocity", "acceleration"))


def recording_at(found: Recording, pose: Pose, rest: Pose, base: Motion, point: Array) -> Recording:
    """Of the non-linear machine, exactly; rest: the base's pose at rest, base: its motion at the rows' instants.

    Measured rates are those that the base sees, in its axes turned as at rest.
    """
    if not point.any():
        return found
    arm, measured = pose.matrix @ point, found.measured.copy()
    now = rotation_from_vector(found.displacement[:, 3:]) @ arm
    turn = base.pose.matrix @ rest.matrix.T
    spin = base.angular_velocity + np.einsum("nij,nj->ni", turn, measured[:, _VELOCITY[3:]])
    measured[:, _ACCELERATION[:3]] += acceleration_by_turning(now, spin, measured[:, _ACCELERATION[3:]])
    measured[:, _POSITION] = displacement_at(measured[:, _POSITION], arm)
    return found._replace(measured=measured, displacement=displacement_at(found.displacement, arm))


def prediction_at(found: Recording, pose: Pose, point: Array) -> Recording:
    """Of the tangent, whose motions are small."""
    to_point, measured = shift(pose, point), found.measured.copy()
    for rows in (_POSITION, _ACCELERATION):
        measured[:, rows] = measured[:, rows] @ to_point.T
    return found._replace(measured=measured, displacement=found.displacement @ to_point.T)
