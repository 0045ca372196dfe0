"""The spectrum of a base that moves at random, or of a load, however it is given, as one checked function."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import one_of
from flexapod.conventions import AXES, TWO_PI, Array, Complex
from flexapod.errors import ArgumentError, shown
from flexapod.excitation.spectra import LOADS, Quantity, Spectrum, check_axis

#: Components of a load on the platform, in the order of `AXES`.
LOAD_AXES = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
Density = ArrayLike | Callable[[Array], ArrayLike] | Spectrum | Mapping[str, Spectrum]


class SourceSpectrum(NamedTuple):
    """density: of omega (n,), rad/s, gives (n, 6) or (n, 6, 6) per rad/s. grid: the band and the density's kinks.

    quantity: of the base's motion; "force" or "moment" of any load.
    """

    density: Callable[[Array], Complex]
    grid: Array
    quantity: Quantity


def ready_made(
    psd: Spectrum | Mapping[str, Spectrum], axis: str | None, omega: Array | None, of_loads: bool = False
) -> SourceSpectrum:
    """Spectra by axis as one (n, 6), with their common band in eighths of octaves (for their kinks)."""
    names = LOAD_AXES if of_loads else AXES
    if isinstance(psd, Spectrum):
        psd = {_known(axis, names): psd}
    elif axis is not None or not psd:
        raise ArgumentError(
            f"axis is {axis!r} and psd names {', '.join(map(str, psd)) or 'none'}; give spectra by axis, or one and "
            "its axis."
        )
    for name, item in psd.items():
        if not isinstance(item, Spectrum):
            raise ArgumentError(f"psd[{name!r}] is {shown(item)}; it must be a flexapod Spectrum.")
        _known(name, names)
        (_check_load if of_loads else _check_motion)(item, name)
    axes, spectra = [_unit_axis(name, names) for name in psd], list(psd.values())
    kinds = {item.quantity for item in spectra}
    if len(kinds) > 1 and not of_loads:
        raise ArgumentError(f"psd mixes spectra of {' and '.join(sorted(kinds))}; they must be of one quantity.")
    ends = [end for item in spectra for end in (item.omega_min, item.omega_max)]
    low, high = min(ends), max(ends)
    given = np.array([low, high]) if omega is None else _checked_band(omega)
    low, high = max(low, given[0]), min(high, given[-1])
    if low >= high:
        raise ArgumentError(f"omega lies outside the spectra, which are from {min(ends):.6g} to {max(ends):.6g} rad/s.")
    inner = np.concatenate([given, ends, np.geomspace(low, high, max(2, int(8 * np.log2(high / low))))])
    grid = np.unique(inner[(inner >= low) & (inner <= high)])

    def density(w: Array) -> Complex:
        parts = [item.values(w)[:, None] * unit for item, unit in zip(spectra, axes, strict=True)]
        return _checked(np.sum(parts, axis=0), w, None, names)

    return SourceSpectrum(density, grid, spectra[0].quantity)


def _check_motion(item: Spectrum, name: str) -> None:
    if item.quantity in LOADS:
        raise ArgumentError(
            f"psd of {name} is a spectrum of {item.quantity}; it must be one of the base's displacement, velocity "
            f"or acceleration. Give a random {item.quantity} on the platform as "
            f'loads=flexapod.vibration.RandomLoad({{"{item.quantity}_{name}": spectrum}}).'
        )
    check_axis(item, name)


def _check_load(item: Spectrum, name: str) -> None:
    quantity = name.split("_")[0]
    if item.quantity != quantity:
        raise ArgumentError(
            f"psd of {name} is a spectrum of {item.quantity}; it must be one of {quantity}, such as "
            f'flat_spectrum(..., quantity="{quantity}") makes one.'
        )


def tabulated(
    psd: ArrayLike | Callable[[Array], ArrayLike],
    axis: str | None,
    omega: Array,
    quantity: Quantity,
    per_hertz: bool,
) -> SourceSpectrum:
    """A table over `omega`, or a function, of densities per rad/s, or per Hz over frequencies in Hz."""
    names = LOAD_AXES if quantity in LOADS else AXES
    grid, unit = _checked_band(omega), TWO_PI if per_hertz else 1.0
    if callable(psd):
        return SourceSpectrum(lambda w: _checked(psd(w / unit), w, axis, names, unit), grid, quantity)
    table = _checked(psd, grid, axis, names, unit)
    between = _linear if table.ndim == 3 else _power_law
    return SourceSpectrum(lambda w: between(grid, table, w), grid, quantity)


def _checked_band(omega: Array) -> Array:
    if omega.size < 2 or omega[0] == 0 or (np.diff(omega) <= 0).any():
        raise ArgumentError("omega must hold at least two frequencies, above zero and ascending: they bound the band.")
    return omega


def _checked(psd: ArrayLike, omega: Array, axis: str | None, names: Sequence[str], unit: float = 1.0) -> Complex:
    """Densities over `unit`, (n, 6) or (n, 6, 6)."""
    try:
        table = np.asarray(np.asarray(psd) / unit, dtype=np.complex128)
    except (TypeError, ValueError, OverflowError) as error:
        raise ArgumentError("psd must hold numbers: (n,) with an axis, (n, 6), or (n, 6, 6).") from error
    if table.shape == omega.shape:
        table = table[:, None] * _unit_axis(axis, names)
    elif axis is not None:
        raise ArgumentError(f"axis is {axis!r}, but psd has shape {table.shape}; one axis takes ({omega.size},).")
    if table.shape not in ((omega.size, 6), (omega.size, 6, 6)):
        n = omega.size
        raise ArgumentError(f"psd has shape {table.shape}; for {n} frequencies give ({n},), ({n}, 6) or ({n}, 6, 6).")
    if not np.isfinite(table).all():
        raise ArgumentError("psd holds NaN or infinity; all its numbers must be finite.")
    if table.ndim == 2:
        if (table.imag != 0).any() or (table.real < 0).any():
            raise ArgumentError("psd holds a negative or complex density; densities of single axes are real and >= 0.")
        return table
    size = np.abs(table).max(axis=(1, 2), initial=0.0)[:, None]
    if (np.abs(table - table.conj().transpose(0, 2, 1)) > 1e-9 * size[..., None]).any():
        raise ArgumentError("psd is not Hermitian: S_jk must be the complex conjugate of S_kj.")
    if (np.linalg.eigvalsh(table) < -1e-9 * size).any():
        raise ArgumentError("psd has a negative eigenvalue; a cross-spectral matrix must be positive semidefinite.")
    return table


def _known(axis: str | None, names: Sequence[str]) -> str:
    if axis is None:
        raise ArgumentError(f"axis is missing; a psd of one axis needs one of {', '.join(names)}.")
    return one_of(axis, "axis", names)


def _unit_axis(axis: str | None, names: Sequence[str]) -> Array:
    return np.eye(6)[names.index(_known(axis, names))]


def _linear(grid: Array, table: Complex, omega: Array) -> Complex:
    i = np.clip(np.searchsorted(grid, omega, side="right") - 1, 0, grid.size - 2)
    t = ((omega - grid[i]) / (grid[i + 1] - grid[i])).reshape(-1, *[1] * (table.ndim - 1))
    return (1 - t) * table[i] + t * table[i + 1]


def _power_law(grid: Array, table: Complex, omega: Array) -> Complex:
    """Straight in log-log axes, linear where the density touches zero."""
    straight = _linear(grid, table, omega)
    i = np.clip(np.searchsorted(grid, omega, side="right") - 1, 0, grid.size - 2)
    positive = (table[i].real > 0) & (table[i + 1].real > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        levels = _linear(np.log(grid), np.log(table), np.log(omega))
    return np.where(positive, np.exp(levels), straight)
