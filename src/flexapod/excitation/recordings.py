"""Recorded motions, loads and commands as excitations: arrays or CSV files, splined."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PPoly, make_interp_spline

from flexapod.conventions import AXES, LEGS, Array
from flexapod.errors import ArgumentError
from flexapod.excitation.excitation import Excitation, sampled_term

Recorded = Literal["value", "velocity", "acceleration"]
INTEGRATIONS = {"value": 0, "velocity": 1, "acceleration": 2}
GAP = 1.5  # of the usual spacing: a sample is missing

TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}
TRAVELS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "in": 0.0254}
TURNS = {"rad": 1.0, "mrad": 1e-3, "urad": 1e-6, "deg": np.pi / 180}
LOADS = {"N": 1.0, "mN": 1e-3, "kN": 1e3, "N_m": 1.0, "N_mm": 1e-3, "kN_m": 1e3}
SUFFIXES: dict[str, Recorded] = {"_per_s2": "acceleration", "_per_s": "velocity", "": "value"}


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
    try:
        text = file.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ArgumentError(f"{file} cannot be read: {error}. Give a CSV file in UTF-8.") from error
    try:
        return parse_time_series(text, recorded)
    except ArgumentError as error:
        raise ArgumentError(f"{file}: {error}") from error


def parse_time_series(text: str, recorded: Recorded | None = None) -> Excitation:
    """A recording from the text of a CSV file; see `read_time_series`."""
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if not lines:
        raise ArgumentError("there is nothing in it; a header and at least six lines of numbers are needed.")
    header = [cell.strip() for cell in next(csv.reader([lines[0][1]]))]
    columns = [_column(cell) for cell in header]
    names = [column.channel for column in columns]
    if names.count("time") != 1 or len(names) < 2 or len(set(names)) < len(names):
        raise ArgumentError(f"the header is {', '.join(header)}; `time` and each channel are needed once.")
    said = {column.recorded for column in columns if column.recorded is not None}
    if len(said | ({recorded} - {None})) > 1:
        raise ArgumentError(f"the header is {', '.join(header)}; all columns must be {recorded or 'of one kind'}.")
    table = _numbers(lines[1:], len(names)) * [column.factor for column in columns]
    time = names.index("time")
    channels = [name for name in names if name != "time"]
    return time_series(table[:, time], np.delete(table, time, axis=1), channels, recorded or (said or {"value"}).pop())


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


class _Column(NamedTuple):
    channel: str
    factor: float  # to SI
    recorded: Recorded | None  # None where no unit says it


def _column(cell: str) -> _Column:
    name, _, unit = cell.partition("_")
    channel = name[3:] if name.startswith("leg") else name
    if channel == "time":
        units = TIMES
    elif channel in AXES + LEGS:
        units = TURNS if channel in AXES[3:] else TRAVELS | LOADS
    else:
        known = f"time, {', '.join(AXES)}, leg1 to leg6"
        raise ArgumentError(f"column {cell!r} is unknown; columns are {known}, with a unit as in z_um.")
    if not unit:
        return _Column(channel, 1.0, None)
    for suffix, recorded in SUFFIXES.items():
        base = unit.removesuffix(suffix)
        if unit.endswith(suffix) and base in units and not (suffix and base in LOADS | TIMES):
            return _Column(channel, units[base], None if channel == "time" else recorded)
    raise ArgumentError(
        f"column {cell!r} has the unit {unit!r}; it may be {', '.join(units)}, _per_s or _per_s2 of it."
    )


def _numbers(lines: list[tuple[int, str]], width: int) -> Array:
    table = np.empty((len(lines), width))
    for row, (number, line) in enumerate(lines):
        cells = next(csv.reader([line]))
        if len(cells) != width:
            raise ArgumentError(f"line {number} has {len(cells)} numbers; the header names {width} columns.")
        for column, cell in enumerate(cells):
            try:
                table[row, column] = float(cell) if cell.strip() else np.nan
            except ValueError:
                raise ArgumentError(f"line {number}: {cell.strip()!r} is not a number.") from None
    return table
