"""What the modes look like: which legs and bodies carry their energy, and the modes in words."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.conventions import AXES, Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import as_joint, single_base, single_pose, states
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.springs import SPRING_LEG, law_states, spring_matrix
from flexapod.pose import Pose, PoseLike
from flexapod.rotations import skew
from flexapod.showing import in_notebooks


@in_notebooks
class EnergyShares(NamedTuple):
    """Parts of each mode's energy, that sum to 1 over springs or bodies.

    Attributes
    ----------
    strain : ndarray
        Strain energy along each leg, (..., 6 legs, 6 modes).
    kinetic : ndarray
        Kinetic energy of the platform, then of the legs, (..., 7, 6 modes). A leg whose inertia no rigid body can have
        may have a negative part.
    joints : ndarray
        Strain energy of the springs in each leg's joints, (..., 6 legs, 6 modes).
    suspension : ndarray
        Strain energy of the suspension, (..., 6 modes).
    """

    strain: Array
    kinetic: Array
    joints: Array
    suspension: Array


@in_notebooks
class ModeDescription(NamedTuple):
    """A mode in words, with the numbers behind them.

    Attributes
    ----------
    text : str
        The words.
    dominant : str
        The direction of most kinetic energy: x, y, z, roll, pitch or yaw.
    share : ndarray
        Parts of the kinetic energy in x, y, z of the mass centre and in roll, pitch, yaw about it, (6,).
    center : ndarray
        Point of the mode's screw axis that is nearest to the mass centre, m, (3,); NaN for a pure translation.
    axis : ndarray
        Unit vector of that axis, (3,).
    pitch : float
        Travel along the axis per radian, m.
    """

    text: str
    dominant: str
    share: Array
    center: Array
    axis: Array
    pitch: float


def energy_shares(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> EnergyShares:
    """Compute which springs store each mode's strain energy and which bodies carry its kinetic energy.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one or many: a Pose, or x, y, z in m and roll, pitch, yaw in rad, (..., 6). Left out, the
        home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    EnergyShares
        `strain` and `joints`, (..., 6 legs, 6 modes), and `suspension`, (..., 6 modes), that sum to 1 together, NaN at
        frequency zero; `kinetic`, (..., 7, 6 modes), the platform's, then the legs', that sums to 1.

    Raises
    ------
    PoseError
        At a single pose that no leg can take; in a batch such a pose gives NaN.
    ArgumentError
        For an unknown joint model.

    Notes
    -----
    Strain energy from the columns of F, one for each spring, times the mode shape; kinetic energy from each body's part
    of the mass matrix.

    Examples
    --------
    >>> shares = fx.mechanics.energy_shares(fx.load("motion-base"))
    >>> shares.kinetic[0].round(2).tolist()  # the platform's, mode by mode
    [0.96, 0.96, 0.93, 0.94, 0.91, 0.89]
    """
    s = law_states(hexapod, pose, base)
    shape = natural_modes(hexapod, pose, base=base, joint=joint).shape
    F = spring_matrix(hexapod, pose, base=base, joint=joint)
    stored = (np.swapaxes(F, -1, -2) @ shape) ** 2
    with np.errstate(invalid="ignore"):
        stored = stored / stored.sum(axis=-2, keepdims=True)
    strain, leg, others = stored[..., :6, :], SPRING_LEG[6 : F.shape[-1]], stored[..., 6:, :]
    joints = (np.arange(6)[:, None] == leg).astype(np.float64) @ others + 0.0 * strain  # NaN where the legs' are
    suspension = others[..., leg < 0, :].sum(axis=-2) + 0.0 * strain[..., 0, :]
    platform, legs = _core.inertia_parts(hexapod.packed, as_joint(joint), s.platform, s.base)
    parts = np.concatenate([platform[:, None], legs], axis=1).reshape(*s.shape, 7, 6, 6)
    kinetic = np.einsum("...im,...bij,...jm->...bm", shape, parts, shape)
    return EnergyShares(strain, kinetic, joints, suspension)


def describe_modes(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    joint: JointModel = "universal",
) -> list[ModeDescription]:
    """Describe each mode of one pose in words: what dominates, and about which point it turns.

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
    list of ModeDescription
        One for each of the six modes, from the lowest, with the words in `text`.

    Raises
    ------
    PoseError
        For a batch of poses, or at a pose that no leg can take.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.natural_modes : The frequencies and shapes.

    Notes
    -----
    The shares are of the kinetic energy, split into translation of the mass centre and rotation about it. The axis is
    that of the screw that the mode shape is.

    Examples
    --------
    >>> print(fx.describe_modes(fx.load("motion-base"))[5].text)
    mostly roll (97%), turning about (0, 0, 3.58) m
    """
    return describe_shapes(hexapod, pose, natural_modes(hexapod, pose, base=base, joint=joint).shape, base, joint)


def describe_shapes(
    hexapod: Hexapod, pose: PoseLike | None, shapes: Array | Complex, base: PoseLike | None, joint: JointModel
) -> list[ModeDescription]:
    """Describe shapes, twists of the reference point as columns, (6, n); of a complex one the axis is of its real part.

    They are scaled so that shape^T J_p shape = 1, which puts as much of a complex shape as can be into its real part.
    """
    pose, base = single_pose(hexapod, pose), single_base(hexapod, base)
    s = states(hexapod, pose, base)
    J = _core.equations_of_motion(hexapod.packed, as_joint(joint), s.platform, s.base)[0][0]
    shift = twist_of_center(hexapod, pose)
    twists = shapes.copy()
    twists[:3] -= shift[:3, 3:] @ shapes[3:]  # shift^-1 of them
    share = (twists.conj() * (shift.T @ J @ shift @ twists)).real
    if np.iscomplexobj(twists):  # of a real one they sum to 1 = twist^T J twist
        share = share / share.sum(axis=0)
    v, w = twists[:3].real.T, twists[3:].real.T
    speed, spin = np.linalg.norm(v, axis=1), np.linalg.norm(w, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):  # of a shape that does not turn
        center = pose.position + pose.matrix @ hexapod.platform_mass_center + np.cross(w, v) / spin[:, None] ** 2
        axis, pitch = w / spin[:, None], np.einsum("ij,ij->i", w, v) / spin**2
    return [_describe(*one) for one in zip(share.T, speed, spin, center, axis, pitch, strict=True)]


def twist_of_center(hexapod: Hexapod, pose: Pose) -> Array:
    """(6, 6): the twist of the reference point from that of the mass centre."""
    shift = np.eye(6)
    shift[:3, 3:] = skew(pose.matrix @ hexapod.platform_mass_center)
    return shift


def _describe(share: Array, speed: float, spin: float, center: Array, axis: Array, pitch: float) -> ModeDescription:
    first = int(np.argmax(share))
    others = [i for i in np.argsort(-share) if i != first and share[i] > 0.1]
    words = f"mostly {AXES[first]} ({min(share[first], 1.0):.0%})"  # coupling may give a direction more than all
    if others:
        words += " with " + ", ".join(f"{AXES[i]} ({share[i]:.0%})" for i in others)
    if spin == 0 or (first < 3 and spin * 1e6 < speed):
        return ModeDescription(words, AXES[first], share, np.full(3, np.nan), np.full(3, np.nan), np.inf)
    if share[3:].sum() > 0.01:  # a mode that hardly turns has an axis, but nobody would see it turn about it
        words += f", turning about ({_rounded(center)}) m"
    return ModeDescription(words, AXES[first], share, center, axis, float(pitch))


def _rounded(point: Array) -> str:
    """Coordinates to three digits of the largest one."""
    decimals = 2 - int(np.floor(np.log10(max(np.abs(point).max(), 1e-9))))
    return ", ".join(f"{c + 0.0:.3g}" for c in np.round(point, decimals))
