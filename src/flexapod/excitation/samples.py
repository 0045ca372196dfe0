"""The samples of a recording: what is wrong with them is told by place, trends and drift are taken out on request."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, one_of, positive
from flexapod.conventions import Array
from flexapod.errors import ArgumentError

Trend = Literal["first", "mean", "linear"]
TRENDS: tuple[Trend, ...] = ("first", "mean", "linear")

GAP = 1.5  # of the usual spacing: a sample is missing
UNEVEN = 0.01  # of the usual spacing: as even as a filter needs
FEWEST_FILTERED = 16  # samples: a filter runs beyond both ends by a reflected piece
TURNS = 10  # changes of sign about the mean, from which a recording is a vibration and no single move
DRIFTS = 10.0  # times the motion that is not slow
QUARTER = np.pi / 2  # rad: no smooth motion turns so far in a sample


@dataclass(frozen=True)
class Samples:
    """Samples of some columns, (n, k) in SI units, with the columns' titles and, from a file, its lines and name."""

    times: Array
    values: Array
    titles: Sequence[str]
    lines: Sequence[int] = ()
    file: str = ""

    def place(self, i: int) -> str:
        """Where sample i is, in words."""
        return f"sample {i + 1} of {self.times.size}" + (f" (line {self.lines[i]})" if self.lines else "")

    def origin(self, k: int) -> str:
        """The column of a file that an excitation is from, in words."""
        return f"{self.file}, column {self.titles[k]}" if self.file else ""


def checked(times: ArrayLike, values: ArrayLike, titles: Sequence[str], lines: Sequence[int], file: str) -> Samples:
    """Samples without a hole in them. Raises ArgumentError that names the first bad one."""
    try:
        t, x = floats(times), floats(values)
    except (TypeError, ValueError):
        raise ArgumentError("times and values must hold numbers; one of them is something else.") from None
    if x.ndim == 1:
        x = x[:, None]
    if t.ndim != 1 or x.shape != (t.size, len(titles)):
        raise ArgumentError(f"times have shape {t.shape} and values {x.shape}; (n,) and (n, {len(titles)}) are needed.")
    if t.size < 6:
        raise ArgumentError(f"the recording has {t.size} samples; six or more are needed for a smooth spline.")
    found = Samples(t, x, titles, lines, file)
    for name, column in (("time", t), *zip(titles, x.T, strict=True)):
        bad = np.flatnonzero(~np.isfinite(column))
        if bad.size:
            raise ArgumentError(
                f"{name} is {column[bad[0]]} at {found.place(bad[0])}; all samples must be finite. "
                "Fill the missing ones, or cut the recording there."
            )
    steps = np.diff(t)
    back = np.flatnonzero(steps <= 0)
    if back.size:
        i = back[0]
        raise ArgumentError(
            f"time goes from {t[i]:.9g} to {t[i + 1]:.9g} s at {found.place(i + 1)}; it must ascend. Sort the "
            "recording and take out repeated samples."
        )
    usual = np.median(steps)
    gaps = np.flatnonzero(steps > GAP * usual)
    if gaps.size:
        i = gaps[0]
        raise ArgumentError(
            f"the recording has {gaps.size} gap{'s' if gaps.size > 1 else ''}: nothing between {t[i]:.9g} and "
            f"{t[i + 1]:.9g} s, {found.place(i + 1)}, where samples are usually {usual:.4g} s apart. Fill it, or cut "
            "the recording there."
        )
    return replace(found, times=t - t[0])


def unwrapped(samples: Samples, k: int) -> Samples:
    """An angle that goes on where it was written past a half turn. Raises ArgumentError where it jumps all the same."""
    values = samples.values.copy()
    values[:, k] = np.unwrap(values[:, k])
    jumps = np.flatnonzero(np.abs(np.diff(values[:, k])) > QUARTER)
    if jumps.size:
        i = jumps[0]
        before, after = np.degrees(samples.values[i : i + 2, k])
        raise ArgumentError(
            f"{samples.titles[k]} goes from {before:.6g} to {after:.6g} degrees at {samples.place(i + 1)}; no smooth "
            "motion turns so far from one sample to the next. Sample it finer; where pitch passes 90 degrees, roll and "
            "yaw jump by 180, and the motion needs other axes."
        )
    return replace(samples, values=values)


def without_trend(samples: Samples, trend: Trend | None, highpass: float | None) -> Samples:
    """Samples less their first value, their mean or a straight line, and less all that is slower than `highpass`."""
    values = samples.values
    if trend is not None:
        from scipy.signal import detrend  # slow to load, and few recordings need it

        one_of(trend, "detrend", TRENDS)
        kind = {"mean": "constant", "linear": "linear"}.get(trend)
        values = values - values[0] if kind is None else detrend(values, axis=0, type=kind)
    if highpass is not None:
        _check_even(samples)
        values = filtered(samples.times, values, highpass)
    return replace(samples, values=values)


def filtered(times: Array, values: Array, highpass: float) -> Array:
    """Values less what is slower than an angular frequency: a Butterworth filter of order two, forwards and back."""
    from scipy import signal

    edge, spacing = positive(highpass, "highpass", "rad/s"), float(np.median(np.diff(times)))
    if edge >= np.pi / spacing:
        raise ArgumentError(
            f"highpass is {edge:.6g} rad/s; it must be below {np.pi / spacing:.6g} rad/s, half the sampling frequency."
        )
    sections = signal.butter(2, edge, "highpass", fs=2 * np.pi / spacing, output="sos")
    return signal.sosfiltfilt(sections, values, axis=0)


def _check_even(samples: Samples) -> None:
    """A filter needs the same time between samples all along, and many."""
    steps = np.diff(samples.times)
    usual = float(np.median(steps))
    off = np.abs(steps - usual)
    if samples.times.size < FEWEST_FILTERED:
        raise ArgumentError(
            f"the recording has {samples.times.size} samples; highpass needs {FEWEST_FILTERED} or more. Leave it out."
        )
    if off.max() > UNEVEN * usual:
        i = int(off.argmax())
        raise ArgumentError(
            f"samples are {usual:.6g} s apart, but {steps[i]:.6g} s at {samples.place(i + 1)}; highpass needs even "
            "sampling. Resample the recording, or leave highpass out."
        )


def drift(times: Array, recorded: Array, displacement: Array, unit: str) -> str:
    """What the offset and slow noise of a recorded rate make of its integral, in words; "" where it is no matter.

    recorded: the samples; displacement: their integral. A cubic holds what is slower than the recording is long.
    """
    mean, spread = float(recorded.mean()), float(recorded.std())
    slow = np.polynomial.Polynomial.fit(times, displacement, 3)(times)
    travel, fast = float(np.ptp(slow)), float(np.std(displacement - slow))
    turns = np.count_nonzero(np.diff(np.sign(recorded - mean)))
    if abs(mean) <= spread and (turns < TURNS or travel <= DRIFTS * fast):
        return ""
    gravity = ", which holds gravity" if unit == "m/s2" and abs(abs(mean) / 9.81 - 1) < 0.05 else ""
    return (
        f"has a mean of {mean:.4g} {unit}{gravity}, and drifts by {travel:.3g} {unit.split('/')[0]} within "
        f"{times[-1]:.4g} s where it is integrated: displacements and their RMS are those of the drift. Take the mean "
        "out (detrend), or what is slow (highpass)"
    )
