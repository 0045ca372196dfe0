"""Plant and controller as linear systems, and their closed loop: what all studies of control share.

The plant is the exact tangent (linear.py) seen from the base: x = displacement of the platform relative to a frame that
the base carries, in inertial axes, driven by six leg forces f beside the springs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array, Complex
from flexapod.errors import ArgumentError, UnstableError
from flexapod.mechanics.linearisation import Linearisation
from flexapod.optional import needed

Measure = Literal["leg_length", "leg_rate", "leg_force", "position", "velocity", "acceleration"]
MEASURES = tuple(cast(Measure, measure.name) for measure in _core.Measure)
UNITS = dict(zip(MEASURES, ("m", "m/s", "N", "m, rad", "m/s, rad/s", "m/s2, rad/s2"), strict=True))


class Plant:
    """z' = A z + B f + E w, y = C z + D f + G w with z = (omega_0 x, x'), w = (base acceleration, base displacement).

    omega_0 (the largest of the natural frequencies) balances displacements and rates, so that eigenvalues are found
    well. y holds the six kinds of measurement in the order of MEASURES, each as a change from rest: leg lengths, their
    rates, forces of springs and actuators in the legs (compression > 0), relative displacement, its rate, and absolute
    acceleration. Base displacement enters by the tilt of gravity alone.
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
        blocks = [np.hstack(rows[name]) for name in MEASURES]
        y = np.vstack(blocks)
        self.C, self.D, self.G = y[:, :12], y[:, 12:18], y[:, 18:]

    @property
    def omega(self) -> Array:
        """(6,) natural frequencies of the machine without control, rad/s, ascending."""
        return self.linear.modes().omega

    def measured(self, names: tuple[Measure, ...]) -> Array:
        """Rows of y that hold the measurements named."""
        return np.concatenate([np.arange(6) + 6 * MEASURES.index(name) for name in names])


@dataclass(frozen=True, eq=False)
class Controller:
    """x_c' = A x_c + B y, f = C x_c + D y: from measurements (changes from rest) to six leg forces, N.

    With a sampling time dt (s) instead x_c[k+1] = A x_c[k] + B y[k], and f is held from one sample to the next.
    A: (n, n). B: (n, m). C: (6, n). D: (6, m). measures: the kinds of y, six numbers each, in this order. name: text.

    Source: own.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    measures: tuple[Measure, ...]
    name: str
    dt: float | None = None

    def on(self, linear: Linearisation) -> Controller:
        """Itself: a controller is already made for its machine."""
        return self

    @property
    def order(self) -> int:
        """How many states it has."""
        return len(self.A)

    def sampled(self, dt: float, method: str = "tustin", delay: int = 0) -> Controller:
        """This controller run at a sampling time dt, s, discretised by python-control's method ("tustin", "zoh", ...).

        delay: whole samples by which the computed force comes late (0 or more).

        Raises: ArgumentError for a time that is not > 0, a delay that is no whole number, or a controller that is
        sampled already; MissingExtraError without python-control.
        """
        if self.dt is not None:
            raise ArgumentError(f"this controller is sampled already, every {self.dt:.6g} s; sample the continuous one")
        if not (np.isfinite(dt) and dt > 0):
            raise ArgumentError(f"dt is {dt} s; a sampling time must be > 0")
        if delay < 0 or int(delay) != delay:
            raise ArgumentError(f"delay is {delay}; it must be a whole number of samples, 0 or more")
        found = Controller(self.A, self.B, self.C, self.D, self.measures, self.name, float(dt))
        if self.order:
            control = needed("control", "control", "sampling a controller needs python-control")
            system = control.sample_system(control.ss(self.A, self.B, self.C, self.D), dt, method=method)
            found = replace(found, A=system.A, B=system.B, C=system.C, D=system.D)
        for _ in range(int(delay)):
            found = found._late()
        return found

    def _late(self) -> Controller:
        """The same with its force one sample later."""
        n = self.order
        A = np.block([[self.A, np.zeros((n, 6))], [self.C, np.zeros((6, 6))]])
        C = np.hstack([np.zeros((6, n)), np.eye(6)])
        return replace(self, A=A, B=np.vstack([self.B, self.D]), C=C, D=np.zeros_like(self.D))


class Law(Protocol):
    """What makes a controller for a machine at a pose."""

    def on(self, linear: Linearisation) -> Controller:
        """The controller for this tangent."""


def static(D: Array, measures: tuple[Measure, ...], name: str) -> Controller:
    """A controller without states: f = D y."""
    return Controller(np.zeros((0, 0)), np.zeros((0, D.shape[1])), np.zeros((6, 0)), D, measures, name)


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
    found = np.linalg.eigvals(joined(plant, controller)).astype(complex)
    if controller.dt is not None:
        found = np.log(found[np.abs(found) > 1e-9]) / controller.dt
    return found[np.lexsort((found.imag, np.abs(found)))]


def is_stable(pole: Complex, plant: Plant) -> np.ndarray:
    """(...) whether all poles (..., n) are in the left half plane, with room for rounding."""
    return np.asarray((pole.real < 1e-11 * plant.omega_0).all(axis=-1))


def damping_ratios(pole: Complex) -> Array:
    """-Re p / |p|; 1 for a pole at zero (an integrator that nothing moves)."""
    size = np.abs(pole)
    return np.where(size > 0, -pole.real / np.where(size > 0, size, 1.0), 1.0)


def six_by_six(value: ArrayLike, name: str) -> Array:
    """A gain as a 6 x 6 matrix: one number, six, or a matrix. Raises ArgumentError for anything else."""
    try:
        gain = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is {value!r}; give a number, six numbers, or a 6 x 6 matrix") from None
    if gain.shape not in ((), (6,), (6, 6)) or not np.isfinite(gain).all():
        raise ArgumentError(
            f"{name} has shape {gain.shape} and must be a finite number, six numbers, or a 6 x 6 matrix"
        )
    return gain if gain.ndim == 2 else np.diag(np.broadcast_to(gain, 6))
