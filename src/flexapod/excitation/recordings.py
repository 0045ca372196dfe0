"""Recorded motions, loads and commands as excitations: arrays or CSV files, splined."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import one_of
from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, Array, unit_of
from flexapod.design.units import QUANTITIES
from flexapod.errors import ArgumentError, shown
from flexapod.excitation.excitation import Excitation, Use
from flexapod.excitation.piecewise import sampled_term
from flexapod.excitation.samples import Samples, Trend, checked, drift, filtered, unwrapped, without_trend
from flexapod.tables import Column, Units, naming, parse_table, read_text, unit_named

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

Recorded = Literal["value", "velocity", "acceleration"]
INTEGRATIONS = {"value": 0, "velocity": 1, "acceleration": 2}

#: What a column may hold: dimension -> what was recorded, and what it can drive.
HOLDS: dict[str, tuple[Recorded, Use]] = {
    "length": ("value", "motion"),
    "velocity": ("velocity", "motion"),
    "acceleration": ("acceleration", "motion"),
    "angle": ("value", "motion"),
    "angular velocity": ("velocity", "motion"),
    "angular acceleration": ("acceleration", "motion"),
    "force": ("value", "force"),
    "moment": ("value", "moment"),
}
#: What a title may be -> a channel, or "time".
NAMES = {
    **{"time": "time", "t": "time", "surge": "x", "sway": "y", "heave": "z"},
    **{axis: axis for axis in AXES},
    **{f"leg{leg}": leg for leg in LEGS},
}
FORM = (
    f"Columns are time, {', '.join(AXES)}, leg1 to leg6, with a unit as in z_um or roll_deg; a header with time and "
    "channels is needed, and at least six lines of numbers."
)


def time_series(
    times: ArrayLike,
    values: ArrayLike,
    axis: str | Sequence[str],
    *,
    recorded: Recorded = "value",
    detrend: Trend | None = None,
    highpass: float | None = None,
) -> Excitation:
    """Return a recording as an excitation.

    Parameters
    ----------
    times : array_like, shape (n,)
        Times of the samples, s, ascending; the first becomes t = 0. At least six.
    values : array_like, shape (n,) or (n, k)
        Samples on one axis, or on k axes.
    axis : str or list of str
        One of x, y, z, roll, pitch, yaw, or a leg "1" to "6", for each column of `values`.
    recorded : {"value", "velocity", "acceleration"}, optional
        What was recorded: the value in the unit of the axis (m, rad, N or N m), or a derivative, which is integrated
        from rest at zero.
    detrend : {"first", "mean", "linear"}, optional
        What is taken out of the samples: their first value, their mean, or a straight line.
    highpass : float, optional
        What is slower than this, rad/s, is taken out, by a Butterworth filter forwards and backwards.

    Returns
    -------
    Excitation
        The recording as splines; it holds nothing after its last sample.

    Raises
    ------
    ArgumentError
        If a sample is not finite, the times do not ascend or have a gap (the message names the sample), there are fewer
        than six samples, a name is unknown, an angle jumps, or the samples cannot be filtered.

    See Also
    --------
    read_time_series : The same from a CSV file.

    Notes
    -----
    Values are interpolated by splines of degree five, derivatives by cubic ones, so that the acceleration is smooth.
    Angles that were written past a half turn (179, then -179 degrees) go on. Where velocities or accelerations lose
    their mean, a line, or what is slow, the motion is that which goes nowhere on the whole: its straight line is left
    out, and it need not begin at rest.

    Examples
    --------
    >>> times = np.linspace(0, 1, 101)
    >>> shaken = fx.excitation.time_series(times, 1e-3 * np.sin(10 * times), "z")
    >>> round(float(shaken.evaluate(0.5)[0][2]), 6)
    -0.000959
    """
    names = [axis] if isinstance(axis, str) else list(axis) if isinstance(axis, Sequence) else []
    if not names or len(set(names)) < len(names):
        raise ArgumentError(f"axis is {shown(axis)}; it must be one axis for each column of values, each once.")
    one_of(recorded, "recorded", INTEGRATIONS)
    uses: list[Use] = ["" if recorded == "value" else "motion"] * len(names)
    samples = checked(times, values, names, (), "")
    return _excitation(samples, names, uses, recorded, detrend, highpass)


def _excitation(
    samples: Samples,
    names: list[str],
    uses: list[Use],
    recorded: Recorded,
    detrend: Trend | None,
    highpass: float | None,
) -> Excitation:
    from scipy.interpolate import PPoly, make_interp_spline

    for k, name in enumerate(names):
        if name in ROTATIONS and recorded == "value":
            samples = unwrapped(samples, k)
    if detrend is not None or highpass is not None:
        samples = without_trend(samples, detrend, highpass)
    settled = recorded != "value" and (highpass is not None or detrend not in (None, "first"))
    t, total = samples.times, Excitation()
    spacing = float(np.median(np.diff(t)))
    for k, (name, use) in enumerate(zip(names, uses, strict=True)):
        column = samples.values[:, k]
        spline = PPoly.from_spline(make_interp_spline(t, column, k=5 if recorded == "value" else 3))
        for _ in range(INTEGRATIONS[recorded]):
            spline = spline.antiderivative()
        if settled:
            spline = _settled(spline, t, highpass)
        kept = np.diff(spline.x) > 0  # knots are repeated at the ends
        unit = f"{unit_of(name) if name in AXES else 'm'}/s{'2' if recorded == 'acceleration' else ''}"
        remark = "" if recorded == "value" else drift(t, column, spline(t), unit)
        total = total + sampled_term(
            name,
            spline.x[:-1][kept],
            spline.c[::-1, kept].T,
            spacing,
            float(t[-1]),
            use=use,
            origin=samples.origin(k),
            remark=remark,
        )
    return total


def _settled(spline: PPoly, times: Array, highpass: float | None) -> PPoly:
    """An integrated motion less what is slow in it, or less its straight line: its mean and its mean speed."""
    from scipy.interpolate import PPoly, make_interp_spline

    x = spline(times)
    slow = np.polyval(np.polyfit(times, x, 1), times) if highpass is None else x - filtered(times, x, highpass)
    rest = PPoly.from_spline(make_interp_spline(times, slow, k=5))
    knots = times[:-1]
    powers = [(spline(knots, nu) - rest(knots, nu)) / math.factorial(nu) for nu in range(5, -1, -1)]
    return PPoly(np.array(powers), times)


def read_time_series(
    path: str | Path,
    *,
    recorded: Recorded | None = None,
    detrend: Trend | None = None,
    highpass: float | None = None,
) -> Excitation:
    """Read a recording from a CSV file.

    Parameters
    ----------
    path : str or Path
        The file: a header with time and axes, then numbers.
    recorded : {"value", "velocity", "acceleration"}, optional
        What was recorded. Default: what the units in the header say, else the value.
    detrend : {"first", "mean", "linear"}, optional
        What is taken out of the samples: their first value, their mean, or a straight line.
    highpass : float, optional
        What is slower than this, rad/s, is taken out, by a Butterworth filter forwards and backwards.

    Returns
    -------
    Excitation
        The recording, from its first sample at t = 0 on.

    Raises
    ------
    ArgumentError
        If the file cannot be read, a column or a unit is unknown, or as in `time_series`.

    See Also
    --------
    time_series : The same from arrays.

    Notes
    -----
    Columns are time (or t), x, y, z (or surge, sway, heave), roll, pitch, yaw, and leg1 to leg6, with their unit if it
    is not SI, as in ``z_um``, ``Roll [deg]``, ``x_mm_per_s2``, ``z_g`` or ``time_ms``; roll, pitch and yaw always name
    theirs. Commas, semicolons or tabs separate; with the last two, numbers may have decimal commas. Lines that begin
    with # and columns named note or comment are left out.

    Examples
    --------
    >>> rows = np.column_stack([10 * np.arange(20), np.sin(0.1 * np.arange(20))])
    >>> np.savetxt("shaker.csv", rows, delimiter=",", header="time_ms,z_um", comments="")
    >>> fx.read_time_series("shaker.csv")
    <Excitation of z, 1 terms>
    """
    file = Path(path)
    text = read_text(file)
    with naming(file):
        return parse_time_series(text, recorded=recorded, detrend=detrend, highpass=highpass, file=str(file))


def parse_time_series(
    text: str,
    *,
    recorded: Recorded | None = None,
    detrend: Trend | None = None,
    highpass: float | None = None,
    file: str = "",
) -> Excitation:
    """A recording from the text of a CSV file; see `read_time_series`. file: its name, for what is told of it."""
    if recorded is not None:
        one_of(recorded, "recorded", INTEGRATIONS)
    table = parse_table(text, NAMES, FORM)
    header = ", ".join(column.title for column in table.columns)
    time = table.column("time")
    channels = [column for column in table.columns if column.name != "time"]
    if time is None or not channels:
        raise ArgumentError(f"the header is {header}; `time` and each channel are needed once.")
    said = [HOLDS[dimension] if dimension else None for dimension in map(_dimension, channels)]
    kinds: set[Recorded] = {holds[0] for holds in said if holds} | ({recorded} if recorded else set())
    if len(kinds) > 1:
        raise ArgumentError(f"the header is {header}; all columns must be {recorded or 'of one kind'}.")
    columns = [
        table.numbers(column, _units(column.name), None if column.name in ROTATIONS else "", finite=False)
        for column in channels
    ]
    kind: Recorded = next(iter(kinds), "value")
    uses: list[Use] = [holds[1] if holds else "" if kind == "value" else "motion" for holds in said]
    samples = checked(
        table.numbers(time, QUANTITIES["time"], finite=False),
        np.column_stack(columns),
        [column.title for column in channels],
        table.lines,
        file,
    )
    return _excitation(samples, [column.name for column in channels], uses, kind, detrend, highpass)


def _dimension(column: Column) -> str | None:
    """The dimension that a column's unit is of; None without a known unit."""
    known = unit_named(column.unit, _units(column.name)) if column.unit else None
    return next((dimension for dimension in _dimensions(column.name) if known in QUANTITIES[dimension]), None)


def _dimensions(channel: str) -> tuple[str, ...]:
    if channel in ROTATIONS:
        return "angle", "angular velocity", "angular acceleration"
    return ("length", "velocity", "acceleration", *(("force", "moment") if channel in TRANSLATIONS else ()))


def _units(channel: str) -> Units:
    """Units of a channel: of the value, its rate and its acceleration, and of loads."""
    return {unit: factor for dimension in _dimensions(channel) for unit, factor in QUANTITIES[dimension].items()}
