"""The machine at rest at a pose: whether it stands there, and its modes without and with damping side by side."""

from __future__ import annotations

from contextlib import suppress
from typing import Literal, NamedTuple

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.cautions import Caution, Tangent, is_singular, pose_cautions, stands, unitless_condition
from flexapod.mechanics.inputs import single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.mode_pairs import pair_modes
from flexapod.mechanics.mode_shapes import ModeDescription, describe_shapes
from flexapod.mechanics.modes import NaturalModes, natural_modes
from flexapod.pose import PoseLike
from flexapod.showing import in_notebooks

Stability = Literal["stable", "falls over", "singular"]
_NOTHING = 1e-12  # of the highest frequency: what is below is rounding at a singular pose


@in_notebooks
class PoseState(NamedTuple):
    """The machine at rest at a pose, as `pose_state` gives it.

    Attributes
    ----------
    stability : {"stable", "falls over", "singular"}
        Whether the machine stands at the pose under its own weight; "singular" where no leg forces hold it.
    condition : float
        Condition number of H with its moments divided by the platform's radius; infinite at a singular pose.
    modes : NaturalModes
        The undamped modes; at a singular pose a frequency that is rounding is 0.
    descriptions : list of ModeDescription
        These modes in words.
    linear : Linearisation or None
        The dynamics linearised at rest, None at a singular pose.
    tangent : Tangent or None
        Its modes, in words, and which undamped mode each is like.
    cautions : list of Caution
        What to beware of at the pose, the gravest first.
    """

    stability: Stability
    condition: float
    modes: NaturalModes
    descriptions: list[ModeDescription]
    linear: Linearisation | None
    tangent: Tangent | None
    cautions: list[Caution]

    @property
    def singular(self) -> bool:
        """Whether the pose is singular to rounding."""
        return self.condition == np.inf

    def condition_shown(self, condition: Array | float) -> float:
        """A condition number of H in other units as it is to be shown: infinite at a singular pose."""
        return np.inf if self.singular else float(condition)


def pose_state(hexapod: Hexapod, pose: PoseLike | None = None, *, joint: JointModel = "universal") -> PoseState:
    """Find whether the machine stands at a pose, with its undamped and damped modes and all cautions.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home pose.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    PoseState
        `stability` ("stable", "falls over" or "singular"), the modes, and the cautions about the pose.

    Raises
    ------
    PoseError
        For a batch of poses, or at a pose that no leg can take.
    ArgumentError
        For an unknown joint model.

    See Also
    --------
    flexapod.natural_modes : The undamped modes alone, of many poses.

    Notes
    -----
    The machine falls over where a pole of `linearise` has a positive real part. A pose is singular where the condition
    number of H without units is above 1e12. It is what the report, `flexapod modes`, `flexapod check` and the page say.

    Examples
    --------
    >>> machine = fx.load("cubic-isolator")
    >>> fx.mechanics.pose_state(machine).stability
    'stable'
    >>> fx.mechanics.pose_state(machine.replace({"platform.mass": 200})).stability
    'falls over'
    """
    where = single_pose(hexapod, pose)
    modes = natural_modes(hexapod, where, joint=joint)
    condition = unitless_condition(hexapod, where)
    singular = is_singular(condition)
    if singular:
        condition, modes = np.inf, NaturalModes(_without_rounding(modes.omega), modes.shape)
    linear = None
    if not singular:
        with suppress(SingularPoseError):
            linear = linearise(hexapod, where, joint=joint)
    tangent = None
    if linear is not None:
        damped = linear.modes()
        words = describe_shapes(hexapod, where, damped.shape, None, joint)
        tangent = Tangent(damped, words, pair_modes(modes, damped))
    stability: Stability = "singular" if tangent is None else "stable" if stands(tangent.modes) else "falls over"
    return PoseState(
        stability,
        condition,
        modes,
        describe_shapes(hexapod, where, modes.shape, None, joint),
        linear,
        tangent,
        pose_cautions(
            hexapod, where, modes.omega, condition, tangent, None if linear is None else linear.rest, joint=joint
        ),
    )


def _without_rounding(omega: Array) -> Array:
    """The frequencies at a singular pose: of the lowest nothing but rounding is left, so that it is 0."""
    return np.where((np.arange(6) == 0) | (omega < _NOTHING * omega[-1]), 0.0, omega)
