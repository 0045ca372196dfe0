"""The plant in units of its own, in which the weights of a controller design are plain ratios."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexapod.control.linear_controller import MEASUREMENTS, Controller, Measurement
from flexapod.control.plant import Plant
from flexapod.conventions import Array
from flexapod.errors import ArgumentError, shown


def measurements(measure: Measurement | Sequence[Measurement]) -> tuple[Measurement, ...]:
    """One or several kinds of measurement; raises ArgumentError for anything else."""
    names = (measure,) if isinstance(measure, str) else tuple(measure)
    wrong = [name for name in names if not isinstance(name, str) or name not in MEASUREMENTS]
    if wrong or not names or len(set(names)) < len(names):
        raise ArgumentError(f"measure is {shown(measure)}; give one or several of {', '.join(MEASUREMENTS)}")
    return names


class ScaledPlant:
    """The plant without units.

    Time is in 1/pace, accelerations of base and platform are divided by `axis` (rotations by the platform's size),
    forces by the acceleration they give, and measurements by what a unit base acceleration gives at rest.
    """

    def __init__(self, plant: Plant, measures: tuple[Measurement, ...]) -> None:
        self.plant, self.measures = plant, measures
        linear = plant.linear
        self.omega_1 = float(plant.omega[0])
        self.pace = float(np.sqrt(plant.omega[0] * plant.omega[-1]))
        size = float(np.linalg.norm(linear.H[3:], axis=0).mean())  # the legs' lever about the reference
        self.axis = np.repeat([1.0, 1.0 / size], 3)  # of a unit motion: m, and rad
        rows = plant.measured(("acceleration",))
        D_a = plant.D[rows] / self.axis[:, None]
        self.force = 1.0 / np.linalg.norm(D_a, axis=0)
        self.signal = np.concatenate([self._signal(name) for name in measures])
        seen = plant.measured(measures)
        # States scaled to the pace: z/pace, so that A z, B f and E w over pace are all of order one.
        self.A = plant.A / self.pace
        self.B = plant.B * self.force
        self.E = plant.E[:, :6] * self.axis
        self.C_a = plant.C[rows] / self.axis[:, None] / self.pace
        self.D_a = D_a * self.force
        self.G_a = plant.G[rows][:, :6] * self.axis / self.axis[:, None]
        self.C = plant.C[seen] / self.signal[:, None] / self.pace
        self.D = plant.D[seen] * self.force / self.signal[:, None]
        self.G = plant.G[seen][:, :6] * self.axis / self.signal[:, None]

    def _signal(self, name: Measurement) -> Array:
        linear = self.plant.linear
        push = (linear.M @ linear.carry + linear.M_b) * self.axis
        force = np.linalg.norm(np.linalg.solve(linear.H, push), axis=1)
        length = force / linear.leg_stiffness
        still = {"leg_force": force, "leg_length": length, "leg_rate": length * self.omega_1, "acceleration": self.axis}
        still |= {"position": self.axis / self.omega_1**2, "velocity": self.axis / self.omega_1}
        return still[name]

    def controller(self, A: Array, B: Array, C: Array, D: Array, name: str) -> Controller:
        """A controller of the plant without units, in SI units."""
        out, into = self.force[:, None], 1.0 / self.signal
        return Controller(A * self.pace, B * into * self.pace, out * C, out * D * into, self.measures, name)
