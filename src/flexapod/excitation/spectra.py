"""Power spectra of floors, the ground and the sea."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import number, one_of, positive, whole
from flexapod.conventions import TWO_PI, Array
from flexapod.errors import ArgumentError
from flexapod.excitation.noise_models import HIGH_NOISE, LOW_NOISE

Quantity = Literal["displacement", "velocity", "acceleration"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)

VC_SPEED = {"VC-A": 50.0, "VC-B": 25.0, "VC-C": 12.5, "VC-D": 6.25, "VC-E": 3.12, "VC-F": 1.56, "VC-G": 0.78}  # um/s


class Spectrum(NamedTuple):
    """A one-sided power spectral density of a motion on one axis, per rad/s.

    Attributes
    ----------
    density : callable
        From angular frequencies (n,) in rad/s to densities (n,): the square of m, m/s or m/s2 (or with rad) per rad/s;
        zero outside the range.
    quantity : {"displacement", "velocity", "acceleration"}
        What the density is of.
    omega_min, omega_max : float
        The range of frequencies, rad/s.

    Examples
    --------
    >>> fx.vc_curve("VC-C").quantity
    'velocity'
    >>> round(fx.excitation.Spectrum(lambda w: 0 * w + 4.0, "velocity", 1.0, 2.0).rms(), 6)
    2.0
    """

    density: Callable[[Array], Array]
    quantity: Quantity
    omega_min: float
    omega_max: float

    def rms(self, samples: int = 20000) -> float:
        """Return the root mean square of the quantity.

        Parameters
        ----------
        samples : int, optional
            Number of frequencies of the integral, at equal ratios.
        """
        omega = np.geomspace(self.omega_min, self.omega_max, whole(samples, "samples", 2))
        return float(np.sqrt(np.trapezoid(self.density(omega), omega)))


def flat_spectrum(rms: float, omega_min: float, omega_max: float, *, quantity: Quantity = "acceleration") -> Spectrum:
    """Return a spectrum with the same density over a range of frequencies.

    Parameters
    ----------
    rms : float
        Root mean square of the quantity, m, m/s or m/s2, or with rad; > 0.
    omega_min, omega_max : float
        Range of frequencies, rad/s, > 0.
    quantity : {"displacement", "velocity", "acceleration"}, optional
        What the spectrum is of.

    Returns
    -------
    Spectrum
        The spectrum; zero outside its range.

    Raises
    ------
    ArgumentError
        If a number is not > 0, or the range does not ascend.

    Notes
    -----
    The density is rms^2 / (omega_max - omega_min).

    Examples
    --------
    >>> round(fx.excitation.flat_spectrum(0.01, 5.0, 200.0).rms(), 6)
    0.01
    """
    low, high = number(omega_min, "omega_min", "rad/s"), number(omega_max, "omega_max", "rad/s")
    if not 0 < low < high:
        raise ArgumentError(f"frequencies are {low} to {high} rad/s; the first must be > 0 and below the second.")
    level = positive(rms, "rms") ** 2 / (high - low)
    return _limited(lambda omega: np.full(np.shape(omega), level), quantity, low, high)


def vc_curve(name: str) -> Spectrum:
    """Return the spectrum of a floor that just meets a vibration criterion.

    Parameters
    ----------
    name : str
        The criterion, "VC-A" to "VC-G".

    Returns
    -------
    Spectrum
        Of velocity, (m/s)^2 per rad/s.

    Raises
    ------
    ArgumentError
        If the criterion is unknown.

    Notes
    -----
    The criteria [1]_ give the RMS velocity in every one-third octave band. VC-A and VC-B: constant acceleration from
    4 Hz, constant velocity from 8 to 80 Hz; the others: constant velocity from 1 to 80 Hz. It is spread evenly over
    each band, so that the density goes with 1/omega.

    References
    ----------
    .. [1] C. G. Gordon, "Generic criteria for vibration-sensitive equipment", Proc. SPIE 1619 (1991); IEST-RP-CC012.

    Examples
    --------
    >>> floor = fx.vc_curve("VC-C")
    >>> round(floor.rms() * 1e6, 1)
    54.4
    """
    one_of(name, "name", VC_SPEED)
    speed = VC_SPEED[name] * 1e-6
    band = 2 ** (1 / 6) - 2 ** (-1 / 6)  # width of a one-third octave band over its middle
    lifted = name in ("VC-A", "VC-B")

    def density(omega: Array) -> Array:
        level = speed * np.where(lifted & (omega < 8 * TWO_PI), 8 * TWO_PI / omega, 1.0)
        return level**2 / (band * omega)

    return _limited(density, "velocity", (4 if lifted else 1) * TWO_PI, 80 * TWO_PI)


def ground_noise(model: Literal["low", "high"] = "high") -> Spectrum:
    """Return the spectrum of the ground between 0.01 and 10 Hz.

    Parameters
    ----------
    model : {"low", "high"}, optional
        The low noise model is that of quiet places, the high noise model that of noisy ones.

    Returns
    -------
    Spectrum
        Of acceleration, (m/s2)^2 per rad/s.

    Raises
    ------
    ArgumentError
        If the model is unknown.

    Notes
    -----
    J. Peterson, "Observations and modeling of seismic background noise", USGS Open-File Report 93-322 (1993).

    Examples
    --------
    >>> round(fx.excitation.ground_noise("high").rms() * 1e6)
    49
    """
    one_of(model, "model", ("low", "high"))
    period, a, b = np.array(LOW_NOISE if model == "low" else HIGH_NOISE).T

    def density(omega: Array) -> Array:
        T = TWO_PI / np.asarray(omega, dtype=float)
        row = np.clip(np.searchsorted(period, T * (1 + 1e-12), side="right") - 1, 0, None)
        return 10 ** ((a[row] + b[row] * np.log10(T)) / 10) / TWO_PI

    return _limited(density, "acceleration", 0.01 * TWO_PI, 10 * TWO_PI)


def sea_spectrum(height: float, period: float, gamma: float = 1.0) -> Spectrum:
    """Return the spectrum of the elevation of a sea.

    Parameters
    ----------
    height : float
        Significant wave height, m, > 0.
    period : float
        Peak period, s, > 0.
    gamma : float, optional
        Peak enhancement of JONSWAP, from 1 (the Pierson-Moskowitz spectrum) to 10.

    Returns
    -------
    Spectrum
        Of displacement, m^2 per rad/s.

    Raises
    ------
    ArgumentError
        If a number is out of range.

    Notes
    -----
    JONSWAP [1]_, which is that of Pierson and Moskowitz [2]_ at gamma 1. The level is set so that four times the RMS is
    the height.

    References
    ----------
    .. [1] K. Hasselmann and others, Deutsche Hydrographische Zeitschrift A8(12) (1973).
    .. [2] W. J. Pierson and L. Moskowitz, Journal of Geophysical Research 69 (1964).

    Examples
    --------
    >>> round(4 * fx.excitation.sea_spectrum(3.0, 9.0, gamma=3.3).rms(), 3)
    3.0
    """
    H, T = positive(height, "height", "m"), positive(period, "period", "s")
    if not 1 <= number(gamma, "gamma") <= 10:
        raise ArgumentError(f"gamma is {gamma}; it must be from 1 (Pierson-Moskowitz) to 10; JONSWAP's mean is 3.3.")
    peak = TWO_PI / T

    def shape(omega: Array) -> Array:
        width = np.where(omega <= peak, 0.07, 0.09)
        lift = gamma ** np.exp(-0.5 * ((omega - peak) / (width * peak)) ** 2)
        return peak**4 / omega**5 * np.exp(-1.25 * (peak / omega) ** 4) * lift

    low, high = 0.3 * peak, 10 * peak  # outside it lies 1e-4 of the energy
    grid = np.geomspace(low, high, 20001)
    level = (H / 4) ** 2 / np.trapezoid(shape(grid), grid)
    return _limited(lambda omega: level * shape(omega), "displacement", low, high)


def _limited(density: Callable[[Array], Array], quantity: Quantity, low: float, high: float) -> Spectrum:
    def limited(omega: ArrayLike) -> Array:
        w = np.asarray(omega, dtype=float)
        inside = (w >= low * (1 - 1e-12)) & (w <= high * (1 + 1e-12))
        return np.where(inside, density(np.clip(w, low, high)), 0.0)

    return Spectrum(limited, quantity, float(low), float(high))
