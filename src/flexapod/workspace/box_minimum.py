"""The least index over a box, quickly: from the lowest poses of a sweep downhill, all of them at once."""

from __future__ import annotations

import numpy as np

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.workspace.pose_sets import Box

_STARTS = 16
_STEPS = 14
_LIMITS = np.concatenate([np.zeros(36), np.tile([-np.inf, np.inf], 6), [np.inf, np.inf, -np.inf]])


def descend(hexapod: Hexapod, universal: bool, box: Box, rows: Array, omega_1: Array) -> float:
    """The lowest frequency found, rad/s, by projected steps along exact gradients from the lowest poses of a sweep.

    Good to a few parts in a thousand where `worst_pose` is exact: for comparing designs, not for vouching for one.
    """
    width = box.high - box.low
    pose = rows[np.argsort(omega_1)[:_STARTS]].copy()
    value, slope = _kernel(hexapod, universal, pose)
    reach = np.full(len(pose), 0.05)  # of a step, in widths of the box
    for _ in range(_STEPS):
        downhill = -slope * width
        size = np.linalg.norm(downhill, axis=1)
        step = downhill * width * (reach / np.where(size > 0, size, 1.0))[:, None]
        trial = np.clip(pose + step, box.low, box.high)
        new, new_slope = _kernel(hexapod, universal, trial)
        better = new < value
        pose[better], value[better], slope[better] = trial[better], new[better], new_slope[better]
        reach = np.where(better, reach * 1.6, reach * 0.35)
    return float(value.min())


def _kernel(hexapod: Hexapod, universal: bool, rows: Array) -> tuple[Array, Array]:
    wanted = _core.SWEEP["omega_1"] | _core.SWEEP["omega_1_gradient"]
    found = _core.sweep(hexapod.packed, universal, rows, wanted, _LIMITS, 1)
    return np.nan_to_num(found["omega_1"]), np.nan_to_num(found["omega_1_gradient"])
