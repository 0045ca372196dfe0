"""The frequencies of a response: those asked for, or a grid that resolves every resonance."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, positive, whole
from flexapod.conventions import TWO_PI, Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, shown, told_apart
from flexapod.mechanics.inputs import ZERO
from flexapod.mechanics.linearisation import linearise
from flexapod.pose import PoseLike
from flexapod.vibration.harmonic import complex_poles, losses

SAMPLES = 500
_BELOW, _ABOVE = 0.2, 1.5  # of the lowest and the highest mode: the default band
_HALF_WIDTHS = 2.0 ** np.arange(-2, 4)  # from a resonance to its grid points, in half widths of its peak


def frequency_grid(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    omega_min: float | None = None,
    omega_max: float | None = None,
    samples: int = SAMPLES,
    loss_factor: ArrayLike | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> Array:
    """Compute frequencies that resolve every resonance of the machine at a pose.

    It is the grid that `transmissibility` and the other responses use where no frequencies are given.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Pose of the platform, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    omega_min, omega_max : float, optional
        Ends of the grid, rad/s; by default a fifth of the lowest and 1.5 times the highest natural frequency.
    samples : int, optional
        Number of frequencies spaced equally by logarithm over the band. Up to 13 more lie around each resonance.
    loss_factor : float or array_like, optional
        Structural damping of the legs' springs, one number or (6,), in place of `legs.loss_factor` of the design. The
        joints have their own of the design.
    base : Pose or array_like, optional
        Pose of the base; the inertial frame by default.
    force, moment : array_like, optional
        Constant force (N) and moment (N m) on the platform at its reference point, in the platform's axes, (3,).
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.

    Returns
    -------
    ndarray
        Frequencies, (n,) rad/s, ascending.

    Raises
    ------
    ArgumentError
        If the band is empty, or an argument has a wrong shape or range.
    PoseError
        If `pose` is not one pose that the legs can take.
    SingularPoseError
        If no leg forces hold the pose.

    Notes
    -----
    The points around a resonance lie at its damped natural frequency and at 1/4, 1/2, 1, 2, 4 and 8 half widths of its
    peak on both sides, so that the peak is met however small its damping.

    Examples
    --------
    >>> hexapod = fx.load("cubic-isolator")
    >>> omega = fx.vibration.frequency_grid(hexapod, samples=100)
    >>> omega[[0, -1]].round(1)
    array([ 5.8, 76. ])
    """
    linear = linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    return grid_around(complex_poles(linear, losses(hexapod, linear, loss_factor)), omega_min, omega_max, samples)


def band(poles: Complex, omega_min: float | None = None, omega_max: float | None = None) -> tuple[float, float]:
    """The ends of a grid, rad/s: those given, or below and above all poles."""
    size = abs(poles[poles != 0])
    low = _BELOW * float(size.min()) if omega_min is None else positive(omega_min, "omega_min", "rad/s")
    high = _ABOVE * float(size.max()) if omega_max is None else positive(omega_max, "omega_max", "rad/s")
    if low >= high:
        one, other = told_apart(low, high, (6, 6))
        raise ArgumentError(f"omega_min is {one} rad/s; it must be less than omega_max, {other} rad/s.")
    return low, high


def grid_around(
    poles: Complex, omega_min: float | None = None, omega_max: float | None = None, samples: int = SAMPLES
) -> Array:
    """The grid of `frequency_grid` for given poles, rad/s."""
    low, high = band(poles, omega_min, omega_max)
    around = np.concatenate([[0.0], _HALF_WIDTHS, -_HALF_WIDTHS])
    near = (poles.imag[:, None] + np.abs(poles.real)[:, None] * around).ravel()
    return np.union1d(np.geomspace(low, high, whole(samples, "samples", 2)), near[(near > low) & (near < high)])


def asked(omega: ArrayLike | None, frequency: ArrayLike | None) -> Array | None:
    """The frequencies given, (n,) rad/s, by `omega` in rad/s or `frequency` in Hz; None where neither is."""
    if omega is not None and frequency is not None:
        raise ArgumentError("omega and frequency are both given; give omega in rad/s, or frequency in Hz.")
    if frequency is not None:
        return TWO_PI * _row(frequency, "frequency", "Hz")
    return None if omega is None else _row(omega, "omega", "rad/s")


def _row(value: ArrayLike, name: str, unit: str) -> Array:
    try:
        array = np.atleast_1d(floats(value))
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is {shown(value)}; it must hold frequencies in {unit}.") from None
    if array.ndim != 1 or array.size == 0:
        raise ArgumentError(f"{name} has shape {array.shape}; it must be a non-empty row of frequencies in {unit}.")
    wrong = np.flatnonzero(~(np.isfinite(array) & (array >= 0)))
    if wrong.size:
        raise ArgumentError(
            f"{name}[{wrong[0]}] is {array[wrong[0]]} {unit}; frequencies must be finite and not negative. "
            "The response at -omega is the complex conjugate of that at omega."
        )
    return array
