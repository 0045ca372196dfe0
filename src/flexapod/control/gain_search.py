"""The gain of a feedback with the most damping, and the range of gains in which it is sought."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import numbers
from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.controllers import Feedback
from flexapod.control.linear_controller import ControlLaw, controller_for
from flexapod.control.plant import Plant, poles
from flexapod.conventions import Array, Complex
from flexapod.errors import ArgumentError

_STILL = 1 - 1e-6  # damping ratio that counts as no vibration
_NEARLY_CANCELLED = 1e-3  # of the lowest natural frequency: a pole below comes of stiffness that a gain takes away


def ascending_gains(gains: ArrayLike, least: int) -> Array:
    """A row of ascending gains > 0; raises ArgumentError for anything else."""
    row = numbers(gains, "gains")
    if row.size < least or not (row > 0).all() or (np.diff(row) <= 0).any():
        raise ArgumentError(f"gains has shape {row.shape}; give at least {least} ascending gains > 0")
    return row


def best_gain(
    plant: Plant, law: Callable[[float], ControlLaw], gains: Array, at_gains: Complex | None = None
) -> tuple[float, float]:
    """The gain at which the least damped pole has the most damping, refined between those given, and that damping.

    If nothing vibrates any more at high gain, the smallest such gain is taken: more only slows the platform. Gains that
    nearly cancel the static stiffness, as force feedback can, are excluded: a pole then hardly decays.

    at_gains: the poles at those gains, (n, poles), where they are known.
    """

    def damping(log_gain: float) -> float:
        return of(poles(plant, controller_for(plant.linear, law(float(np.exp(log_gain))))))

    def of(pole: Complex) -> float:
        creeps = (pole.real > -_NEARLY_CANCELLED * plant.omega[0]) & (np.abs(pole) > 1e-9 * np.abs(pole).max())
        return least_damping(pole) if not creeps.any() else -1.0

    logs = np.log(gains)
    values = np.array([damping(x) for x in logs] if at_gains is None else [of(pole) for pole in at_gains])
    still = np.flatnonzero(values >= _STILL)
    if still.size:
        return _first_still(damping, logs, int(still[0]))
    best = int(values.argmax())
    span = (logs[max(best - 1, 0)], logs[min(best + 1, len(logs) - 1)])
    from scipy.optimize import minimize_scalar

    refined = minimize_scalar(lambda x: -damping(x), bounds=span, method="bounded", options={"xatol": 1e-7})
    most, at = max((float(-refined.fun), float(refined.x)), (float(values[best]), float(logs[best])))
    return float(np.exp(at)), most


def _first_still(damping: Callable[[float], float], logs: Array, first: int) -> tuple[float, float]:
    low, high = logs[max(first - 1, 0)], logs[first]
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if damping(middle) >= _STILL else (middle, high)
    return float(np.exp(high)), 1.0


def default_gains(plant: Plant, feedback: Feedback) -> Array:
    """(400,) gains of a force loop or (200,) of a velocity loop, from negligible to far too high."""
    omega = plant.omega
    low, high = 0.01 * omega[0], 30 * omega[-1]
    if feedback == "force":
        return np.geomspace(low, high, 400)
    # In a mode of frequency w, a rate gain g on legs of stiffness k damps as g w/(2 k): 2 k/w is critical.
    k = plant.linear.leg_stiffness.mean()
    return k / np.geomspace(high, low, 200)
