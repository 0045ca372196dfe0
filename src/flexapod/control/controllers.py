"""Control laws: position control (PID) and decentralised active damping, in which each leg has a loop of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, not_negative, one_of, positive
from flexapod.control.linear_controller import Controller, Measurement, static
from flexapod.conventions import Array, Unit
from flexapod.errors import ArgumentError, shown
from flexapod.mechanics.linearisation import Linearisation
from flexapod.showing import in_notebooks

Space = Literal["joint", "task"]
Actuator = Literal["force", "command"]
Feedback = Literal["force", "velocity"]
ALL_LEGS = (1, 2, 3, 4, 5, 6)
GAIN_UNIT: dict[str, Unit] = {"force": "rad/s", "velocity": "N s/m"}  # of active damping, by feedback


def pid_units(law: PID) -> tuple[Unit, Unit, Unit]:
    """Units of kp, kd and ki where each is a single number."""
    if law.actuator == "command":
        return "1", "s", "1/s"
    return ("N/m", "N s/m", "N/(m s)") if law.space == "joint" else ("1/s^2", "1/s", "1/s^3")


@in_notebooks
@dataclass(frozen=True)
class PID:
    """Proportional, integral and derivative position control.

    Parameters
    ----------
    kp, kd, ki : float or array_like, shape (6,) or (6, 6), optional
        Proportional, derivative and integral gains; see Notes for their units.
    space : {"joint", "task"}, optional
        What is controlled: the six leg lengths, each by its own leg if the gain is a number or six, or the platform's
        displacement and rotation vector.
    actuator : {"force", "command"}, optional
        What the controller sets: leg forces beside the springs, or changes of the unstretched leg lengths d, which act
        as forces K d.
    bandwidth : float, optional
        Cut-off frequency, rad/s, of the filter with which the derivative is taken from the measured position. By
        default the rate itself is measured.

    Raises
    ------
    ArgumentError
        If a gain has another shape, `space` or `actuator` is unknown, or the bandwidth is not positive.

    Notes
    -----
    Units of kp, kd and ki. Joint space with forces: N/m, N s/m and N/(m s) of leg length. Commands, in either space: 1,
    s and 1/s, since a length answers a length; in task space the error of the platform becomes leg lengths by H^T. Task
    space with forces: a wrench, N/m and N m/rad and so on, which the legs produce through H^-1; there a single number
    is per unit of inertia (1/s2, 1/s, 1/s3), so that it means the same for translations and rotations.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> loop = fx.control.closed_loop(hexapod, None, fx.control.PID(kp=4e3, kd=400.0))
    >>> round(float(loop.worst_damping), 2)
    0.57
    """

    kp: ArrayLike = 0.0
    kd: ArrayLike = 0.0
    ki: ArrayLike = 0.0
    space: Space = "joint"
    actuator: Actuator = "force"
    bandwidth: float | None = None

    def __post_init__(self) -> None:
        one_of(self.space, "space", get_args(Space))
        one_of(self.actuator, "actuator", get_args(Actuator))
        for name in ("kp", "kd", "ki"):
            _gain_matrix(getattr(self, name), name)
        if self.bandwidth is not None:
            positive(self.bandwidth, "bandwidth", "rad/s")

    def on(self, linear: Linearisation) -> Controller:
        """Return the controller at a pose. Its states are the integral, then the filter of the derivative."""
        if not isinstance(linear, Linearisation):
            raise ArgumentError(f"linear is {shown(linear)}; it must be what flexapod.linearise gives.")
        kp, kd, ki = (self._force(getattr(self, name), name, linear) for name in ("kp", "kd", "ki"))
        position, rate = ("leg_length", "leg_rate") if self.space == "joint" else ("position", "velocity")
        measures: tuple[Measurement, ...] = (position,) if self.bandwidth is not None else (position, rate)  # type: ignore[assignment]
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
        gain = _gain_matrix(value, name)
        K_legs = linear.leg_stiffness[:, None]
        if self.space == "joint":
            return gain if self.actuator == "force" else K_legs * gain
        if self.actuator == "command":
            return K_legs * (linear.H.T @ gain)
        wrench = linear.M @ gain if np.ndim(value) == 0 else gain
        return np.asarray(np.linalg.solve(linear.H, wrench), dtype=np.float64)


@in_notebooks
@dataclass(frozen=True)
class ForceFeedback:
    """Integral force feedback for active damping: f' = -gain F - leak f in each leg.

    F is the change of the whole force in the leg, f the force of its actuator.

    Parameters
    ----------
    gain : float
        Gain, rad/s.
    leak : float, optional
        Leak of the integral, rad/s.
    legs : tuple of int, optional
        Numbers, from 1 to 6, of the legs that have a loop.

    Raises
    ------
    ArgumentError
        If a gain is negative, or the legs are not different numbers from 1 to 6.

    Notes
    -----
    After Preumont [1]_. A loop cancels the stiffness of its leg at frequencies below about `gain`: without a leak even
    at rest, so that a platform that carries weight creeps away. A leak well below the lowest natural frequency, such as
    a tenth of it, preserves the static stiffness.

    References
    ----------
    .. [1] A. Preumont, Vibration Control of Active Structures, Springer (2011).

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> loop = fx.control.closed_loop(hexapod, None, fx.control.ForceFeedback(20.0, leak=5.0), nearness=0)
    >>> round(float(loop.worst_damping), 2)
    0.28
    """

    gain: float
    leak: float = 0.0
    legs: tuple[int, ...] = ALL_LEGS

    def __post_init__(self) -> None:
        not_negative(self.gain, "gain", "rad/s")
        not_negative(self.leak, "leak", "rad/s")
        check_legs(self.legs)

    def on(self, linear: Linearisation) -> Controller:
        """Return the controller, which has one state for each loop: the force."""
        loops = _loops(self.legs)
        leak = -self.leak * np.eye(len(self.legs))
        return Controller(
            leak, -self.gain * loops.T, loops, np.zeros((6, 6)), ("leg_force",), "integral force feedback"
        )


@in_notebooks
@dataclass(frozen=True)
class VelocityFeedback:
    """Direct velocity feedback for active damping: f = -gain L' in each leg, a force against the rate of its length.

    Parameters
    ----------
    gain : float
        Gain, N s/m.
    legs : tuple of int, optional
        Numbers, from 1 to 6, of the legs that have a loop.

    Raises
    ------
    ArgumentError
        If the gain is negative, or the legs are not different numbers from 1 to 6.

    Notes
    -----
    After A. Preumont, Vibration Control of Active Structures (2011).

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> loop = fx.control.closed_loop(hexapod, None, fx.control.VelocityFeedback(300.0))
    >>> round(float(loop.worst_damping), 2)
    0.51
    """

    gain: float
    legs: tuple[int, ...] = ALL_LEGS

    def __post_init__(self) -> None:
        not_negative(self.gain, "gain", "N s/m")
        check_legs(self.legs)

    def on(self, linear: Linearisation) -> Controller:
        """Return the controller, which has no states."""
        loops = _loops(self.legs)
        return static(-self.gain * loops @ loops.T, ("leg_rate",), "direct velocity feedback")


def damping_law(
    feedback: Feedback, gain: float, leak: float, legs: Sequence[int] = ALL_LEGS
) -> ForceFeedback | VelocityFeedback:
    """The control law of a name; raises ArgumentError for an unknown one."""
    one_of(feedback, "feedback", get_args(Feedback))
    return ForceFeedback(gain, leak, tuple(legs)) if feedback == "force" else VelocityFeedback(gain, tuple(legs))


def check_legs(legs: Sequence[int]) -> None:
    """Raises ArgumentError unless these are different numbers of legs."""
    chosen = tuple(legs) if isinstance(legs, Sequence | np.ndarray | range) else ()
    if not chosen or any(np.ndim(leg) or leg not in ALL_LEGS for leg in chosen) or len(set(chosen)) < len(chosen):
        raise ArgumentError(f"legs is {shown(legs)}; give different numbers from 1 to 6, at least one")


def _loops(legs: tuple[int, ...]) -> Array:
    """(6, n): which leg each loop drives."""
    return np.eye(6)[:, np.array(legs) - 1]


def _gain_matrix(value: ArrayLike, name: str) -> Array:
    """A gain as a 6 x 6 matrix: one number, six, or a matrix."""
    try:
        gain = floats(value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is {shown(value)}; give a number, six numbers, or a 6 x 6 matrix") from None
    if gain.shape not in ((), (6,), (6, 6)) or not np.isfinite(gain).all():
        raise ArgumentError(
            f"{name} has shape {gain.shape} and must be a finite number, six numbers, or a 6 x 6 matrix"
        )
    return gain if gain.ndim == 2 else np.diag(np.broadcast_to(gain, 6))
