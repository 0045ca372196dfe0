"""Checks of arguments. Each returns the value in its proper type, or raises ArgumentError with what is required."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Collection
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.errors import ArgumentError, shown


def is_masked(value: Any) -> bool:
    """Whether some entries of a value are masked; plain arrays do not load `numpy.ma`, which is slow, for it."""
    return isinstance(value, np.ndarray) and type(value) is not np.ndarray and bool(np.ma.is_masked(value))


def floats(value: Any, *, copy: bool = True) -> Array:
    """As float64 of any shape. Raises TypeError or ValueError for what is no number, or none that can be used.

    copy: where it is false, an array that is float64 already is given back itself.

    NumPy would leave out the mask of masked entries and the imaginary parts of complex ones, and cannot hold integers
    of hundreds of digits.
    """
    if is_masked(value):
        raise ValueError("some entries are masked")
    if isinstance(value, np.ndarray) and value.dtype.kind in "cmM":
        raise TypeError(f"numbers of the type {value.dtype}")
    try:
        return np.array(value, dtype=np.float64) if copy else np.asarray(value, dtype=np.float64)
    except OverflowError as error:
        raise ValueError("an integer too large for a number of this machine") from error


def number(value: Any, name: str, unit: str = "", *, need: str = "finite") -> float:
    """A number that is finite and, as `need` says, "finite", "> 0" or ">= 0"."""
    try:
        found = float(value)
    except (TypeError, ValueError, OverflowError):
        found = float("nan")
    holds = {"finite": True, "> 0": found > 0, ">= 0": found >= 0}[need]
    if isinstance(value, bool | np.bool_) or not (np.isfinite(found) and holds):
        required = "a finite number" if need == "finite" else f"finite and {need}"
        raise ArgumentError(f"{name} is {shown(value)}{' ' * bool(unit)}{unit}; it must be {required}.")
    return found


def instance(value: Any, kind: Any, name: str, how: str) -> None:
    """Raises ArgumentError for what is not of a kind; how: where one comes from, the end of a sentence."""
    if not isinstance(value, kind):
        raise ArgumentError(f"{name} is {shown(value)}; it must be a {kind.__name__}, {how}.")


def stop_asked(stop: Any) -> Callable[[], bool]:
    """The argument `stop`: what is asked whether to stop; where it is None, nothing ever says so."""
    if stop is None:
        return lambda: False
    if not callable(stop):
        raise ArgumentError(f"stop is {shown(stop)}; it must be a function that answers whether to stop, or None.")
    return stop


def positive(value: Any, name: str, unit: str = "") -> float:
    """A finite number > 0."""
    return number(value, name, unit, need="> 0")


def not_negative(value: Any, name: str, unit: str = "") -> float:
    """A finite number >= 0."""
    return number(value, name, unit, need=">= 0")


def whole(value: Any, name: str, least: int = 1) -> int:
    """A whole number, at least `least` and at most what a size may be."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise ArgumentError(f"{name} is {shown(value)}; it must be a whole number, at least {least}.")
    if value >= 2**63:
        raise ArgumentError(f"{name} is {shown(value)}; it must be less than 2^63.")
    return int(value)


def one_of(value: Any, name: str, choices: Collection[str]) -> str:
    """One of some words; the message names the nearest of them."""
    if isinstance(value, str) and value in choices:
        return value
    from difflib import get_close_matches  # needed for errors only

    near = get_close_matches(str(value).lower(), choices, n=1)
    hint = f" Did you mean {near[0]!r}?" if near else ""
    raise ArgumentError(f"{name} is {shown(value)}; it must be one of {', '.join(map(repr, choices))}.{hint}")


def numbers(value: ArrayLike, name: str, shape: tuple[int | None, ...] | None = (None,)) -> Array:
    """Finite float64 numbers of a shape, in which None stands for any size, or of any shape; a copy."""
    try:
        array = floats(value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} is {shown(value)}; it must hold numbers.") from None
    if shape is not None and not _fits(array.shape, shape):
        wanted = ", ".join("n" if size is None else str(size) for size in shape)
        raise ArgumentError(f"{name} has shape {array.shape}; it must have shape ({wanted}{',' * (len(shape) == 1)}).")
    if not np.isfinite(array).all():
        raise ArgumentError(f"{name} holds NaN or infinity; all its numbers must be finite.")
    return array


def _fits(found: tuple[int, ...], shape: tuple[int | None, ...]) -> bool:
    return len(found) == len(shape) and all(want in (None, size) for want, size in zip(shape, found, strict=True))


def several(value: Any) -> bool:
    """Whether a value is a sequence, where one number may stand as well."""
    return isinstance(value, tuple | list) or (isinstance(value, np.ndarray) and value.ndim > 0)


def thread_count(threads: int | None) -> int:
    """Threads to use: those asked for, or all that this process may have."""
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise ArgumentError(
            f"threads is {threads!r}; it must be a whole number, at least 1. Leave it out for all cores."
        )
    return threads


def level_outside() -> int:
    """Stack level of the first caller outside this package, for warnings."""
    package = Path(__file__).parent
    level = 1
    frame: FrameType | None = sys._getframe()
    while frame is not None and Path(frame.f_code.co_filename).is_relative_to(package):
        level, frame = level + 1, frame.f_back
    return level - 1
