"""Power spectra of floors, the ground, the sea, and loads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, number, one_of, positive, whole
from flexapod.conventions import ROTATIONS, TWO_PI, Array
from flexapod.errors import ArgumentError, shown
from flexapod.excitation.noise_models import HIGH_NOISE, LOW_NOISE
from flexapod.showing import in_notebooks

Quantity = Literal["displacement", "velocity", "acceleration", "force", "moment"]
QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)
MOTIONS: tuple[Quantity, ...] = QUANTITIES[:3]
MOST = 1e100  # of an RMS, whose square must be a number
LOADS: dict[Quantity, str] = {"force": "N", "moment": "N m"}

VC_SPEED = {"VC-A": 50.0, "VC-B": 25.0, "VC-C": 12.5, "VC-D": 6.25, "VC-E": 3.12, "VC-F": 1.56, "VC-G": 0.78}  # um/s


@in_notebooks
@dataclass(frozen=True)
class Spectrum:
    """A one-sided power spectral density of a motion or a load on one axis, per rad/s.

    Attributes
    ----------
    density : callable
        From angular frequencies (n,) in rad/s to densities (n,): the square of m, m/s or m/s2 (or with rad), N or N m
        per rad/s; zero outside the range.
    quantity : {"displacement", "velocity", "acceleration", "force", "moment"}
        What the density is of.
    omega_min, omega_max : float
        The range of frequencies, rad/s.
    unit : {"", "m", "rad"}, optional
        Whether a motion is a translation (m, m/s, m/s2) or a rotation; "" where it is that of the axis.

    Raises
    ------
    ArgumentError
        If the density is no function, the quantity or the unit is unknown, or the range does not ascend from above 0.

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
    unit: Literal["", "m", "rad"] = ""

    def __post_init__(self) -> None:
        if not callable(self.density):
            raise ArgumentError(
                f"density is {shown(self.density)}; it must be a function of angular frequencies, rad/s."
            )
        one_of(self.quantity, "quantity of the spectrum", QUANTITIES)
        one_of(self.unit, "unit of the spectrum", ("", "m", "rad"))
        for name, end in zip(("omega_min", "omega_max"), _range(self.omega_min, self.omega_max), strict=True):
            object.__setattr__(self, name, end)

    def values(self, omega: Array) -> Array:
        """Return the densities at angular frequencies.

        Parameters
        ----------
        omega : ndarray, shape (n,)
            Angular frequencies, rad/s.

        Returns
        -------
        ndarray, shape (n,)
            Densities, in the unit of `density`.

        Raises
        ------
        ArgumentError
            If the density's function gives other than a finite number >= 0 for each frequency.
        """
        try:
            found = np.broadcast_to(floats(self.density(omega)), omega.shape)
        except (TypeError, ValueError, LookupError):
            raise ArgumentError(
                "density gives no densities (n,) for frequencies (n,) in rad/s; it must give a number for each."
            ) from None
        if not np.isfinite(found).all() or (found < 0).any():
            raise ArgumentError("the density holds NaN, infinity or negative numbers; it must be >= 0 and finite.")
        return found

    def rms(self, samples: int = 20000) -> float:
        """Return the root mean square of the quantity.

        Parameters
        ----------
        samples : int, optional
            Number of frequencies of the integral, at equal ratios.
        """
        omega = np.geomspace(self.omega_min, self.omega_max, whole(samples, "samples", 2))
        return float(np.sqrt(np.trapezoid(self.values(omega), omega)))


def check_axis(spectrum: Spectrum, axis: str) -> None:
    """Raises ArgumentError where a spectrum of metres is given to a rotation, or one of radians to a translation."""
    turns = isinstance(axis, str) and axis in ROTATIONS
    if spectrum.quantity in LOADS and turns:
        raise ArgumentError(
            f"axis is {axis!r}, but the spectrum is one of {spectrum.quantity}, which has the axes x, y, z. Choose one."
        )
    if spectrum.unit == ("m" if turns else "rad"):
        raise ArgumentError(
            f"axis is {axis!r}, but the spectrum of {spectrum.quantity} is in {spectrum.unit}; it must be one of "
            f"{'rad' if turns else 'm'}. Give a spectrum for that axis, such as flat_spectrum makes one."
        )


def flat_spectrum(rms: float, omega_min: float, omega_max: float, *, quantity: Quantity = "acceleration") -> Spectrum:
    """Return a spectrum with the same density over a range of frequencies.

    Parameters
    ----------
    rms : float
        Root mean square of the quantity, m, m/s or m/s2, or with rad, N or N m; > 0.
    omega_min, omega_max : float
        Range of frequencies, rad/s, > 0.
    quantity : {"displacement", "velocity", "acceleration", "force", "moment"}, optional
        What the spectrum is of.

    Returns
    -------
    Spectrum
        The spectrum; zero outside its range.

    Raises
    ------
    ArgumentError
        If a number is not > 0, the range does not ascend, or the quantity is unknown.

    Notes
    -----
    The density is rms^2 / (omega_max - omega_min).

    Examples
    --------
    >>> round(fx.excitation.flat_spectrum(0.01, 5.0, 200.0).rms(), 6)
    0.01
    """
    low, high = _range(omega_min, omega_max)
    one_of(quantity, "quantity", QUANTITIES)
    level = _square(positive(rms, "rms"), "rms") / (high - low)
    return Spectrum(_Limited(_Flat(level), low, high), quantity, low, high)


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
    lifted = name in ("VC-A", "VC-B")
    low, high = (4 if lifted else 1) * TWO_PI, 80 * TWO_PI
    density = _Criterion(VC_SPEED[name] * 1e-6, lifted)
    return Spectrum(_Limited(density, low, high), "velocity", low, high, "m")


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
    low, high = 0.01 * TWO_PI, 10 * TWO_PI
    return Spectrum(_Limited(_Ground(model == "low"), low, high), "acceleration", low, high, "m")


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

    low, high = 0.3 * peak, 10 * peak  # outside it lies 1e-4 of the energy
    grid = np.geomspace(low, high, 20001)
    level = float(_square(H, "height") / 16 / np.trapezoid(_Waves(1.0, peak, gamma)(grid), grid))
    return Spectrum(_Limited(_Waves(level, peak, gamma), low, high), "displacement", low, high, "m")


def _range(omega_min: float, omega_max: float) -> tuple[float, float]:
    low, high = number(omega_min, "omega_min", "rad/s"), number(omega_max, "omega_max", "rad/s")
    if not 0 < low < high:
        raise ArgumentError(f"frequencies are {low} to {high} rad/s; the first must be > 0 and below the second.")
    return low, high


def _square(value: float, name: str) -> float:
    if value > MOST:
        raise ArgumentError(f"{name} is {value:g}; it must be at most {MOST:g}.")
    return value**2


@dataclass(frozen=True)
class _Limited:
    """A density that is zero outside its range."""

    density: Callable[[Array], Array]
    low: float
    high: float

    def __call__(self, omega: ArrayLike) -> Array:
        w = np.asarray(omega, dtype=float)
        inside = (w >= self.low * (1 - 1e-12)) & (w <= self.high * (1 + 1e-12))
        return np.where(inside, self.density(np.clip(w, self.low, self.high)), 0.0)


@dataclass(frozen=True)
class _Flat:
    level: float

    def __call__(self, omega: Array) -> Array:
        return np.full(np.shape(omega), self.level)


@dataclass(frozen=True)
class _Criterion:
    """The same speed (m/s) in each one-third octave band; lifted: more below 8 Hz."""

    speed: float
    lifted: bool

    def __call__(self, omega: Array) -> Array:
        band = 2 ** (1 / 6) - 2 ** (-1 / 6)  # width of a one-third octave band over its middle
        level = self.speed * np.where(self.lifted & (omega < 8 * TWO_PI), 8 * TWO_PI / omega, 1.0)
        return level**2 / (band * omega)


@dataclass(frozen=True)
class _Ground:
    """Peterson's models of noise."""

    low: bool

    def __call__(self, omega: Array) -> Array:
        period, a, b = np.array(LOW_NOISE if self.low else HIGH_NOISE).T
        T = TWO_PI / np.asarray(omega, dtype=float)
        row = np.clip(np.searchsorted(period, T * (1 + 1e-12), side="right") - 1, 0, None)
        return 10 ** ((a[row] + b[row] * np.log10(T)) / 10) / TWO_PI


@dataclass(frozen=True)
class _Waves:
    """JONSWAP's spectrum with a peak (rad/s)."""

    level: float
    peak: float
    gamma: float

    def __call__(self, omega: Array) -> Array:
        width = np.where(omega <= self.peak, 0.07, 0.09)
        lift = self.gamma ** np.exp(-0.5 * ((omega - self.peak) / (width * self.peak)) ** 2)
        return self.level * self.peak**4 / omega**5 * np.exp(-1.25 * (self.peak / omega) ** 4) * lift
