"""Natural frequencies and modes about a pose (Eq. 5), the dynamic stability index, and what it depends on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.packing import PLACES
from flexapod.mechanics.inputs import as_joint, single_pose, states
from flexapod.mechanics.kinematics import force_transformation
from flexapod.pose import PoseLike, skew


class NaturalModes(NamedTuple):
    """omega: (..., 6) rad/s, ascending. shape: (..., 6, 6), columns are mass-normalised twists of the platform.

    A twist is the translation of the reference point (rows 1-3) and the rotation vector (rows 4-6), inertial axes;
    shape^T J_p shape is the identity, so its units are kg^-1/2 and rad kg^-1/2 m^-1.

    Source: Eq. 5.
    """

    omega: Array
    shape: Array


class EnergyShares(NamedTuple):
    """Parts of each mode's energy, summing to 1 over their first named axis.

    strain: (..., 6 legs, 6 modes). kinetic: (..., 7, 6 modes): platform, then the legs. A leg whose printed inertia no
    rigid body can have may have a negative part.

    Source: own.
    """

    strain: Array
    kinetic: Array


class ModeDescription(NamedTuple):
    """A mode in words, with the numbers behind them.

    text: the words. dominant: one of x, y, z, roll, pitch, yaw. share: (6,) part of the kinetic energy in x, y, z of
    the mass centre and in roll, pitch, yaw about it. center: (3,) m, the point of the mode's axis nearest to the mass
    centre (NaN for a pure translation); axis: (3,) unit vector of that axis. pitch: m of travel along the axis per
    radian.

    Source: own.
    """

    text: str
    dominant: str
    share: Array
    center: Array
    axis: Array
    pitch: float


class Sensitivity(NamedTuple):
    """Derivatives of the six frequencies, rad/s per SI unit of each number, modes on the first axis.

    platform_mass (6,), platform_mass_center (6, 3), platform_inertia (6, 3, 3; a change of both off-diagonal twins),
    stiffness (6, 6 legs), base_joints and platform_joints (6, 6 joints, 3), lower_mass and upper_mass (6, 6 legs),
    pose (6, 6): by translation (m) and rotation vector (rad) of the platform.

    Source: R. L. Fox and M. P. Kapoor, AIAA Journal 6 (1968).
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


def natural_modes(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> NaturalModes:
    """Six natural frequencies (rad/s) and mode shapes at a pose, undamped, without preload or gravity.

    They are singular values of L^-1 H K^1/2 with J_p = L L^T, which keeps the low ones accurate near a singular pose;
    at one, the lowest is zero to rounding. joint: "universal" (exact) or "spin_free" (the paper's W.s = 0).

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for an unknown joint model.
    Source: Eq. 5; part C says what it leaves out.
    """
    s = states(hexapod, pose, base)
    omega, shape = _core.natural_modes(hexapod.packed, as_joint(joint), s.platform, s.base)
    return NaturalModes(omega.reshape(*s.shape, 6), shape.reshape(*s.shape, 6, 6))


def stability_index(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> Array | float:
    """The dynamic stability index (...): the lowest natural frequency, rad/s; zero at a singular pose.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for an unknown joint model.
    Source: Section 2.
    """
    return natural_modes(hexapod, pose, base=base, joint=joint).omega[..., 0][()]


def energy_shares(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> EnergyShares:
    """Which legs store each mode's strain energy, (..., 6, 6), and which bodies carry its kinetic energy, (..., 7, 6).

    Shares of 1; NaN at frequency zero.

    Raises: PoseError at a pose that no leg can take (in a batch it gives NaN), or for an unknown joint model.
    Source: own.
    """
    s = states(hexapod, pose, base)
    shape = natural_modes(hexapod, pose, base=base, joint=joint).shape
    stretch = np.swapaxes(force_transformation(hexapod, pose, base=base), -1, -2) @ shape
    strain = hexapod.legs.stiffness[:, None] * stretch**2
    with np.errstate(invalid="ignore"):
        strain = strain / strain.sum(axis=-2, keepdims=True)
    platform, legs = _core.inertia_parts(hexapod.packed, as_joint(joint), s.platform, s.base)
    parts = np.concatenate([platform[:, None], legs], axis=1).reshape(*s.shape, 7, 6, 6)
    kinetic = np.einsum("...im,...bij,...jm->...bm", shape, parts, shape)
    return EnergyShares(strain, kinetic)


def describe_modes(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> list[ModeDescription]:
    """Each mode of one pose in words: what dominates (x, y, z, roll, pitch, yaw) and about which point (m) it turns.

    Raises: PoseError for a batch of poses, or at a pose that no leg can take.
    Source: own.
    """
    pose = single_pose(hexapod, pose)
    s = states(hexapod, pose, base)
    modes = natural_modes(hexapod, pose, base=base, joint=joint)
    J = _core.equations_of_motion(hexapod.packed, as_joint(joint), s.platform, s.base)[0][0]
    r = pose.matrix @ hexapod.platform_mass_center
    shift = np.eye(6)  # twist of the reference point from that of the mass centre
    shift[:3, 3:] = skew(r)
    J_center = shift.T @ J @ shift
    center = pose.position + r
    return [_describe(np.linalg.solve(shift, v), J_center, center) for v in modes.shape.T]


def _describe(twist: Array, J: Array, mass_center: Array) -> ModeDescription:
    share = twist * (J @ twist)  # of 1 = twist^T J twist
    v, w = twist[:3], twist[3:]
    speed, spin = np.linalg.norm(v), np.linalg.norm(w)
    first = int(np.argmax(share))
    others = [i for i in np.argsort(-share) if i != first and share[i] > 0.1]
    words = f"mostly {AXES[first]} ({min(share[first], 1.0):.0%})"  # coupling may give a direction more than all
    if others:
        words += " with " + ", ".join(f"{AXES[i]} ({share[i]:.0%})" for i in others)
    if spin == 0 or (first < 3 and spin * 1e6 < speed):
        return ModeDescription(words, AXES[first], share, np.full(3, np.nan), np.full(3, np.nan), np.inf)
    center = mass_center + np.cross(w, v) / spin**2
    axis, pitch = w / spin, float(w @ v / spin**2)
    if share[3:].sum() > 0.01:  # a mode that hardly turns has an axis, but nobody would see it turn about it
        words += f", turning about ({_rounded(center)}) m"
    return ModeDescription(words, AXES[first], share, center, axis, pitch)


def _rounded(point: Array) -> str:
    """Coordinates to three digits of the largest one."""
    decimals = 2 - int(np.floor(np.log10(max(np.abs(point).max(), 1e-9))))
    return ", ".join(f"{c + 0.0:.3g}" for c in np.round(point, decimals))


def near_repeated(omega: Array, gap: float = 0.01) -> list[tuple[int, int]]:
    """Neighbouring modes (numbered from 0) whose frequencies differ by less than `gap` of the higher one.

    omega: (6,) rad/s, ascending.

    Raises: nothing of its own.
    Source: own.
    """
    return [(i, i + 1) for i in range(5) if omega[i + 1] - omega[i] < gap * omega[i + 1]]


def frequency_sensitivity(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> Sensitivity:
    """Exact derivatives of the six frequencies (rad/s) by the design and by the pose, for one pose.

    From v^T (dK - omega^2 dJ) v. Universal axes are held. Modes that are exactly repeated have only directional
    derivatives, which single entries do not give (see `near_repeated`); a zero frequency gives NaN.

    Raises: PoseError for a batch of poses, or at a pose that no leg can take.
    Source: R. L. Fox and M. P. Kapoor, AIAA Journal 6 (1968), with exact derivatives of J_p and H K H^T.
    """
    pose = single_pose(hexapod, pose)
    s = states(hexapod, pose, base)
    omega = natural_modes(hexapod, pose, base=base, joint=joint).omega
    by_design, by_pose = _core.frequency_derivatives(hexapod.packed, as_joint(joint), s.platform, s.base)
    half = np.where(omega > 0, 0.5 / np.where(omega > 0, omega, 1.0), np.nan)[:, None]
    derivatives = half * by_design[0]
    by = {key: derivatives[:, place] for key, place in PLACES.items()}
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
    )


def advised_sampling_time(omega_max: float) -> float:
    """Largest sensible sampling time of a controller, s: 2 pi / (20 omega_max) (paper, conclusion 3)."""
    return float(2 * np.pi / (20 * omega_max))
