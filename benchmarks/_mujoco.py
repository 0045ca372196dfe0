"""MuJoCo on manipulator II: the step it needs for natural frequencies to 1 %, and its time then.

The model is that of `fx.interchange.write_mjcf` without its drawing, constraints as stiff as the step allows. A
constant wrench along a mode is put on the resting machine; the frequency is that of what follows.
"""

from __future__ import annotations

import time
from typing import Any

import mujoco
import numpy as np

import flexapod as fx
from benchmarks._vibration import WANTED, Vibration, machine, ring, vibration
from flexapod.interchange.mjcf import mjcf

INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
}
STEPS = (1e-4, 5e-5, 3e-5, 2e-5, 1e-5, 5e-6)  # s; it is not stable at 2e-4


def main() -> None:
    """Print the first step that is good enough, for the lowest and the highest mode."""
    hexapod, pose = machine()
    for integrator in INTEGRATORS:
        for mode, name in ((0, "lowest"), (5, "highest")):
            v = vibration(hexapod, pose, mode)
            for step in STEPS:
                error = ring(ringing(v, integrator, step), step)[0] / v.omega - 1
                if abs(error) < WANTED:
                    break
            seconds = Simulation(v, integrator, step).cpu_seconds() / v.duration
            print(
                f"  MuJoCo {integrator:12s} {name:7s} frequency off by {error:+.1%} at {step:g} s: "
                f"{seconds:.3f} s per simulated second"
            )


class Simulation:
    """The experiment in MuJoCo, from rest."""

    def __init__(self, v: Vibration, integrator: str, step: float) -> None:
        self.model = model(v.hexapod, v.pose, integrator, step)
        self.data = mujoco.MjData(self.model)
        self.steps = round(v.duration / step)
        self.wrench = v.wrench

    def start(self) -> None:
        """Back to rest, with the wrench."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.xfrc_applied[self.model.body("platform").id] = self.wrench
        mujoco.mj_forward(self.model, self.data)

    def cpu_seconds(self) -> float:
        """Of the whole experiment, with nothing recorded."""
        self.start()
        began = time.process_time()
        mujoco.mj_step(self.model, self.data, self.steps)
        return time.process_time() - began


def ringing(v: Vibration, integrator: str, step: float) -> Any:
    """What the mode's weights see after every step."""
    run = Simulation(v, integrator, step)
    run.start()
    at = run.model.joint("platform").qposadr[0]
    seen, qpos = np.empty(run.steps), run.data.qpos[at : at + 7]
    for i in range(seen.size):
        mujoco.mj_step(run.model, run.data)
        seen[i] = np.concatenate([qpos[:3] - v.pose.position, 2 * qpos[4:7]]) @ v.weights  # small angles
    return seen


def model(hexapod: fx.Hexapod, pose: fx.Pose, integrator: str, step: float) -> mujoco.MjModel:
    """The machine at rest at a pose, without the shapes that are only looked at."""
    spec = mujoco.MjSpec.from_string(mjcf(hexapod, pose, step))
    for geom in list(spec.geoms):
        spec.delete(geom)
    found = spec.compile()
    found.opt.integrator = INTEGRATORS[integrator]
    return found
