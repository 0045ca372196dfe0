"""Control laws: position loops (PD, PID) and decentralised active damping, each leg on its own.

Damping laws after A. Preumont, Vibration Control of Active Structures (Springer), for collocated pairs: with zeros
between the poles every mode gains damping at every gain, and loses it again beyond the best one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.plant import Controller, Law, Measure, Plant, poles, six_by_six, static
from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import Linearisation

Space = Literal["joint", "task"]
Actuator = Literal["force", "command"]
Feedback = Literal["force", "velocity"]
ALL = (1, 2, 3, 4, 5, 6)
GAIN_UNIT = {"force": "rad/s", "velocity": "N s/m"}  # of damping laws by name
_STILL = 1 - 1e-6  # damping ratio that counts as no vibration
_CREEP = 1e-3  # of the lowest natural frequency: a pole that decays more slowly comes of stiffness taken away


@dataclass(frozen=True)
class PID:
    """Proportional, derivative and integral gains of a position loop.

    space="joint": the six leg lengths are controlled, each by its own leg for a single number or six. space="task":
    the platform's displacement and rotation vector. actuator="force": leg forces beside the springs.
    actuator="command": changes of the legs' unstretched lengths d, which act as forces K d.

    Units of kp, kd, ki, each a number, six, or a 6 x 6 matrix: joint, force: N/m, N s/m, N/(m s) of leg length. Command
    (either space): 1, s, 1/s, since a length answers a length; in task space the platform's error is turned into leg
    lengths by H^T. Task, force: a wrench, N/m and N m/rad and so on, which the legs produce through H^-1; there a
    single number is per unit of inertia (1/s2, 1/s, 1/s3), so that it means the same for translations and rotations.

    bandwidth: rad/s of the filter through which the derivative is taken from the measured position; None: the rate
    itself is measured.

    Raises: ArgumentError for gains of another shape, an unknown space or actuator, or a bandwidth that is not > 0.
    Source: own; conclusion 2 says how to choose the gains.
    """

    kp: ArrayLike = 0.0
    kd: ArrayLike = 0.0
    ki: ArrayLike = 0.0
    space: Space = "joint"
    actuator: Actuator = "force"
    bandwidth: float | None = None

    def __post_init__(self) -> None:
        for name, value, known in (("space", self.space, Space), ("actuator", self.actuator, Actuator)):
            if value not in get_args(known):
                raise ArgumentError(f"{name} is {value!r}; it must be {' or '.join(map(repr, get_args(known)))}")
        for name in ("kp", "kd", "ki"):
            six_by_six(getattr(self, name), name)
        if self.bandwidth is not None and not (np.isfinite(self.bandwidth) and self.bandwidth > 0):
            raise ArgumentError(f"bandwidth is {self.bandwidth} rad/s; it must be > 0")

    def on(self, linear: Linearisation) -> Controller:
        """The controller at a pose. States: the integral, then the derivative's filter, where there are any."""
        kp, kd, ki = (self._force(getattr(self, name), name, linear) for name in ("kp", "kd", "ki"))
        position, rate = ("leg_length", "leg_rate") if self.space == "joint" else ("position", "velocity")
        measures: tuple[Measure, ...] = (position,) if self.bandwidth is not None else (position, rate)  # type: ignore[assignment]
        width = 6 * len(measures)
        zero, one = np.zeros((6, 6)), np.eye(6)
        D = -kp if self.bandwidth is not None else np.hstack([-kp, -kd])
        A, B, C = np.zeros((0, 0)), np.zeros((0, width)), np.zeros((6, 0))
        if ki.any():
            A, B, C = zero, np.hstack([one, *[zero] * (len(measures) - 1)]), -ki
        if self.bandwidth is not None:  # kd N s/(s + N) = kd N - kd N^2/(s + N)
            N, n = self.bandwidth, len(A)
            A = np.block([[A, np.zeros((n, 6))], [np.zeros((6, n)), -N * one]])
            B, C, D = np.vstack([B, N * one]), np.hstack([C, N * kd]), D - N * kd
        return Controller(A, B, C, D, measures, f"{self.space}-space PID")

    def _force(self, value: ArrayLike, name: str, linear: Linearisation) -> Array:
        """The gain from measured positions to leg forces."""
        gain = six_by_six(value, name)
        K_legs = linear.leg_stiffness[:, None]
        if self.space == "joint":
            return gain if self.actuator == "force" else K_legs * gain
        if self.actuator == "command":
            return K_legs * (linear.H.T @ gain)
        wrench = linear.M @ gain if np.ndim(value) == 0 else gain
        return np.asarray(np.linalg.solve(linear.H, wrench), dtype=np.float64)


@dataclass(frozen=True)
class ForceFeedback:
    """Integral force feedback: in each leg f' = -gain F - leak f, with F the change of the whole leg force.

    gain, leak: rad/s. A loop takes its leg's stiffness away below about `gain`: without a leak even at rest, so that a
    machine that carries weight creeps away; a leak well below the lowest natural frequency (such as a tenth) keeps it.
    legs: numbers, from 1, of the legs that have a loop.

    Raises: ArgumentError for gains below zero, or legs that are no numbers from 1 to 6.
    Source: A. Preumont, Vibration Control of Active Structures (2011).
    """

    gain: float
    leak: float = 0.0
    legs: tuple[int, ...] = ALL

    def __post_init__(self) -> None:
        _check(self.legs, gain=self.gain, leak=self.leak)

    def on(self, linear: Linearisation) -> Controller:
        """Its controller; one state for each loop, the force."""
        loops = _loops(self.legs)
        leak = -self.leak * np.eye(len(self.legs))
        return Controller(
            leak, -self.gain * loops.T, loops, np.zeros((6, 6)), ("leg_force",), "integral force feedback"
        )


@dataclass(frozen=True)
class VelocityFeedback:
    """Direct velocity feedback: in each leg f = -gain L', a force against the rate of its length. gain: N s/m.

    legs: numbers, from 1, of the legs that have a loop.

    Raises: ArgumentError for a gain below zero, or legs that are no numbers from 1 to 6.
    Source: A. Preumont, Vibration Control of Active Structures (2011).
    """

    gain: float
    legs: tuple[int, ...] = ALL

    def __post_init__(self) -> None:
        _check(self.legs, gain=self.gain)

    def on(self, linear: Linearisation) -> Controller:
        """Its controller, without states."""
        loops = _loops(self.legs)
        return static(-self.gain * loops @ loops.T, ("leg_rate",), "direct velocity feedback")


def make(feedback: Feedback, gain: float, leak: float, legs: tuple[int, ...] = ALL) -> ForceFeedback | VelocityFeedback:
    """The law of a name. Raises ArgumentError for an unknown one."""
    if feedback not in get_args(Feedback):
        raise ArgumentError(f"feedback is {feedback!r}; it must be 'force' or 'velocity'")
    return ForceFeedback(gain, leak, legs) if feedback == "force" else VelocityFeedback(gain, legs)


def best_gain(plant: Plant, law: Callable[[float], Law], gains: Array) -> tuple[float, float]:
    """The gain with the largest least damping, refined between those given, and that damping.

    Where nothing vibrates any more at high gain, the least gain at which that is so: more only slows the machine. A
    gain that all but takes the machine's static stiffness away, as force feedback may, is none: a pole then hardly
    decays.
    """

    def damping(log_gain: float) -> float:
        pole = poles(plant, law(float(np.exp(log_gain))).on(plant.linear))
        creeps = (pole.real > -_CREEP * plant.omega[0]) & (np.abs(pole) > 1e-9 * np.abs(pole).max())
        return least_damping(pole) if not creeps.any() else -1.0

    logs = np.log(gains)
    values = np.array([damping(x) for x in logs])
    still = np.flatnonzero(values >= _STILL)
    if still.size:
        return _first_still(damping, logs, int(still[0]))
    best = int(values.argmax())
    span = (logs[max(best - 1, 0)], logs[min(best + 1, len(logs) - 1)])
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
    """(400,) gains from next to nothing to far too much."""
    omega = plant.omega
    low, high = 0.01 * omega[0], 30 * omega[-1]
    if feedback == "force":
        return np.geomspace(low, high, 400)
    # In a mode of frequency w, a rate gain g on legs of stiffness k damps as g w/(2 k): 2 k/w is critical.
    k = plant.linear.leg_stiffness.mean()
    return k / np.geomspace(high, low, 200)


def _loops(legs: tuple[int, ...]) -> Array:
    """(6, n): which leg each loop drives."""
    return np.eye(6)[:, np.array(legs) - 1]


def _check(legs: tuple[int, ...], **gains: float) -> None:
    for name, value in gains.items():
        if not (np.isfinite(value) and value >= 0):
            raise ArgumentError(f"{name} is {value}; it must be finite and >= 0")
    wrong = [leg for leg in legs if leg not in ALL]
    if wrong or not legs or len(set(legs)) < len(legs):
        raise ArgumentError(f"legs is {legs}; give different numbers from 1 to 6, at least one")
