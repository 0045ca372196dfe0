"""Derivatives of the natural frequencies by the design and by the pose."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design import layout
from flexapod.design.hexapod import Hexapod
from flexapod.design.packing import PLACES, compliance_slope
from flexapod.design.stiffness_laws import TableLaw
from flexapod.mechanics.inputs import as_joint, single_base, single_pose
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.springs import law_states
from flexapod.pose import PoseLike
from flexapod.showing import in_notebooks

#: Keys of stiffnesses whose derivatives are given where they are zero as well.
ALWAYS = (*(f"legs.joint_stiffness.{name}" for name in ("universal", "spherical", "torsion")), "suspension.stiffness")


@in_notebooks
class Sensitivity(NamedTuple):
    """Derivatives of the six natural frequencies, rad/s per SI unit of each number; modes are the first axis.

    Attributes
    ----------
    platform_mass : ndarray
        By the mass of the platform, (6,).
    platform_mass_center : ndarray
        By its mass centre, (6, 3).
    platform_inertia : ndarray
        By its inertia, (6, 3, 3); off the diagonal by a change of both equal entries.
    stiffness : ndarray
        By the stiffness of each leg, (6, 6).
    base_joints, platform_joints : ndarray
        By the coordinates of the joints, (6, 6, 3).
    lower_mass, upper_mass : ndarray
        By the masses of the parts of each leg, (6, 6).
    pose : ndarray
        By translation (m) and rotation vector (rad) of the platform, (6, 6).
    springs : mapping of str to ndarray
        By the numbers of the springs beside constant ones along the legs, by key of the design file: springs in series,
        joints, stiffness law, suspension (off its diagonal by a change of both equal entries). Those by the stiffness
        of joints and suspension are there for a design that has none, too.
    """

    platform_mass: Array
    platform_mass_center: Array
    platform_inertia: Array
    stiffness: Array
    base_joints: Array
    platform_joints: Array
    lower_mass: Array
    upper_mass: Array
    pose: Array
    springs: Mapping[str, Array] = MappingProxyType({})


def frequency_sensitivity(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> Sensitivity:
    """Compute the derivatives of the six natural frequencies by the design and by the pose.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Sensitivity
        Derivatives, rad/s per SI unit, with the modes on the first axis. NaN for a frequency of zero.

    Raises
    ------
    PoseError
        For a batch of poses, or at a pose that no leg can take.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.mechanics.near_repeated : Modes of nearly the same frequency.

    Notes
    -----
    R. L. Fox and M. P. Kapoor, AIAA Journal 6 (1968): v^T (dK - omega^2 dJ) v, with exact derivatives of J_p and of the
    stiffness of all springs. The universal axes are held. Modes that are exactly repeated have only directional
    derivatives, which single entries do not give.

    Examples
    --------
    >>> by = fx.frequency_sensitivity(fx.load("motion-base"))
    >>> round(float(by.platform_mass[0]), 5)  # rad/s per kg
    -0.00322
    """
    pose, base = single_pose(hexapod, pose), single_base(hexapod, base)
    s = law_states(hexapod, pose, base)
    omega = natural_modes(hexapod, pose, base=base, joint=joint).omega
    by_design, by_pose = _core.frequency_derivatives(hexapod.packed, as_joint(joint), s.platform, s.base)
    half = np.where(omega > 0, 0.5 / np.where(omega > 0, omega, 1.0), np.nan)[:, None]
    derivatives = half * by_design[0]
    by = {key: derivatives[:, place] for key, place in PLACES.items()}
    series = hexapod.legs.series_stiffness
    by["legs.series_stiffness"] = by["legs.series_compliance"][..., None] * compliance_slope(series)
    springs = {key: by[key] for key in (*ALWAYS, *layout.springs(hexapod)) if key != "suspension.damping"}
    if isinstance(hexapod.legs.stiffness_law, TableLaw):
        for key in ("legs.stiffness_law.lengths", "legs.stiffness_law.stiffnesses"):
            springs[key] = springs[key][:, : len(hexapod.legs.stiffness_law.lengths)]
    return Sensitivity(
        platform_mass=by["platform.mass"],
        platform_mass_center=by["platform.mass_center"],
        platform_inertia=by["platform.inertia"],
        stiffness=by["legs.stiffness"],
        base_joints=by["base.joints"],
        platform_joints=by["platform.joints"],
        lower_mass=by["legs.lower.mass"],
        upper_mass=by["legs.upper.mass"],
        pose=half * by_pose[0],
        springs=springs,
    )
