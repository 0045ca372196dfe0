"""The exact tangent as a MAT-file, for MATLAB, Octave, and whatever else reads it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from flexapod import __version__
from flexapod.design.hexapod import Hexapod
from flexapod.errors import OutputError
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.linearisation import RestOptions, linearise
from flexapod.pose import Pose

# What a signal is -> the units of its linear and of its angular parts.
UNITS = {
    "position": ("m", "rad"),
    "velocity": ("m/s", "rad/s"),
    "acceleration": ("m/s^2", "rad/s^2"),
    "base_acceleration": ("m/s^2", "rad/s^2"),
    "wrench": ("N", "N m"),
    "leg_force": ("N", ""),
    "leg_length": ("m", ""),
    "leg_command": ("m", ""),
}


def write_mat(path: str | Path, hexapod: Hexapod, pose: Pose | None = None, **rest: Unpack[RestOptions]) -> Path:
    """Write the state space of `linearise` at a pose (default: home) to `path`, a MAT-file of version 5; returns it.

    It holds A (12, 12), B (12, 24), C (24, 12), D (24, 24) in SI units and radians; cell arrays of text state_names,
    state_units, and the same for input and output; design, digest, joint, flexapod; pose_position (3, 1) m,
    pose_rotation (3, 3), pose_rpy (3, 1) rad; rest_leg_force (6, 1) N. Signals are those of
    `Linearisation.state_space`.

    Raises: PoseError without a pose, and with SingularPoseError as `linearise`; OutputError where the file cannot be
    written.
    Source: own.
    """
    from scipy.io import savemat

    where = single_pose(hexapod, pose)
    tangent = linearise(hexapod, where, **rest)
    system = tangent.state_space()
    content = {
        "A": system.A,
        "B": system.B,
        "C": system.C,
        "D": system.D,
        "design": hexapod.name,
        "digest": hexapod.digest,
        "joint": rest.get("joint", "universal"),
        "flexapod": __version__,
        "pose_position": where.position,
        "pose_rotation": where.matrix,
        "pose_rpy": where.rpy,
        "rest_leg_force": tangent.rest.leg_force,
    }
    for kind, names in (("state", system.states), ("input", system.inputs), ("output", system.outputs)):
        content |= {f"{kind}_names": _cells(names), f"{kind}_units": _cells([_unit(name) for name in names])}
    file = Path(path)
    try:
        with file.open("wb") as stream:
            savemat(stream, content, oned_as="column")
    except OSError as error:
        raise OutputError(f"{file} cannot be written: {error.strerror}. Choose another place.") from error
    return file


def _unit(name: str) -> str:
    quantity, _, part = name.rpartition("_")
    linear, angular = UNITS[quantity]
    return angular if part in ("roll", "pitch", "yaw") else linear


def _cells(texts: Sequence[str]) -> NDArray[np.object_]:
    """Text as MATLAB's cell array."""
    return np.array(texts, dtype=object)
