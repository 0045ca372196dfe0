"""Random motions that have a power spectrum: on one axis, or of a ship in one sea."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import instance, whole
from flexapod.conventions import TWO_PI, Array
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, Use
from flexapod.excitation.sines import harmonic
from flexapod.excitation.spectra import LOADS, MOTIONS, Spectrum, check_axis


def random_motion(axis: str, spectrum: Spectrum, *, seed: int = 0, samples: int = 400) -> Excitation:
    """Return a random motion, or a random load, with a power spectrum, as a sum of sines.

    Parameters
    ----------
    axis : str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6".
    spectrum : Spectrum
        Density of displacement, velocity or acceleration, or of a force or moment, per rad/s. It also says what the
        sum can drive.
    seed : int, optional
        Seed of the frequencies and phases.
    samples : int, optional
        Number of sines.

    Returns
    -------
    Excitation
        The motion, from t = 0 on.

    Raises
    ------
    ArgumentError
        If the axis is unknown or not one of the spectrum's unit, the number of sines is invalid, or the density is
        negative or not finite.

    Notes
    -----
    The sum of cosines with random phases of Shinozuka and Deodatis, Applied Mechanics Reviews 44 (1991). The range of
    the spectrum is cut into bands of equal width, and one frequency is drawn in each, so that the motion does not
    repeat.

    Examples
    --------
    >>> floor = fx.random_motion("z", fx.vc_curve("VC-C"), seed=1)
    >>> velocity = floor.evaluate(np.linspace(0, 100, 4001))[1][:, 2]
    >>> round(float(velocity.std() / fx.vc_curve("VC-C").rms()), 1)
    1.0
    """
    omega, amplitude, phase = _lines(spectrum, seed, samples)
    check_axis(spectrum, axis)
    use: Use = spectrum.quantity if spectrum.quantity in LOADS else "motion"  # type: ignore[assignment]
    return harmonic(axis, amplitude, omega, phase).for_use(use)


def sea_motion(
    spectrum: Spectrum,
    response: Mapping[str, Callable[[Array], ArrayLike]],
    *,
    seed: int = 0,
    samples: int = 400,
) -> Excitation:
    """Return the motions of a ship in one sea.

    Parameters
    ----------
    spectrum : Spectrum
        Of the sea's elevation, by `sea_spectrum`.
    response : dict of str to callable
        For each axis that moves, the complex motion per elevation at the angular frequencies omega (n,) in rad/s: m/m
        for x, y, z and rad/m for roll, pitch, yaw.
    seed : int, optional
        Seed of the frequencies and phases of the waves.
    samples : int, optional
        Number of waves.

    Returns
    -------
    Excitation
        The motion of the base. All axes follow the same waves, with the phases that their responses give them.

    Raises
    ------
    ArgumentError
        If an axis is unknown, the spectrum is not one of a motion, the number of waves is invalid, or a response is not
        finite.

    Notes
    -----
    Linear superposition of St. Denis and Pierson, Transactions of SNAME 61 (1953).

    Examples
    --------
    >>> sea = fx.excitation.sea_spectrum(2.0, 8.0)
    >>> fx.excitation.sea_motion(sea, {"z": lambda w: 1 / (1 + w**2), "roll": lambda w: 0.02j * w})
    <Excitation of z, roll, 2 terms>
    """
    omega, amplitude, phase = _lines(spectrum, seed, samples)
    if spectrum.quantity in LOADS:
        raise ArgumentError(f"spectrum is one of {spectrum.quantity}; it must be that of the sea's elevation.")
    instance(response, Mapping, "response", "from names of axes to functions of omega")
    total = Excitation()
    for axis, operator in response.items():
        factor = np.broadcast_to(np.asarray(operator(omega), dtype=complex), omega.shape)
        if not np.isfinite(factor).all():
            raise ArgumentError(f"the response of {axis} holds NaN or infinity; it must be finite for all omega.")
        motion = harmonic(axis, amplitude * np.abs(factor), omega, phase + np.angle(factor))
        total = total + motion.for_use("motion")
    return total


def _lines(spectrum: Spectrum, seed: int, samples: int) -> tuple[Array, Array, Array]:
    """Frequencies, phases, and amplitudes of the displacement or the load."""
    instance(spectrum, Spectrum, "spectrum", "such as fx.vc_curve('VC-C')")
    samples = whole(samples, "samples")
    rng = np.random.default_rng(whole(seed, "seed", 0))
    edges = np.linspace(spectrum.omega_min, spectrum.omega_max, samples + 1)
    omega = edges[:-1] + np.diff(edges) * rng.uniform(size=samples)
    density, quantity = spectrum.values(omega), spectrum.quantity
    power = MOTIONS.index(quantity) if quantity in MOTIONS else 0
    amplitude = np.sqrt(2 * density * np.diff(edges)) / omega**power
    return omega, amplitude, rng.uniform(0, TWO_PI, samples)
