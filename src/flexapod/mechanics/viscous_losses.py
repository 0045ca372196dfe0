"""Structural losses as viscous friction, for what is computed in time or in states."""

from __future__ import annotations

import numpy as np

from flexapod.checks import positive
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import as_joint, single_base, single_pose
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.springs import axial_stiffness, spring_matrix
from flexapod.pose import Pose, PoseLike

SAME = 1e-3  # relative: modes as near as this count as one, whose shapes are any mixture of theirs

#: What is said where a design's losses are left out.
LEFT_OUT = (
    "The loss factors of the design are left out here: in time only viscous friction acts. Give loss_frequency "
    "(--loss-frequency of the command), rad/s, at which a viscous friction shall take as much, or use the responses by "
    "frequency, where loss factors are exact."
)


def has_losses(hexapod: Hexapod) -> bool:
    """Whether a loss factor of the design takes energy: of a leg, or of a joint that has stiffness."""
    joints = hexapod.legs.joint_stiffness
    stiff = joints.universal.any(axis=1) | (joints.spherical > 0) | (joints.torsion > 0)
    return bool(hexapod.legs.loss_factor.any() or (joints.loss_factor * stiff).any())


def viscous_equivalent(
    hexapod: Hexapod,
    loss_frequency: float,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> Hexapod:
    """The machine with viscous friction in place of its loss factors, which takes as much at one frequency.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    loss_frequency : float
        The frequency, rad/s. Below it the friction takes less than the losses, above it more.
    pose : Pose or array_like, optional
        Pose whose stiffness and modes count: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home
        pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the joints between base and legs.

    Returns
    -------
    Hexapod
        The same machine with more `legs.damping` and without loss factors.

    Raises
    ------
    ArgumentError
        For a frequency that is not > 0, or an unknown joint model.
    PoseError
        For a batch of poses, or at a pose that no leg can take.

    See Also
    --------
    flexapod.transmissibility : The response by frequency, in which loss factors are exact.
    flexapod.simulate : Takes `loss_frequency` itself.

    Notes
    -----
    A spring k (1 + i eta) takes pi eta k a^2 in each cycle of the amplitude a, and a damper c takes pi c omega a^2:
    they are equal for c = eta k / omega. Along the legs that holds for every motion. A design has one friction of each
    universal joint, against both its axes, and one of each spherical joint, against bending and twist alike. Where the
    stiffnesses differ, k is their mean, weighted by the squared rates in the mode of Eq. 5 that is nearest to the
    frequency (in all modes within 0.1 % of it): in that motion the friction takes what the losses take.

    Examples
    --------
    >>> lossy = fx.load("cubic-isolator").replace({"legs.loss_factor": 0.02})
    >>> viscous = fx.mechanics.viscous_equivalent(lossy, 50.0)
    >>> added = viscous.legs.damping.prismatic - lossy.legs.damping.prismatic
    >>> stiffness = 1 / (1 / lossy.legs.stiffness + lossy.legs.series_compliance)
    >>> bool(np.allclose(added, 0.02 * stiffness / 50.0))
    True
    """
    where, base = single_pose(hexapod, pose), single_base(hexapod, base)
    as_joint(joint)
    omega = positive(loss_frequency, "loss_frequency", "rad/s")
    if not has_losses(hexapod):
        return hexapod
    legs = hexapod.legs
    stiffness, _ = axial_stiffness(hexapod, inverse_kinematics(hexapod, where, base=base))
    changes: dict[str, object] = {
        "legs.damping.prismatic": legs.damping.prismatic + legs.loss_factor * stiffness / omega,
        "legs.loss_factor": 0.0,
    }
    if legs.joint_stiffness.loss_factor.any():
        of_base, of_platform = _joint_stiffness(hexapod, where, base, omega, joint)
        factor = legs.joint_stiffness.loss_factor / omega
        changes["legs.damping.universal"] = legs.damping.universal + factor * of_base
        changes["legs.damping.spherical"] = legs.damping.spherical + factor * of_platform
        changes["legs.joint_stiffness.loss_factor"] = np.zeros(())
    return hexapod.replace(changes)


def _joint_stiffness(
    hexapod: Hexapod, pose: Pose, base: Pose | None, omega: float, joint: JointModel
) -> tuple[Array, Array]:
    """The stiffness, N m/rad, (6,), that each base and platform joint has in the mode nearest to omega."""
    joints = hexapod.legs.joint_stiffness
    modes = natural_modes(hexapod, pose, base=base, joint=joint)
    nearest = modes.omega[np.argmin(np.abs(modes.omega - omega))]
    shape = modes.shape[:, np.abs(modes.omega - nearest) <= SAME * nearest]
    # With unit stiffness in each joint the columns of F are the directions of the joints' rates.
    unit = hexapod.replace(
        {f"legs.joint_stiffness.{name}": np.ones(()) for name in ("universal", "spherical", "torsion")}
    )
    directions = spring_matrix(unit, pose, base=base, joint=joint)[:, 6:36]
    rate = ((directions.T @ shape) ** 2).sum(axis=1).reshape(6, 5)
    stiffness = np.column_stack([joints.universal, joints.spherical, joints.spherical, joints.torsion])
    still = 1e-12 * rate.max()
    return _mean(stiffness[:, :2], rate[:, :2], still), _mean(stiffness[:, 2:], rate[:, 2:], still)


def _mean(stiffness: Array, weight: Array, still: float) -> Array:
    """Mean by weights, (6,); the plain mean of a joint that moves less than `still`."""
    total = weight.sum(axis=1, keepdims=True)
    weight = np.where(total > still, weight, 1.0)
    return np.asarray((stiffness * weight).sum(axis=1) / weight.sum(axis=1))
