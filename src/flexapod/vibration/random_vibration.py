"""Vibration by random motion of the base and random loads: spectra and RMS values, from the exact tangent at rest."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, TWO_PI, Array, Complex, JointModel, in_mixed_units, in_unit
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.excitation.spectra import Quantity
from flexapod.mechanics.cautions import grows
from flexapod.mechanics.inputs import ZERO, PointLike, as_hexapod, as_point, single_pose
from flexapod.mechanics.linearisation import Linearisation, linearise
from flexapod.mechanics.point_motion import shift
from flexapod.pose import PoseLike
from flexapod.vibration.frequency_response import MOTION_UNITS, attributes, leg_forces
from flexapod.vibration.harmonic import complex_poles, leg_losses, losses, steady_response
from flexapod.vibration.quadrature import Panels, graded
from flexapod.vibration.random_sources import Answers, RandomLoad, Shaking, Source
from flexapod.vibration.source_spectrum import Density

QUANTITIES = {
    "displacement": ("output", "output_unit"),
    "relative": ("output", "output_unit"),
    "acceleration": ("output", "output_unit/s^2"),
    "leg_force": ("leg", "N"),
    "actuator_force": ("leg", "N"),
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

        `omega` holds the frequencies given and those at which the integrals were computed, rad/s. The attribute
        ``spectrum_caution`` tells of modes outside the band of a spectrum, if there are any.

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
    to_point = shift(pose, as_point(hexapod, point))

    def answers(w: Array) -> Answers:
        steady = steady_response(linear, w, eta)

        def amplitudes(absolute: Complex, relative: Complex) -> dict[str, Complex]:
            moved = {"displacement": to_point @ absolute, "relative": to_point @ relative}
            return {**moved, "leg_force": leg_forces(linear, relative, eta)}

        return Answers(amplitudes(steady.absolute, steady.relative), amplitudes(steady.wrench, steady.wrench))

    sources = Shaking(psd, loads, omega, frequency, of, axis).sources(hexapod, pose, poles)
    origin = attributes(hexapod, pose, point, eta, linear)
    return stationary(sources, poles, answers, origin)


def stationary(
    sources: Sequence[Source], poles: Complex, answers: Callable[[Array], Answers], origin: Mapping[str, object]
) -> xr.Dataset:
    """Spectra and RMS values of a machine with these poles, which answers at frequencies (n,) rad/s as told.

    origin: attributes of the Dataset.
    """
    for source in sources:
        _check_damped(poles, source.spectrum.grid)
    panels = Panels(graded(np.unique(np.concatenate([source.spectrum.grid for source in sources])), poles))
    answer = answers(panels.omega)
    found = _dataset(panels, {source.name: answer.densities(panels.omega, source) for source in sources})
    return found.assign_attrs({**origin, "spectrum_caution": _outside(sources, poles)})


def _outside(sources: Sequence[Source], poles: Complex) -> str:
    """That spectra say nothing of frequencies at which the machine vibrates, where it is so: those alike together."""
    moving = poles.imag > 1e-6 * np.abs(poles)  # and not rounding of what only creeps
    natural = np.sort(poles.imag[moving]) / TWO_PI
    alike: dict[tuple[float, float], list[str]] = {}
    for source in sources:
        low, high = source.spectrum.grid[[0, -1]] / TWO_PI
        alike.setdefault((low, high), []).append("the base" if source.name == "base" else source.name)
    told = []
    for (low, high), names in alike.items():
        missed = ", ".join(f"{f:.4g}" for f in natural[(natural < low) | (natural > high)])
        if missed:
            what, are = ("spectrum", "is") if len(names) == 1 else ("spectra", "are")
            told.append(
                f"The {what} of {' and '.join(names)} {are} from {low:.4g} to {high:.4g} Hz; outside it counts as no "
                f"excitation, and there lie modes, at {missed} Hz. Where they are excited too, more moves than is told "
                f"here: extend the {what}."
            )
    return " ".join(told)


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
    dataset.attrs["sources"] = list(by_source)
    there = next(iter(by_source.values()))
    for name, (along, unit) in ((name, of) for name, of in QUANTITIES.items() if name in there):
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
