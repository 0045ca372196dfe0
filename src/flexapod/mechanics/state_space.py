"""The linearised dynamics as a state space with named signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flexapod.conventions import AXES, LEGS, Array
from flexapod.showing import in_notebooks

if TYPE_CHECKING:
    from flexapod.mechanics.linearisation import Linearisation

STATES = ("position", "velocity")
INPUTS = ("base_acceleration", "leg_force", "wrench", "leg_command")
OUTPUTS = ("position", "leg_length", "leg_force", "acceleration")


@in_notebooks
class StateSpace(NamedTuple):
    """A state space x' = A x + B u, y = C x + D u in SI units, with names; see `Linearisation.state_space`.

    Attributes
    ----------
    A, B, C, D : ndarray
        Matrices, (12, 12), (12, 24), (24, 12) and (24, 24).
    states, inputs, outputs : tuple of str
        A name for each state, input and output.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


def state_space_of(tangent: Linearisation) -> StateSpace:
    """The state space of a linearisation; `Linearisation.state_space` says what it holds."""
    M_inv = np.linalg.inv(tangent.M)
    zero, one = np.zeros((6, 6)), np.eye(6)
    K_legs, K_commands = np.diag(tangent.leg_stiffness), np.diag(tangent.command_stiffness)
    force_inputs = [tangent.H, one, tangent.H @ K_commands]
    drive = M_inv @ np.hstack([-tangent.M_b - tangent.M @ tangent.carry, *force_inputs])
    A = np.block([[zero, one], [-M_inv @ tangent.K, -M_inv @ tangent.C]])
    B = np.vstack([np.zeros((6, 24)), drive])
    rate = tangent.H.T  # leg rates from relative twist
    C = np.block([[one, zero], [rate, zero], [-K_legs @ rate, zero], [A[6:]]])
    absolute = drive + np.hstack([tangent.carry, np.zeros((6, 18))])
    legs = np.hstack([zero, one, zero, K_commands])
    D = np.vstack([np.zeros((12, 24)), legs, absolute])
    return StateSpace(A, B, C, D, _labels(STATES), _labels(INPUTS), _labels(OUTPUTS))


def _labels(groups: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{group}_{part}" for group in groups for part in (LEGS if group.startswith("leg_") else AXES))
