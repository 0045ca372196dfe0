"""Figures of control: maps of gains, root loci, transmissibility with control, sampled runs, gain schedules.

Each function draws a result of a study, on a new figure where none is given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure, SubFigure

from flexapod.conventions import TWO_PI, Array, Complex, printed_unit
from flexapod.mechanics.point_motion import of_point
from flexapod.plots.style import (
    BLUE,
    DASHED,
    FAINT,
    ORANGE,
    SIX,
    VALUES,
    dress,
    entitle,
    ink,
    legend,
    letters,
    plain_decades,
    stage,
    state_words,
    wide,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def gain_map(dataset: xr.Dataset, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw the distance of poles to natural frequencies and the worst damping over two gains.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `control.gain_map`.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Crosses: unstable. The line bounds the gains that the paper warns of, with a pole near a natural frequency.

    Examples
    --------
    >>> found = fx.control.gain_map(fx.load("motion-base"), kp=[4e6, 8e6], kd=[4e5, 8e5])
    >>> fx.plots.control.gain_map(found).savefig("gains.png")
    """
    page, (left, right) = stage(figure, (10.5, 4.3), (1, 2), sharex=True, sharey=True)
    kd, kp = dataset.kd.values, dataset.kp.values
    unstable = ~dataset.stable.values
    nearness = float(dataset.attrs["nearness"])
    distance = np.where(np.isfinite(dataset.distance.values), dataset.distance.values, np.nan)
    panels = (
        (left, np.maximum(distance, 1e-3), "distance to natural frequencies, relative", True),
        (right, np.where(unstable, np.nan, dataset.worst_damping.values), "worst damping ratio", False),
    )
    for ax, values, words, logarithmic in panels:
        shade: dict[str, Any] = {"cmap": VALUES, "shading": "nearest", "rasterized": True}
        if logarithmic and np.isfinite(values).any():
            shade["norm"] = LogNorm(np.nanmin(values), max(np.nanmax(values), 1.01 * np.nanmin(values)))
        mesh = ax.pcolormesh(kd, kp, values, **shade)
        bar = page.colorbar(mesh, ax=ax, shrink=0.95)
        bar.set_label(words, color=ink())
        bar.ax.tick_params(labelcolor=ink(), color=FAINT, labelsize=letters("xtick.labelsize"))
        if dataset.near.values.any() and not dataset.near.values.all():
            near = dataset.near.values.astype(float)
            ax.contour(kd, kp, near, levels=[0.5], colors=[ORANGE], linewidths=wide(1.8))
        rows, columns = np.nonzero(unstable)
        ax.plot(kd[columns], kp[rows], ls="none", marker="x", ms=wide(3), mew=wide(0.8), color=ink())
        ax.set_xlabel(f"derivative gain kd, {printed_unit(dataset.kd.attrs['units'])}")
        dress(ax)
        _spread(ax, kd, kp)
    left.set_ylabel(f"proportional gain kp, {printed_unit(dataset.kp.attrs['units'])}")
    words = f"{dataset.attrs['design']}: {dataset.attrs['space']} space, {dataset.attrs['actuator']}"
    note = f"   (orange: a pole within {nearness:.0%} of a natural frequency; ×: unstable; white: no vibration)"
    entitle(page, words + note)
    return page


def root_locus(dataset: xr.Dataset, chosen: float | None = None, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw poles over the gain, upper half plane, and the least damping against the gain.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `control.root_locus`.
    chosen : float, optional
        A gain to mark, in the unit of the dataset's.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Crosses: no control. Circles: zeros. Diamonds: the gain with the most damping. Squares: the chosen gain.

    Examples
    --------
    >>> found = fx.control.root_locus(fx.load("cubic-isolator"), None, "force")
    >>> fx.plots.control.root_locus(found).savefig("locus.png")
    """
    page, (left, right) = stage(figure, (10.5, 4.6), (1, 2), width_ratios=[1.25, 1])
    pole, omega = dataset.pole.values, dataset.omega.values
    top = 1.15 * float(np.max(omega))
    shown = np.where((pole.imag > -1e-9 * top) & (np.abs(pole) < 2 * top), pole, np.nan)
    moving = [k for k in range(pole.shape[1]) if np.nanmax(pole[:, k].imag, initial=0.0) > 1e-6 * top]
    for number, k in enumerate(moving):
        left.plot(shown[:, k].real, shown[:, k].imag, color=SIX[number % 6], lw=wide(1.6))
    _damping_rays(left, top)
    _marks(left, dataset.open_pole.values, "x", 8, 1.8, color=ink(), label="no control")
    zero = dataset.zero.values[np.isfinite(dataset.zero.values)]
    zero = zero[zero <= top]
    if zero.size:
        _marks(left, 1j * zero, "o", 7, 1.3, mfc="none", mec=ink(), label="zeros")
    helps = dataset.attrs["best_damping"] > 0
    if helps:
        best = int(np.argmin(np.abs(dataset.gain.values - dataset.attrs["best_gain"])))
        at = shown[best][shown[best].imag > 1e-6 * top]
        left.plot(at.real, at.imag, "D", ms=wide(6), color=ORANGE, mec="white", mew=wide(0.8), label="most damping")
    if chosen is not None:
        _mark_chosen(left, right, dataset, chosen, top)
    left.set(
        xlim=(-top, 0.06 * top), ylim=(-0.02 * top, top), xlabel="real part, rad/s", ylabel="imaginary part, rad/s"
    )
    wide_enough = left.bbox.width > 4 * page.dpi
    left.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.16 if wide_enough else -0.24),  # below the axis title
        ncols=4 if wide_enough else 2,
        fontsize=letters(),
        frameon=False,
    )
    _least_damping(right, dataset)
    for ax in (left, right):
        dress(ax)
    kind = {"force": "integral force feedback", "velocity": "direct velocity feedback"}[dataset.attrs["feedback"]]
    leak = dataset.attrs["leak_rad_s"]
    legs = dataset.attrs["legs"]
    which = "all legs" if len(legs) == 6 else f"leg{'s' if len(legs) > 1 else ''} {', '.join(map(str, legs))}"
    entitle(page, f"{dataset.attrs['design']}: {kind}, {which}" + (f", leak {leak:.4g} rad/s" if leak else ""))
    return page


def _marks(ax: Axes, pole: Complex, marker: str, size: float, edge: float, **style: Any) -> None:
    """Marks in the complex plane, whole also at the edges."""
    ax.plot(pole.real, pole.imag, ls="none", marker=marker, ms=wide(size), mew=wide(edge), clip_on=False, **style)


def _least_damping(right: Axes, dataset: xr.Dataset) -> None:
    """The least damping against the gain, and the gain that has most of it."""
    least = np.maximum(dataset.least_damping.values, -0.2)  # below zero it is unstable, however much
    right.semilogx(dataset.gain.values, least, color=BLUE, lw=wide(1.8))
    right.axhspan(-0.25, 0, color=ORANGE, alpha=0.12, lw=0)
    right.set_ylim(-0.22, 1.15 * max(dataset.attrs["best_damping"], 0.3))
    right.annotate(
        "unstable", (0.02, -0.11), xycoords=("axes fraction", "data"), color=ink(), fontsize=letters(), va="center"
    )
    if dataset.attrs["best_damping"] > 0:
        peak = (dataset.attrs["best_gain"], dataset.attrs["best_damping"])
        right.plot(*peak, "D", ms=wide(7), color=ORANGE, mec="white")
        words = f"{peak[1]:.3g} at {peak[0]:.4g} {dataset.gain.attrs['units']}"
        right.annotate(
            words, peak, xytext=(-8, 4), textcoords="offset points", ha="right", color=ink(), fontsize=letters()
        )
    right.set(xlabel=f"gain, {dataset.gain.attrs['units']}", ylabel="least damping ratio")


def _mark_chosen(left: Axes, right: Axes, dataset: xr.Dataset, gain: float, top: float) -> None:
    """Squares at the poles and at the least damping of a gain, between those that were computed."""
    row = np.log(dataset.gain.values)
    at = float(np.log(gain))
    if not row[0] <= at <= row[-1]:
        return
    pole = np.array([np.interp(at, row, branch) for branch in dataset.pole.values.T])
    pole = pole[(pole.imag > 1e-6 * top) & (np.abs(pole) < 2 * top)]
    style: dict[str, Any] = {"ls": "none", "marker": "s", "ms": wide(6), "mfc": "none", "mec": ink(), "mew": wide(1.4)}
    left.plot(pole.real, pole.imag, label="chosen gain", **style)
    right.plot(gain, np.interp(at, row, np.maximum(dataset.least_damping.values, -0.2)), **style)


def _damping_rays(ax: Axes, top: float) -> None:
    for ratio in (0.1, 0.3, 0.5, 0.7):
        x, y = -ratio, float(np.sqrt(1 - ratio**2))
        ax.plot([0, 2 * top * x], [0, 2 * top * y], color=FAINT, lw=wide(0.6), ls=(0, (1, 2)), zorder=0)
        scale = 0.97 * top / max(y, ratio)
        ax.annotate(f"{ratio:g}", (scale * x, scale * y), color=FAINT, fontsize=letters(), ha="right", va="top")


def isolation(
    dataset: xr.Dataset, axes: tuple[str, ...] = ("x", "z"), *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Draw the transmissibility with and without control.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `control.controlled_transmissibility`.
    axes : tuple of str, optional
        The axes, of platform and base alike.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    On logarithmic scales; frequencies in Hz.

    Examples
    --------
    >>> law = fx.control.VelocityFeedback(50.0)
    >>> found = fx.control.controlled_transmissibility(fx.load("cubic-isolator"), controller=law)
    >>> fx.plots.control.isolation(found, ("z",)).savefig("isolation.png")
    """
    page, drawn = stage(figure, (4.9 * len(axes) + 0.6, 4.0), (1, len(axes)), sharey=True)
    hertz = dataset.omega.values / TWO_PI
    for ax, axis in zip(drawn, axes, strict=True):
        for case, color, style in (("passive", FAINT, DASHED), ("controlled", BLUE, "-")):
            curve = np.abs(dataset[case].sel(output=axis, base=axis).values)
            ax.loglog(
                hertz, curve, color=color, ls=style, lw=wide(1.8), label={"passive": "no control"}.get(case, "control")
            )
        ax.axhline(1.0, color=FAINT, lw=wide(0.7))
        ax.set(xlabel="frequency, Hz", title=f"{axis} of platform per {axis} of base")
        ax.title.set(color=ink(), fontsize=letters("axes.titlesize"))
        legend(ax)
        dress(ax)
        plain_decades(ax)
        ax.set_ylabel("transmissibility")
        ax.label_outer(remove_inner_ticks=False)
    words = f"{dataset.attrs['controller']}{of_point(dataset.attrs)}{state_words(dataset.attrs)}"
    entitle(page, f"{dataset.attrs['design']}: {words}")
    return page


def controlled_run(dataset: xr.Dataset, axis: str = "z", *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw the acceleration of one axis in time, with and without control, and the RMS values of all axes.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `control.simulate_control`.
    axis : str, optional
        The axis drawn in time.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Marks: what the tangent predicts. Axes that hardly move are left out.

    Examples
    --------
    >>> fx.plots.control.controlled_run(run).savefig("run.png")  # doctest: +SKIP
    """
    page, (left, right) = stage(figure, (10.5, 4.4), (1, 2), width_ratios=[1.7, 1])
    unit = printed_unit(str(dataset.acceleration_unit.sel(axis=axis).values))
    for case, color, width in (("passive", FAINT, 0.9), ("controlled", BLUE, 1.1)):
        left.plot(
            dataset.time, dataset.acceleration.sel(case=case, axis=axis), color=color, lw=width, label=_WORDS[case]
        )
    left.set(xlabel="time, s", ylabel=f"acceleration {axis}, {unit}")
    legend(left, loc="upper right")
    passive = dataset.rms_acceleration.sel(case="passive").values
    shaken = passive > 1e-3 * passive.max()  # less is left by symmetry and second-order effects
    place = np.arange(int(shaken.sum()))
    for shift, case, color in ((-0.2, "passive", FAINT), (0.2, "controlled", BLUE)):
        ratio = dataset.rms_acceleration.sel(case=case).values[shaken] / passive[shaken]
        expected = dataset.predicted_rms_acceleration.sel(case=case).values[shaken] / passive[shaken]
        right.bar(place + shift, ratio, 0.38, color=color, label=_WORDS[case])
        label = "tangent" if case == "controlled" else None
        right.plot(
            place + shift, expected, ls="none", marker="_", ms=wide(17), mew=wide(2.2), color=ORANGE, label=label
        )
    right.set_xticks(place, list(dataset.axis.values[shaken]))
    right.set_ylabel("RMS acceleration over that without control")
    right.set_ylim(0, 1.3 * max(1.0, right.get_ylim()[1] / 1.05))
    legend(right, ncols=3, loc="upper center", columnspacing=1.2)
    for ax in (left, right):
        dress(ax)
    attrs = dataset.attrs
    limited = f", force limited in {attrs['saturated']:.1%} of samples" if attrs["saturated"] else ""
    sampled = f"{attrs['controller']}{of_point(attrs)}, sampled every {1e3 * attrs['dt_s']:.4g} ms"
    entitle(page, f"{attrs['design']}: {sampled}{limited}")
    return page


_WORDS = {"passive": "no control", "controlled": "control"}


def schedule(dataset: xr.Dataset, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw gain and least damping over one or two axes of a gain schedule.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `control.gain_schedule`; of more than two axes, the first two.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Dashed: one gain for all poses.

    Examples
    --------
    >>> fx.plots.control.schedule(found).savefig("schedule.png")  # doctest: +SKIP
    """
    page, (left, right) = stage(figure, (10.5, 4.2), (1, 2))
    dims = dataset.gain.dims
    if len(dims) == 1:
        _lines(dataset, str(dims[0]), left, right)
    else:
        rest = {str(name): dataset.sizes[name] // 2 for name in dims[2:]}
        cut = dataset.isel(rest)
        for ax, name in ((left, "gain"), (right, "fixed_damping")):
            x, y = (str(name) for name in cut.gain.dims)
            mesh = ax.pcolormesh(_shown(cut, x), _shown(cut, y), cut[name].values.T, cmap=VALUES, shading="nearest")
            page.colorbar(mesh, ax=ax).set_label(_named(cut[name]), color=ink())
            ax.set(xlabel=_label(cut, x), ylabel=_label(cut, y))
    for ax in (left, right):
        dress(ax)
    entitle(page, f"{dataset.attrs['design']}: schedule of {dataset.attrs['law']} feedback")
    return page


def _lines(dataset: xr.Dataset, name: str, left: Axes, right: Axes) -> None:
    x = _shown(dataset, name) if name in dataset.coords else np.arange(dataset.sizes[name])
    left.plot(x, dataset.gain, color=BLUE, lw=wide(1.8), marker=".")
    left.axhline(dataset.attrs["fixed_gain"], color=FAINT, lw=wide(1.0), ls=DASHED)
    left.set(ylabel=_named(dataset.gain))
    right.plot(x, dataset.least_damping, color=BLUE, lw=wide(1.8), marker=".", label="gain follows the pose")
    right.plot(x, dataset.fixed_damping, color=ORANGE, lw=wide(1.4), ls=DASHED, label="one gain")
    right.set(ylabel="least damping ratio")
    legend(right)
    for ax in (left, right):
        ax.set_xlabel(_label(dataset, name) if name in dataset.coords else name)


def _shown(dataset: xr.Dataset, name: str) -> Array:
    values = dataset[name].values
    return np.degrees(values) if dataset[name].attrs.get("units") == "rad" else values


def _named(values: xr.DataArray) -> str:
    """What it is, and its unit where it has one."""
    return ", ".join(str(values.attrs[key]) for key in ("long_name", "units") if key in values.attrs)


def _label(dataset: xr.Dataset, name: str) -> str:
    unit = dataset[name].attrs.get("units", "")
    return f"{name}, {'deg' if unit == 'rad' else unit}"


def _spread(ax: Axes, kd: Array, kp: Array) -> None:
    """A logarithmic scale for gains that are spaced so."""
    for values, scale in ((kd, ax.set_xscale), (kp, ax.set_yscale)):
        if values.size > 2 and values.min() > 0 and values.max() > 30 * values.min():
            scale("log")
