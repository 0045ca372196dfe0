"""Decentralised active damping: integral force feedback and direct velocity feedback, each leg on its own.

After A. Preumont, Vibration Control of Active Structures (Springer), for collocated pairs: with zeros between the poles
every mode gains damping at every gain, and loses it again beyond the best one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Unpack, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.linalg import eigh, null_space
from scipy.optimize import linear_sum_assignment, minimize_scalar

from flexapod.errors import ArgumentError
from flexapod.feedback import Complex, Controller, Plant, damping_ratios, poles, static
from flexapod.hexapod import Hexapod
from flexapod.linear import Linearisation, RestOptions, linearise
from flexapod.pose import Array, Pose

ALL = (1, 2, 3, 4, 5, 6)
Feedback = Literal["force", "velocity"]


@dataclass(frozen=True)
class ForceFeedback:
    """Integral force feedback: in each leg f' = -gain F - leak f, with F the change of the whole leg force.

    gain, leak: rad/s. A loop takes its leg's stiffness away below about `gain`: without a leak even at rest, so that a
    machine that carries weight creeps away; a leak well below the lowest natural frequency (such as a tenth) keeps it.
    legs: numbers, from 1, of the legs that have a loop.
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
        return Controller(leak, -self.gain * loops.T, loops, np.zeros((6, 6)), ("leg_force",), "integral force feedback")


@dataclass(frozen=True)
class VelocityFeedback:
    """Direct velocity feedback: in each leg f = -gain L', a force against the rate of its length. gain: N s/m.

    legs: numbers, from 1, of the legs that have a loop.
    """

    gain: float
    legs: tuple[int, ...] = ALL

    def __post_init__(self) -> None:
        _check(self.legs, gain=self.gain)

    def on(self, linear: Linearisation) -> Controller:
        """Its controller, without states."""
        loops = _loops(self.legs)
        return static(-self.gain * loops @ loops.T, ("leg_rate",), "direct velocity feedback")


def open_zeros(linear: Linearisation, feedback: Feedback, legs: Sequence[int] = ALL) -> Array:
    """Frequencies, rad/s, to which the loops' poles go at high gain: with friction left out, the natural frequencies of
    the machine without the controlled legs' stiffness (force feedback), or with these legs locked (velocity feedback).

    Zeros of a force loop at which the machine would topple are NaN. A velocity loop on all legs leaves none.
    """
    chosen = np.array(sorted(legs)) - 1
    K, H = 0.5 * (linear.K + linear.K.T), linear.H[:, chosen]
    if feedback == "force":
        square = eigh(K - (H * linear.leg_stiffness[chosen]) @ H.T, linear.M, eigvals_only=True)
        small = 1e-9 * np.abs(eigh(K, linear.M, eigvals_only=True)).max()
        square = np.where(np.abs(square) < small, 0.0, square)
        with np.errstate(invalid="ignore"):
            return np.sqrt(square)
    free = null_space(H.T)
    if free.shape[1] == 0:
        return np.zeros(0)
    return np.sqrt(np.maximum(eigh(free.T @ K @ free, free.T @ linear.M @ free, eigvals_only=True), 0.0))


def root_locus(
    hexapod: Hexapod,
    pose: Pose,
    feedback: Feedback = "force",
    *,
    gains: ArrayLike | None = None,
    legs: Sequence[int] = ALL,
    leak: float = 0.0,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """Poles over the gain of decentralised feedback ("force": integral, rad/s; "velocity": N s/m), and the best gain.

    gains: (n,) > 0; default: 200 that span the modes. Dataset over `gain`: `pole` (gain, branch), rad/s, each branch
    followed from gain to gain; `damping_ratio`; `least_damping`, of the vibrating poles. Over `zero_number`: `zero`,
    rad/s (see `open_zeros`). Attributes: best_gain, best_damping: the gain, refined between samples, with the largest
    least damping.
    """
    plant = Plant(linearise(hexapod, pose, **rest))
    row = _default_gains(plant, feedback) if gains is None else np.asarray(gains, dtype=np.float64)
    if row.ndim != 1 or row.size < 2 or not np.isfinite(row).all() or not (row > 0).all():
        raise ArgumentError(f"gains has shape {row.shape}; give a row of at least two finite gains > 0")
    row = np.sort(row)
    legs = tuple(legs)
    pole = _followed(np.stack([poles(plant, make(feedback, g, leak, legs).on(plant.linear)) for g in row]))
    least = np.array([least_damping(p) for p in pole])
    gain, damping = best_gain(plant, feedback, legs, leak, row)
    unit = "rad/s" if feedback == "force" else "N s/m"
    zeros = open_zeros(plant.linear, feedback, legs)
    return xr.Dataset(
        {
            "pole": (("gain", "branch"), pole, {"units": "rad/s"}),
            "damping_ratio": (("gain", "branch"), damping_ratios(pole)),
            "least_damping": ("gain", least, {"long_name": "least damping ratio"}),
            "zero": ("zero_number", zeros, {"units": "rad/s", "long_name": "frequencies at infinite gain"}),
            "omega": ("mode", plant.omega, {"units": "rad/s", "long_name": "natural frequencies without control"}),
        },
        {"gain": ("gain", row, {"units": unit})},
        {
            "design": hexapod.name,
            "digest": hexapod.digest,
            "feedback": feedback,
            "legs": list(legs),
            "leak_rad_s": leak,
            "best_gain": gain,
            "best_damping": damping,
        },
    )


def make(feedback: Feedback, gain: float, leak: float, legs: tuple[int, ...] = ALL) -> ForceFeedback | VelocityFeedback:
    """The law of a name. Raises ArgumentError for an unknown one."""
    if feedback not in get_args(Feedback):
        raise ArgumentError(f"feedback is {feedback!r}; it must be 'force' or 'velocity'")
    return ForceFeedback(gain, leak, legs) if feedback == "force" else VelocityFeedback(gain, legs)


def least_damping(pole: Complex) -> float:
    """The least damping ratio of vibrating or growing poles; 1 when there are none."""
    size = np.abs(pole).max()
    matter = (np.abs(pole.imag) > 1e-9 * size) | (pole.real > 1e-9 * size)
    return float(damping_ratios(pole[matter]).min(initial=1.0))


def best_gain(
    plant: Plant,
    feedback: Feedback,
    legs: tuple[int, ...] = ALL,
    leak: float = 0.0,
    gains: Array | None = None,
) -> tuple[float, float]:
    """The gain with the largest least damping, and that damping."""
    row = _default_gains(plant, feedback)[::4] if gains is None else gains

    def damping(log_gain: float) -> float:
        return least_damping(poles(plant, make(feedback, float(np.exp(log_gain)), leak, legs).on(plant.linear)))

    logs = np.log(row)
    values = np.array([damping(x) for x in logs])
    best = int(values.argmax())
    span = (logs[max(best - 1, 0)], logs[min(best + 1, len(logs) - 1)])
    refined = minimize_scalar(lambda x: -damping(x), bounds=span, method="bounded", options={"xatol": 1e-7})
    if -refined.fun >= values[best]:
        return float(np.exp(refined.x)), float(-refined.fun)
    return float(row[best]), float(values[best])


def _default_gains(plant: Plant, feedback: Feedback) -> Array:
    omega = plant.omega
    low, high = 0.01 * omega[0], 30 * omega[-1]
    if feedback == "force":
        return np.geomspace(low, high, 200)
    # In a mode of frequency w, a rate gain g on legs of stiffness k damps as g w/(2 k): 2 k/w is critical.
    k = plant.linear.leg_stiffness.mean()
    return k / np.geomspace(high, low, 200)


def _followed(pole: Complex) -> Complex:
    """Rows of poles in an order in which every column moves little from row to row."""
    out = pole.copy()
    step = np.zeros(pole.shape[1], dtype=complex)
    for i in range(1, len(pole)):
        guess = out[i - 1] + step
        _, order = linear_sum_assignment(np.abs(guess[:, None] - pole[i][None, :]))
        out[i] = pole[i][order]
        step = out[i] - out[i - 1]
    return out


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
