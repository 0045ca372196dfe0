"""What shakes a machine at random: its base, and loads at points of its platform; and what each of them makes of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import instance, numbers, one_of
from flexapod.conventions import Array, Complex
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, shown
from flexapod.excitation.spectra import MOTIONS, Quantity, Spectrum
from flexapod.mechanics.inputs import ZERO, PointLike, as_point
from flexapod.mechanics.point_motion import shift
from flexapod.pose import Pose
from flexapod.showing import in_notebooks
from flexapod.vibration.grid import asked, grid_around
from flexapod.vibration.source_spectrum import Density, SourceSpectrum, ready_made, tabulated


@in_notebooks
@dataclass(frozen=True, eq=False)
class RandomLoad:
    """Random forces and moments on the platform: wind, sound, cables, fans.

    Parameters
    ----------
    psd : Spectrum, dict of str to Spectrum, array_like or callable
        One-sided power spectral density, N^2 or (N m)^2, in inertial axes. One of

        - a Spectrum of force or moment on one `axis`, such as `flat_spectrum` makes one, or several by axis, which are
          independent: ``{"force_x": ..., "moment_z": ...}``;
        - a table over `omega` or `frequency`: (n,) of one `axis`, (n, 6) of six independent axes, forces first, or
          (n, 6, 6), the Hermitian cross-spectral matrix;
        - a function that gives such numbers at frequencies (n,).

        Tables and functions are densities per rad/s over `omega`; per Hz where `frequency` is given.
    omega : array_like, optional
        Frequencies of a table, (n,) rad/s, ascending and > 0. The first and the last bound the band.
    frequency : array_like, optional
        The same in Hz, in place of `omega`.
    axis : str, optional
        The axis where `psd` is of one: "force_x", "force_y", "force_z", "moment_x", "moment_y" or "moment_z".
    point : array_like or str, optional
        Where it acts, platform frame, m, (3,), or the name of a point of the design; the reference point by default.
    name : str, optional
        What it is called in results.

    Raises
    ------
    ArgumentError
        If the point or the name is none. The spectrum is checked where it is used.

    See Also
    --------
    random_response : takes it as `loads`.

    Examples
    --------
    >>> wind = fx.excitation.flat_spectrum(10.0, 1.0, 100.0, quantity="force")
    >>> load = fx.vibration.RandomLoad(wind, axis="force_y", point=(0, 0, 0.2), name="wind")
    >>> response = fx.random_response(fx.load("cubic-isolator"), loads=load, loss_factor=0.01)
    """

    psd: Density
    omega: ArrayLike | None = None
    frequency: ArrayLike | None = None
    axis: str | None = None
    point: PointLike = ZERO
    name: str = "load"

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise ArgumentError(f'name of a load is {shown(self.name)}; it must be text, such as "wind".')
        if not isinstance(self.point, str):
            object.__setattr__(self, "point", numbers(self.point, f"point of the load {self.name!r}", (3,)))


class Source(NamedTuple):
    """A source with its spectrum. from_wrench: (6, 6), of a load, from its point to the reference point; None: base."""

    name: str
    spectrum: SourceSpectrum
    from_wrench: Array | None


class Answers(NamedTuple):
    """How a machine answers at some frequencies: complex amplitudes (n, 6, 6) of "displacement" and other quantities.

    base: per displacement of the base; wrench: per wrench on the platform's reference point.
    """

    base: Mapping[str, Complex]
    wrench: Mapping[str, Complex]

    def densities(self, omega: Array, source: Source) -> dict[str, Array]:
        """Spectral densities (n, 6) of every quantity and of acceleration from one source; none beyond its band."""
        if source.from_wrench is None:
            answer: Mapping[str, Complex] = self.base
        else:
            answer = {name: H @ source.from_wrench for name, H in self.wrench.items()}
        order = {"velocity": 2, "acceleration": 4}.get(source.spectrum.quantity, 0)
        filters = {name: (H, -float(order)) for name, H in answer.items()}
        filters["acceleration"] = answer["displacement"], 4.0 - order
        low, high = source.spectrum.grid[[0, -1]]
        inside = np.flatnonzero((omega >= low) & (omega <= high))
        given = source.spectrum.density(omega[inside])
        found = {}
        for name, (H, power) in filters.items():
            found[name] = np.zeros((omega.size, 6))
            found[name][inside] = _power(H[inside], given) * omega[inside, None] ** power
        return found


class Shaking(NamedTuple):
    """What shakes at random, as it is given: the base's spectrum with its frequencies, quantity and axis, and loads."""

    psd: Density | None
    loads: RandomLoad | Sequence[RandomLoad]
    omega: ArrayLike | None
    frequency: ArrayLike | None
    of: Quantity
    axis: str | None

    def sources(self, hexapod: Hexapod, pose: Pose, poles: Complex) -> list[Source]:
        """Its checked sources, the base first. poles: for the band of a function without frequencies."""
        found = list(load_sources(hexapod, self.loads, pose, poles))
        if self.psd is not None:
            one_of(self.of, "of", MOTIONS)
            given, per_hertz = asked(self.omega, self.frequency), self.frequency is not None
            spectrum = spectrum_of(self.psd, self.axis, given, per_hertz, poles, self.of)
            found.insert(0, Source("base", spectrum, None))
        elif self.axis is not None or self.omega is not None or self.frequency is not None:
            raise ArgumentError(
                "axis, omega and frequency belong to psd, which is missing. Give those of a load to RandomLoad."
            )
        if not found:
            raise ArgumentError("psd and loads are both missing; give the spectrum of the base, or loads, or both.")
        return found


def _power(H: Complex, source: Complex) -> Array:
    """Diagonal of H S H^*."""
    if source.ndim == 2:
        return np.einsum("nij,nj->ni", np.abs(H) ** 2, source.real)
    return np.maximum(np.einsum("nij,nij->ni", H @ source, H.conj()).real, 0.0)


def spectrum_of(
    psd: Density, axis: str | None, given: Array | None, per_hertz: bool, poles: Complex, of: Quantity
) -> SourceSpectrum:
    """A spectrum in whatever form it is given. given: its frequencies, rad/s. of: of what; "force": of a load."""
    if isinstance(psd, Spectrum | Mapping):
        return ready_made(psd, axis, given, of == "force")
    if given is None and not callable(psd):
        raise ArgumentError("omega is missing; a psd of numbers needs their frequencies, as omega or frequency.")
    grid = grid_around(poles) if given is None else given
    return tabulated(psd, axis, grid, of, per_hertz)


def load_sources(
    hexapod: Hexapod, loads: RandomLoad | Sequence[RandomLoad], pose: Pose, poles: Complex
) -> Iterator[Source]:
    """The loads as sources. Raises ArgumentError for what is none, with its name."""
    loads = [loads] if isinstance(loads, RandomLoad) else loads
    if isinstance(loads, str) or not isinstance(loads, Sequence):
        raise ArgumentError(f"loads is {shown(loads)}; it must be a flexapod.vibration.RandomLoad, or a list of them.")
    for load in loads:
        instance(load, RandomLoad, "a load", "such as flexapod.vibration.RandomLoad(...) makes one")
    for load, name in zip(loads, _names(loads), strict=True):
        try:
            grid = asked(load.omega, load.frequency)
            spectrum = spectrum_of(load.psd, load.axis, grid, load.frequency is not None, poles, "force")
        except ArgumentError as error:
            raise ArgumentError(f"the load {name!r}: {error}") from error
        place = as_point(hexapod, load.point, f"point of the load {name!r}")
        yield Source(name, spectrum, shift(pose, place).T)


def _names(loads: Sequence[RandomLoad]) -> list[str]:
    """Of each load a name of its own: those that share one are numbered."""
    given = [load.name for load in loads]
    names = [f"{name} {k}" if given.count(name) > 1 else name for k, name in enumerate(given, 1)]
    if "base" in names:
        raise ArgumentError("a load is called 'base', as the moving base is in the results. Give it another name.")
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise ArgumentError(f"two loads are called {twice[0]!r}; each must have a name of its own.")
    return names
