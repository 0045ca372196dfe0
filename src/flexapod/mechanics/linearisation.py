"""The exact linear dynamics about static equilibrium: geometric stiffness, gravity, damping, moving base."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod._suggestions import suggests
from flexapod.conventions import TWO_PI, Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.inputs import ZERO, at_once, single_base, single_pose, wrench
from flexapod.mechanics.modes import MODE_WORDS
from flexapod.mechanics.state_space import StateSpace, state_space_of
from flexapod.mechanics.statics import Equilibrium, hold
from flexapod.optional import needed
from flexapod.pose import Motion, Pose, PoseLike
from flexapod.showing import drawn, in_notebooks

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    import control


@in_notebooks
@suggests(MODE_WORDS | {"poles": "pole"})
class DampedModes(NamedTuple):
    """The six modes of the linearised dynamics with the base fixed.

    Attributes
    ----------
    pole : ndarray
        Poles, rad/s, complex, (6,), in the upper half plane or real, by modulus.
    omega : ndarray
        Moduli of the poles, rad/s, (6,).
    damping_ratio : ndarray
        Damping ratios, (6,), negative where a mode grows, and 0 where only rounding damps it.
    shape : ndarray
        Twists of the platform as columns, complex, (6, 6), scaled so that shape^T M shape = 1 with a real largest part.
    """

    pole: Complex
    omega: Array
    damping_ratio: Array
    shape: Complex

    @property
    def frequency(self) -> Array:
        """Moduli of the poles, Hz, (6,)."""
        return self.omega / TWO_PI

    def plot(
        self, *, ax: Axes | None = None, tangent: ArrayLike | None = None, labels: Sequence[str] | None = None
    ) -> Axes:
        """Draw the six frequencies of one pose, in Hz: `plots.frequencies`, with its options."""
        return drawn(self, ax=ax, tangent=tangent, labels=labels)


_ROUNDING = 1e-13  # of the largest pole: a smaller real or imaginary part is rounding, and 0

_WORDS = {
    "mass_matrix": "M",
    "damping_matrix": "C",
    "stiffness_matrix": "K",
    "poles": "modes() (its pole)",
    "frequency": "modes() (its frequency in Hz)",
    "omega": "modes() (its omega in rad/s)",
    "damping_ratio": "modes() (its damping_ratio)",
}


@in_notebooks
@suggests(_WORDS)
@dataclass(frozen=True, eq=False)
class Linearisation:
    """Linear dynamics M x'' + C x' + K x + M_b x_b'' + C_b x_b' + K_b x_b = H f + w about rest.

    All matrices are (6, 6), SI, in inertial axes. x and x_b are small displacements of platform and base: translation
    of the reference point (m) and rotation vector (rad). f is the change of the leg forces (N) beside their springs, w
    the change of the wrench on the platform (N, N m), which, like the static one, turns with the platform. A command
    that lengthens leg i's unstretched length by d acts as f = command_stiffness_i d.

    Attributes
    ----------
    M, C, K : ndarray
        Mass, damping and stiffness of the platform on its legs. K holds the stiffness of legs, joints and suspension,
        the geometric stiffness of loaded legs and joints, gravity and the turning external wrench; with an external
        wrench it need not be symmetric.
    M_b, C_b, K_b : ndarray
        Coupling to the motion of the base.
    H : ndarray
        Force transformation.
    leg_stiffness : ndarray
        Axial stiffness of the legs at their unstretched lengths, with springs in series, N/m, (6,).
    rest : Equilibrium
        The equilibrium about which the dynamics are linear.
    carry : ndarray
        A platform that moves rigidly with the base has x = carry x_b.
    gravity : ndarray
        Gravity, m/s2, (3,).
    springs : ndarray
        F, (6, m), a column for each spring: without load, gravity and damping K is F F^T.
    command_stiffness : ndarray
        Change of a leg's force by its unstretched length, N/m, (6,): `leg_stiffness`, and by a stiffness law what the
        preload changes with it.
    losses : ndarray
        Structural loss factor that the design gives each column of `springs`, (m,).
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
    carry: Array
    gravity: Array
    springs: Array
    command_stiffness: Array
    losses: Array

    def modes(self) -> DampedModes:
        """Compute the complex modes with the base fixed; of a pair of real poles, the slower or growing one."""
        pole, omega, ratio, shape = self._modes
        return DampedModes(pole.copy(), omega.copy(), ratio.copy(), shape.copy())

    @cached_property
    def _modes(self) -> DampedModes:
        """Computed once: a response needs them for its frequencies and to tell whether the machine stands."""
        zero, one = np.zeros((6, 6)), np.eye(6)
        A = np.block([[zero, one], [-np.linalg.solve(self.M, self.K), -np.linalg.solve(self.M, self.C)]])
        scale = np.sqrt(np.abs(np.linalg.eigvals(A[6:, :6])).max())  # balances displacements against rates
        balanced = np.block([[zero, scale * one], [A[6:, :6] / scale, A[6:, 6:]]])
        poles, vectors = np.linalg.eig(balanced)
        poles = poles.astype(np.complex128)  # where all are real, they come as real numbers
        poles.real[np.abs(poles.real) < _ROUNDING * np.abs(poles).max()] = 0.0
        poles, vectors = _double_poles_joined(poles, vectors.astype(np.complex128))
        chosen = _one_of_each_pair(poles, vectors[:6], self.M)
        pole, shape = poles[chosen], vectors[:6, chosen]
        shape = shape / np.sqrt(np.einsum("im,ij,jm->m", shape, self.M, shape))
        largest = shape[np.abs(shape).argmax(axis=0), range(6)]
        shape = shape * np.where(largest.real < 0, -1.0, 1.0)
        omega = np.abs(pole)
        with np.errstate(invalid="ignore"):
            ratio = -pole.real / omega + 0.0
        return DampedModes(pole, omega, ratio, shape)

    def state_space(self) -> StateSpace:
        """Twelve states: the platform's displacement and velocity relative to a frame carried by the base.

        Inputs (24): base acceleration in the inertial frame (m/s2, rad/s2), leg forces (N), wrench (N, N m), leg length
        commands (m). Outputs (24): relative displacement (m, rad), change of leg lengths (m) and of the force in the
        legs' springs and actuators (N), absolute acceleration (m/s2, rad/s2). Exact but for two effects that twelve
        states cannot hold and `transmissibility` keeps: a tilted base tilts gravity, and in the model "spin_free" a
        turning base rubs on legs that do not spin with it.
        """
        return state_space_of(self)

    def to_control(self) -> control.StateSpace:
        """The state space as a `control.StateSpace` with named signals; needs python-control (extra "control").

        Raises
        ------
        MissingExtraError
            Where python-control is not installed.
        """
        control = needed("control", "control", "to_control needs python-control")
        s = self.state_space()
        return control.ss(
            s.A, s.B, s.C, s.D, states=list(s.states), inputs=list(s.inputs), outputs=list(s.outputs), name="hexapod"
        )


def _double_poles_joined(poles: Complex, vectors: Complex) -> tuple[Complex, Complex]:
    """Double real poles, which rounding may have made a pair beside the real axis, as two with real shapes."""
    poles, vectors = poles.copy(), vectors.copy()
    beside = (poles.imag != 0) & (np.abs(poles.imag) < _ROUNDING * np.abs(poles).max())
    for i in np.flatnonzero(beside & (poles.imag > 0)):
        (pair,) = np.flatnonzero(poles == poles[i].conj())
        vectors[:, [i, pair]] = np.stack([vectors[:, i].real, vectors[:, i].imag], axis=1)
    poles.imag[beside] = 0.0
    return poles, vectors


def _one_of_each_pair(poles: Complex, shapes: Complex, M: Array) -> list[int]:
    """Indices of six poles out of twelve: the upper one of each complex pair, of real ones the slower or the growing.

    Two real poles are a pair by their shapes, which they share, and do not both grow: shapes of equal poles are those
    that rounding leaves, and may be more alike than those of a pair. Ordered by modulus.
    """
    chosen = [i for i, p in enumerate(poles) if p.imag > 0]
    real = sorted((i for i, p in enumerate(poles) if p.imag == 0), key=lambda i: -poles[i].real)
    weighted = np.linalg.cholesky(M).T @ shapes
    overlap = np.abs(weighted.conj().T @ weighted) / np.outer(*2 * [np.linalg.norm(weighted, axis=0)])
    while real:
        first = real.pop(0)
        chosen.append(first)
        if real:
            decaying = [i for i in real if poles[i].real <= 0]
            real.remove(max(decaying or real, key=lambda i: overlap[first, i]))
    return sorted(chosen, key=lambda i: abs(poles[i]))


def linearise(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Linearisation:
    """Linearise the equations of motion about a pose held at rest under gravity and a load.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    pose : Pose or array_like, optional
        Pose of the platform, one: a Pose, or x, y, z in m and roll, pitch, yaw in rad. Left out, the home pose.
    base : Pose or array_like, optional
        Pose of the base in the inertial frame. Left out, the base frame is the inertial frame.
    force, moment : array_like
        Force (N) and moment (N m) on the platform, in its own frame, at its reference point, (..., 3).
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Linearisation
        Mass, damping and stiffness matrices (`M`, `C`, `K`), the coupling to the base, and methods `modes` and
        `state_space`.

    Raises
    ------
    PoseError
        For a batch of poses, or at a pose that no leg can take.
    SingularPoseError
        Where no leg forces hold the pose.
    ArgumentError
        For loads of a wrong shape, or an unknown joint model.

    See Also
    --------
    flexapod.natural_modes : The undamped modes without preload and gravity.
    flexapod.transmissibility : The response to a moving base.

    Notes
    -----
    The tangent of Eq. 34 of the paper by exact derivatives. Its frequencies approach those of `natural_modes` as the
    legs stiffen.

    Examples
    --------
    >>> tangent = fx.linearise(fx.load("cubic-isolator"))
    >>> tangent.modes().frequency.round(2).tolist()  # Hz
    [4.6, 4.6, 4.8, 4.94, 4.94, 8.06]
    """
    moving = isinstance(pose, Motion) or isinstance(base, Motion)  # refused below
    found = None if moving else at_once("linearise", hexapod, pose, base, joint, force, moment)
    if found is None:
        pose, base = single_pose(hexapod, pose), single_base(hexapod, base)
        hold(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
        (load,) = wrench(force, moment, ())
        found = at_once("linearise", hexapod, pose, base, joint, *np.split(load, 2))
    if found is None:
        raise SingularPoseError(
            "no leg forces of finite size hold this pose: it is singular but for rounding. Move the platform away."
        )
    (M, C, K, M_b, C_b, K_b, H, carry), legs, F, numbers = found
    leg_force, leg_length, unstretched, stiffness, command = legs
    at = hexapod.home if pose is None else pose
    at = at if isinstance(at, Pose) else Pose.trusted(numbers[:3], numbers[3:].reshape(3, 3))
    rest = Equilibrium(at, leg_force, leg_length, unstretched)
    losses = hexapod.legs.spring_losses[: F.shape[1]]
    return Linearisation(M, C, K, M_b, C_b, K_b, H, stiffness, rest, carry, hexapod.gravity, F, command, losses)
