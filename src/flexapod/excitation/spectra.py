"""Power spectra of floors, the ground and the sea, and random motions that have them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, harmonic

Quantity = Literal["displacement", "velocity", "acceleration"]
HERTZ = 2 * np.pi  # rad/s

VC_SPEED = {"VC-A": 50.0, "VC-B": 25.0, "VC-C": 12.5, "VC-D": 6.25, "VC-E": 3.12, "VC-F": 1.56, "VC-G": 0.78}  # um/s

# Peterson's models: level a + b log10(period) in dB of 1 (m/s2)2/Hz from each period (s) to the next.
LOW_NOISE = (
    (0.10, -162.36, 5.64),
    (0.17, -166.70, 0.00),
    (0.40, -170.00, -8.30),
    (0.80, -166.40, 28.90),
    (1.24, -168.60, 52.48),
    (2.40, -159.98, 29.81),
    (4.30, -141.10, 0.00),
    (5.00, -71.36, -99.77),
    (6.00, -97.26, -66.49),
    (10.00, -132.18, -31.57),
    (12.00, -205.27, 36.16),
    (15.60, -37.65, -104.33),
    (21.90, -114.37, -47.10),
    (31.60, -160.58, -16.28),
    (45.00, -187.50, 0.00),
    (70.00, -216.47, 15.70),
    (101.00, -185.00, 0.00),
)
HIGH_NOISE = (
    (0.10, -108.73, -17.23),
    (0.22, -150.34, -80.50),
    (0.32, -122.31, -23.87),
    (0.80, -116.85, 32.51),
    (3.80, -108.48, 18.08),
    (4.60, -74.66, -32.95),
    (6.30, 0.66, -127.18),
    (7.90, -93.37, -22.42),
    (15.40, 73.54, -162.98),
    (20.00, -151.52, 10.01),
)


class Spectrum(NamedTuple):
    """A one-sided power spectral density per rad/s.

    density(omega): takes and gives arrays; zero outside the range. quantity: "displacement", "velocity" or
    "acceleration". omega_min, omega_max: the range, rad/s.

    Source: own.
    """

    density: Callable[[Array], Array]
    quantity: Quantity
    omega_min: float
    omega_max: float

    def rms(self, lines: int = 20000) -> float:
        """Root mean square of the quantity."""
        omega = np.geomspace(self.omega_min, self.omega_max, lines)
        return float(np.sqrt(np.trapezoid(self.density(omega), omega)))


def flat_spectrum(rms: float, omega_min: float, omega_max: float, quantity: Quantity = "acceleration") -> Spectrum:
    """The same density from omega_min to omega_max (rad/s).

    rms: root mean square of the quantity ("displacement", "velocity", "acceleration"), m, m/s or m/s2; rad and so on.

    Raises: ArgumentError for a value or a range that is not > 0.
    Source: own.
    """
    _range(omega_min, omega_max)
    level = _positive(rms, "rms") ** 2 / (omega_max - omega_min)
    return _limited(lambda omega: np.full(np.shape(omega), level), quantity, omega_min, omega_max)


def vc_curve(name: str) -> Spectrum:
    """A floor that just meets a vibration criterion: RMS velocity (m/s) in every one-third octave band.

    name: "VC-A" to "VC-G". VC-A and VC-B: constant acceleration from 4 Hz, constant velocity from 8 to 80 Hz; the
    others: constant velocity from 1 to 80 Hz. Spread over each band evenly, so that the density goes with 1/omega.

    Raises: ArgumentError for a criterion that is none.
    Source: C. G. Gordon, Generic criteria for vibration-sensitive equipment, Proc. SPIE 1619 (1991); IEST-RP-CC012.
    """
    if name not in VC_SPEED:
        raise ArgumentError(f"criterion is {name!r}; it must be one of {', '.join(VC_SPEED)}.")
    speed = VC_SPEED[name] * 1e-6
    band = 2 ** (1 / 6) - 2 ** (-1 / 6)  # width of a one-third octave band over its middle
    lifted = name in ("VC-A", "VC-B")

    def density(omega: Array) -> Array:
        level = speed * np.where(lifted & (omega < 8 * HERTZ), 8 * HERTZ / omega, 1.0)
        return level**2 / (band * omega)

    return _limited(density, "velocity", (4 if lifted else 1) * HERTZ, 80 * HERTZ)


def ground_noise(model: Literal["low", "high"] = "high") -> Spectrum:
    """Ground between 0.01 and 10 Hz: acceleration (m/s2) by Peterson's low and high noise models.

    model: "low" for quiet ground, "high" for noisy ground.

    Raises: ArgumentError for a model that is neither "low" nor "high".
    Source: J. Peterson, Observations and modeling of seismic background noise, USGS Open-File Report 93-322 (1993).
    """
    tables = {"low": LOW_NOISE, "high": HIGH_NOISE}
    if model not in tables:
        raise ArgumentError(f"noise model is {model!r}; it must be 'low' or 'high'.")
    period, a, b = np.array(tables[model]).T

    def density(omega: Array) -> Array:
        T = HERTZ / np.asarray(omega, dtype=float)
        row = np.clip(np.searchsorted(period, T * (1 + 1e-12), side="right") - 1, 0, None)
        return 10 ** ((a[row] + b[row] * np.log10(T)) / 10) / HERTZ

    return _limited(density, "acceleration", 0.01 * HERTZ, 10 * HERTZ)


def sea_spectrum(height: float, period: float, gamma: float = 1.0) -> Spectrum:
    """Elevation of a sea of significant wave height (m) and peak period (s): JONSWAP, or Pierson-Moskowitz at gamma 1.

    The level is set so that 4 RMS is the height.

    Raises: ArgumentError for a height or period that is not > 0, or gamma not from 1 to 10.
    Source: K. Hasselmann and others, Dtsch. Hydrogr. Z. A8(12) (1973); W. J. Pierson and L. Moskowitz (1964).
    """
    H, T = _positive(height, "wave height"), _positive(period, "peak period")
    if not 1 <= gamma <= 10:
        raise ArgumentError(f"gamma is {gamma}; it must be from 1 (Pierson-Moskowitz) to 10; JONSWAP's mean is 3.3.")
    peak = HERTZ / T

    def shape(omega: Array) -> Array:
        width = np.where(omega <= peak, 0.07, 0.09)
        lift = gamma ** np.exp(-0.5 * ((omega - peak) / (width * peak)) ** 2)
        return peak**4 / omega**5 * np.exp(-1.25 * (peak / omega) ** 4) * lift

    low, high = 0.3 * peak, 10 * peak  # outside it lies 1e-4 of the energy
    grid = np.geomspace(low, high, 20001)
    level = (H / 4) ** 2 / np.trapezoid(shape(grid), grid)
    return _limited(lambda omega: level * shape(omega), "displacement", low, high)


def random_motion(channel: str, spectrum: Spectrum, *, seed: int, lines: int = 400) -> Excitation:
    """A sum of `lines` sinusoids on a channel (x to yaw) with random phases that has a spectrum.

    The spectrum is of displacement, velocity or acceleration (m, rad). One frequency (rad/s) is drawn in each of
    `lines` bands of equal width, so that the motion does not repeat.

    Raises: ArgumentError for an unknown channel, no lines, or a density that none can be.
    Source: M. Shinozuka and G. Deodatis, Appl. Mech. Rev. 44 (1991).
    """
    omega, amplitude, phase = _lines(spectrum, seed, lines)
    return harmonic(channel, amplitude, omega, phase)


def sea_motion(
    spectrum: Spectrum, response: Mapping[str, Callable[[Array], ArrayLike]], *, seed: int, lines: int = 400
) -> Excitation:
    """Motions of a ship in one sea: `response` gives each channel's complex motion per elevation at omega (rad/s).

    spectrum: of the sea's elevation, by `sea_spectrum`. All channels follow the same waves, with the phases that their
    responses give them (m/m, rad/m). lines: how many sinusoids, as in `random_motion`.

    Raises: ArgumentError for an unknown channel, no lines, or a response that is not finite.
    Source: M. St. Denis and W. J. Pierson, Trans. SNAME 61 (1953).
    """
    omega, amplitude, phase = _lines(spectrum, seed, lines)
    total = Excitation()
    for channel, operator in response.items():
        factor = np.broadcast_to(np.asarray(operator(omega), dtype=complex), omega.shape)
        if not np.isfinite(factor).all():
            raise ArgumentError(f"the response of {channel} holds NaN or infinity; it must be finite for all omega.")
        total = total + harmonic(channel, amplitude * np.abs(factor), omega, phase + np.angle(factor))
    return total


def _lines(spectrum: Spectrum, seed: int, lines: int) -> tuple[Array, Array, Array]:
    """Frequencies, displacement amplitudes and phases."""
    if lines < 1:
        raise ArgumentError(f"lines is {lines}; it must be >= 1.")
    rng = np.random.default_rng(seed)
    edges = np.linspace(spectrum.omega_min, spectrum.omega_max, lines + 1)
    omega = edges[:-1] + np.diff(edges) * rng.uniform(size=lines)
    density = np.asarray(spectrum.density(omega), dtype=float)
    if not np.isfinite(density).all() or (density < 0).any():
        raise ArgumentError("the density holds NaN, infinity or negative numbers; it must be >= 0 and finite.")
    if spectrum.quantity not in get_args(Quantity):
        raise ArgumentError(f"the spectrum is of {spectrum.quantity!r}; it must be of {', '.join(get_args(Quantity))}.")
    power = get_args(Quantity).index(spectrum.quantity)
    amplitude = np.sqrt(2 * density * np.diff(edges)) / omega**power
    return omega, amplitude, rng.uniform(0, 2 * np.pi, lines)


def _limited(density: Callable[[Array], Array], quantity: Quantity, low: float, high: float) -> Spectrum:
    def limited(omega: ArrayLike) -> Array:
        w = np.asarray(omega, dtype=float)
        inside = (w >= low * (1 - 1e-12)) & (w <= high * (1 + 1e-12))
        return np.where(inside, density(np.clip(w, low, high)), 0.0)

    return Spectrum(limited, quantity, float(low), float(high))


def _range(low: float, high: float) -> None:
    if not (np.isfinite(high) and 0 < low < high):
        raise ArgumentError(f"frequencies are {low} to {high} rad/s; the first must be > 0 and below the second.")


def _positive(value: float, name: str) -> float:
    if not (np.isfinite(value) and value > 0):
        raise ArgumentError(f"{name} is {value}; it must be > 0 and finite.")
    return float(value)
