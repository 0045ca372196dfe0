"""Vibration passed on by the machine in the frequency domain, from its exact tangent at rest."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple, Unpack, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.excitation.spectra import Quantity, Spectrum
from flexapod.mechanics.inputs import ZERO
from flexapod.mechanics.linearisation import Linearisation, RestOptions, linearise
from flexapod.pose import Pose, skew, vectors
from flexapod.vibration.harmonic import SteadyResponse, complex_poles, frequencies, loss_factors, steady_response

__all__ = ["random_response", "transmissibility"]

MOTION_UNITS = ("m", "m", "m", "rad", "rad", "rad")
WRENCH_UNITS = ("N", "N", "N", "N m", "N m", "N m")

Density = ArrayLike | Callable[[Array], ArrayLike] | Spectrum | Mapping[str, Spectrum]


def transmissibility(
    hexapod: Hexapod,
    pose: Pose,
    omega: ArrayLike,
    *,
    point: ArrayLike = ZERO,
    loss_factor: ArrayLike = 0.0,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """Frequency response of the platform to base motion, wrench and leg commands, by the exact tangent at rest.

    omega: (n,) rad/s, not negative. point: output point, m, platform frame. loss_factor: structural damping of the
    legs' springs, K (1 + i eta), one number or six, beside the viscous friction of the design. rest: `base`, `force`,
    `moment`, `joint` of `linearise`; the wrench that acts on the platform at rest.

    Complex amplitudes for x(t) = Re(X e^{i omega t}), small translations (m) and rotation vectors (rad) in inertial
    axes; a base rotation turns gravity with respect to the machine, which is kept. Variables:

    - absolute (omega, output, base): motion of the output point per motion of the base's reference point
    - relative (omega, output, base): the same less the rigid motion with the base
    - compliance (omega, output, wrench): motion per wrench at the output point
    - command (omega, output, leg): motion per change of a leg's unstretched length
    - leg_force (omega, leg, base): change of the force of a leg's spring (positive: compression) per base motion

    Units stand beside the axes, in `output_unit`, `base_unit`, `wrench_unit`. At an undamped resonance: infinite.

    Raises: PoseError for a batch of poses or more than one point; SingularPoseError where no leg forces hold the pose;
    ArgumentError for frequencies or loss factors that are negative or not finite.
    Source: own, on the tangent of part C.
    """
    w, eta = frequencies(omega), loss_factors(loss_factor)
    linear = linearise(hexapod, pose, **rest)
    to_point = shift(pose, point)
    steady = steady_response(linear, w, eta)
    relative = to_point @ steady.relative
    arrays = {
        "absolute": relative + to_point @ linear.carry,
        "relative": relative,
        "compliance": to_point @ steady.wrench @ to_point.T,
        "command": to_point @ steady.command,
        "leg_force": _leg_force(linear, steady, eta),
    }
    variables = {name: (RESPONSES[name][0], array, RESPONSES[name][1]) for name, array in arrays.items()}
    coordinates = {"omega": ("omega", w, {"units": "rad/s", "long_name": "frequency"}), **COORDINATES}
    return xr.Dataset(variables, coordinates, _attributes(hexapod, pose, point, eta))


COORDINATES = {
    **{axis: (axis, list(AXES)) for axis in ("output", "base", "wrench")},
    "leg": ("leg", list(LEGS)),
    "output_unit": ("output", list(MOTION_UNITS)),
    "base_unit": ("base", list(MOTION_UNITS)),
    "wrench_unit": ("wrench", list(WRENCH_UNITS)),
}
RESPONSES: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {
    "absolute": (
        ("omega", "output", "base"),
        {"units": "output_unit/base_unit", "long_name": "absolute transmissibility"},
    ),
    "relative": (
        ("omega", "output", "base"),
        {"units": "output_unit/base_unit", "long_name": "motion relative to the base per base motion"},
    ),
    "compliance": (("omega", "output", "wrench"), {"units": "output_unit/wrench_unit", "long_name": "compliance"}),
    "command": (("omega", "output", "leg"), {"units": "output_unit/m", "long_name": "motion per leg command"}),
    "leg_force": (("omega", "leg", "base"), {"units": "N/base_unit", "long_name": "leg force per base motion"}),
}


def shift(pose: Pose, point: ArrayLike) -> Array:
    """(6, 6): small displacement of a point of the platform (platform frame, m) from that of the reference point."""
    place = vectors(point, "point")
    if place.shape != (3,):
        raise PoseError(f"point has shape {place.shape}; give one point (3,) in m, in the platform's frame")
    r = pose.matrix @ place
    matrix = np.eye(6)
    matrix[:3, 3:] = skew(r).T
    return matrix


def _leg_force(linear: Linearisation, steady: SteadyResponse, eta: Array) -> Complex:
    stiffness = linear.leg_stiffness * (1 + 1j * eta)
    return -stiffness[:, None] * (linear.H.T @ steady.relative)


def _attributes(hexapod: Hexapod, pose: Pose, point: ArrayLike, eta: Array) -> dict[str, object]:
    return {
        "design": hexapod.name,
        "digest": hexapod.digest,
        "position_m": pose.position.tolist(),
        "rpy_rad": pose.rpy.tolist(),
        "point_m": np.asarray(point, dtype=float).tolist(),
        "loss_factor": eta.tolist(),
    }


def random_response(
    hexapod: Hexapod,
    pose: Pose,
    psd: Density,
    omega: ArrayLike | None = None,
    *,
    of: Quantity = "acceleration",
    axis: str | None = None,
    point: ArrayLike = ZERO,
    loss_factor: ArrayLike = 0.0,
    **rest: Unpack[RestOptions],
) -> xr.Dataset:
    """Spectra and RMS of the platform and the legs on a base that moves at random, by the exact tangent at rest.

    psd: one-sided power spectral density per rad/s of the base's motion, so that its mean square is the integral over
    omega > 0; a density per Hz is 2 pi times that per rad/s. One of

    - a `Spectrum` (`fx.vc_curve`, `fx.excitation.ground_noise`, ...) of one `axis` ("x" to "yaw"), or several by
      axis, which move independently: {"x": ..., "z": ...}. Their range is the band, omega (if given) cuts it.
    - numbers at omega (n,) rad/s, ascending, which bounds the band, or a function of omega that gives such numbers, for
      the quantity `of` ("acceleration", "velocity", "displacement"): (n,) for one `axis`, e.g. (m/s2)2/(rad/s); (n, 6)
      for six independent axes; (n, 6, 6) for the Hermitian cross-spectral matrix S_jk of E[X_j conj(X_k)].

    Between the frequencies a table is a power law (straight in log-log axes; linear where it touches zero), a matrix
    linear. Resonances are resolved whatever their damping: panels shrink geometrically towards every pole, with eight
    Gauss points each. `omega` of the result holds the frequencies given, the panels' other edges and those points.
    point, loss_factor, rest: as in `transmissibility`.

    Quantities: displacement and acceleration of the output point (absolute), relative (displacement less the rigid
    motion with the base), leg_force: each behind `psd_`, `rms_` and `cumulative_` (RMS of what lies below omega).

    Raises: ArgumentError for a spectrum that none can be, and for a mode in the band that has no damping or grows;
    PoseError for more than one point; SingularPoseError where no leg forces hold the pose.
    Source: own, on the tangent of part C.
    """
    eta = loss_factors(loss_factor)
    linear = linearise(hexapod, pose, **rest)
    if isinstance(psd, Spectrum | Mapping):
        psd, omega, of, axis = _combined(psd, omega, axis)
    if of not in get_args(Quantity):
        raise ArgumentError(f"of is {of!r}; the psd is that of the base's {', '.join(get_args(Quantity))}")
    grid = _band(omega)
    spectrum = _spectrum(psd, grid, axis)
    poles = complex_poles(linear, eta)
    _check_damped(poles, grid)
    panels = _Panels(_graded(grid, poles))
    filters = _Filters(linear, shift(pose, point), eta, of)
    densities = filters.spectra(panels.omega, spectrum(panels.omega))
    return _random_dataset(panels, densities).assign_attrs(_attributes(hexapod, pose, point, eta))


def _random_dataset(panels: _Panels, densities: dict[str, Array]) -> xr.Dataset:
    coordinates = {
        "omega": ("omega", panels.omega, {"units": "rad/s", "long_name": "frequency"}),
        "output": list(AXES),
        "output_unit": ("output", list(MOTION_UNITS)),
        "leg": list(LEGS),
    }
    dataset = xr.Dataset(coords=coordinates)
    dataset.attrs["convention"] = "one-sided spectral density per rad/s: mean square = integral over omega > 0"
    for name, (along, unit) in QUANTITIES.items():
        cumulative = np.sqrt(panels.cumulated(densities[name]))
        dataset[f"psd_{name}"] = (("omega", along), densities[name], {"units": f"({unit})2/(rad/s)"})
        dataset[f"cumulative_{name}"] = (("omega", along), cumulative, {"units": unit})
        dataset[f"rms_{name}"] = ((along,), cumulative[-1], {"units": unit})
    return dataset


QUANTITIES = {
    "displacement": ("output", "output_unit"),
    "relative": ("output", "output_unit"),
    "acceleration": ("output", "output_unit/s2"),
    "leg_force": ("leg", "N"),
}
_NODES = 8  # Gauss points of a panel: a pole is at least its panel's width away, so they err by about 1e-10
_LEAST_DAMPING = 1e-13  # damping ratio that rounding of the poles may hide


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
        absolute = relative + self.to_point @ self.linear.carry
        order = {"displacement": 0, "velocity": 2, "acceleration": 4}[self.of]
        with np.errstate(divide="ignore"):
            displacement = omega[:, None] ** -float(order)
        power = {
            "displacement": (absolute, displacement),
            "relative": (relative, displacement),
            "acceleration": (absolute, omega[:, None] ** (4.0 - order)),
            "leg_force": (_leg_force(self.linear, steady, self.eta), displacement),
        }
        return {name: _power(H, base) * scale for name, (H, scale) in power.items()}


def _power(H: Complex, base: Complex) -> Array:
    """Diagonal of H S H^*."""
    if base.ndim == 2:
        return np.einsum("nij,nj->ni", np.abs(H) ** 2, base.real)
    return np.maximum(np.einsum("nij,nij->ni", H @ base, H.conj()).real, 0.0)


def _combined(
    psd: Spectrum | Mapping[str, Spectrum], omega: ArrayLike | None, axis: str | None
) -> tuple[Callable[[Array], Array], Array, Quantity, None]:
    """Spectra by axis as one function (n, 6), with their common band in eighths of octaves (for their kinks)."""
    if isinstance(psd, Spectrum):
        _unit_axis(axis)
        psd = {str(axis): psd}
    elif axis is not None or not psd:
        raise ArgumentError(f"axis is {axis!r} and psd names {', '.join(psd) or 'none'}; give spectra by axis, or one")
    for name, item in psd.items():
        if not isinstance(item, Spectrum):
            raise ArgumentError(f"psd[{name!r}] is {item!r}; it must be a flexapod Spectrum")
    axes, spectra = [_unit_axis(name) for name in psd], list(psd.values())
    kinds = {item.quantity for item in spectra}
    if len(kinds) > 1:
        raise ArgumentError(f"psd mixes spectra of {' and '.join(sorted(kinds))}; they must be of one quantity")
    ends = [end for item in spectra for end in (item.omega_min, item.omega_max)]
    low, high = min(ends), max(ends)
    given = np.array([low, high]) if omega is None else _band(omega)
    low, high = max(low, given[0]), min(high, given[-1])
    if low >= high:
        raise ArgumentError(f"omega lies outside the spectra, which are from {min(ends):.6g} to {max(ends):.6g} rad/s")
    inner = np.concatenate([given, ends, np.geomspace(low, high, max(2, int(8 * np.log2(high / low))))])
    grid = np.unique(inner[(inner >= low) & (inner <= high)])

    def density(w: Array) -> Array:
        return np.sum([item.density(w)[:, None] * unit for item, unit in zip(spectra, axes, strict=True)], axis=0)

    return density, grid, spectra[0].quantity, None


def _band(omega: ArrayLike | None) -> Array:
    if omega is None:
        raise ArgumentError("omega is missing; numbers or a function for the psd need the frequencies of the band")
    grid = frequencies(omega)
    if grid.size < 2 or grid[0] == 0 or (np.diff(grid) <= 0).any():
        raise ArgumentError("omega must hold at least two frequencies, above zero and ascending: they bound the band")
    return grid


def _check_damped(poles: Complex, grid: Array) -> None:
    ratio = -poles.real / np.abs(poles)
    inside = (poles.imag >= grid[0]) & (poles.imag <= grid[-1])
    for i in np.flatnonzero((ratio < -_LEAST_DAMPING) | (inside & (ratio < _LEAST_DAMPING))):
        raise ArgumentError(
            f"mode {i + 1} ({abs(poles[i]):.6g} rad/s) has damping ratio {ratio[i]:.1e}, so its random response never "
            "becomes stationary. Give the legs damping, a loss_factor, or a band without the mode."
        )


def _graded(grid: Array, poles: Complex) -> Array:
    """Panel edges: the grid, octaves of its lowest frequency, and steps that double away from every pole."""
    low, high = grid[0], grid[-1]
    edges = [grid, low * 2.0 ** np.arange(1, np.ceil(np.log2(high / low)))]
    for pole in poles:
        width = max(abs(pole.real), 1e-13 * abs(pole))
        steps = width * 2.0 ** np.arange(-1, np.ceil(np.log2(high / width)))
        edges += [pole.imag + steps, pole.imag - steps]
    merged = np.unique(np.concatenate(edges))
    return merged[(merged >= low) & (merged <= high)]


class _Panels:
    """Gauss quadrature over panels; omega: every panel's lower edge and nodes, then the last edge."""

    def __init__(self, edges: Array) -> None:
        x, self._weights = np.polynomial.legendre.leggauss(_NODES)
        self._half = 0.5 * np.diff(edges)
        nodes = edges[:-1, None] + self._half[:, None] * (1 + x)
        self.omega = np.append(np.column_stack([edges[:-1], nodes]).ravel(), edges[-1])
        powers = np.arange(_NODES)  # integral of the nodes' interpolant from the lower edge to each node
        antiderivative = (x[:, None] ** (powers + 1) - (-1.0) ** (powers + 1)) / (powers + 1)
        self._to_nodes = antiderivative @ np.linalg.inv(x[:, None] ** powers)

    def cumulated(self, density: Array) -> Array:
        """Integral (n, 6) of a density (n, 6) from the lowest frequency to each of `omega`."""
        at_nodes = density[:-1].reshape(self._half.size, _NODES + 1, 6)[:, 1:]
        scaled = self._half[:, None, None] * at_nodes
        whole = np.cumsum(np.einsum("k,pkj->pj", self._weights, scaled), axis=0)
        before = np.concatenate([np.zeros((1, 6)), whole])
        inside = before[:-1, None] + np.concatenate(
            [np.zeros((self._half.size, 1, 6)), self._to_nodes @ scaled], axis=1
        )
        bounded = np.clip(inside, before[:-1, None], whole[:, None])  # an interpolant may overshoot
        return np.maximum.accumulate(np.concatenate([bounded.reshape(-1, 6), whole[-1:]]))


def _spectrum(psd: Density, grid: Array, axis: str | None) -> Callable[[Array], Complex]:
    """The base's spectrum as a checked function of frequency that gives (n, 6) or (n, 6, 6)."""
    if callable(psd):
        return lambda omega: _checked(psd(omega), omega, axis)
    table = _checked(np.asarray(psd), grid, axis)
    if table.ndim == 3:
        return lambda omega: _linear(grid, table, omega)
    return lambda omega: _power_law(grid, table, omega)


def _checked(psd: ArrayLike, omega: Array, axis: str | None) -> Complex:
    try:
        table = np.asarray(psd, dtype=np.complex128)
    except (TypeError, ValueError) as error:
        raise ArgumentError("psd must hold numbers: (n,) with an axis, (n, 6), or (n, 6, 6)") from error
    if table.shape == omega.shape:
        table = table[:, None] * _unit_axis(axis)
    elif axis is not None:
        raise ArgumentError(f"axis is {axis!r}, but psd has shape {table.shape}; one axis takes ({omega.size},)")
    if table.shape not in ((omega.size, 6), (omega.size, 6, 6)):
        n = omega.size
        raise ArgumentError(f"psd has shape {table.shape}; for {n} frequencies give ({n},), ({n}, 6) or ({n}, 6, 6)")
    if not np.isfinite(table).all():
        raise ArgumentError("psd holds NaN or infinity; all its numbers must be finite")
    if table.ndim == 2:
        if (table.imag != 0).any() or (table.real < 0).any():
            raise ArgumentError("psd holds a negative or complex density; densities of single axes are real and >= 0")
        return table
    size = np.abs(table).max(axis=(1, 2), initial=0.0)[:, None]
    if (np.abs(table - table.conj().transpose(0, 2, 1)) > 1e-9 * size[..., None]).any():
        raise ArgumentError("psd is not Hermitian: S_jk must be the complex conjugate of S_kj")
    if (np.linalg.eigvalsh(table) < -1e-9 * size).any():
        raise ArgumentError("psd has a negative eigenvalue; a cross-spectral matrix must be positive semidefinite")
    return table


def _unit_axis(axis: str | None) -> Array:
    if axis not in AXES:
        raise ArgumentError(f"axis is {axis!r}; a psd of one axis needs one of {', '.join(AXES)}")
    return np.eye(6)[AXES.index(axis)]


def _linear(grid: Array, table: Complex, omega: Array) -> Complex:
    i = np.clip(np.searchsorted(grid, omega, side="right") - 1, 0, grid.size - 2)
    t = ((omega - grid[i]) / (grid[i + 1] - grid[i])).reshape(-1, *[1] * (table.ndim - 1))
    return (1 - t) * table[i] + t * table[i + 1]


def _power_law(grid: Array, table: Complex, omega: Array) -> Complex:
    straight = _linear(grid, table, omega)
    i = np.clip(np.searchsorted(grid, omega, side="right") - 1, 0, grid.size - 2)
    positive = (table[i].real > 0) & (table[i + 1].real > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        levels = _linear(np.log(grid), np.log(table), np.log(omega))
    return np.where(positive, np.exp(levels), straight)
