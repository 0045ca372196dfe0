"""How the six coordinates of a pose move the platform."""

from __future__ import annotations

import numpy as np

from flexapod import _core
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME, numbers
from flexapod.mechanics.inputs import as_joint, taken
from flexapod.pose import Motion, Pose, vectors
from flexapod.rotations import rpy_matrix

_BASE = Motion.fixed().packed[None]
_AT_REST = np.zeros(_core.motion_size - 12)


def twist_of_coordinates(six: Array) -> Array:
    """(6, 6): translation and rotation vector (inertial axes) for each change of x, y, z, roll, pitch, yaw."""
    pitch, yaw = six[4], six[5]
    cp, sp, cy, sy = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    jacobian = np.eye(6)
    jacobian[3:, 3:] = [[cy * cp, -sy, 0.0], [sy * cp, cy, 0.0], [-sp, 0.0, 1.0]]
    return jacobian


class AtCoordinates:
    """What the core tells of a machine at x, y, z, roll, pitch, yaw, with derivatives by these six; its home stays."""

    def __init__(self, hexapod: Hexapod, joint: JointModel) -> None:
        own, self._hexapod = numbers(hexapod), hexapod
        self._design, self._still, self._joint = own[: HOME.start], np.zeros((len(AXES), HOME.start)), as_joint(joint)
        self._home = np.zeros((0, _core.motion_size))
        if hexapod.home is not None:
            self._home = Motion(Pose.from_rpy(*own[HOME])).packed[None]
        self._home_still = np.zeros((len(AXES) if len(self._home) else 0, 6))

    def __call__(self, six: Array) -> _core.DesignDirections:
        return _core.DesignDirections(
            design=self._design,
            joint=self._joint,
            platform=_platform(six),
            directions=self._still,
            displacements=np.ascontiguousarray(twist_of_coordinates(six).T[None]),
            home=self._home,
            home_displacements=self._home_still,
        )

    def taken(self, six: Array) -> bool:
        """Whether the legs can take the pose. Raises PoseError for numbers that are none."""
        return bool(taken(self._hexapod, *_core.leg_fit(self._hexapod.packed, _platform(six), _BASE)).all())


def _platform(six: Array) -> Array:
    """(1, n): the core's numbers of a platform at rest, as a Motion has them."""
    six = vectors(six, "pose", 6)
    return np.concatenate([six[:3], rpy_matrix(six[3:]).ravel(), _AT_REST])[None]
