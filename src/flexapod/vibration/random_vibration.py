"""Vibration by random motion of the base and random loads: spectra and RMS values, from the exact tangent at rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.checks import one_of
from flexapod.conventions import AXES, LEGS, Array, Complex, JointModel, in_mixed_units, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.excitation.spectra import MOTIONS, Quantity
from flexapod.mechanics.cautions import grows
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_point, single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import PoseLike
from flexapod.vibration.frequency_response import MOTION_UNITS, attributes
from flexapod.vibration.grid import asked
from flexapod.vibration.harmonic import complex_poles, leg_losses, losses, steady_response
from flexapod.vibration.quadrature import Panels, graded
from flexapod.vibration.random_sources import Answers, RandomLoad, Source, load_sources, spectrum_of
from flexapod.vibration.source_spectrum import Density

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
    psd: Density | None = None,
    loads: RandomLoad | Sequence[RandomLoad] = (),
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
    """Compute spectra and RMS values of the platform and the legs, of random motion of the base and random loads.

    Parameters
    ----------
    hexapod : Hexapod
        The design.
    pose : Pose or array_like, optional
        Pose of the platform, a Pose or x, y, z (m), roll, pitch, yaw (rad); the home pose by default.
    psd : Spectrum, dict of str to Spectrum, array_like or callable, optional
        One-sided power spectral density of the base's motion. One of

        - a Spectrum of one `axis`, such as ``flexapod.vc_curve("VC-C")``, or several by axis, which move independently:
          ``{"x": ..., "z": ...}``;
        - a table over `omega` or `frequency`: (n,) of one `axis`, (n, 6) of six independent axes, or (n, 6, 6), the
          Hermitian cross-spectral matrix S_jk of E[X_j conj(X_k)];
        - a function that gives such numbers at frequencies (n,).

        Tables and functions are densities per rad/s over `omega`; per Hz where `frequency` is given. A base at rest by
        default.
    loads : RandomLoad or sequence of RandomLoad, optional
        Random forces and moments at points of the platform, independent of each other and of the base.
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
        - source_rms_... (source, output or leg): RMS by the base alone and by each load alone

        `omega` holds the frequencies given and those at which the integrals were computed, rad/s.

    Raises
    ------
    ArgumentError
        If there is neither `psd` nor a load, `psd` cannot be a spectral density, or a mode in the band has no damping
        or grows.
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
    The exact linearisation of Eq. 34 of [1]_ at rest filters the spectrum of the base, and the densities of the motion
    by independent sources add up. Between its frequencies a table
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
    sources = list(load_sources(hexapod, loads, pose, poles))
    if psd is not None:
        one_of(of, "of", MOTIONS)
        spectrum = spectrum_of(psd, axis, asked(omega, frequency), frequency is not None, poles, of)
        sources.insert(0, Source("base", spectrum, None))
    elif axis is not None or omega is not None or frequency is not None:
        raise ArgumentError(
            "axis, omega and frequency belong to psd, which is missing. Give those of a load to RandomLoad."
        )
    if not sources:
        raise ArgumentError("psd and loads are both missing; give the spectrum of the base, or loads, or both.")
    for source in sources:
        _check_damped(poles, source.spectrum.grid)
    panels = Panels(graded(np.unique(np.concatenate([source.spectrum.grid for source in sources])), poles))
    answers = Answers(linear, steady_response(linear, panels.omega, eta), shift(pose, as_point(hexapod, point)), eta)
    found = {source.name: answers.densities(panels.omega, source) for source in sources}
    dataset = _dataset(panels, found).assign_attrs(attributes(hexapod, pose, point, eta, linear))
    return dataset.assign_attrs(sources=list(found))


def _dataset(panels: Panels, by_source: dict[str, dict[str, Array]]) -> xr.Dataset:
    coordinates = {
        "omega": ("omega", panels.omega, in_unit("rad/s", "frequency")),
        "output": list(AXES),
        "output_unit": ("output", MOTION_UNITS),
        "leg": list(LEGS),
        "source": list(by_source),
    }
    dataset = xr.Dataset(coords=coordinates)
    dataset.attrs["convention"] = "one-sided spectral density per rad/s: mean square = integral over omega > 0"
    for name, (along, unit) in QUANTITIES.items():
        total = np.sum([densities[name] for densities in by_source.values()], axis=0)
        cumulative = np.sqrt(panels.cumulated(total))
        alone = [np.sqrt(panels.cumulated(densities[name])[-1]) for densities in by_source.values()]
        amount, density = _units(unit)
        dataset[f"psd_{name}"] = (("omega", along), total, density)
        dataset[f"cumulative_{name}"] = (("omega", along), cumulative, amount)
        dataset[f"rms_{name}"] = ((along,), cumulative[-1], amount)
        dataset[f"source_rms_{name}"] = (("source", along), alone, amount)
    return dataset


def _units(unit: str) -> tuple[dict[str, str], dict[str, str]]:
    """Attributes of an amount and of its spectral density."""
    if unit == "N":
        return in_unit("N"), in_unit("N^2/(rad/s)")
    return in_mixed_units(unit), in_mixed_units(f"({unit})^2/(rad/s)")


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
