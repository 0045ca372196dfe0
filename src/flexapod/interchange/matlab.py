"""The state space of the linearised hexapod as a MAT-file, for MATLAB, Octave and SciPy."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.io import savemat

from flexapod import __version__
from flexapod.conventions import ROTATIONS, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.interchange.multibody import left_out
from flexapod.mechanics.inputs import ZERO, single_pose
from flexapod.mechanics.linearisation import linearise
from flexapod.output_files import output_path, write_file
from flexapod.pose import PoseLike

#: Kind of a signal: the units of its linear and of its angular parts.
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


def write_mat(
    path: str | PathLike[str],
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Path:
    """Write the state space of the linearised hexapod as a MAT-file.

    The file has version 5. It holds the matrices ``A`` (12, 12), ``B`` (12, 24),
    ``C`` (24, 12) and ``D`` (24, 24) in SI units and radians; cell arrays of text ``state_names``, ``state_units`` and
    the same for ``input`` and ``output``; ``design``, ``digest``, ``joint`` and ``flexapod`` (the version);
    ``pose_position`` (3, 1) in m, ``pose_rotation`` (3, 3) and ``pose_rpy`` (3, 1) in rad; ``rest_leg_force`` (6, 1) in
    N; and ``left_out``, a cell array of text that says what of the design the states leave out.

    Parameters
    ----------
    path : str or path-like
        The file to write.
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    ArgumentError
        If the path, the force, the moment or the joint model is invalid.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.
    OutputError
        If the file cannot be written.

    See Also
    --------
    flexapod.linearise : Gives the same model as a Python object.

    Notes
    -----
    The signals are those of ``Linearisation.state_space``: exact derivatives of the equations of motion (Eq. 34) at the
    static equilibrium.

    Examples
    --------
    >>> from scipy.io import loadmat
    >>> file = fx.interchange.write_mat("motion-base.mat", fx.load("motion-base"))
    >>> loadmat(file)["A"].shape
    (12, 12)
    """
    file = output_path(path)
    where = single_pose(hexapod, pose)
    tangent = linearise(hexapod, where, base=base, force=force, moment=moment, joint=joint)
    system = tangent.state_space()
    content = {
        "A": system.A,
        "B": system.B,
        "C": system.C,
        "D": system.D,
        "design": hexapod.name,
        "digest": hexapod.digest,
        "joint": joint,
        "flexapod": __version__,
        "pose_position": where.position,
        "pose_rotation": where.matrix,
        "pose_rpy": where.rpy,
        "rest_leg_force": tangent.rest.leg_force,
        "left_out": _cells(left_out(hexapod, where, "mat")),
    }
    for kind, names in (("state", system.states), ("input", system.inputs), ("output", system.outputs)):
        content |= {f"{kind}_names": _cells(names), f"{kind}_units": _cells([_unit(name) for name in names])}
    stream = BytesIO()
    savemat(stream, content, oned_as="column")
    return write_file(file, stream.getvalue())


def _unit(name: str) -> str:
    quantity, _, part = name.rpartition("_")
    linear, angular = UNITS[quantity]
    return angular if part in ROTATIONS else linear


def _cells(texts: Sequence[str]) -> NDArray[np.object_]:
    """Text as MATLAB's cell array."""
    return np.array(texts, dtype=object)
