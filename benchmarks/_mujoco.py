"""MuJoCo on manipulator II: the step it needs for natural frequencies to 1 %, and its time then.

Six legs of two hinges and a slide with the leg's spring, tied to a free platform by `connect` constraints, as stiff as
the step allows. The appendix's leg inertias, which no rigid body has and MuJoCo refuses, are replaced by small ones in
both codes. A constant wrench along a mode is put on the resting machine; the frequency is that of what follows.
"""

from __future__ import annotations

import time
from typing import Any

import mujoco
import numpy as np

import flexapod as fx
from benchmarks._vibration import WANTED, Vibration, machine, ring, vibration

INTEGRATORS = ("Euler", "implicitfast", "RK4")
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
    seen, qpos = np.empty(run.steps), run.data.qpos
    for i in range(seen.size):
        mujoco.mj_step(run.model, run.data)
        seen[i] = np.concatenate([qpos[:3] - v.pose.position, 2 * qpos[4:7]]) @ v.weights  # small angles
    return seen


def model(hexapod: fx.Hexapod, pose: fx.Pose, integrator: str, step: float) -> mujoco.MjModel:
    """The machine at rest at a pose."""
    return mujoco.MjModel.from_xml_string(_xml(hexapod, pose, integrator, step))


def _xml(hexapod: fx.Hexapod, pose: fx.Pose, integrator: str, step: float) -> str:
    rest = fx.hold(hexapod, pose)
    legs = "".join(_leg(hexapod, pose, i, rest.leg_force[i]) for i in range(6))
    stiff = f'anchor="0 0 0" solref="{2 * step} 1" solimp="0.9999 0.9999 0.001"'
    ties = "".join(f'<connect body1="upper{i}" body2="platform" {stiff}/>' for i in range(6))
    platform = (
        f'<body name="platform" pos="{_text(pose.position)}"><freejoint/>'
        f"{_body(hexapod.platform_mass, hexapod.platform_mass_center, hexapod.platform_inertia)}</body>"
    )
    return (
        f'<mujoco><option timestep="{step}" integrator="{integrator}" gravity="{_text(hexapod.gravity)}" '
        f'solver="Newton" tolerance="1e-14" iterations="100"/><worldbody>{platform}{legs}</worldbody>'
        f"<equality>{ties}</equality></mujoco>"
    )


def _leg(hexapod: fx.Hexapod, pose: fx.Pose, i: int, force: float) -> str:
    start, k = hexapod.base_joints[i], hexapod.universal_axes[i]
    S = pose.position + pose.matrix @ hexapod.platform_joints[i] - start
    length = np.linalg.norm(S)
    s = S / length
    y = np.cross(k, s) / np.linalg.norm(np.cross(k, s))
    axes = np.column_stack([s, y, np.cross(s, y)])
    parts = hexapod.legs
    damping = parts.damping
    inertials = [_body(part.mass[i], part.mass_center[i], part.inertia[i]) for part in (parts.lower, parts.upper)]
    return (
        f'<body name="lower{i}" pos="{_text(start)}" xyaxes="{_text([*axes[:, 0], *axes[:, 1]])}">'
        f'<joint type="hinge" axis="{_text(axes.T @ k)}" damping="{damping.universal[i]}"/>'
        f'<joint type="hinge" axis="0 1 0" damping="{damping.universal[i]}"/>{inertials[0]}'
        f'<body name="upper{i}" pos="{length} 0 0"><joint type="slide" axis="1 0 0" stiffness="{parts.stiffness[i]}" '
        f'springref="{force / parts.stiffness[i]}" damping="{damping.prismatic[i]}"/>{inertials[1]}</body></body>'
    )


def _body(mass: float, center: Any, inertia: Any) -> str:
    six = np.asarray(inertia)[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    return f'<inertial mass="{mass}" pos="{_text(center)}" fullinertia="{_text(six)}"/>'


def _text(numbers: Any) -> str:
    return " ".join(f"{x:.17g}" for x in numbers)
