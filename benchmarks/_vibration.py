"""An experiment that any simulator can do: a constant wrench along a mode, put on a resting machine, makes it ring."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

import flexapod as fx

PERIODS, SHORTEST = 10, 0.02  # what is simulated: so many periods, and at least so many seconds
WANTED = 0.01  # relative error of a frequency
AMPLITUDE = 1e-6  # m


class Vibration(NamedTuple):
    """omega: of the mode, rad/s. wrench: force (N) and moment (N m) on the platform. weights: of the displacement's six
    numbers, so that their sum shows that mode alone. duration: s.
    """

    hexapod: fx.Hexapod
    pose: fx.Pose
    omega: float
    wrench: Any
    weights: Any
    duration: float


def machine() -> tuple[fx.Hexapod, fx.Pose]:
    """Manipulator II with leg parts that a rigid body can have, as other tools refuse the paper's; without friction in
    the spherical joints, for which MuJoCo would need six more bodies.
    """
    hexapod = fx.interchange.nearest_physical(fx.load("mukherjee-ii")).replace({"legs.damping.spherical": 0.0})
    return hexapod, fx.home_pose(hexapod)


def vibration(hexapod: fx.Hexapod, pose: fx.Pose, mode: int) -> Vibration:
    """The experiment for a mode of the tangent at rest, counted from 0."""
    modes = fx.linearise(hexapod, pose).modes()
    omega = float(modes.omega[mode])
    weights = fx.equations_of_motion(hexapod, pose).J_p @ modes.shape[:, mode].real
    duration = max(PERIODS * 2 * np.pi / omega, SHORTEST)
    return Vibration(hexapod, pose, omega, AMPLITUDE * omega**2 * weights, weights, duration)


def ring(seen: Any, step: float) -> tuple[float, float]:
    """Angular frequency, from the first to the last upward crossing of the mean, and the amplitude in the last fifth;
    NaN if it does not ring.
    """
    x = seen - seen.mean()
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    if up.size < 3 or not np.isfinite(x).all():
        return np.nan, np.nan
    at = up - x[up] / (x[up + 1] - x[up])
    omega = 2 * np.pi * (up.size - 1) / ((at[-1] - at[0]) * step)
    last = x[-x.size // 5 :]
    phase = omega * step * np.arange(last.size)
    parts = np.linalg.lstsq(np.stack([np.cos(phase), np.sin(phase), np.ones(last.size)], axis=1), last, rcond=None)[0]
    return omega, float(np.hypot(*parts[:2]))


def own_run(v: Vibration) -> fx.simulation.SimulationRun:
    """The experiment for Flexapod."""
    x, y, z = (fx.excitation.polynomial(channel, [1.0]) for channel in "xyz")
    force, moment = (a * x + b * y + c * z for a, b, c in np.split(v.wrench, 2))
    return fx.simulation.SimulationRun(v.hexapod, v.pose, force=force, moment=moment)
