"""The linearised machine shaken at given frequencies: its steady response, accurate at the sharpest resonance too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod.checks import floats
from flexapod.conventions import Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import Linearisation
from flexapod.mechanics.symmetric_pencil import pencil_modes

MOST_LOSS = 1e30  #: of a loss factor
_BLOCK = 4096  # frequencies solved at a time: bounds the memory


class SteadyResponse(NamedTuple):
    """Complex amplitudes (n, 6, 6) of x(t) = Re(X e^{i omega t}): the platform's small displacement, inertial axes.

    absolute: per base displacement; relative: the same less the rigid motion with the base. wrench: per wrench on the
    platform's reference point. command: per commanded change of each leg's unstretched length.
    """

    absolute: Complex
    relative: Complex
    wrench: Complex
    command: Complex


def leg_losses(hexapod: Hexapod, value: ArrayLike | None) -> Array:
    """Loss factors of the springs along the legs, (6,): those given, one or six, or those of the design.

    Raises ArgumentError unless they are finite and not negative.
    """
    if value is None:
        return hexapod.legs.loss_factor
    try:
        eta = np.broadcast_to(floats(value), (6,))
    except (TypeError, ValueError) as error:
        raise ArgumentError(f"loss_factor is {value!r}; give one number, or six for the legs") from error
    if not ((eta >= 0) & (eta <= MOST_LOSS)).all():
        raise ArgumentError(
            f"loss_factor is {value!r}; it must be finite and not negative, and at most {MOST_LOSS:g}. Use 0 for "
            "lossless legs."
        )
    return eta


def losses(hexapod: Hexapod, linear: Linearisation, value: ArrayLike | None) -> Array:
    """Loss factors of all springs, the columns of `linear.springs`, (m,); value: of the legs, None for the design's."""
    eta = linear.losses.copy()
    eta[:6] = leg_losses(hexapod, value)
    return eta


def loss_matrix(linear: Linearisation, losses: Array) -> Array:
    """Imaginary part of the stiffness matrix at frequencies > 0, (6, 6), for the loss factors (m,) of all springs."""
    along, others = linear.H * (losses[:6] * linear.leg_stiffness), linear.springs[:, 6:]
    return np.asarray(along @ linear.H.T + (others * losses[6:]) @ others.T)


def steady_response(linear: Linearisation, omega: Array, losses: ArrayLike = 0.0) -> SteadyResponse:
    """Steady response at omega (n,) rad/s; infinite at an undamped resonance.

    losses: of each spring, (m,) or one number. A spring's stiffness is k (1 + i eta), against base motion and against
    commands alike. Solved in the undamped modes, where K - omega^2 M is (omega_m - omega)(omega_m + omega): its
    cancellation near resonance costs no digits.
    """
    out = SteadyResponse(*(np.empty((omega.size, 6, 6), dtype=np.complex128) for _ in range(4)))
    basis = _Modes(linear, losses)
    # Below the highest resonance the motion is near the base's, above it nearly none is left: what is small is solved
    # for, and the other is found from it without a small difference.
    fast = omega**2 > basis.square[-1]
    for start in range(0, omega.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        base, out.wrench[part], out.command[part] = np.split(basis.solve(omega[part], fast[part]), 3, axis=2)
        rigid = np.where(fast[part, None, None], linear.carry, 0.0)
        out.relative[part] = base - rigid
        out.absolute[part] = base + (linear.carry - rigid)
    return out


class _Modes:
    """The dynamic stiffness and its right-hand sides in undamped modes."""

    def __init__(self, linear: Linearisation, losses: ArrayLike) -> None:
        square, self.shape = pencil_modes(0.5 * (linear.K + linear.K.T), linear.M)
        left = self.shape.T
        self.square = square
        self.skew = left @ (0.5 * (linear.K - linear.K.T)) @ self.shape  # only a wrench that turns makes K unsymmetric
        eta = np.broadcast_to(losses, linear.springs.shape[1])
        self.loss = left @ loss_matrix(linear, eta) @ self.shape
        self.friction = left @ linear.C @ self.shape
        # Rigid motion with the base meets no spring, and a turned base turns gravity: K carry + K_b is known without
        # the cancellation, which would drown slow motion. It meets no friction either, but in the model "spin_free".
        lifted = (linear.M + linear.M_b)[:, :3]
        self.tilt = left @ np.hstack([np.zeros((6, 3)), np.cross(linear.gravity, lifted)])
        rubbed = linear.C @ linear.carry + linear.C_b
        rounding = 1e-14 * np.abs(linear.C).max() * np.abs(linear.carry).max()
        self.rubbed = left @ np.where(np.abs(rubbed) > rounding, rubbed, 0.0)
        self.inertia = left @ (linear.M @ linear.carry + linear.M_b)
        self.base = (
            left @ linear.M_b,
            left @ linear.C_b,
            left @ linear.K_b - 1j * self.loss @ left @ linear.M @ linear.carry,
        )
        command = linear.H * (linear.command_stiffness + 1j * eta[:6] * linear.leg_stiffness)  # wrench of unit commands
        self.given = np.hstack([left, left @ command])

    def solve(self, omega: Array, absolute: NDArray[np.bool_]) -> Complex:
        """Displacements (n, 6, 18) per base displacement, wrench and command; absolute: else less the rigid motion."""
        w = omega[:, None, None]
        root = np.sqrt(self.square.astype(np.complex128))  # imaginary for a mode that gravity topples
        detuning = (root - omega[:, None]) * (root + omega[:, None])
        Z: Complex = self.skew + 1j * self.loss + 1j * w * self.friction
        Z[:, range(6), range(6)] += detuning
        given = np.broadcast_to(self.given, (omega.size, 6, 12))
        mass, damping, stiffness = (
            np.where(absolute[:, None, None], whole, less)
            for whole, less in zip(self.base, (self.inertia, self.rubbed, self.tilt), strict=True)
        )
        right = np.concatenate([w**2 * mass - 1j * w * damping - stiffness, given], axis=2)
        return self.shape @ _solve(Z, right)


def _solve(Z: Complex, right: Complex) -> Complex:
    try:
        return np.asarray(np.linalg.solve(Z, right), dtype=np.complex128)
    except np.linalg.LinAlgError:  # an undamped resonance hit exactly
        out: Complex = np.full(right.shape, np.inf, dtype=np.complex128)
        for i in np.flatnonzero(np.linalg.matrix_rank(Z) == 6):
            out[i] = np.linalg.solve(Z[i], right[i])
        return out


def complex_poles(linear: Linearisation, losses: ArrayLike = 0.0) -> Complex:
    """Six poles (rad/s) with Im > 0 by size, of a motion e^{pt}, with the springs' losses: as seen at omega > 0."""
    if not np.any(losses):
        return linear.modes().pole.astype(np.complex128)
    modes = _Modes(linear, losses)
    zero, scale = np.zeros((6, 6)), np.sqrt(np.abs(modes.square).max())
    stiffness = np.diag(modes.square) + modes.skew + 1j * modes.loss
    A = np.block([[zero, scale * np.eye(6)], [-stiffness / scale, -modes.friction]])
    poles = np.linalg.eigvals(A)
    upper = poles[np.argsort(-poles.imag)[:6]]
    return upper[np.argsort(np.abs(upper))]
