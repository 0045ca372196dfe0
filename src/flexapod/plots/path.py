"""Figures of paths: the index along them, the plan beside the straight line, leg forces and travel, motors.

Each function draws a result of a study, on a new figure where none is given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import EngFormatter

from flexapod.conventions import TWO_PI
from flexapod.paths.analysis import PathIndex
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
    legend_below,
    legend_of,
    letters,
    new_axes,
    stage,
    wide,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_RPM = 60.0 / TWO_PI
STYLES = ("-", "-", "-", (0, (5, 1.5)), (0, (5, 1.5)), (0, (5, 1.5)))


def index_along(
    found: PathIndex, beside: PathIndex | None = None, *, figure: Figure | SubFigure | None = None
) -> Figure:
    """Draw the index along a path against its bound, and the condition number below.

    Parameters
    ----------
    found : PathIndex
        The result of `path_index`.
    beside : PathIndex, optional
        That of another path, such as the straight one.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Paths of different duration are drawn over the share of it.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i")
    >>> way = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0.05, 0, 0.89]]), [0, 1])
    >>> fx.plots.path.index_along(fx.path_index(hexapod, way, bound=100.0)).savefig("index.png")
    """
    page, (above, below) = stage(figure, (8.2, 5.4), (2, 1), sharex=True, height_ratios=[2, 1])
    shared = beside is not None and beside.samples.time.values[-1] != found.samples.time.values[-1]
    paths = [(found, BLUE, "-", "path"), *([] if beside is None else [(beside, FAINT, DASHED, "straight line")])]
    for result, color, style, label in paths:
        x = _x(result, shared)
        above.plot(x, result.samples["index"], color=color, ls=style, lw=wide(1.9), label=label)
        below.plot(x, result.samples.condition_number, color=color, ls=style, lw=wide(1.5))
    where = np.interp(found.minimum_time, found.samples.time.values, _x(found, shared))
    above.plot(where, found.minimum, "o", ms=wide(6), color=BLUE, mec="white", mew=wide(0.9))
    above.annotate(
        f"{found.minimum:.4g}", (where, found.minimum), xytext=(0, -14), textcoords="offset points", ha="center",
        color=ink(), fontsize=letters(),
    )  # fmt: skip
    if found.bound is not None:
        above.axhline(found.bound, color=ORANGE, lw=wide(1.3), label=f"bound {found.bound:.4g} rad/s")
        for result, color, *_ in paths:
            values = result.samples["index"].values
            above.fill_between(
                _x(result, shared), values, found.bound, where=values < found.bound, color=color, alpha=0.15, lw=0
            )
    above.set(ylabel=r"lowest natural frequency $\omega_1$, rad/s")
    above.set_ylim(bottom=0)
    legend(above)
    conditions = np.concatenate([result.samples.condition_number.values for result, *_ in paths])
    largest, least = np.nanmax(conditions), np.nanmin(conditions)
    below.set_yscale("log" if largest > 10 * least else "linear")  # a part of a decade has no round numbers
    below.set(ylabel="cond(H)", xlabel="share of the path's time" if shared else "time, s")
    for ax in (above, below):
        dress(ax)
    entitle(page, f"{found.samples.attrs['design']}: index along the path")
    return page


def _x(result: PathIndex, shared: bool) -> np.ndarray:
    t = np.asarray(result.samples.time.values)
    return (t - t[0]) / (t[-1] - t[0]) if shared else t


def plan_map(dataset: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw the index on the plane through start, goal and the planned path's farthest point.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `paths.plan_slice`.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    White line: the bound. Hatched: a requirement is broken.

    Examples
    --------
    >>> fx.plots.path.plan_map(plane).figure.savefig("plan.png")  # doctest: +SKIP
    """
    width, height = np.ptp(dataset.along.values), np.ptp(dataset.aside.values)
    alone = ax is None
    ax = new_axes(7.4, 1.4 + 5.6 * min(height / width, 1.2)) if ax is None else ax
    bound = dataset.attrs["bound"]
    x, y, values = dataset.along.values, dataset.aside.values, dataset["index"].values
    mesh = ax.pcolormesh(x, y, values, cmap=VALUES, shading="gouraud", rasterized=True, vmin=0)
    bar = ax.figure.colorbar(mesh, ax=ax)
    bar.set_label(r"lowest natural frequency $\omega_1$, rad/s", color=ink())
    bar.ax.axhline(bound, color="white", lw=wide(2))
    weak = ax.contour(x, y, values, levels=[bound], colors="white", linewidths=wide(1.6))
    ax.clabel(weak, fmt={bound: f"{bound:.4g} rad/s"}, fontsize=letters(), colors="white")
    blocked = np.where(dataset.met.values, np.nan, 1.0)
    ax.contourf(x, y, np.nan_to_num(blocked), levels=[0.5, 1.5], colors="none", hatches=["////"])
    ax.plot([0, dataset.attrs["straight"]], [0, 0], color=ORANGE, lw=wide(2.0), ls=DASHED, label="straight line")
    ax.plot(dataset.path_along, dataset.path_aside, color="white", lw=wide(4.0))
    ax.plot(dataset.path_along, dataset.path_aside, color=ink(), lw=wide(2.2), label="planned path")
    for place, name in ((0.0, "start"), (dataset.attrs["straight"], "goal")):
        ax.plot(place, 0.0, "o", ms=wide(8), color="white", mec=ink(), mew=wide(1.5), zorder=5)
        ax.annotate(name, (place, 0.0), xytext=(0, -17), textcoords="offset points", ha="center", color="white")
    ax.set(
        xlabel="along the straight line from start to goal, m",
        ylabel="aside, towards the path's farthest point, m",
        xlim=(x[0], x[-1]),
        ylim=(y[0], y[-1]),
        aspect="equal",
    )
    legend_of(ax, alone, 2)
    ax.tick_params(color=FAINT, labelcolor=ink(), labelsize=letters("xtick.labelsize"))
    entitle(ax, f"{dataset.attrs['design']}: round the weak region (hatched: a requirement is broken)")
    return ax


def loads(dataset: xr.Dataset, *, figure: Figure | SubFigure | None = None) -> Figure:
    """Draw leg forces and leg lengths along a path.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `paths.path_loads`.
    figure : Figure or SubFigure, optional
        Where the panels are drawn. Default: a new figure.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, or the SubFigure that was given.

    Notes
    -----
    Thin lines are the forces at rest.

    Examples
    --------
    >>> way = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0.05, 0, 0.89]]), [0, 1])
    >>> found = fx.paths.path_loads(fx.load("mukherjee-i"), way)
    >>> fx.plots.path.loads(found).savefig("loads.png")
    """
    page, (left, right) = stage(figure, (10.5, 4.4), (1, 2), sharex=True)
    for i, leg in enumerate(dataset.leg.values):
        line = {"color": SIX[i], "ls": STYLES[i]}
        left.plot(dataset.time, dataset.leg_force[:, i], lw=wide(1.7), label=f"leg {leg}", **line)
        left.plot(dataset.time, dataset.static_force[:, i], lw=wide(0.6), alpha=0.7, **line)
        right.plot(dataset.time, dataset.leg_length[:, i], lw=wide(1.7), **line)
    left.set(ylabel="leg force, N (thin: at rest)", xlabel="time, s")
    right.set(ylabel="leg length, m", xlabel="time, s")
    left.yaxis.set_major_formatter(EngFormatter())
    for ax in (left, right):
        dress(ax)
    legend_below(page, 6, *left.get_legend_handles_labels())
    entitle(page, f"{dataset.attrs['design']}: legs along the path")
    return page


def motors(dataset: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Draw torque and speed of the motors along a path, in the plane of the motors' curve.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `paths.motor_loads`, without cases.
    ax : Axes, optional
        Axes to draw on. Default: those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
        The axes; their ``figure`` can be saved.

    Notes
    -----
    Marks are RMS torques at RMS speeds. Where speed and torque have one sign the motor drives, elsewhere it brakes.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-i").replace({"drive": {"lead_mm": 5, "efficiency": 0.9}})
    >>> way = fx.Trajectory(fx.Pose([[0, 0, 0.89], [0.05, 0, 0.89]]), [0, 1])
    >>> found = fx.paths.motor_loads(hexapod, fx.paths.path_loads(hexapod, way))
    >>> fx.plots.path.motors(found).figure.savefig("motors.png")
    """
    alone = ax is None
    ax = new_axes(7.4, 5.0) if ax is None else ax
    for i, leg in enumerate(dataset.leg.values):
        line: dict[str, Any] = {"color": SIX[i], "ls": STYLES[i], "lw": wide(1.5), "label": f"leg {leg}"}
        ax.plot(_RPM * dataset.motor_speed[:, i], dataset.motor_torque[:, i], **line)
        ax.plot(
            _RPM * dataset.rms_speed[i],
            dataset.rms_torque[i],
            "o",
            ms=wide(5),
            color=SIX[i],
            mec=ink(),
            mew=wide(0.8),
            zorder=5,
        )
    if "curve_speed" in dataset:
        _curve(ax, dataset)
    for level in (ax.axhline, ax.axvline):
        level(0.0, color=FAINT, lw=wide(0.7), zorder=0)
    ax.set(xlabel="motor speed, rpm", ylabel="motor torque, N m (dots: RMS)")
    dress(ax)
    legend_of(ax, alone, 4)
    entitle(ax, f"{dataset.attrs['design']}: motors along the path")
    return ax


def _curve(ax: Axes, dataset: xr.Dataset) -> None:
    """The motor's curve in all four quadrants as far as there are torques, and the greatest speed."""
    least, most = (float(reduced(dataset.motor_torque)) for reduced in (np.min, np.max))
    fastest = float(dataset.max_speed.min())
    speeds = np.unique(np.append(np.minimum(dataset.curve_speed.values, fastest), fastest))
    both = _RPM * np.concatenate([-speeds[::-1], speeds])
    for name, words, style in (("peak", "peak torque", "-"), ("continuous", "continuous torque", DASHED)):
        values = np.interp(speeds, dataset.curve_speed.values, dataset[f"{name}_curve"].values)
        for sign, needed in ((1.0, most > 0), (-1.0, least < 0)):
            if needed:
                half = sign * np.concatenate([values[::-1], values])
                ax.plot(both, half, color=ink(), lw=wide(1.6), ls=style, label=words if sign > 0 or most <= 0 else None)
    for sign in (-1.0, 1.0):
        ax.axvline(
            _RPM * sign * fastest, color=ink(), lw=wide(1.0), ls=":", label="greatest speed" if sign > 0 else None
        )
