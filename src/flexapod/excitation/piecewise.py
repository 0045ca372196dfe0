"""Shocks, pulses, steps, polynomials and recordings: polynomials and half sines in pieces, with exact derivatives."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod._core import TermKind
from flexapod.checks import number, numbers, positive
from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import PIECE, Excitation, Use, one_term


def half_sine_shock(axis: str, acceleration: float, duration: float, *, recovery: float | None = None) -> Excitation:
    """Return a half-sine pulse of the acceleration of a base, from rest.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw.
    acceleration : float
        Peak, m/s2 or rad/s2.
    duration : float
        Duration of the pulse, s, > 0.
    recovery : float, optional
        Duration, s, of a second half sine, opposite and as strong as needed, that brings the base to rest again.
        Without it the motion goes on at the speed that the pulse leaves.

    Returns
    -------
    Excitation
        The base motion.

    Raises
    ------
    ArgumentError
        If the axis is unknown, the peak is not finite, or a duration is not > 0.

    Notes
    -----
    The pulse of IEC 60068-2-27. It leaves the velocity 2 acceleration duration / pi.

    Examples
    --------
    >>> shock = fx.half_sine_shock("z", 50.0, 0.011, recovery=0.05)
    >>> [round(float(part[2]), 6) for part in shock.evaluate(0.0055)]
    [0.00035, 0.17507, 50.0]
    """
    peak = number(acceleration, "acceleration")
    T = positive(duration, "duration", "s")
    speed = 2 * peak * T / np.pi
    pieces = [_half_sine(0.0, 0.0, 0.0, peak, T)]
    travel = peak * T * T / np.pi
    if recovery is not None:
        T_2 = positive(recovery, "recovery", "s")
        pieces.append(_half_sine(T, travel, speed, -peak * T / T_2, T_2))
        travel += speed * T_2 - peak * T * T_2 / np.pi
        T, speed = T + T_2, 0.0
    pieces.append(_piece(T, [travel, speed]))
    return _pieces(axis, pieces, use="motion")


def half_sine_pulse(axis: str, peak: float, duration: float) -> Excitation:
    """Return a half-sine pulse of the value itself, as of a force.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    peak : float
        Largest value in the unit of the axis, such as N.
    duration : float
        Duration, s, > 0; the value is zero after it.

    Returns
    -------
    Excitation
        The pulse, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis is unknown, the peak is not finite, or the duration is not > 0.

    Notes
    -----
    The value has corners where it begins and ends; the simulation steps onto them.

    Examples
    --------
    >>> round(float(fx.excitation.half_sine_pulse("x", 3.0, 0.01).evaluate(0.005)[0][0]), 6)
    3.0
    """
    size, T = number(peak, "peak"), positive(duration, "duration", "s")
    return _pieces(axis, [_piece(0.0, [0.0], size, np.pi / T), _piece(T, [0.0])])


def polynomial(axis: str, coefficients: ArrayLike) -> Excitation:
    """Return c0 + c1 t + c2 t^2 + ... on one axis.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    coefficients : array_like, shape (n,)
        One to eight numbers c0, c1, ... in the unit of the axis and s; ``("yaw", [0, rate])`` spins the base at a rate
        in rad/s.

    Returns
    -------
    Excitation
        The polynomial, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis is unknown, or the coefficients are not one to eight finite numbers.

    Notes
    -----
    A base that moves at t = 0 already takes the platform along where `simulate` is told ``start="carried"``.

    Examples
    --------
    >>> spin = fx.excitation.polynomial("yaw", [0.0, 0.5])
    >>> float(spin.evaluate(2.0)[0][5])
    1.0
    """
    c = np.atleast_1d(numbers(coefficients, "coefficients", None))
    if c.ndim != 1 or not 1 <= c.size <= 8:
        raise ArgumentError(f"coefficients have shape {c.shape}; one to eight numbers are needed.")
    return _pieces(axis, [_piece(0.0, c)])


def smooth_step(axis: str, change: float, duration: float) -> Excitation:
    """Return a smooth change from zero to a value that then stays.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    change : float
        The last value in the unit of the axis, such as m or rad.
    duration : float
        Time of the change, s, > 0.

    Returns
    -------
    Excitation
        The step, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis is unknown, the change is not finite, or the duration is not > 0.

    Notes
    -----
    The polynomial of degree 7 with three continuous derivatives at both ends.

    Examples
    --------
    >>> step = fx.excitation.smooth_step("z", 0.01, 0.5)
    >>> step.evaluate([0.0, 0.25, 0.5])[0][:, 2].round(6)
    array([0.   , 0.005, 0.01 ])
    """
    size, T = number(change, "change"), positive(duration, "duration", "s")
    with np.errstate(all="ignore"):
        rise = np.array([0, 0, 0, 0, 35, -84, 70, -20]) * size / T ** np.arange(8)
    return _pieces(axis, [_piece(0.0, rise), _piece(T, [size])])


def sampled_term(
    axis: str, knots: Array, coefficients: Array, spacing: float, end: float, *, use: Use, origin: str, remark: str
) -> Excitation:
    """A recording as smoothly joined polynomials: coefficients (n, <= 8) of powers of the time since each knot (n,).

    spacing: s between samples; end: s, the last one. use, origin, remark: as in `Term`.
    """
    pieces = np.zeros(knots.size, PIECE)
    pieces["start"] = knots
    pieces["coefficients"][:, : coefficients.shape[1]] = coefficients
    numbers = np.concatenate([[0.0], pieces.view(np.float64)])
    return one_term(axis, TermKind.pieces, numbers, use=use, sampled=spacing, last=end, origin=origin, remark=remark)


def _pieces(axis: str, pieces: list[NDArray[np.void]], use: Use = "") -> Excitation:
    """Pieces joined with corners, which a simulation steps onto. Raises ArgumentError for numbers that overflow."""
    rows = np.stack(pieces).view(np.float64)
    if not np.isfinite(rows).all():
        raise ArgumentError("duration and height are too far apart in size: what comes of them is not finite.")
    return one_term(axis, TermKind.pieces, np.concatenate([[1.0], rows]), use=use)


def _piece(start: float, coefficients: ArrayLike, sine: float = 0.0, omega: float = 0.0) -> NDArray[np.void]:
    piece = np.zeros((), PIECE)
    c = np.asarray(coefficients, dtype=float)
    piece["start"], piece["coefficients"][: c.size], piece["sine"], piece["omega"] = start, c, sine, omega
    return piece


def _half_sine(start: float, travel: float, speed: float, peak: float, duration: float) -> NDArray[np.void]:
    """x'' = peak sin(pi t / duration) from the travel and speed given."""
    scale = duration / np.pi
    return _piece(start, [travel, speed + peak * scale], -peak * scale * scale, np.pi / duration)
