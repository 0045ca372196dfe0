"""The exact linear dynamics about static equilibrium: geometric stiffness, gravity, damping, moving base."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import AXES, LEGS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import ZERO, as_joint, single_pose, states, wrench
from flexapod.mechanics.statics import Equilibrium, hold
from flexapod.optional import needed
from flexapod.pose import Pose, PoseLike, skew

if TYPE_CHECKING:
    import control

__all__ = ["DampedModes", "Linearisation", "StateSpace", "linearise"]

STATES = ("position", "velocity")
INPUTS = ("base_acceleration", "leg_force", "wrench", "leg_command")
OUTPUTS = ("position", "leg_length", "leg_force", "acceleration")


class RestOptions(TypedDict, total=False):
    """What `linearise` takes beside the hexapod and the pose, for the studies that pass it on."""

    base: Pose | None
    force: ArrayLike
    moment: ArrayLike
    joint: JointModel


class DampedModes(NamedTuple):
    """pole: (6,) complex rad/s (upper half plane, or real), by size. omega: (6,) rad/s, its modulus.

    damping_ratio: (6,), negative if the mode grows. shape: (6, 6) complex twists of the platform as columns, scaled so
    that shape^T M shape = 1 with a real largest part.

    Source: part C.
    """

    pole: Array
    omega: Array
    damping_ratio: Array
    shape: Array


class StateSpace(NamedTuple):
    """x' = A x + B u, y = C x + D u with names for the states, inputs and outputs; see `Linearisation.state_space`.

    A: (12, 12). B: (12, 24). C: (24, 12). D: (24, 24), SI. states, inputs, outputs: a name for each.

    Source: part C.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Linearisation:
    """M x'' + C x' + K x + M_b x_b'' + C_b x_b' + K_b x_b = H f + w about `rest`, all matrices (6, 6), inertial axes.

    x, x_b: small displacements (translation of the reference point in m, rotation vector in rad) of platform and base;
    f: change of the leg forces (N) beside their springs; w: change of the wrench on the platform (N, N m), which, like
    the static one, turns with the platform. A command that lengthens leg i's unstretched length by d acts as f = K_i d.
    K holds leg stiffness, the geometric stiffness of loaded legs, gravity and the turning external wrench: it need not
    be symmetric when there is an external wrench. leg_stiffness: (6,) N/m. carry: a platform that moves rigidly with
    the base has x = carry x_b. gravity: (3,) m/s2. rest: the `Equilibrium`.

    Source: Eq. 34 about rest; part C.
    """

    M: Array
    C: Array
    K: Array
    M_b: Array
    C_b: Array
    K_b: Array
    H: Array
    leg_stiffness: Array
    rest: Equilibrium
    carry: Array  # displacement of a platform that moves rigidly with the base: x = carry x_b
    gravity: Array

    def modes(self) -> DampedModes:
        """Complex modes with the base fixed. Of a pair of real poles (no vibration), the slower or growing one."""
        zero, one = np.zeros((6, 6)), np.eye(6)
        A = np.block([[zero, one], [-np.linalg.solve(self.M, self.K), -np.linalg.solve(self.M, self.C)]])
        scale = np.sqrt(np.abs(np.linalg.eigvals(A[6:, :6])).max())  # balances displacements against rates
        balanced = np.block([[zero, scale * one], [A[6:, :6] / scale, A[6:, 6:]]])
        poles, vectors = np.linalg.eig(balanced)
        chosen = _one_of_each_pair(poles)
        pole, shape = poles[chosen], vectors[:6, chosen]
        shape = shape / np.sqrt(np.einsum("im,ij,jm->m", shape, self.M, shape))
        largest = shape[np.abs(shape).argmax(axis=0), range(6)]
        shape = shape * np.where(largest.real < 0, -1.0, 1.0)
        omega = np.abs(pole)
        with np.errstate(invalid="ignore"):
            ratio = -pole.real / omega
        return DampedModes(pole, omega, ratio, shape)

    def state_space(self) -> StateSpace:
        """Twelve states: the platform's displacement and velocity relative to a frame carried by the base.

        Inputs (24): base acceleration in the inertial frame (m/s2, rad/s2), leg forces (N), wrench (N, N m), leg length
        commands (m). Outputs (24): relative displacement (m, rad), change of leg lengths (m) and of the force in the
        legs' springs and actuators (N), absolute acceleration (m/s2, rad/s2). Exact but for two effects that twelve
        states cannot hold and `transmissibility` keeps: a tilted base tilts gravity, and in the model "spin_free" a
        turning base rubs on legs that do not spin with it.
        """
        M_inv = np.linalg.inv(self.M)
        zero, one = np.zeros((6, 6)), np.eye(6)
        K_legs = np.diag(self.leg_stiffness)
        force_inputs = [self.H, one, self.H @ K_legs]
        drive = M_inv @ np.hstack([-self.M_b - self.M @ self.carry, *force_inputs])
        A = np.block([[zero, one], [-M_inv @ self.K, -M_inv @ self.C]])
        B = np.vstack([np.zeros((6, 24)), drive])
        rate = self.H.T  # leg rates from relative twist
        C = np.block([[one, zero], [rate, zero], [-K_legs @ rate, zero], [A[6:]]])
        absolute = drive + np.hstack([self.carry, np.zeros((6, 18))])
        legs = np.hstack([zero, one, zero, K_legs])
        D = np.vstack([np.zeros((12, 24)), legs, absolute])
        return StateSpace(A, B, C, D, _labels(STATES), _labels(INPUTS), _labels(OUTPUTS))

    def to_control(self) -> control.StateSpace:
        """The state space as a `control.StateSpace` with named signals. Needs python-control (extra "control").

        Raises: MissingExtraError without python-control.
        """
        control = needed("control", "control", "to_control needs python-control")
        s = self.state_space()
        return control.ss(
            s.A, s.B, s.C, s.D, states=list(s.states), inputs=list(s.inputs), outputs=list(s.outputs), name="hexapod"
        )


def _labels(groups: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{group}_{part}" for group in groups for part in (LEGS if group.startswith("leg_") else AXES))


def _one_of_each_pair(poles: Array) -> list[int]:
    """Indices of six poles out of twelve: the upper one of each complex pair, of real ones the slower or the growing.

    Ordered by modulus.
    """
    upper = [i for i, p in enumerate(poles) if p.imag > 0]
    real = sorted((i for i, p in enumerate(poles) if p.imag == 0), key=lambda i: -poles[i].real)
    return sorted(upper + real[: 6 - len(upper)], key=lambda i: abs(poles[i]))


def linearise(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Linearisation:
    """The tangent of the equations of motion at a pose held at rest under gravity and a wrench, by exact derivatives.

    force (N), moment (N m): on the platform, in its frame, at its reference point. The frequencies approach those of
    `natural_modes` (Eq. 5) as legs stiffen.

    Raises: SingularPoseError where no leg forces hold the pose; PoseError for a batch of poses, or at a pose that no
    leg can take.
    Source: Eq. 34; part C.
    """
    pose = single_pose(hexapod, pose)
    rest = hold(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    s = states(hexapod, pose, base)
    M, C, K, M_b, C_b, K_b, H = _core.tangent(
        hexapod.packed, as_joint(joint), s.platform, s.base, wrench(force, moment, ()), rest.unstretched_length
    )
    r = s.platform[0, :3] - s.base[0, :3]
    carry = np.eye(6)
    carry[:3, 3:] = skew(r).T
    return Linearisation(M, C, K, M_b, C_b, K_b, H, hexapod.legs.stiffness, rest, carry, hexapod.gravity)
