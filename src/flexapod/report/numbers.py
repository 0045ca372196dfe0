"""Numbers, poses and names as they are shown to people. Loads no NumPy, so that commands start at once."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flexapod.conventions import Array
    from flexapod.pose import Pose


DASH = "\u2013"


def shown(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits; powers of ten only where plain digits would be too long."""
    if value is None or math.isnan(value):
        return DASH
    if math.isinf(value):
        return "\u221e" if value > 0 else "-\u221e"
    value = float(f"{value:.{digits}g}")
    if value == 0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if -4 <= exponent <= 6:
        text = f"{value:.{max(0, digits - 1 - exponent)}f}"
    else:
        text = f"{value / 10.0**exponent:.{digits - 1}f}e{exponent}"
    return text


def brief(value: float, digits: int = 4) -> str:
    """As `shown`, without zeros at the end: for what is given, not measured."""
    text = shown(value, digits)
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def percent(share: float, digits: int = 0) -> str:
    """A share of 1 in percent."""
    if math.isnan(share):
        return DASH
    return f"{100 * share + 0.0:.{digits}f} %"


def without_rounding(values: Array, share: float = 1e-12) -> Array:
    """Zero for what is nothing but rounding beside the largest: symmetry that floating point breaks."""
    import numpy as np

    return np.where(np.abs(values) < share * np.nanmax(np.abs(values), initial=0.0), 0.0, values)


def pose_words(pose: Pose) -> str:
    """A pose in m and degrees."""
    x, y, z = (f"{value + 0.0:.6g}" for value in pose.position)
    turned = [math.degrees(angle) for angle in pose.rpy]
    words = f"x {x}, y {y}, z {z} m"
    if max(map(abs, turned)) > 1e-9:
        roll, pitch, yaw = (f"{0.0 if abs(value) < 1e-9 else value:.5g}" for value in turned)
        words += f", roll {roll}\u00b0, pitch {pitch}\u00b0, yaw {yaw}\u00b0"
    return words


def pose_numbers(pose: Pose) -> list[float]:
    """A pose as the six numbers of `--pose`: m and degrees."""
    return [*pose.position.tolist(), *(math.degrees(angle) for angle in pose.rpy)]


def six_words(pose: Array) -> str:
    """Six numbers (m, rad) in mm and degrees."""
    x, y, z = (brief(1e3 * v) for v in pose[:3])
    roll, pitch, yaw = (brief(math.degrees(v)) for v in pose[3:])
    return f"x {x}, y {y}, z {z} mm, roll {roll}, pitch {pitch}, yaw {yaw} deg"


def file_name(name: str) -> str:
    """A design's name as a file's: nothing in it that a file system or a shell could take amiss."""
    return re.sub(r"[^\w.-]+", "-", name).strip("-.") or "hexapod"
