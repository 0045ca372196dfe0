"""What the linearised hexapod predicts of a sampled controller on a moving base."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.control.linear_controller import Controller, signals
from flexapod.control.plant import Plant
from flexapod.conventions import Array
from flexapod.excitation.excitation import Excitation

_FINER = 8  # steps within one of the simulation, over which base acceleration is linear


class Clock(NamedTuple):
    """Sampling time dt (s), how many samples, and the integrator's steps in each of them."""

    dt: float
    samples: int
    steps: int

    @property
    def times(self) -> Array:
        """(rows,) at which motions are recorded, s."""
        return np.asarray(np.arange(self.samples * self.steps + 1) * (self.dt / self.steps), dtype=np.float64)


class Recording(NamedTuple):
    """Motion and forces of the hexapod with one controller."""

    measured: Array  # (rows, 36)
    displacement: Array  # (rows, 6)
    force: Array  # (samples, 6)
    limited: Array  # (samples,) whether a force was limited


def predict(plant: Plant, controller: Controller, base_motion: Excitation, clock: Clock, noise: Array) -> Recording:
    """The response without force limits: exact but for base acceleration, which is linear over short steps."""
    fine = clock.steps * _FINER
    h = clock.dt / fine
    A, B, start, end = _ramped(plant, h)
    at = np.arange(clock.samples * fine + 1) * h
    value, _, acceleration = base_motion.evaluate(at)
    w = np.concatenate([acceleration, value], axis=1)
    drive = (w[:-1] @ start.T + w[1:] @ end.T).reshape(clock.samples, fine, 12)
    shaken = np.zeros((clock.samples, 12))
    by_base = np.empty((clock.samples, clock.steps, 12))
    by_state, by_force = np.eye(12), np.zeros((12, 6))
    maps = []
    for i in range(fine):
        shaken = shaken @ A.T + drive[:, i]
        by_state, by_force = A @ by_state, A @ by_force + B
        if (i + 1) % _FINER == 0:
            by_base[:, i // _FINER] = shaken
            maps.append((by_state, by_force))
    to_state, to_force = (np.stack(m) for m in zip(*maps, strict=True))
    z, force, x = np.zeros(12), np.zeros(6), np.zeros(controller.order)
    rows = plant.measured(controller.measures)
    C, D, G = plant.C[rows], plant.D[rows], plant.G[rows]
    forces = np.empty((clock.samples, 6))
    states = np.empty((clock.samples, clock.steps, 12))
    for k in range(clock.samples):
        y = C @ z + D @ force + G @ w[k * fine] + noise[k, rows]
        force, x = controller.C @ x + controller.D @ y, controller.A @ x + controller.B @ y
        forces[k] = force
        states[k] = to_state @ z + to_force @ force + by_base[k]
        z = states[k, -1]
    every = np.vstack([np.zeros(12), states.reshape(-1, 12)])
    held = np.vstack([np.zeros(6), np.repeat(forces, clock.steps, axis=0)])
    base = w[::_FINER]
    measured = every @ plant.C.T + held @ plant.D.T + base @ plant.G.T
    displacement = measured[:, signals("position")] + value[::_FINER] @ plant.linear.carry.T
    return Recording(measured, displacement, forces, np.zeros(clock.samples))


def _ramped(plant: Plant, h: float) -> tuple[Array, Array, Array, Array]:
    """Over a step h: z' = A z + B f + E_0 w(start) + E_1 w(end), the force held and w linear."""
    from scipy.linalg import expm

    whole = np.zeros((42, 42))
    whole[:12] = np.hstack([plant.A, plant.B, plant.E, np.zeros((12, 12))])
    whole[18:30, 30:] = np.eye(12) / h
    step = expm(h * whole)
    rising = step[:12, 30:]
    return step[:12, :12], step[:12, 12:18], step[:12, 18:30] - rising, rising
