"""Vibration on a base that moves at random: spectra and RMS values, from the exact tangent at rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, Array, Complex, JointModel, in_mixed_units, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.excitation.spectra import Quantity, Spectrum
from flexapod.mechanics.cautions import grows
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_point, single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import PoseLike
from flexapod.vibration.base_spectrum import Density, ready_made, tabulated
from flexapod.vibration.frequency_response import MOTION_UNITS, attributes, leg_forces
from flexapod.vibration.grid import asked, grid_around
from flexapod.vibration.harmonic import complex_poles, leg_losses, losses, steady_response
from flexapod.vibration.quadrature import Panels, graded

QUANTITIES = {
    "displacement": ("output", "output_unit"),
    "relative": ("output", "output_unit"),
    "acceleration": ("output", "output_unit/s^2"),
    "leg_force": ("leg", "N"),
}
_LEAST_DAMPING = 1e-13  # damping ratio that rounding of the poles may hide


def random_response(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    psd: Density,
    omega: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    of: Quantity = "acceleration",
    axis: str | None = None,
    point: PointLike = ZERO,
    loss_factor: ArrayLike | None = None,
    base: PoseLike | None = None,
    force: ArrayLike = ZERO,
    moment: ArrayLike = ZERO,
    joint: JointModel = "universal",
) -> xr.Dataset:
    """Compute spectra and RMS values of the platform and the legs on a base that moves at random.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Pose of the platform, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    psd : Spectrum, dict of str to Spectrum, array_like or callable
        One-sided power spectral density of the base's motion. One of

        - a Spectrum of one `axis`, such as ``flexapod.vc_curve("VC-C")``, or several by axis, which move independently:
          ``{"x": ..., "z": ...}``;
        - a table over `omega` or `frequency`: (n,) of one `axis`, (n, 6) of six independent axes, or (n, 6, 6), the
          Hermitian cross-spectral matrix S_jk of E[X_j conj(X_k)];
        - a function that gives such numbers at frequencies (n,).

        Tables and functions are densities per rad/s over `omega`; per Hz where `frequency` is given.
    omega : array_like, optional
        Frequencies of a table, (n,) rad/s, ascending and > 0. The first and the last bound the band. By default the
        band of a Spectrum, or that of `vibration.frequency_grid` for a function.
    frequency : array_like, optional
        The same in Hz, in place of `omega`.
    of : {"acceleration", "velocity", "displacement"}, optional
        What a table or function is the density of. A Spectrum says it itself.
    axis : {"x", "y", "z", "roll", "pitch", "yaw"}, optional
        Axis of the base that moves, where `psd` is of one axis.
    point : array_like or str, optional
        Output point, (3,) m, in the platform's frame, or the name of a point of the design.
    loss_factor : float or array_like, optional
        Structural damping of the legs' springs, one number or (6,), in place of `legs.loss_factor` of the design. The
        joints have their own of the design.
    base : Pose or array_like, optional
        Pose of the base at rest; the inertial frame by default.
    force, moment : array_like, optional
        Constant force (N) and moment (N m) on the platform at its reference point, in the platform's axes, (3,).
    joint : {"universal", "spin_free"}, optional
        Model of the joint between a leg and the base.

    Returns
    -------
    xarray.Dataset
        For displacement and acceleration of the output point (absolute), relative (displacement less the rigid motion
        with the base) over `output` (x, y, z, roll, pitch, yaw), and leg_force (N) over `leg`:

        - psd_... (omega, output or leg): one-sided spectral density per rad/s
        - cumulative_... (omega, output or leg): RMS of what lies below omega
        - rms_... (output or leg): RMS of the whole band

        `omega` holds the frequencies given and those at which the integrals were computed, rad/s.

    Raises
    ------
    ArgumentError
        If `psd` cannot be a spectral density, or a mode in the band has no damping or grows.
    PoseError
        If `pose` is not one pose that the legs can take.
    SingularPoseError
        If no leg forces hold the pose.

    See Also
    --------
    transmissibility : the frequency response behind it.
    vc_curve : spectra of quiet floors.

    Notes
    -----
    The exact linearisation of Eq. 34 of [1]_ at rest filters the spectrum of the base. Between its frequencies a table
    is straight in log-log axes (linear where it touches zero), a matrix linear. Integrals are Gauss quadratures over
    panels that shrink geometrically towards every pole, so that resonances are resolved whatever their damping.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration (2007).

    Examples
    --------
    >>> response = fx.random_response(fx.load("cubic-isolator"), psd=fx.vc_curve("VC-C"), axis="z", loss_factor=0.01)
    >>> round(1e6 * float(response.rms_displacement.sel(output="z")), 1)  # micrometres
    4.6
    """
    leg_losses(as_hexapod(hexapod), loss_factor)
    pose = single_pose(hexapod, pose)
    linear = linearise(hexapod, pose, base=base, force=force, moment=moment, joint=joint)
    eta = losses(hexapod, linear, loss_factor)
    _check_stands(linear)
    poles = complex_poles(linear, eta)
    given = asked(omega, frequency)
    if isinstance(psd, Spectrum | Mapping):
        spectrum = ready_made(psd, axis, given)
    else:
        if given is None and not callable(psd):
            raise ArgumentError("omega is missing; a psd of numbers needs their frequencies, as omega or frequency.")
        grid = grid_around(poles) if given is None else given
        spectrum = tabulated(psd, axis, grid, of, per_hertz=frequency is not None)
    _check_damped(poles, spectrum.grid)
    panels = Panels(graded(spectrum.grid, poles))
    filters = _Filters(linear, shift(pose, as_point(hexapod, point)), eta, spectrum.quantity)
    densities = filters.spectra(panels.omega, spectrum.density(panels.omega))
    return _dataset(panels, densities).assign_attrs(attributes(hexapod, pose, point, eta, linear))


def _dataset(panels: Panels, densities: dict[str, Array]) -> xr.Dataset:
    coordinates = {
        "omega": ("omega", panels.omega, in_unit("rad/s", "frequency")),
        "output": list(AXES),
        "output_unit": ("output", MOTION_UNITS),
        "leg": list(LEGS),
    }
    dataset = xr.Dataset(coords=coordinates)
    dataset.attrs["convention"] = "one-sided spectral density per rad/s: mean square = integral over omega > 0"
    for name, (along, unit) in QUANTITIES.items():
        cumulative = np.sqrt(panels.cumulated(densities[name]))
        amount, density = _units(unit)
        dataset[f"psd_{name}"] = (("omega", along), densities[name], density)
        dataset[f"cumulative_{name}"] = (("omega", along), cumulative, amount)
        dataset[f"rms_{name}"] = ((along,), cumulative[-1], amount)
    return dataset


def _units(unit: str) -> tuple[dict[str, str], dict[str, str]]:
    """Attributes of an amount and of its spectral density."""
    if unit == "N":
        return in_unit("N"), in_unit("N^2/(rad/s)")
    return in_mixed_units(unit), in_mixed_units(f"({unit})^2/(rad/s)")


class _Filters(NamedTuple):
    """From the base's spectrum to those of the quantities."""

    linear: Linearisation
    to_point: Array
    eta: Array
    of: Quantity

    def spectra(self, omega: Array, base: Complex) -> dict[str, Array]:
        """Spectral densities (n, 6) of every quantity; base: (n, 6) or (n, 6, 6)."""
        steady = steady_response(self.linear, omega, self.eta)
        relative = self.to_point @ steady.relative
        absolute = self.to_point @ steady.absolute
        order = {"displacement": 0, "velocity": 2, "acceleration": 4}[self.of]
        with np.errstate(divide="ignore"):
            displacement = omega[:, None] ** -float(order)
        power = {
            "displacement": (absolute, displacement),
            "relative": (relative, displacement),
            "acceleration": (absolute, omega[:, None] ** (4.0 - order)),
            "leg_force": (leg_forces(self.linear, steady, self.eta), displacement),
        }
        return {name: _power(H, base) * scale for name, (H, scale) in power.items()}


def _power(H: Complex, base: Complex) -> Array:
    """Diagonal of H S H^*."""
    if base.ndim == 2:
        return np.einsum("nij,nj->ni", np.abs(H) ** 2, base.real)
    return np.maximum(np.einsum("nij,nij->ni", H @ base, H.conj()).real, 0.0)


def _check_stands(linear: Linearisation) -> None:
    """With a loss factor the poles at omega > 0 do not show what grows: the machine's own do."""
    growing = np.flatnonzero(grows(linear.modes()))
    if growing.size:
        raise ArgumentError(
            f"the machine is not stable at rest ({growing.size} of its modes grow), so its random response never "
            "becomes stationary. Stiffen the legs, or lower the mass centre."
        )


def _check_damped(poles: Complex, grid: Array) -> None:
    ratio = -poles.real / np.abs(poles)
    inside = (poles.imag >= grid[0]) & (poles.imag <= grid[-1])
    for i in np.flatnonzero((ratio < -_LEAST_DAMPING) | (inside & (ratio < _LEAST_DAMPING))):
        raise ArgumentError(
            f"mode {i + 1} ({abs(poles[i]):.6g} rad/s) has {_damping_words(ratio[i])}, so its random response never "
            "becomes stationary. Give the legs damping, a loss_factor, or a band without the mode."
        )


def _damping_words(ratio: float) -> str:
    return "no damping" if abs(ratio) < _LEAST_DAMPING else f"the damping ratio {ratio:.1e}"
