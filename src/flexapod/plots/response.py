"""Figures of vibration: frequency response, random response, stepped sine.

Each function draws a result of a study on a new matplotlib Figure and returns it. Frequencies are in Hz unless asked
for in rad/s; the rest is in SI units.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from flexapod.conventions import LEGS, ROTATIONS, TRANSLATIONS, TWO_PI, Array
from flexapod.plots.style import FAINT, INK, OUTPUT_NAMES, SIX, dress, name_panel, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = SIX[:3]  # line styles tell them apart as well
STYLES = ("-", (0, (6, 2)), (0, (2, 1.5)))
_ROUNDING = 1e-9  # of the largest curve beside it: what is smaller is symmetry broken by rounding, and left out
_VARIABLES = {
    "absolute": ("base", "motion per base motion"),
    "relative": ("base", "motion relative to the base per base motion"),
    "compliance": ("wrench", "compliance"),
    "command": ("leg", "motion per leg command"),
}


def frequency_response(
    dataset: xr.Dataset, variable: str = "absolute", given: str = "z", natural: Iterable[float] = ()
) -> Figure:
    """Draw amplitude and phase of the six motions of the platform for one input.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `transmissibility`.
    variable : {"absolute", "relative", "compliance", "command"}, optional
        Which response: to motion of the base (absolute or relative to it), to a wrench, or to a leg's command.
    given : str, optional
        The input: an axis, or a leg's number for commands.
    natural : iterable of float, optional
        Frequencies to mark, rad/s.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Notes
    -----
    Curves that are symmetry broken by rounding, below 1e-9 of the largest, are left out.

    Examples
    --------
    >>> found = fx.transmissibility(fx.load("mukherjee-ii"), frequency=np.geomspace(10, 300, 50))
    >>> fx.plots.response.frequency_response(found, "absolute", "z").savefig("response.png")
    """
    dimension, words = _VARIABLES[variable]
    natural, response = list(natural), dataset[variable].sel({dimension: given})
    hertz = dataset.omega.values / TWO_PI
    unit = "m" if dimension == "leg" else str(dataset[f"{dimension}_unit"].sel({dimension: given}).values)
    figure = new_figure(10, 6.2)
    grid = figure.subplots(2, 2, sharex=True, height_ratios=[2, 1])
    least = _ROUNDING * np.nanmax(_positive(np.abs(response.values)), initial=0.0)
    for column, outputs in enumerate((TRANSLATIONS, ROTATIONS)):
        above, below = grid[0, column], grid[1, column]
        for i, output in enumerate(outputs):
            values = response.sel(output=output).values
            line = {"color": COLOURS[i], "ls": STYLES[i], "lw": 1.6}
            moves = np.nanmax(_positive(np.abs(values)), initial=0.0) > least
            label = OUTPUT_NAMES[output] + ("" if moves else ": none")
            shown = values if moves else np.full_like(values, np.nan)
            above.loglog(hertz, _positive(np.abs(shown)), label=label, **line)
            below.semilogx(hertz, _unwrapped_once(np.degrees(np.angle(shown))), **line)
        moved = "rad" if column else "m"
        above.set_ylabel(f"amplitude, {_ratio_unit(moved, unit)}")
        _span(above)
        below.set(ylabel="phase, deg", ylim=(-190, 190), yticks=[-180, -90, 0, 90, 180], xlabel="frequency, Hz")
        for ax in (above, below):
            dress(ax)
            _mark(ax, natural)
            _plain_decades(ax)
        above.legend(loc="best", frameon=True, framealpha=0.85, edgecolor="none", fontsize=9)
    source = f"leg {given}" if dimension == "leg" else f"{dimension} {given}"
    figure.suptitle(f"{dataset.attrs['design']}: {words}, {source}", color=INK, fontsize=12)
    return figure


def random_spectra(dataset: xr.Dataset, quantity: str = "acceleration") -> Figure:
    """Draw spectral density and cumulative RMS of a quantity on a base that moves at random.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `random_response`.
    quantity : {"acceleration", "displacement", "relative", "leg_force"}, optional
        What is drawn.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Notes
    -----
    Densities are one-sided and per Hz.

    Examples
    --------
    >>> found = fx.random_response(fx.load("cubic-isolator"), psd=fx.vc_curve("VC-C"), axis="z")
    >>> fx.plots.response.random_spectra(found).savefig("random.png")
    """
    density, cumulative = dataset[f"psd_{quantity}"], dataset[f"cumulative_{quantity}"]
    along = density.dims[1]
    hertz = dataset.omega.values / TWO_PI
    groups = [TRANSLATIONS, ROTATIONS] if along == "output" else [LEGS[:3], LEGS[3:]]
    figure = new_figure(10, 6.2)
    grid = figure.subplots(2, 2, sharex=True)
    least = _ROUNDING * float(cumulative[-1].max())
    for column, names in enumerate(groups):
        for i, name in enumerate(names):
            line = {"color": COLOURS[i], "ls": STYLES[i], "lw": 1.6}
            rms = cumulative.sel({along: name}).values
            seen = 1.0 if rms[-1] > least else np.nan
            label = f"{OUTPUT_NAMES.get(name, f'leg {name}')}: {rms[-1] if seen == 1 else 0:.4g}"
            grid[0, column].loglog(hertz, _positive(seen * TWO_PI * density.sel({along: name}).values), **line)
            grid[1, column].loglog(hertz, _positive(seen * rms), label=label, **line)
        unit = _quantity_unit(quantity, column)
        grid[0, column].set_ylabel(f"density, {unit if unit == 'N' else f'({unit})'}²/Hz")
        grid[1, column].set(ylabel=f"RMS below, {unit}", xlabel="frequency, Hz")
        for ax in grid[:, column]:
            dress(ax)
            _span(ax)
            _plain_decades(ax)
        grid[1, column].legend(loc="best", fontsize=9, framealpha=0.85, edgecolor="none", title=f"total RMS, {unit}")
    figure.suptitle(
        f"{dataset.attrs['design']}: {quantity.replace('_', ' ')} on the moving base", color=INK, fontsize=12
    )
    return figure


def stepped_ratio(
    dataset: xr.Dataset,
    natural: Iterable[float] = (),
    linear: xr.DataArray | None = None,
    scale: Literal["linear", "log"] = "linear",
) -> Figure:
    """Draw the ratio of response amplitude to base amplitude against frequency (rad/s), six motions.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `stepped_sine`: dots.
    natural : iterable of float, optional
        Frequencies to mark, rad/s.
    linear : xarray.DataArray, optional
        Complex response of the tangent (omega, output): the line. Default: that in the dataset.
    scale : {"linear", "log"}, optional
        Scale of the frequencies.

    Returns
    -------
    matplotlib.figure.Figure
        The figure.

    Notes
    -----
    In the form of Fig. 9 of the paper.

    Examples
    --------
    >>> found = fx.stepped_sine(fx.load("mukherjee-ii"), omega=[300.0, 500.0], amplitude=1e-6, axis="z")
    >>> fx.plots.response.stepped_ratio(found).savefig("stepped.png")
    """
    line = dataset["linear"] if linear is None else linear
    natural, least = list(natural), _ROUNDING * float(np.abs(line).max())
    figure = new_figure(10.5, 6.2)
    for i, (name, ax) in enumerate(zip(OUTPUT_NAMES, figure.subplots(2, 3, sharex=True).ravel(), strict=True)):
        smooth = np.abs(line.sel(output=name).values)
        dots = dataset.ratio.sel(output=name).values
        if smooth.max() <= least:
            smooth, dots = np.full_like(smooth, np.nan), np.full_like(dots, np.nan)
            ax.text(0.5, 0.5, "none", transform=ax.transAxes, ha="center", color=FAINT)
            ax.yaxis.set_visible(False)
        ax.set_xscale(scale)
        ax.semilogy(line.omega.values, _positive(smooth), color=FAINT, lw=1.2, label="tangent")
        ax.semilogy(dataset.omega.values, _positive(dots), "o", color=COLOURS[0], ms=2.6, mew=0, label="non-linear")
        _span(ax)
        if scale == "log":
            _plain_decades(ax)
        _mark(ax, natural, hertz=False)
        dress(ax)
        name_panel(ax, i, name)
        unit = "rad" if i > 2 else "m"
        ax.set_ylabel(f"ratio, {_ratio_unit(unit, dataset.attrs['amplitude_unit'])}")
        if i > 2:
            ax.set_xlabel("base frequency, rad/s")
    handles = ax.get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower right", ncols=2, frameon=False, labelcolor=INK)
    return figure


def _mark(ax: Axes, natural: Iterable[float], hertz: bool = True) -> None:
    low, high = ax.get_xlim()
    for omega in natural:
        place = omega / TWO_PI if hertz else omega
        if low < place < high:
            ax.axvline(place, color=FAINT, lw=0.7, ls=(0, (1, 2)), zorder=0)


def _plain_decades(ax: Axes) -> None:
    """Plain numbers at 1, 2, 5 of every decade of the horizontal axis, where they have room."""
    low, high = ax.get_xlim()
    ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high / low < 3e3 else (1,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.10g}"))
    ax.xaxis.set_minor_locator(NullLocator())


def _span(ax: Axes, decades: float = 9.0) -> None:
    """Limits a logarithmic axis to what is above rounding: `decades` below the largest value drawn."""
    drawn: list[Any] = [np.asarray(line.get_ydata(), dtype=float) for line in ax.get_lines()]
    finite = np.concatenate([values[np.isfinite(values)] for values in drawn]) if drawn else np.array([])
    if finite.size == 0 or finite.max() <= 0:
        return
    top = finite.max()
    bottom = max(finite[finite > 0].min(), top * 10.0**-decades)
    margin = (top / bottom) ** 0.06 if top > bottom else 2.0
    ax.set_ylim(bottom / margin, top * margin)


def _positive(values: Array) -> Array:
    """Values for a logarithmic axis; what it cannot show is left out."""
    return np.where(np.isfinite(values) & (values > 0), values, np.nan)


def _unwrapped_once(degrees: Array) -> Array:
    """Phase with a gap instead of a vertical line where it wraps."""
    jump = np.abs(np.diff(degrees, prepend=degrees[:1])) > 270
    return np.where(jump, np.nan, degrees)


def _ratio_unit(above: str, below: str) -> str:
    if above == below:
        return f"{above}/{below}"
    return f"{above}/({below})" if " " in below else f"{above}/{below}"


def _quantity_unit(quantity: str, column: int) -> str:
    if quantity == "leg_force":
        return "N"
    return ("rad" if column else "m") + ("/s²" if quantity == "acceleration" else "")
