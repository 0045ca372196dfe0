"""Structural losses in controlled machines, whose states have viscous friction only."""

from __future__ import annotations

import warnings

from numpy.typing import ArrayLike

from flexapod.checks import level_outside
from flexapod.control.plant import Plant
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import as_hexapod
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.viscous_losses import has_losses, viscous_equivalent
from flexapod.pose import PoseLike

_NO_LOSS = (
    "The machine without control has the friction of its design and no structural loss. Real legs lose energy by "
    "themselves, so that control gains less than is told here."
)
_LOSS = (
    "The loss factors of the design are left out here, except in responses by frequency: the states of a controlled "
    "machine have viscous friction only. mechanics.viscous_equivalent, or --loss-frequency of the command, gives the "
    "friction that takes as much at one frequency."
)
_LEFT_OUT = (
    "The loss factors of the design are left out here: poles and motions in time have viscous friction only. "
    "mechanics.viscous_equivalent gives the machine with friction that takes as much at one frequency."
)
_NO_JOINTS = (
    "Its joints have no stiffness; with joints that resist turning the zeros of force feedback lie above 0 and damping "
    "ends below 1: a damping ratio of 1 and zeros at 0 are limits of the model."
)


def assumptions(hexapod: Hexapod, loss_frequency: float | None = None) -> str:
    """What the model of control leaves out of a machine, and what that does to its numbers.

    loss_frequency, rad/s: where friction stands for the loss factors of the design; None where nothing does.
    """
    if not has_losses(hexapod):
        losses = _NO_LOSS
    elif loss_frequency is None:
        losses = _LOSS
    else:
        losses = f"Viscous friction takes what the loss factors of the design take at {loss_frequency:.5g} rad/s."
    return losses if hexapod.legs.joint_stiffness.any else f"{losses} {_NO_JOINTS}"


def warn_of_losses(hexapod: Hexapod) -> None:
    """Warn the caller of a function of control where loss factors of the design are left out."""
    if has_losses(hexapod):
        warnings.warn(_LEFT_OUT, UserWarning, stacklevel=level_outside())


def plant_with_losses(
    hexapod: Hexapod,
    pose: PoseLike | None,
    loss_frequency: float | None,
    *,
    base: PoseLike | None,
    force: ArrayLike,
    moment: ArrayLike,
    joint: JointModel,
) -> tuple[Plant, str]:
    """The plant with friction in place of the loss factors, and in words what became of them."""
    machine, told = as_hexapod(hexapod), ""
    if loss_frequency is not None:
        machine = viscous_equivalent(hexapod, loss_frequency, pose, base=base, joint=joint)
        told = f", losses viscous at {loss_frequency:.5g} rad/s"
    elif has_losses(hexapod):
        told = ", loss factors left out"
    return Plant(linearise(machine, pose, base=base, force=force, moment=moment, joint=joint)), told
