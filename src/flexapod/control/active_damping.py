"""Root loci of decentralised active damping: integral force feedback and direct velocity feedback (see laws.py)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Unpack

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.linalg import eigh, null_space
from scipy.optimize import linear_sum_assignment

from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.controllers import ALL, GAIN_UNIT, Feedback, best_gain, default_gains, make
from flexapod.control.plant import Plant, damping_ratios, poles
from flexapod.conventions import Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.mechanics.linearisation import Linearisation, RestOptions, linearise
from flexapod.pose import Pose


def open_zeros(linear: Linearisation, feedback: Feedback, legs: Sequence[int] = ALL) -> Array:
    """Frequencies, rad/s, to which the loops' poles go at high gain.

    With friction left out, these are the natural frequencies of the machine (linear) without the stiffness of the
    `legs` that have a loop (feedback "force"), or with these legs locked ("velocity"). Zeros of a force loop at which
    the machine would topple are NaN. A velocity loop on all legs leaves none.

    Raises: nothing of its own.
    Source: A. Preumont, Vibration Control of Active Structures (2011).
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

    gains: (n,) > 0; default: 400 that span the modes. legs, leak: as in `ForceFeedback`. Dataset over `gain`: `pole`
    (gain, branch), rad/s, each branch followed from gain to gain; `damping_ratio`; `least_damping`, of the vibrating
    poles. Over `zero_number`: `zero`, rad/s (see `open_zeros`). Attributes: best_gain, best_damping: the gain, refined
    between samples, with the largest least damping.

    Raises: ArgumentError for gains that are no row of numbers > 0, wrong legs or another feedback; PoseError and
    SingularPoseError as `linearise`.
    Source: A. Preumont, Vibration Control of Active Structures (2011).
    """
    plant = Plant(linearise(hexapod, pose, **rest))
    row = np.sort(default_gains(plant, feedback) if gains is None else _row(gains))
    legs = tuple(legs)
    pole = _followed(np.stack([poles(plant, make(feedback, g, leak, legs).on(plant.linear)) for g in row]))
    least = np.array([least_damping(p) for p in pole])
    gain, damping = best_gain(plant, lambda g: make(feedback, g, leak, legs), row)
    zeros = open_zeros(plant.linear, feedback, legs)
    return xr.Dataset(
        {
            "pole": (("gain", "branch"), pole, {"units": "rad/s"}),
            "damping_ratio": (("gain", "branch"), damping_ratios(pole)),
            "least_damping": ("gain", least, {"long_name": "least damping ratio"}),
            "zero": ("zero_number", zeros, {"units": "rad/s", "long_name": "frequencies at infinite gain"}),
            "omega": ("mode", plant.omega, {"units": "rad/s", "long_name": "natural frequencies without control"}),
        },
        {"gain": ("gain", row, {"units": GAIN_UNIT[feedback]})},
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


def _row(gains: ArrayLike) -> Array:
    row = np.asarray(gains, dtype=np.float64)
    if row.ndim != 1 or row.size < 2 or not np.isfinite(row).all() or not (row > 0).all():
        raise ArgumentError(f"gains has shape {row.shape}; give a row of at least two finite gains > 0")
    return row


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
