"""Root loci of decentralised active damping: integral force feedback and direct velocity feedback."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import instance, numbers, one_of
from flexapod.control.closed_loop_poles import least_damping
from flexapod.control.controllers import ALL_LEGS, GAIN_UNIT, Feedback, check_legs, damping_law
from flexapod.control.gain_search import ascending_gains, best_gain, default_gains
from flexapod.control.losses import assumptions
from flexapod.control.plant import Plant, damping_ratios, poles_over
from flexapod.conventions import Array, Complex, JointModel, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.mechanics.cautions import response_attributes
from flexapod.mechanics.inputs import ZERO
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.symmetric_pencil import pencil_squares
from flexapod.pose import PoseLike

_STEP = 0.04  # of the highest natural frequency: poles that move farther from gain to gain are looked at between
_HALVINGS = 7  # of the steps between gains, at most


def open_zeros(linear: Linearisation, feedback: Feedback, legs: Sequence[int] = ALL_LEGS) -> Array:
    """Find the frequencies that the poles of active damping approach at high gain.

    Parameters
    ----------
    linear : Linearisation
        The hexapod linearised at a pose, from `flexapod.linearise`.
    feedback : {"force", "velocity"}
        Integral force feedback or direct velocity feedback.
    legs : sequence of int, optional
        Numbers, from 1 to 6, of the legs that have a loop.

    Returns
    -------
    ndarray, shape (n,)
        Frequencies of the zeros, rad/s. Zeros of a force loop at which the platform would topple are NaN. Velocity
        loops on all legs have no zeros.

    Raises
    ------
    ArgumentError
        If the feedback is unknown, or the legs are not different numbers from 1 to 6.

    Notes
    -----
    Friction is left out. The zeros are the natural frequencies of the hexapod without the stiffness of the legs that
    have a force loop, or with the legs locked that have a velocity loop [1]_. Joints and a suspension with stiffness
    lift the zeros of force loops above 0, and integral force feedback then damps a mode at omega with its zero at z by
    (omega - z) / (2 z) at most.

    References
    ----------
    .. [1] A. Preumont, Vibration Control of Active Structures, Springer (2011).

    Examples
    --------
    >>> linear = fx.linearise(fx.load("cubic-isolator"))
    >>> len(fx.control.open_zeros(linear, "velocity", legs=(5,)))
    5
    """
    one_of(feedback, "feedback", get_args(Feedback))
    check_legs(legs)
    instance(linear, Linearisation, "linear", "as fx.linearise gives it")
    chosen = np.array(sorted(legs)) - 1
    K, H = 0.5 * (linear.K + linear.K.T), linear.H[:, chosen]
    if feedback == "force":
        square = pencil_squares(K - (H * linear.leg_stiffness[chosen]) @ H.T, linear.M)
        small = 1e-9 * np.abs(pencil_squares(K, linear.M)).max()
        square = np.where(np.abs(square) < small, 0.0, square)
        with np.errstate(invalid="ignore"):
            return np.sqrt(square)
    free = _null_space(H.T)
    if free.shape[1] == 0:
        return np.zeros(0)
    return np.sqrt(np.maximum(pencil_squares(free.T @ K @ free, free.T @ linear.M @ free), 0.0))


def _null_space(matrix: Array) -> Array:
    """An orthonormal basis of the x with matrix x = 0, as columns."""
    _, s, vt = np.linalg.svd(matrix)
    rank = int(np.sum(s > max(matrix.shape) * np.finfo(float).eps * s.max(initial=0.0)))
    return vt[rank:].T


def root_locus(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    feedback: Feedback = "force",
    *,
    gains: ArrayLike | None = None,
    legs: Sequence[int] = ALL_LEGS,
    leak: float = 0.0,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute the poles over the gain of decentralised active damping, and the best gain.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, shape (6,), optional
        Where the platform is held at rest: x, y, z in m, roll, pitch, yaw in rad. The home pose by default.
    feedback : {"force", "velocity"}, optional
        Integral force feedback (gain in rad/s) or direct velocity feedback (gain in N s/m).
    gains : array_like, shape (n,), optional
        Different gains > 0, at least two. By default several hundred that span the modes.
    legs : sequence of int, optional
        Numbers, from 1 to 6, of the legs that have a loop.
    leak : float, optional
        Leak of the force feedback, rad/s.
    base : Pose or array_like, shape (6,), optional
        Pose of the base in the inertial frame. The identity by default.
    force, moment : array_like, shape (3,), optional
        Static force (N) and moment (N m) on the platform at its reference point, in its frame.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.

    Returns
    -------
    xarray.Dataset
        Over ``gain``: ``pole`` (gain, branch) in rad/s, each branch followed from gain to gain; ``damping_ratio``
        (gain, branch); ``least_damping``, that of the least damped vibrating pole. Over ``zero_number``: ``zero`` in
        rad/s, see `open_zeros`. Over ``mode``: ``omega`` and ``open_pole`` in rad/s, without control. The attributes
        ``best_gain`` and ``best_damping`` are the gain, refined between samples, at which ``least_damping`` is largest,
        and its value.

    Raises
    ------
    ArgumentError
        If the gains, the legs, the leak or the feedback is invalid.
    PoseError
        If the pose is missing, a batch, or out of the legs' reach.
    SingularPoseError
        If no leg forces hold the platform at the pose.

    Notes
    -----
    The root locus method for collocated actuators and sensors after Preumont [1]_: with zeros between the poles, every
    mode gains damping at every gain, and loses it again beyond the best one.

    References
    ----------
    .. [1] A. Preumont, Vibration Control of Active Structures, Springer (2011).

    Examples
    --------
    >>> locus = fx.control.root_locus(fx.load("cubic-isolator"), leak=3.0, gains=np.geomspace(1, 100, 30))
    >>> round(locus.attrs["best_gain"], 1), round(locus.attrs["best_damping"], 2)
    (27.4, 0.34)
    """
    damping_law(feedback, 0.0, leak, legs)  # checks them
    plant = Plant(linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint))
    row = default_gains(plant, feedback) if gains is None else ascending_gains(np.sort(numbers(gains, "gains")), 2)
    row = np.sort(row)

    def of(gains: Array) -> Complex:
        return poles_over(plant, lambda gain: damping_law(feedback, gain, leak, legs).on(plant.linear), gains)

    pole = of(row)
    gain, damping = best_gain(plant, lambda g: damping_law(feedback, g, leak, legs), row, pole)
    pole = _followed(pole)
    if gains is None:
        row, pole = _finer(plant, of, row, pole)
    least = np.array([least_damping(p) for p in pole])
    zeros = open_zeros(plant.linear, feedback, legs)
    return xr.Dataset(
        {
            "pole": (("gain", "branch"), pole, in_unit("rad/s")),
            "damping_ratio": (("gain", "branch"), damping_ratios(pole), in_unit("1", "damping ratio")),
            "least_damping": ("gain", least, in_unit("1", "least damping ratio")),
            "zero": ("zero_number", zeros, in_unit("rad/s", "frequencies at infinite gain")),
            "open_pole": ("mode", _upper(plant.linear.modes().pole), in_unit("rad/s", "poles without control")),
            "omega": ("mode", plant.omega, in_unit("rad/s", "natural frequencies without control")),
        },
        {"gain": ("gain", row, in_unit(GAIN_UNIT[feedback], "gain"))},
        {
            **origin(hexapod),
            "feedback": feedback,
            "legs": list(legs),
            "leak_rad_s": leak,
            "best_gain": gain,
            "best_damping": damping,
            "assumptions": assumptions(hexapod),
            **response_attributes(plant.linear),
        },
    )


def _upper(pole: Complex) -> Complex:
    """The six poles with frequencies >= 0, and of pairs that do not swing the faster ones."""
    order = np.lexsort((pole.real, -pole.imag))
    return np.asarray(pole[order][:6][::-1], dtype=np.complex128)


def _finer(plant: Plant, of: Callable[[Array], Complex], row: Array, pole: Complex) -> tuple[Array, Complex]:
    """More gains between those where a pole that the modes' band holds moves far, as where two of them meet."""
    reach = float(plant.omega[-1])
    for _ in range(_HALVINGS):
        seen = np.minimum(np.abs(pole[1:]), np.abs(pole[:-1])) < 2 * reach
        far = np.flatnonzero((np.where(seen, np.abs(np.diff(pole, axis=0)), 0.0)).max(axis=1) > _STEP * reach)
        if not far.size:
            break
        between = np.sqrt(row[far] * row[far + 1])
        row = np.insert(row, far + 1, between)
        pole = _followed(np.insert(pole, far + 1, of(between), axis=0))
    return row, pole


def _followed(pole: Complex) -> Complex:
    """The rows of poles ordered such that every column moves little from row to row."""
    from scipy.optimize import linear_sum_assignment

    out = pole.copy()
    step = np.zeros(pole.shape[1], dtype=complex)
    for i in range(1, len(pole)):
        guess = out[i - 1] + step
        _, order = linear_sum_assignment(np.abs(guess[:, None] - pole[i][None, :]))
        out[i] = pole[i][order]
        step = out[i] - out[i - 1]
    return out
