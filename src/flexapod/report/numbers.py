"""Numbers as they are shown to people."""

from __future__ import annotations

import math

import numpy as np

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


def pose_words(pose: Pose) -> str:
    """A pose in m and degrees."""
    x, y, z = (f"{value + 0.0:.6g}" for value in pose.position)
    turned = np.degrees(pose.rpy)
    words = f"x {x}, y {y}, z {z} m"
    if np.abs(turned).max() > 1e-9:
        roll, pitch, yaw = (f"{value + 0.0:.5g}" for value in np.where(np.abs(turned) < 1e-9, 0.0, turned))
        words += f", roll {roll}\u00b0, pitch {pitch}\u00b0, yaw {yaw}\u00b0"
    return words
