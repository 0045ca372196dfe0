"""The linearised hexapod as a plant, and its closed loop with a controller: what all studies of control share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from flexapod.control.linear_controller import MEASUREMENTS, Controller, Measurement, signals
from flexapod.conventions import Array, Complex
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.linearisation import Linearisation


class Plant:
    """The linearised hexapod z' = A z + B f + E w, y = C z + D f + G w, with z = (omega_0 x, x').

    x is the displacement of the platform relative to a frame that the base carries, in inertial axes; f are six leg
    forces beside the springs; w = (base acceleration, base displacement), of which the displacement enters by the tilt
    of gravity alone. omega_0, the largest natural frequency, balances displacements and rates, so that eigenvalues are
    accurate. y holds the kinds of measurement in the order of MEASUREMENTS, six numbers each, as changes from rest: leg
    lengths, their rates, forces of springs and actuators in the legs (compression > 0), relative displacement, its
    rate, and absolute acceleration.
    """

    def __init__(self, linear: Linearisation) -> None:
        self.linear = linear
        zero, one = np.zeros((6, 6)), np.eye(6)
        M_inv = np.linalg.inv(linear.M)
        self.omega_0 = float(np.sqrt(np.abs(np.linalg.eigvals(M_inv @ linear.K)).max()))
        K, C, H = M_inv @ linear.K / self.omega_0, M_inv @ linear.C, M_inv @ linear.H
        self.A = np.block([[zero, self.omega_0 * one], [-K, -C]])
        self.B = np.vstack([zero, H])
        accelerated = -M_inv @ (linear.M @ linear.carry + linear.M_b)
        tilted = -M_inv @ (linear.K @ linear.carry + linear.K_b)
        tilted[:, :3] = 0.0  # a translated base changes nothing; what is left there is rounding
        self.E = np.block([[zero, zero], [accelerated, tilted]])
        rate = linear.H.T
        spring = -linear.leg_stiffness[:, None] * rate
        rows = {
            "leg_length": [rate / self.omega_0, zero, zero, zero, zero],
            "leg_rate": [zero, rate, zero, zero, zero],
            "leg_force": [spring / self.omega_0, zero, one, zero, zero],
            "position": [one / self.omega_0, zero, zero, zero, zero],
            "velocity": [zero, one, zero, zero, zero],
            "acceleration": [-K, -C, H, accelerated + linear.carry, tilted],
        }
        blocks = [np.hstack(rows[name]) for name in MEASUREMENTS]
        y = np.vstack(blocks)
        self.C, self.D, self.G = y[:, :12], y[:, 12:18], y[:, 18:]

    @property
    def omega(self) -> Array:
        """(6,) natural frequencies of the machine without control, rad/s, ascending."""
        return self.linear.modes().omega

    def measured(self, names: tuple[Measurement, ...]) -> NDArray[np.int64]:
        """Rows of y that hold the measurements named."""
        return signals(*names)


def joined(plant: Plant, controller: Controller) -> Array:
    """The closed loop's matrix over (z, x_c), or for a sampled controller over (z, x_c, force held), per sample."""
    rows = plant.measured(controller.measures)
    C, D = plant.C[rows], plant.D[rows]
    if controller.dt is None:
        return _continuous(plant, controller, C, D)
    A_d, B_d, _ = held(plant, controller.dt)
    n = controller.order
    # The measurement is taken while the force of the sample before still acts.
    y = np.hstack([C, np.zeros((len(rows), n)), D])
    force = controller.D @ y
    force[:, 12 : 12 + n] += controller.C
    z = np.hstack([A_d, np.zeros((12, n + 6))]) + B_d @ force
    x_c = controller.B @ y
    x_c[:, 12 : 12 + n] += controller.A
    return np.vstack([z, x_c, force])


def _continuous(plant: Plant, controller: Controller, C: Array, D: Array) -> Array:
    through = controller.D @ D
    loop = np.eye(6) - through
    if np.linalg.svd(loop, compute_uv=False)[-1] < 1e-12 * (1 + np.linalg.norm(through, 2)):
        raise UnstableError(
            f"the loop of {controller.name} is not well posed: its measurement depends at once on its own force with "
            "gain one. Change the gain, or measure something else."
        )
    force = np.linalg.solve(loop, np.hstack([controller.D @ C, controller.C]))
    y = np.hstack([C, np.zeros((len(C), controller.order))]) + D @ force
    z = np.hstack([plant.A, np.zeros((12, controller.order))]) + plant.B @ force
    x_c = controller.B @ y
    x_c[:, 12:] += controller.A
    return np.vstack([z, x_c])


def held(plant: Plant, dt: float) -> tuple[Array, Array, Array]:
    """The plant over one sample with its inputs held: z[k+1] = A z + B f + E w."""
    from scipy.linalg import expm

    inputs = np.hstack([plant.B, plant.E])
    whole = expm(dt * np.block([[plant.A, inputs], [np.zeros((18, 30))]]))
    return whole[:12, :12], whole[:12, 12:18], whole[:12, 18:]


def poles(plant: Plant, controller: Controller) -> Complex:
    """Poles of the closed loop, rad/s, by size. Those of a sampled loop are log(z)/dt; z = 0 (a delay) is left out."""
    with np.errstate(over="ignore", invalid="ignore"):
        loop = joined(plant, controller)
    found = _eigenvalues(loop, plant, controller.name)
    if controller.dt is not None:
        found = (np.log(found[np.abs(found) > 1e-9]) / controller.dt).astype(complex)
    return found[np.lexsort((found.imag, np.abs(found)))]


def poles_over(plant: Plant, law: Callable[[float], Controller], gains: Array) -> Complex:
    """Poles (n, m) of continuous loops, rad/s, by size, at gains (n,) that the loop's matrix is linear in."""
    most = float(gains.max())
    with np.errstate(over="ignore", invalid="ignore"):
        none, whole = joined(plant, law(0.0)), joined(plant, law(most))
        loops = none + (gains / most)[:, None, None] * (whole - none)
    found = _eigenvalues(loops, plant, law(most).name)
    return np.take_along_axis(found, np.lexsort((found.imag, np.abs(found)), axis=-1), axis=-1)


def _eigenvalues(loop: Array, plant: Plant, name: str) -> Complex:
    """Eigenvalues (..., m) of the matrices of loops. Raises ArgumentError where they hold more than numbers can be."""
    if not np.isfinite(loop).all():
        raise ArgumentError(
            f"the loop of {name} holds numbers beyond all bounds: its gains or its sampling time are too large for a "
            f"machine with poles of up to {np.abs(np.linalg.eigvals(plant.A)).max():.3g} rad/s. Lower them, or move "
            "away from a singular pose."
        )
    return np.linalg.eigvals(loop).astype(complex)


def is_stable(pole: Complex, plant: Plant) -> np.ndarray:
    """(...) whether all poles (..., n) are in the left half plane, with room for rounding."""
    return np.asarray((pole.real < 1e-11 * plant.omega_0).all(axis=-1))


def damping_ratios(pole: Complex) -> Array:
    """-Re p / |p|; 1 for a pole at zero (an integrator that nothing moves)."""
    size = np.abs(pole)
    return np.where(size > 0, -pole.real / np.where(size > 0, size, 1.0), 1.0)
