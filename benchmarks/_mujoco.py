"""MuJoCo on manipulator II: the step it needs for natural frequencies to 1 %, and its time then.

The model is that of `fx.write_mjcf` without its drawing, constraints as stiff as the step allows. The appendix's leg
inertias, which no rigid body has and MuJoCo refuses, are replaced by the nearest ones in both codes, and the spherical
joints' friction, for which MuJoCo needs six more bodies, is left out. A constant wrench along a mode is put on the
resting machine; the frequency is that of what follows.
"""

from __future__ import annotations

import time
from typing import Any

import mujoco
import numpy as np

import flexapod as fx
from flexapod.interchange.mjcf import mjcf

PERIODS = 10
WANTED = 0.01
STEPS = (1e-4, 5e-5, 3e-5, 2e-5, 1e-5, 5e-6)  # s; it is not stable at 2e-4


INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
}


def machine() -> tuple[fx.Hexapod, fx.Pose]:
    """Manipulator II with leg parts that a rigid body can have."""
    hexapod = fx.nearest_physical(fx.load("mukherjee-ii")).replace({"legs.damping.spherical": 0.0})
    return hexapod, fx.home_pose(hexapod)


def main() -> None:
    """Print the first step that is good enough, for the lowest and the highest mode."""
    hexapod, pose = machine()
    for integrator in INTEGRATORS:
        for mode, name in ((0, "lowest"), (5, "highest")):
            for step in STEPS:
                error, seconds = trial(hexapod, pose, integrator, step, mode)
                if abs(error) < WANTED:
                    break
            print(
                f"  MuJoCo {integrator:12s} {name:7s} frequency off by {error:+.1%} at {step:g} s: "
                f"{seconds:.3f} s per simulated second"
            )


def trial(hexapod: fx.Hexapod, pose: fx.Pose, integrator: str, step: float, mode: int) -> tuple[float, float]:
    """Relative error of a natural frequency, and CPU time per simulated second."""
    modes = fx.linearise(hexapod, pose).modes()
    omega, shape = float(modes.omega[mode]), modes.shape[:, mode].real
    J = fx.equations_of_motion(hexapod, pose).J_p
    model = _model(mjcf(hexapod, pose, step))
    model.opt.integrator = INTEGRATORS[integrator]
    data = mujoco.MjData(model)
    at = model.joint("platform").qposadr[0]
    data.xfrc_applied[model.body("platform").id] = 1e-6 * omega**2 * (J @ shape)
    weights = J @ shape
    mujoco.mj_forward(model, data)
    duration = max(PERIODS * 2 * np.pi / omega, 0.02)
    seen = np.empty(round(duration / step))
    began = time.process_time()
    for i in range(seen.size):
        mujoco.mj_step(model, data)
        moved = np.concatenate([data.qpos[at : at + 3] - pose.position, 2 * data.qpos[at + 4 : at + 7]])  # small angles
        seen[i] = moved @ weights
    seconds = (time.process_time() - began) / duration
    return _frequency(seen, step) / omega - 1, seconds


def _model(text: str) -> Any:
    """The model without the shapes that are only looked at."""
    spec = mujoco.MjSpec.from_string(text)
    for geom in list(spec.geoms):
        spec.delete(geom)
    return spec.compile()


def _frequency(seen: Any, step: float) -> float:
    """Angular frequency from the first to the last upward crossing of the mean."""
    x = seen - seen.mean()
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    if up.size < 3 or not np.isfinite(x).all():
        return np.nan
    at = up - x[up] / (x[up + 1] - x[up])
    return 2 * np.pi * (up.size - 1) / ((at[-1] - at[0]) * step)
