"""Figures of optimal design and of robustness. Without `ax` or `figure` a new one is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, NullLocator

from flexapod.conventions import LEGS, Array
from flexapod.errors import ArgumentError
from flexapod.mechanics.kinematics import home_pose
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.pareto import ParetoFront
from flexapod.optimisation.uncertainty import Robustness
from flexapod.plots.style import (
    BLUE,
    DASHED,
    FAINT,
    GREEN,
    ORANGE,
    SKY,
    dress,
    entitle,
    ink,
    legend,
    legend_below,
    legend_of,
    letters,
    new_axes,
    stage,
    wide,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PARAMETERS = 14  # most that are drawn
INDEX = "index, rad/s"


def search(found: OptimalDesign, *, ax: Axes | None = None) -> Axes:
    """Draw every trial of a search in its order, the best so far, and the result.

    Parameters
    ----------
    found : OptimalDesign
        The result of `optimise`.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    Crosses: trials that break a constraint. The first trial is the design begun with as the variables make it: within
    their bounds, and with joints on a circle where a `JointCircle` holds them.

    Examples
    --------
    >>> fx.plots.optimisation.search(found).figure.savefig("search.png")  # doctest: +SKIP
    """
    below = ax is None
    ax = _axes(7.6, 4.0) if ax is None else ax
    trial, index = found.history.trial.values, found.history["index"].values
    feasible = found.history["feasible"].values
    if trial.size:
        ax.plot(
            trial[~feasible], index[~feasible], "x", ms=wide(5), color=FAINT, mew=wide(1.0), label="breaks a constraint"
        )
        ax.plot(trial[feasible], index[feasible], "o", ms=wide(4), color=BLUE, mew=0, alpha=0.75, label="trial")
        best = np.fmax.accumulate(np.where(feasible, index, np.nan))
        ax.step(trial, best, where="post", color=BLUE, lw=wide(1.4), label="best so far")
        if trial[0] == 0:
            ax.plot(0, index[0], "s", ms=wide(10), color=ORANGE, mfc="none", label="the same as the variables make it")
    ax.axhline(found.index, color=GREEN, lw=wide(1.8), label=f"finished and verified: {found.index:.5g}")
    ax.axhline(
        found.start_index, color=ORANGE, lw=wide(1.4), ls=DASHED, label=f"design begun with: {found.start_index:.5g}"
    )
    ax.xaxis.set_major_locator(MaxNLocator(integer=True) if trial.size else NullLocator())
    told = found.history["index"].attrs
    ax.set(xlabel="trial", ylabel=told["label"] + (f", {told['units']}" if told["units"] != "1" else ""))
    ax.set_ylim(bottom=0, top=1.08 * max(found.index, found.start_index, *index[np.isfinite(index)]))
    legend_of(ax, below, 3)
    entitle(ax, f"{found.start.name}: search")
    return ax


def plan(found: OptimalDesign, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw both designs from above and from the side, at home and to one scale: joints and numbered legs, in mm.

    Parameters
    ----------
    found : OptimalDesign
        The result of `optimise`.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Dashed: the design begun with. Numbers stand on the legs of the design found.

    Examples
    --------
    >>> fx.plots.optimisation.plan(found).savefig("plan.png")  # doctest: +SKIP
    """
    page, (above, beside) = stage(figure, (9.6, 4.8), (1, 2))
    shapes = ((found.start, ORANGE, (0, (4, 2)), 1.2), (found.hexapod, BLUE, "-", 1.8))
    views = ((above, (0, 1)), (beside, (0, 2)))
    corners = []
    for hexapod, color, style, width in shapes:
        pose = home_pose(hexapod)
        position, turn = (np.zeros(3), np.eye(3)) if pose is None else (pose.position, pose.matrix)
        base = 1e3 * hexapod.base_joints
        platform = 1e3 * (position + hexapod.platform_joints @ turn.T)
        corners += [base, platform]
        for ax, (i, k) in views:
            for b, p in zip(base, platform, strict=True):
                ax.plot([b[i], p[i]], [b[k], p[k]], color=color, lw=width, ls=style)
            ax.plot(base[:, i], base[:, k], "s", ms=wide(5), color=color, mec="white", mew=wide(0.7), zorder=4)
            ax.plot(platform[:, i], platform[:, k], "o", ms=wide(6), color=color, mec="white", mew=wide(0.7), zorder=4)
    _one_scale(views, np.concatenate(corners))
    for ax, (i, k) in views:
        _number(ax, base[:, (i, k)], platform[:, (i, k)])
    above.set(xlabel="x, mm", ylabel="y, mm", aspect="equal", title="from above")
    beside.set(xlabel="x, mm", ylabel="z, mm", aspect="equal", title="from the side")
    lines = [Line2D([], [], color=c, ls=s, lw=w) for _, c, s, w in shapes]
    lines += [Line2D([], [], color=FAINT, ls="none", marker=m, ms=wide(6)) for m in "so"]
    names = ["design begun with", "design found", "base joint", "platform joint"]
    for ax in (above, beside):
        dress(ax)
        ax.title.set(color=ink(), fontsize=letters("axes.titlesize"))
    legend_below(page, 4, lines, names)
    return page


def _one_scale(views: Sequence[tuple[Axes, tuple[int, int]]], points: Array) -> None:
    """Limits of the same extent along all axes."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    half = 0.58 * np.ptp(points, axis=0).max()
    for ax, (i, k) in views:
        ax.set(xlim=(middle[i] - half, middle[i] + half), ylim=(middle[k] - half, middle[k] + half))


def _number(ax: Axes, base: Array, platform: Array) -> None:
    """Numbers on the legs, where most of them stand apart; those that lie behind one another share a place."""
    near = 0.05 * np.ptp(np.concatenate([base, platform]), axis=0).max()
    rows = (_apart(base + along * (platform - base), near) for along in (0.4, 0.3, 0.5, 0.2, 0.6))
    frame = {"boxstyle": "round,pad=0.2", "fc": "white", "ec": "none"}
    for (x, y), names in max(rows, key=len):
        ax.text(x, y, ", ".join(names), ha="center", va="center", fontsize=letters(), color=ink(), bbox=frame, zorder=5)


def _apart(points: Array, near: float) -> list[tuple[Array, list[str]]]:
    """Places that are farther apart than `near`, with the legs that have their points there."""
    places: list[tuple[Array, list[str]]] = []
    for leg, point in zip(LEGS, points, strict=True):
        here = next((names for at, names in places if np.linalg.norm(at - point) < near), None)
        if here is None:
            places.append((point, [leg]))
        else:
            here.append(leg)
    return places


def front(found: ParetoFront, *, ax: Axes | None = None) -> Axes:
    """Draw a Pareto front among all trials, and the design one began with.

    Parameters
    ----------
    found : ParetoFront
        The result of `pareto_front`.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    Trials that break a constraint are left out.

    Examples
    --------
    >>> fx.plots.optimisation.front(found).figure.savefig("front.png")  # doctest: +SKIP
    """
    ax = _axes(7.2, 4.6) if ax is None else ax
    told = found.history
    keep = told["feasible"].values & (told["index"].values > 0)
    ax.plot(
        told["against"].values[keep], told["index"].values[keep], ".", ms=wide(5), color=FAINT, mew=0, label="trial"
    )
    ax.plot(
        found.against,
        found.index,
        "-o",
        ms=wide(5.5),
        lw=wide(1.6),
        color=BLUE,
        mec="white",
        mew=wide(0.7),
        label="Pareto front",
    )
    ax.plot(
        found.start[1],
        found.start[0],
        "D",
        ms=wide(8),
        color=ORANGE,
        mec="white",
        mew=wide(0.9),
        ls="none",
        label="design begun with",
    )
    seen = np.append(found.against, found.start[1])
    if keep.any() and told["against"].values[keep].max() > 20 * seen.min():
        ax.set_xscale("log")
    ax.set(xlabel=f"{found.name}{f', {found.unit}' if found.unit else ''}", ylabel=INDEX)
    ax.set_ylim(bottom=0)
    legend(ax)
    entitle(ax, f"{found.hexapod.name}: index against {found.name}")
    return ax


def spread(found: Robustness, *, ax: Axes | None = None) -> Axes:
    """Draw the distribution of the index of uncertain designs, with the nominal and the worst case.

    Parameters
    ----------
    found : Robustness
        The result of `robustness`.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    The dashed line is the 1 % quantile.

    Examples
    --------
    >>> oil = fx.Uncertain("legs.stiffness_law.bulk_modulus", 0.1)
    >>> found = fx.robustness(fx.load("motion-base"), oil, samples=64, sensitivity=0)
    >>> fx.plots.optimisation.spread(found).figure.savefig("spread.png")
    """
    below = ax is None
    ax = _axes(7.2, 4.0) if ax is None else ax
    values = found.samples["index"].values
    ax.hist(values, bins=min(80, max(12, int(np.sqrt(values.size)))), color=BLUE, alpha=0.55, density=True, lw=0)
    lines = [
        (found.nominal, GREEN, "-", f"as designed: {found.nominal:.5g}"),
        (found.quantiles[0.01], BLUE, DASHED, f"99 % are above {found.quantiles[0.01]:.5g}"),
        (found.worst, ORANGE, "-", f"worst case: {found.worst:.5g}"),
    ]
    for value, color, style, label in lines:
        ax.axvline(value, color=color, lw=wide(1.8), ls=style, label=label)
    ax.set(xlabel=f"least {INDEX}" if found.samples.attrs["poses"] > 1 else INDEX, ylabel="share of designs per rad/s")
    legend_of(ax, below, 3)
    entitle(ax, f"{found.samples.attrs['design']}: index of {values.size} uncertain designs")
    return ax


def importance(found: Robustness, *, ax: Axes | None = None) -> Axes:
    """Draw the Sobol indices of the parameters, the most important first, with their 95 % confidence.

    Parameters
    ----------
    found : Robustness
        The result of `robustness` with a sensitivity.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Raises
    ------
    ArgumentError
        If the sensitivity was left out.

    Notes
    -----
    At most 14 parameters are drawn.

    Examples
    --------
    >>> fx.plots.optimisation.importance(found).figure.savefig("importance.png")  # doctest: +SKIP
    """
    if found.sensitivity is None:
        raise ArgumentError("found has no sensitivity. Give robustness a number of base samples: sensitivity=1024.")
    told = found.sensitivity.sortby("total", ascending=False).isel(parameter=slice(0, _PARAMETERS))
    below = ax is None
    ax = _axes(7.2, 1.4 + 0.34 * told.sizes["parameter"]) if ax is None else ax
    y = np.arange(told.sizes["parameter"])[::-1]
    bars = (("total", 0.19, BLUE, "with interactions"), ("first", -0.19, SKY, "on its own"))
    for name, offset, color, label in bars:
        error = told[f"{name}_confidence"].values
        ax.barh(
            y + offset, np.maximum(told[name].values, 0), 0.36, color=color, label=label, xerr=error,
            error_kw={"ecolor": ink(), "lw": wide(0.8), "capsize": 2},
        )  # fmt: skip
    ax.set_yticks(y, [found.ranges[str(name)].words for name in told.parameter.values])
    ax.set(xlabel="share of the variance of the index")
    ax.set_xlim(left=0)
    legend_of(ax, below, 2)
    return ax


def _axes(width: float, height: float) -> Axes:
    ax = new_axes(width, height)
    dress(ax)
    return ax
