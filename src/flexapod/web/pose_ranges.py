"""Where a page starts in the workspace of a design: its home pose, and the ranges of the sliders around it."""

from __future__ import annotations

import numpy as np

from flexapod.design.hexapod import Hexapod
from flexapod.web.answers import Drawn, PoseBox
from flexapod.web.geometry import in_degrees, mean_leg_length, mean_radius


def home(hexapod: Hexapod) -> list[float]:
    """The home pose in m and degrees; if the design has none, the platform over the base at a usual height."""
    if hexapod.home is not None:
        return in_degrees([*hexapod.home.position, *hexapod.home.rpy])
    base, platform = hexapod.base_joints, hexapod.platform_joints
    centre = base.mean(axis=0) - platform.mean(axis=0)
    height = 1.2 * mean_radius(base)
    if hexapod.limits.leg_length is not None:
        offset = np.linalg.norm((platform + centre - base)[:, :2], axis=1)
        middle = np.asarray(hexapod.limits.leg_length).reshape(-1, 2).mean(axis=1)
        height = float(np.sqrt(np.maximum(middle**2 - offset**2, (0.2 * middle) ** 2)).mean())
    x, y, z = centre.tolist()
    return [x, y, z + height, 0.0, 0.0, 0.0]


def drawn(hexapod: Hexapod, at: list[float] | None = None) -> Drawn:
    """What a 3-D view must know of a design. at: a pose in m and degrees to be home, where it is not the design's."""
    start = home(hexapod) if at is None else at
    return {"name": hexapod.name, "home": start, "box": box(hexapod, start), "leg": mean_leg_length(hexapod, start)}


def box(hexapod: Hexapod, start: list[float] | None = None) -> PoseBox:
    """Ranges of the pose that the sliders and sweeps start with, m and degrees, around home.

    As far as the legs' stroke takes the platform where the design limits it, otherwise a quarter of a leg's length.
    """
    start = home(hexapod) if start is None else start
    at, reach = np.array(start), 0.25 * mean_leg_length(hexapod, start)
    if hexapod.limits.leg_length is not None:
        pairs = np.asarray(hexapod.limits.leg_length).reshape(-1, 2)
        reach = min(reach, 0.6 * float((pairs[:, 1] - pairs[:, 0]).mean()))
    turn = min(30.0, float(np.degrees(reach / max(mean_radius(hexapod.platform_joints), 1e-9))))
    span = np.array([_rounded(v) for v in (reach, reach, reach, turn, turn, turn)])
    return {"low": np.round(at - span, 9).tolist(), "high": np.round(at + span, 9).tolist()}


def _rounded(value: float) -> float:
    """Two significant digits, so that sliders end at numbers people read."""
    return float(f"{value:.1e}")
