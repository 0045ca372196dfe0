"""Recorded motions, loads and commands as excitations: arrays or CSV files, splined."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly, make_interp_spline

from flexapod.checks import one_of
from flexapod.conventions import AXES, LEGS, ROTATIONS, Array
from flexapod.design.units import UNITS
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation
from flexapod.excitation.piecewise import sampled_term
from flexapod.tables import TIMES, Units, naming, parse_table, read_text

Recorded = Literal["value", "velocity", "acceleration"]
INTEGRATIONS = {"value": 0, "velocity": 1, "acceleration": 2}
GAP = 1.5  # of the usual spacing: a sample is missing

TRAVELS: Units = {**UNITS["length"], "nm": (1, 1e9)}
TURNS: Units = {**UNITS["angle"], "urad": (1, 1e6)}
LOADS: Units = {"N": (1, 1), "mN": (1, 1e3), "kN": (1e3, 1), "N_m": (1, 1), "N_mm": (1, 1e3), "kN_m": (1e3, 1)}
SUFFIXES: dict[str, Recorded] = {"_per_s2": "acceleration", "_per_s": "velocity", "": "value"}
#: What a title may be -> a channel, or "time".
NAMES = {"time": "time", "t": "time", **{axis: axis for axis in AXES}, **{f"leg{leg}": leg for leg in LEGS}}
FORM = (
    f"Columns are time, {', '.join(AXES)}, leg1 to leg6, with a unit as in z_um; a header with time and channels is "
    "needed, and at least six lines of numbers."
)


def time_series(
    times: ArrayLike, values: ArrayLike, axis: str | Sequence[str], *, recorded: Recorded = "value"
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

    Returns
    -------
    Excitation
        The recording as splines; it holds nothing after its last sample.

    Raises
    ------
    ArgumentError
        If a sample is not finite, the times do not ascend or have a gap (the message names the sample), there are fewer
        than six samples, or a name is unknown.

    See Also
    --------
    read_time_series : The same from a CSV file.

    Notes
    -----
    Values are interpolated by splines of degree five, derivatives by cubic ones, so that the acceleration is smooth.

    Examples
    --------
    >>> times = np.linspace(0, 1, 101)
    >>> shaken = fx.excitation.time_series(times, 1e-3 * np.sin(10 * times), "z")
    >>> round(float(shaken.evaluate(0.5)[0][2]), 6)
    -0.000959
    """
    names = [axis] if isinstance(axis, str) else list(axis)
    one_of(recorded, "recorded", INTEGRATIONS)
    t, x = _checked(times, values, names)
    t = t - t[0]
    spacing = float(np.median(np.diff(t)))
    total = Excitation()
    for name, column in zip(names, x.T, strict=True):
        spline = PPoly.from_spline(make_interp_spline(t, column, k=5 if recorded == "value" else 3))
        for _ in range(INTEGRATIONS[recorded]):
            spline = spline.antiderivative()
        kept = np.diff(spline.x) > 0  # knots are repeated at the ends
        total = total + sampled_term(name, spline.x[:-1][kept], spline.c[::-1, kept].T, spacing, float(t[-1]))
    return total


def read_time_series(path: str | Path, *, recorded: Recorded | None = None) -> Excitation:
    """Read a recording from a CSV file.

    Parameters
    ----------
    path : str or Path
        The file: a header with time and axes, then numbers.
    recorded : {"value", "velocity", "acceleration"}, optional
        What was recorded. Default: what the units in the header say, else the value.

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
    Columns are time (or t), x, y, z, roll, pitch, yaw, and leg1 to leg6, with their unit if it is not SI, as in
    ``z_um``, ``Roll [deg]``, ``x_mm_per_s2`` or ``time_ms``. Commas, semicolons or tabs separate; with the last two,
    numbers may have decimal commas. Lines that begin with # and columns named note or comment are left out.

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
        return parse_time_series(text, recorded)


def parse_time_series(text: str, recorded: Recorded | None = None) -> Excitation:
    """A recording from the text of a CSV file; see `read_time_series`."""
    table = parse_table(text, NAMES, FORM)
    header = ", ".join(column.title for column in table.columns)
    time = table.column("time")
    channels = [column for column in table.columns if column.name != "time"]
    if time is None or not channels:
        raise ArgumentError(f"the header is {header}; `time` and each channel are needed once.")
    said = {_recorded(column.unit) for column in channels if column.unit}
    if len(said | ({recorded} - {None})) > 1:
        raise ArgumentError(f"the header is {header}; all columns must be {recorded or 'of one kind'}.")
    values = np.column_stack([table.numbers(column, _units(column.name), finite=False) for column in channels])
    return time_series(
        table.numbers(time, TIMES, finite=False),
        values,
        [column.name for column in channels],
        recorded=recorded or (said or {"value"}).pop(),
    )


def _recorded(unit: str) -> Recorded:
    """What a unit says that a column holds."""
    return next(kind for suffix, kind in SUFFIXES.items() if unit.endswith(suffix))


def _units(channel: str) -> Units:
    """Units of a channel, of its rate and of its acceleration; those of loads have neither."""
    turned = channel in ROTATIONS
    rates = {
        f"{unit}{suffix}": factor for suffix in SUFFIXES for unit, factor in (TURNS if turned else TRAVELS).items()
    }
    return rates if turned else {**rates, **LOADS}


def _checked(times: ArrayLike, values: ArrayLike, names: list[str]) -> tuple[Array, Array]:
    t, x = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if x.ndim == 1:
        x = x[:, None]
    if t.ndim != 1 or x.shape != (t.size, len(names)):
        raise ArgumentError(f"times have shape {t.shape} and values {x.shape}; (n,) and (n, {len(names)}) are needed.")
    if t.size < 6:
        raise ArgumentError(f"the recording has {t.size} samples; six or more are needed for a smooth spline.")
    for name, column in (("time", t), *zip(names, x.T, strict=True)):
        bad = np.flatnonzero(~np.isfinite(column))
        if bad.size:
            raise ArgumentError(
                f"{name} is {column[bad[0]]} at sample {bad[0] + 1} of {t.size}; all samples must be finite. "
                "Fill the missing ones, or cut the recording there."
            )
    steps = np.diff(t)
    back = np.flatnonzero(steps <= 0)
    if back.size:
        i = back[0]
        raise ArgumentError(
            f"time goes from {t[i]:.9g} to {t[i + 1]:.9g} s at sample {i + 2}; it must ascend. Sort the recording and "
            "take out repeated samples."
        )
    usual = np.median(steps)
    gaps = np.flatnonzero(steps > GAP * usual)
    if gaps.size:
        i = gaps[0]
        raise ArgumentError(
            f"the recording has {gaps.size} gap{'s' if gaps.size > 1 else ''}: nothing between {t[i]:.9g} and "
            f"{t[i + 1]:.9g} s, where samples are usually {usual:.4g} s apart. Fill it, or cut the recording there."
        )
    return t, x
