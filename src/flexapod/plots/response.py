"""Figures of vibration: frequency response, random response, stepped sine.

Each function draws a result of a study, on a new figure where none is given. Frequencies are in Hz unless asked for in
rad/s; the rest is in SI units.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure

from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, TWO_PI, Array, metric, unit_of
from flexapod.mechanics.point_motion import of_point
from flexapod.plots.style import (
    FAINT,
    OUTPUT_NAMES,
    SIX,
    dress,
    entitle,
    fitting,
    legend,
    legend_below,
    letters,
    moves,
    name_panel,
    note_still,
    panels,
    plain_decades,
    stage,
    state_words,
    wide,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = SIX[:3]  # line styles tell them apart as well
STYLES = ("-", (0, (6, 2)), (0, (2, 1.5)))
_VARIABLES = {
    "absolute": ("base", "motion per base motion"),
    "relative": ("base", "motion relative to the base per base motion"),
    "compliance": ("wrench", "compliance"),
    "command": ("leg", "motion per leg command"),
}


def frequency_response(
    dataset: xr.Dataset,
    variable: str = "absolute",
    given: str = "z",
    natural: Iterable[float] = (),
    *,
    figure: Figure | SubFigure | None = None,
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
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

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
    drawn = dict(zip(AXES, moves(response.values), strict=True))
    page, grid, groups = _halves(figure, (TRANSLATIONS, ROTATIONS), drawn, [2, 1])
    for (above, below), outputs in zip(grid, groups, strict=True):
        for i, output in enumerate(outputs):
            if drawn[output]:
                values = response.sel(output=output).values
                line = {"color": COLOURS[i], "ls": STYLES[i], "lw": wide(1.6)}
                above.loglog(hertz, _positive(np.abs(values)), label=OUTPUT_NAMES[output], **line)
                below.semilogx(hertz, _unwrapped_once(np.degrees(np.angle(values))), **line)
        above.set_ylabel(f"amplitude, {_ratio_unit(unit_of(outputs[0]), unit)}")
        _span(above)
        below.set(ylabel="phase, deg", ylim=(-190, 190), yticks=[-180, -90, 0, 90, 180], xlabel="frequency, Hz")
        for ax in (above, below):
            dress(ax)
            _mark(ax, natural)
            plain_decades(ax)
        legend(above)
    note_still(page, [OUTPUT_NAMES[axis] for axis in AXES if not drawn[axis]])
    source = f"leg {given}" if dimension == "leg" else f"{dimension} {given}"
    state = state_words(dataset.attrs)
    words = f"{words}, {source}{of_point(dataset.attrs)}{state}"
    entitle(page, f"{dataset.attrs['design']}: {words}")
    return page


def random_spectra(
    dataset: xr.Dataset,
    quantity: str = "acceleration",
    passive: xr.Dataset | None = None,
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Draw spectral density and cumulative RMS of a quantity under random motion of the base and random loads.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `random_response`, or of `control.controlled_random_response`.
    quantity : {"acceleration", "displacement", "relative", "leg_force", "actuator_force"}, optional
        What is drawn.
    passive : xarray.Dataset, optional
        The same without control, drawn in grey behind it.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Densities are one-sided and per Hz.

    Examples
    --------
    >>> found = fx.random_response(fx.load("cubic-isolator"), psd=fx.vc_curve("VC-C"), axis="z")
    >>> fx.plots.response.random_spectra(found).savefig("random.png")
    """
    cumulative = dataset[f"cumulative_{quantity}"]
    along = str(cumulative.dims[1])
    groups: list[Sequence[str]] = [TRANSLATIONS, ROTATIONS] if along == "output" else [LEGS[:3], LEGS[3:]]
    everything = [name for group in groups for name in group]
    drawn = dict(zip(everything, moves(cumulative.values[-1:]), strict=True))
    page, grid, groups = _halves(figure, groups, drawn, [1, 1])
    for (above, below), names in zip(grid, groups, strict=True):
        factor, unit = metric(float(cumulative.sel({along: list(names)}).max()), _plain_unit(quantity, names[0]))
        for name in (name for name in names if drawn[name]):
            i = names.index(name)
            line = {"ls": STYLES[i], "lw": wide(1.6)}
            if passive is not None:
                _Curve(passive, quantity, name, factor).draw(above, below, color=FAINT, **line)
            _Curve(dataset, quantity, name, factor, _named(name)).draw(above, below, color=COLOURS[i], **line)
        if passive is not None:
            below.plot([], [], color=FAINT, lw=wide(1.6), label="grey: without control")
        per = "/s²" if quantity == "acceleration" else ""
        above.set_ylabel(f"density, {unit if unit == 'N' else f'({unit}{per})'}²/Hz")
        below.set(ylabel=f"RMS below, {unit}{per}", xlabel="frequency, Hz")
        for ax in (above, below):
            dress(ax)
            _span(ax)
            plain_decades(ax)
        legend(below, title=f"total RMS, {unit}{per}", title_fontsize=letters())
    note_still(page, [_named(name) for name in everything if not drawn[name]], "nothing")
    sources = dataset.attrs.get("sources", ["base"])
    cause = "on the moving base" if list(sources) == ["base"] else f"by {' and '.join(sources)}"
    words = f"{quantity.replace('_', ' ')} {cause}{of_point(dataset.attrs)}"
    entitle(page, f"{dataset.attrs['design']}: {words}")
    return page


class _Curve(NamedTuple):
    """One axis or leg of a Dataset. factor: to the unit of the figure. label: told with its RMS."""

    dataset: xr.Dataset
    quantity: str
    name: str
    factor: float
    label: str = ""

    def draw(self, above: Axes, below: Axes, **line: Any) -> None:
        """Draw its density and its cumulative RMS."""
        density, cumulative = (self.dataset[f"{kind}_{self.quantity}"] for kind in ("psd", "cumulative"))
        at, hertz = {density.dims[1]: self.name}, self.dataset.omega.values / TWO_PI
        rms = self.factor * cumulative.sel(at).values
        above.loglog(hertz, _positive(TWO_PI * self.factor**2 * density.sel(at).values), **line)
        below.loglog(hertz, _positive(rms), label=f"{self.label}: {rms[-1]:.4g}" if self.label else None, **line)


def stepped_ratio(
    dataset: xr.Dataset,
    natural: Iterable[float] = (),
    linear: xr.DataArray | None = None,
    scale: Literal["linear", "log"] = "linear",
    unit: Literal["rad/s", "Hz"] = "rad/s",
    *,
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Draw the ratio of response amplitude to base amplitude against frequency, a panel for each motion.

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
    unit : {"rad/s", "Hz"}, optional
        Unit of the frequencies.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    In the form of Fig. 9 of the paper.

    Examples
    --------
    >>> found = fx.stepped_sine(fx.load("mukherjee-ii"), omega=[300.0, 500.0], amplitude=1e-6, axis="z")
    >>> fx.plots.response.stepped_ratio(found).savefig("stepped.png")
    """
    line = dataset["linear"] if linear is None else linear
    per = TWO_PI if unit == "Hz" else 1.0
    natural, drawn = list(natural), moves(line.transpose(..., "output").values)
    shown = [axis for axis, seen in zip(AXES, drawn, strict=True) if seen]
    page, axes = panels(figure, len(shown), sharex=True)
    for place, (name, ax) in enumerate(zip(shown, axes, strict=False)):
        smooth = np.abs(line.sel(output=name).values)
        dots = dataset.ratio.sel(output=name).values
        ax.set_xscale(scale)
        ax.semilogy(line.omega.values / per, _positive(smooth), color=FAINT, lw=wide(1.2), label="tangent")
        ax.semilogy(
            dataset.omega.values / per, _positive(dots), "o", color=COLOURS[0], ms=wide(2.6), mew=0, label="non-linear"
        )
        _span(ax)
        if scale == "log":
            plain_decades(ax)
        _mark(ax, natural, hertz=unit == "Hz")
        dress(ax)
        name_panel(ax, place, name)
        ax.set_ylabel(f"ratio, {_ratio_unit(unit_of(name), dataset.attrs['amplitude_unit'])}")
        ax.set_xlabel(f"base frequency, {unit}")
    note_still(page, [OUTPUT_NAMES[axis] for axis in AXES if axis not in shown])
    legend_below(page, 2, *ax.get_legend_handles_labels())
    return page


def _halves(
    figure: Figure | SubFigure | None, groups: Sequence[Sequence[str]], drawn: Mapping[str, bool], heights: list[int]
) -> tuple[Any, Any, list[Sequence[str]]]:
    """A figure with two axes above one another, (n, 2), for each of the n groups of curves in which one is drawn."""
    seen = [group for group in groups if any(drawn[name] for name in group)] or list(groups[:1])
    n = len(seen)
    inches = (10.0 if n > 1 else 6.6, 6.2)
    if fitting(figure, inches, n) == n:
        figure, axes = stage(figure, inches, (2, n), sharex=True, height_ratios=heights)
        return figure, axes.reshape(2, n).T, seen
    figure, axes = stage(figure, (5.0, n * 4.6), (2 * n, 1), sharex=True, height_ratios=heights * n)
    return figure, axes.reshape(n, 2), seen


def _named(name: str) -> str:
    return OUTPUT_NAMES.get(name, f"leg {name}")


def _mark(ax: Axes, natural: Iterable[float], hertz: bool = True) -> None:
    low, high = ax.get_xlim()
    for omega in natural:
        place = omega / TWO_PI if hertz else omega
        if low < place < high:
            ax.axvline(place, color=FAINT, lw=wide(0.7), ls=(0, (1, 2)), zorder=0)


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


def _plain_unit(quantity: str, name: str) -> str:
    """Of a quantity's displacement, or of a force."""
    return "N" if quantity.endswith("force") else unit_of(name)
