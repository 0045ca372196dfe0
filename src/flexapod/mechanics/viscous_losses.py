"""Structural losses as viscous friction, for what is computed in time or in states."""

from __future__ import annotations

import numpy as np

from flexapod.checks import positive
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import single_base, single_pose
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.springs import axial_stiffness
from flexapod.pose import PoseLike

#: What is said where a design's losses are left out.
LEFT_OUT = (
    "The loss factors of the design are left out here: in time only viscous friction acts. Give loss_frequency, rad/s, "
    "at which a viscous friction shall take as much, or use the responses by frequency, where loss factors are exact."
)


def has_losses(hexapod: Hexapod) -> bool:
    """Whether a loss factor of the design takes energy: of a leg, or of a joint that has stiffness."""
    joints = hexapod.legs.joint_stiffness
    stiff = joints.universal.any(axis=1) | (joints.spherical > 0) | (joints.torsion > 0)
    return bool(hexapod.legs.loss_factor.any() or (joints.loss_factor * stiff).any())


def viscous_equivalent(
    hexapod: Hexapod, loss_frequency: float, pose: PoseLike | None = None, *, base: PoseLike | None = None
) -> Hexapod:
    """The machine with viscous friction in place of its loss factors, which takes as much at one frequency.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    loss_frequency : float
        The frequency, rad/s. Below it the friction takes less than the losses, above it more.
    pose : Pose or array_like, optional
        Pose whose leg stiffness counts, where that depends on the length: a Pose, or x, y, z in m and roll, pitch, yaw
        in rad. Left out, the home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.

    Returns
    -------
    Hexapod
        The same machine with more `legs.damping` and without loss factors.

    Raises
    ------
    ArgumentError
        For a frequency that is not > 0.
    PoseError
        For a batch of poses, or at a pose that no leg can take.

    See Also
    --------
    flexapod.transmissibility : The response by frequency, in which loss factors are exact.
    flexapod.simulate : Takes `loss_frequency` itself.

    Notes
    -----
    A spring k (1 + i eta) takes pi eta k a^2 in each cycle of the amplitude a, and a damper c takes pi c omega a^2:
    they are equal for c = eta k / omega. A design has one friction of each universal joint, for which the mean
    stiffness of its two axes counts, and one of each spherical joint, for which the bending stiffness counts and which
    acts in torsion too: there the friction takes more than the losses where torsion is softer than bending, and less
    where it is stiffer.

    Examples
    --------
    >>> lossy = fx.load("cubic-isolator").replace({"legs.loss_factor": 0.02})
    >>> viscous = fx.mechanics.viscous_equivalent(lossy, 50.0)
    >>> added = viscous.legs.damping.prismatic - lossy.legs.damping.prismatic
    >>> bool(np.allclose(added, 0.02 * lossy.legs.stiffness / 50.0))
    True
    """
    where, base = single_pose(hexapod, pose), single_base(hexapod, base)
    omega = positive(loss_frequency, "loss_frequency", "rad/s")
    if not has_losses(hexapod):
        return hexapod
    legs = hexapod.legs
    stiffness, _ = axial_stiffness(hexapod, inverse_kinematics(hexapod, where, base=base))
    joints = legs.joint_stiffness
    changes: dict[str, object] = {
        "legs.damping.prismatic": legs.damping.prismatic + legs.loss_factor * stiffness / omega,
        "legs.damping.universal": legs.damping.universal + joints.loss_factor * joints.universal.mean(axis=1) / omega,
        "legs.damping.spherical": legs.damping.spherical + joints.loss_factor * joints.spherical / omega,
        "legs.loss_factor": 0.0,
    }
    if joints.loss_factor.any():
        changes["legs.joint_stiffness.loss_factor"] = np.zeros(())
    return hexapod.replace(changes)
