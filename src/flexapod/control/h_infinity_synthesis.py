"""The H-infinity problem of isolation: the weighted plant, and a controller for it by SLICOT."""

from __future__ import annotations

import numpy as np

from flexapod.control.scaled_plant import ScaledPlant
from flexapod.conventions import Array
from flexapod.errors import UnstableError
from flexapod.optional import needed

System = tuple[Array, Array, Array, Array]  # A, B, C, D


def weighted_plant(
    task: ScaledPlant, *, corner: float, depth: float, bandwidth: float, effort: float, noise: float
) -> System:
    """The generalised plant of the H-infinity problem; frequencies are divided by the plant's pace.

    Inputs are base acceleration, sensor noise and force; outputs weighted acceleration and force, then measurement.
    Weights have a state for each signal: on acceleration x' = a - depth corner x, depth (a + corner (1 - depth) x); on
    force (depth s/bandwidth + effort)/(s/(far bandwidth) + 1) with `far` so high that it only makes it proper.
    """
    far = 30.0
    pole, rise = far * bandwidth, far * depth  # the force's weight is rise - pole (rise - effort)/(s + pole)
    one, o, m = np.eye(6), np.zeros, len(task.C)
    A = np.block(
        [
            [task.A, o((12, 12))],
            [task.C_a, -depth * corner * one, o((6, 6))],
            [o((6, 18)), -pole * one],
        ]
    )
    B = np.block([[task.E, o((12, m)), task.B], [task.G_a, o((6, m)), task.D_a], [o((6, 6 + m)), one]])
    C = np.block(
        [
            [depth * task.C_a, depth * corner * (1 - depth) * one, o((6, 6))],
            [o((6, 18)), -pole * (rise - effort) * one],
            [task.C, o((m, 12))],
        ]
    )
    D = np.block(
        [
            [depth * task.G_a, o((6, m)), depth * task.D_a],
            [o((6, 6)), o((6, m)), rise * one],
            [task.G, noise * np.eye(m), task.D],
        ]
    )
    return A, B, C, D


def suboptimal_controller(system: System, measurements: int) -> tuple[float, tuple[Array, ...]]:
    """A bound gamma a fifth above the smallest one, and its central controller (A, B, C, D).

    SLICOT's SB10AD, the routine behind control.hinfsyn, but with gamma given: the optimal controllers that hinfsyn
    gives have poles near infinity, which no sampled controller can follow.
    """
    slycot = needed("slycot", "control", "H-infinity design needs slycot")
    A, B, C, D = system
    sizes = (len(A), B.shape[1], len(C), 6, measurements)

    def attempt(gamma: float) -> tuple[Array, ...] | None:
        try:
            return tuple(np.asarray(m) for m in slycot.sb10ad(*sizes, gamma, A, B, C, D, job=4)[1:5])
        except slycot.exceptions.SlycotError:
            return None

    high = 1.0
    while attempt(high) is None:
        high *= 4.0
        if high > 1e9:
            raise UnstableError(
                "no H-infinity controller was found: the measurement may not show every motion, or a weight is too "
                "small. Raise effort and noise."
            )
    low = high / 4.0
    while attempt(low) is not None:
        high, low = low, low / 4.0
    while high > 1.01 * low:
        middle = float(np.sqrt(high * low))
        low, high = (low, middle) if attempt(middle) is not None else (middle, high)
    for room in (1.2, 1.1, 1.4, 1.05, 2.0, 1.0):  # the routine fails here and there for reasons of rounding
        found = attempt(room * high)
        if found is not None:
            return room * high, found
    raise UnstableError("the H-infinity design is too badly conditioned. Raise effort and noise, or lower the depth.")
