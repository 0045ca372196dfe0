"""The linearised machine under control, shaken at given frequencies by its base and by wrenches on its platform."""

from __future__ import annotations

import copy
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.control.linear_controller import Controller
from flexapod.control.plant import Plant, held
from flexapod.conventions import Array, Complex
from flexapod.vibration.harmonic import loss_matrix

_BLOCK = 2048  # frequencies solved at a time: bounds the memory


class LoopResponse(NamedTuple):
    """Amplitudes per base displacement and, in the last six columns, per wrench on the platform's reference point.

    Absolute and relative displacement and leg forces (springs and actuators; compression > 0), (n, 6, 12); force: what
    the controller gives.
    """

    absolute: Complex
    relative: Complex
    leg_force: Complex
    force: Complex


def loop_response(plant: Plant, omega: Array, controller: Controller | None) -> LoopResponse:
    """Steady response at omega (n,) > 0 rad/s with a controller, or without one.

    Of a sampled loop it is the component at the frequency of the excitation: the samples meet the plant with its forces
    held, exactly. What the hold adds at other frequencies is left out.
    """
    blocks = [
        _block(plant, omega[start : start + _BLOCK], controller) for start in range(0, max(omega.size, 1), _BLOCK)
    ]
    return LoopResponse(*(np.concatenate(parts) for parts in zip(*blocks, strict=True)))


def lossy(plant: Plant) -> Plant:
    """The plant at frequencies > 0, where the stiffness of each spring is k (1 + i eta): A and C are complex."""
    linear, eta = plant.linear, plant.linear.losses
    found = copy.copy(plant)
    A, C = plant.A.astype(np.complex128), plant.C.astype(np.complex128)
    slowed = 1j * np.linalg.solve(linear.M, loss_matrix(linear, eta)) / plant.omega_0
    A[6:, :6] -= slowed
    C[plant.measured(("acceleration",)), :6] -= slowed
    C[plant.measured(("leg_force",)), :6] -= 1j * (eta[:6] * linear.leg_stiffness)[:, None] * linear.H.T / plant.omega_0
    found.A, found.C = A, C
    return found


def _block(plant: Plant, omega: Array, controller: Controller | None) -> LoopResponse:
    s = 1j * omega[:, None, None].astype(np.complex128)
    M_inv, n = np.linalg.inv(plant.linear.M), omega.size
    base = np.concatenate([s**2 * np.eye(6), np.broadcast_to(np.eye(6), (n, 6, 6))], axis=1)
    pushed, felt = np.vstack([np.zeros((6, 6)), M_inv]), np.zeros((len(plant.C), 6))
    felt[plant.measured(("acceleration",))] = M_inv
    inputs = [np.broadcast_to(plant.B, (n, 12, 6)), plant.E @ base, np.broadcast_to(pushed, (n, 12, 6))]
    direct = [np.broadcast_to(plant.D, (n, *plant.D.shape)), plant.G @ base, np.broadcast_to(felt, (n, *felt.shape))]
    z = np.linalg.solve(s * np.eye(12) - plant.A, np.concatenate(inputs, axis=2).astype(complex))
    y = plant.C @ z + np.concatenate(direct, axis=2)
    by_force, given = y[..., :6], y[..., 6:]
    force = np.zeros((n, 6, 12), dtype=complex)
    if controller is not None:
        rows = plant.measured(controller.measures)
        K, hold, through = _gain_at(controller, s), np.ones_like(s), by_force[:, rows]
        if (dt := controller.dt) is not None:
            hold, through = (1 - np.exp(-s * dt)) / (s * dt), _sampled(plant, rows, dt, s)
        force = hold * np.linalg.solve(np.eye(6) - K @ through, K @ given[:, rows])
        given = given + by_force @ force
    acceleration, relative, leg_force = (
        given[:, plant.measured((name,))] for name in ("acceleration", "position", "leg_force")
    )
    # What is small is not told as a difference of what is not: slow motion is near the base's, fast one leaves little.
    rigid = np.hstack([plant.linear.carry, np.zeros((6, 6))])
    absolute = np.where(omega[:, None, None] > plant.omega_0, acceleration / s**2, relative + rigid)
    return LoopResponse(absolute, relative, leg_force, force)


def _sampled(plant: Plant, rows: NDArray[np.int64], dt: float, s: Complex) -> Complex:
    """What is measured per force of the samples; at the instant of a sample the force before still acts."""
    A_d, B_d, _ = held(plant, dt)
    later = np.exp(s * dt)
    moved = np.linalg.solve(later * np.eye(12) - A_d, B_d.astype(complex)[None])
    return np.asarray(plant.C[rows] @ moved + plant.D[rows] / later)


def _gain_at(controller: Controller, s: Complex) -> Complex:
    """The controller's forces, before any hold, per measurement."""
    K = controller
    if K.order == 0:
        return np.broadcast_to(K.D, (len(s), *K.D.shape)).astype(np.complex128)
    at = s if K.dt is None else np.exp(s * K.dt)
    inner = np.linalg.solve(at * np.eye(K.order) - K.A, np.broadcast_to(K.B, (len(s), *K.B.shape)).astype(complex))
    return np.asarray(K.C @ inner + K.D, dtype=np.complex128)
