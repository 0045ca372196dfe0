"""Rest: the leg forces that hold a pose, and where the platform settles for given unstretched leg lengths."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.checks import numbers
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import KinematicsError, PoseError, SingularPoseError
from flexapod.mechanics.assembly import forward_kinematics
from flexapod.mechanics.dynamics import inverse_dynamics
from flexapod.mechanics.inputs import ZERO, as_hexapod, as_joint, pose_or_home, single_base, single_pose, states, wrench
from flexapod.mechanics.kinematics import inverse_kinematics
from flexapod.mechanics.springs import axial_stiffness, refuse_outside_law
from flexapod.pose import Pose, PoseLike, unpack
from flexapod.rotations import orthonormal
from flexapod.showing import in_notebooks


@in_notebooks
class Equilibrium(NamedTuple):
    """A pose at rest and what its legs carry.

    Attributes
    ----------
    pose : Pose
        The pose or poses, (...).
    leg_force : ndarray
        Forces of the legs, N, (..., 6), positive in compression.
    leg_length : ndarray
        Lengths of the loaded legs, m, (..., 6).
    unstretched_length : ndarray
        Lengths that the legs would have without load, m, (..., 6).
    """

    pose: Pose
    leg_force: Array
    leg_length: Array
    unstretched_length: Array


def hold(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Equilibrium:
    """Compute the leg forces that hold a pose at rest under gravity and a load.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, in its own frame, at its reference point, (..., 3).
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Equilibrium
        `pose`, `leg_force` (N), `leg_length` and `unstretched_length` (m).

    Raises
    ------
    PoseError
        At a single pose that no leg can take, or outside the range of the design's stiffness law; in a batch such a
        pose gives NaN.
    SingularPoseError
        At a single pose that no leg forces hold; in a batch such a pose gives NaN.
    ArgumentError
        For loads of a shape that does not fit, or an unknown joint model.

    See Also
    --------
    flexapod.static_equilibrium : The pose for given unstretched lengths.

    Notes
    -----
    Eqs 2 to 4 of the paper, F = -K (L - L0) with the force positive in compression. In the model "spin_free" legs whose
    mass is off their axis weigh a little differently.

    Examples
    --------
    >>> fx.hold(fx.load("motion-base")).leg_force.round(0).tolist()
    [7911.0, 7911.0, 7911.0, 7911.0, 7911.0, 7911.0]
    """
    pose = pose_or_home(hexapod, pose)
    leg_force = inverse_dynamics(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    length = inverse_kinematics(hexapod, pose, base=base)
    return Equilibrium(pose, leg_force, length, unstretched_lengths(hexapod, length, leg_force))


def unstretched_lengths(hexapod: Hexapod, length: Array, leg_force: Array) -> Array:
    """Lengths without load, m, of legs that have these lengths and forces, (..., 6).

    Raises PoseError for six of them that the design's stiffness law does not reach; in a batch they are NaN.
    """
    rows = [np.ascontiguousarray(part) for part in np.broadcast_arrays(length, leg_force)]
    found: Array = _core.unstretched_lengths(hexapod.packed, *rows).reshape(rows[0].shape)
    lost = np.isnan(found) & np.isfinite(rows[0]) & np.isfinite(rows[1])
    if found.ndim == 1 and lost.any():
        refuse_outside_law(hexapod, rows[0], "length")
        i = int(np.argmax(lost))
        raise PoseError(
            f"leg {i + 1} of length {rows[0][i]:.6g} m has no unstretched length within legs.stiffness_law at which it "
            f"pushes with {rows[1][i]:.6g} N. Move the platform, or reduce the load."
        )
    return found


def static_equilibrium(
    hexapod: Hexapod,
    unstretched_length: ArrayLike,
    *,
    start: PoseLike | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Equilibrium:
    """Find where the platform is at rest under gravity and a load, for given unstretched leg lengths.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    unstretched_length : array_like
        Lengths of the legs without load, m, (6,).
    start : Pose or array_like, optional
        Where the search begins. Left out, the pose at which the legs have these lengths.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, in its own frame, at its reference point, (..., 3).
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Equilibrium
        `pose`, `leg_force` (N), `leg_length` and `unstretched_length` (m).

    Raises
    ------
    PoseError
        For a start or a base that is not one pose, and for lengths outside the range of the design's stiffness law.
    KinematicsError
        Where no equilibrium is found, and for lengths that are not > 0.
    SingularPoseError
        Where the stiffness becomes singular on the way.
    ArgumentError
        For lengths that are not six finite numbers, loads of a wrong shape, or an unknown joint model.

    See Also
    --------
    flexapod.hold : The leg forces and lengths for a given pose.
    flexapod.linearise : Its poles tell whether an equilibrium is stable.

    Notes
    -----
    Newton's method with the exact tangent. The equilibrium found may be unstable: then a pole of `linearise` has a
    positive real part.

    Examples
    --------
    >>> machine = fx.load("cubic-isolator")
    >>> lengths = fx.inverse_kinematics(machine)  # of legs that give way under the weight
    >>> sag = fx.static_equilibrium(machine, lengths).pose.position - machine.home.position
    >>> round(1000 * float(sag[2]), 2)  # mm
    -11.78
    """
    as_hexapod(hexapod)
    L_0 = numbers(unstretched_length, "unstretched_length", (6,))
    if (L_0 <= 0).any():
        raise KinematicsError(f"unstretched_length has {L_0.min():.6g} m; every leg length must be > 0 m")
    refuse_outside_law(hexapod, L_0, "unstretched_length")
    base = single_base(hexapod, base)
    if start is not None:
        start = single_pose(hexapod, start, "start")
    else:
        start = forward_kinematics(hexapod, L_0)
        if base is not None:
            start = Pose(base.position + base.matrix @ start.position, base.matrix @ start.matrix)
    s = states(hexapod, start, base)
    found, outcome = _core.settle(hexapod.packed, as_joint(joint), s.platform, s.base, wrench(force, moment, ()), L_0)
    parts = unpack(found)
    pose = Pose(parts["position"], orthonormal(parts["matrix"]))
    if outcome == _core.Rest.singular:
        raise SingularPoseError(
            f"the search for equilibrium met {pose!r}, where the legs have no stiffness in some direction. "
            "Start nearer to the equilibrium, or stiffen the legs."
        )
    if outcome == _core.Rest.not_found:
        raise KinematicsError(
            f"no equilibrium was found; the search ended at {pose!r}. The load may be more than the legs can carry "
            "before they collapse: start nearer, reduce the load, or stiffen the legs."
        )
    length = inverse_kinematics(hexapod, pose, base=base)
    return Equilibrium(pose, axial_stiffness(hexapod, L_0)[0] * (L_0 - length), length, L_0)
