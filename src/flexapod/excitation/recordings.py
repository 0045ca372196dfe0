"""Recorded motions, loads and commands as excitations: arrays or CSV files, splined."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly, make_interp_spline

from flexapod.conventions import AXES, LEGS, ROTATIONS, Array
from flexapod.design.units import UNITS
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, sampled_term
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
    times: ArrayLike, values: ArrayLike, channels: str | Sequence[str], recorded: Recorded = "value"
) -> Excitation:
    """A recording as an excitation that begins with its first sample at t = 0.

    times: (n,) s, ascending; values: (n,) or (n, k) for k channels. recorded: "value" (the channel's own unit), or its
    "velocity" or "acceleration", integrated from rest at zero. Values are splined by quintics, derivatives by cubics,
    so that acceleration is smooth.

    Raises: ArgumentError, which names the sample, for NaN, times that do not ascend, gaps, and less than six samples.
    Source: own, with SciPy's splines.
    """
    names = [channels] if isinstance(channels, str) else list(channels)
    if recorded not in INTEGRATIONS:
        raise ArgumentError(f"recorded is {recorded!r}; it must be one of {', '.join(INTEGRATIONS)}.")
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


def read_time_series(path: str | Path, recorded: Recorded | None = None) -> Excitation:
    """A recording from the CSV file at `path`: a header with `time` and channels, then numbers.

    Channels are x, y, z, roll, pitch, yaw or leg1 to leg6, with their unit behind them if it is not SI, as `z_um`,
    `roll_deg`, `x_mm_per_s2` or `time_ms`. recorded: as in `time_series`; by default what the units say. Lines that
    begin with # are left out.

    Raises: ArgumentError as `time_series`, and for what cannot be read.
    Source: own.
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
        recorded or (said or {"value"}).pop(),
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
