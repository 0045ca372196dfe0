"""Sines, and sines whose frequency changes."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from flexapod._core import TermKind
from flexapod.checks import number, numbers, one_of, positive
from flexapod.conventions import TWO_PI
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, one_term

_POWERS = {"displacement": 0.0, "velocity": 1.0, "acceleration": 2.0}


def harmonic(
    axis: str,
    amplitude: ArrayLike,
    omega: ArrayLike | None = None,
    phase: ArrayLike = 0.0,
    *,
    frequency: ArrayLike | None = None,
) -> Excitation:
    """Return a sine, or a sum of sines, on one axis.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    amplitude : float or array_like, shape (n,)
        In the unit of the axis: m or rad, or N or N m where the excitation is a load.
    omega : float or array_like, shape (n,), optional
        Angular frequencies, rad/s, >= 0.
    phase : float or array_like, shape (n,), optional
        Phases, rad: the value is the sum of amplitude sin(omega t + phase).
    frequency : float or array_like, shape (n,), optional
        Frequencies in Hz, in place of `omega`.

    Returns
    -------
    Excitation
        The sum, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis is unknown, there is no sine, a number is not finite, a frequency is negative, or not one of `omega`
        and `frequency` is given.

    See Also
    --------
    Excitation.ramped : A smooth start.

    Notes
    -----
    A sine does not start from rest; with `Excitation.ramped` it does.

    Examples
    --------
    >>> fx.harmonic("z", 1e-3, frequency=5.0)
    <Excitation of z, 1 terms>
    >>> value, rate, acceleration = fx.harmonic("z", 1e-3, 20.0).evaluate(0.1)
    >>> round(float(value[2]), 6)
    0.000909
    """
    if (omega is None) == (frequency is None):
        raise ArgumentError("give one of omega (rad/s) and frequency (Hz).")
    if omega is None:
        omega = TWO_PI * numbers(frequency, "frequency", None)  # type: ignore[arg-type]
    given = [numbers(v, name, None) for v, name in ((amplitude, "amplitude"), (omega, "omega"), (phase, "phase"))]
    try:
        count = np.broadcast_shapes(*(v.shape for v in given), (1,))[-1]
    except ValueError:
        shapes = " and ".join(str(v.shape) for v in given)
        raise ArgumentError(f"amplitude, omega and phase have shapes {shapes}; they must be equal or 1.") from None
    if count == 0:
        raise ArgumentError("amplitude, omega or phase is empty; at least one sine is needed.")
    parts = np.broadcast_arrays(*(np.atleast_1d(v) for v in given))
    triples = np.stack([part.ravel() for part in parts], axis=1)
    if np.any(triples[:, 1] < 0):
        raise ArgumentError(f"omega is {triples[:, 1].min():.6g} rad/s; it must be >= 0.")
    return one_term(axis, TermKind.sinusoids, triples.ravel())


def sine_sweep(
    axis: str,
    amplitude: float,
    omega_start: float,
    omega_end: float,
    duration: float,
    *,
    law: Literal["log", "linear"] = "log",
    hold: Literal["displacement", "velocity", "acceleration"] = "displacement",
) -> Excitation:
    """Return a sine whose frequency goes from one value to another and stays there.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    amplitude : float
        Amplitude of the displacement at `omega_start`, m or rad.
    omega_start, omega_end : float
        First and last angular frequency, rad/s, > 0.
    duration : float
        Time from the first to the last frequency, s, > 0.
    law : {"log", "linear"}, optional
        How the frequency goes with time.
    hold : {"displacement", "velocity", "acceleration"}, optional
        What keeps its amplitude while the frequency changes. With "acceleration" the amplitude of the displacement goes
        with 1/omega^2, as in tests on shakers; it then drives motions only.

    Returns
    -------
    Excitation
        The sweep, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis, `law` or `hold` is unknown, or a number is out of range.

    Notes
    -----
    Logarithmic sweeps are those of IEC 60068-2-6.

    Examples
    --------
    >>> sweep = fx.sine_sweep("z", 1e-3, 10.0, 100.0, 5.0, hold="acceleration")
    >>> round(float(sweep.evaluate(np.linspace(5, 6, 1000))[0][:, 2].max()), 8)
    1e-05
    """
    one_of(law, "law", ("log", "linear"))
    one_of(hold, "hold", _POWERS)
    start, end = positive(omega_start, "omega_start", "rad/s"), positive(omega_end, "omega_end", "rad/s")
    size, time = number(amplitude, "amplitude"), positive(duration, "duration", "s")
    six = np.array([size, start, end, time, float(law == "log"), _POWERS[hold]])
    return one_term(axis, TermKind.chirp, six, use="" if hold == "displacement" else "motion")
