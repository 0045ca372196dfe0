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

PERIODS = 10
WANTED = 0.01
STEPS = (1e-4, 5e-5, 3e-5, 2e-5, 1e-5, 5e-6)  # s; it is not stable at 2e-4


def machine() -> tuple[fx.Hexapod, fx.Pose]:
    """Manipulator II with leg parts that a rigid body can have."""
    small = 1e-5 * np.eye(3)
    hexapod = fx.load("mukherjee-ii").replace({"legs.lower.inertia": small, "legs.upper.inertia": small})
    return hexapod, fx.home_pose(hexapod)


def main() -> None:
    """Print the first step that is good enough, for the lowest and the highest mode."""
    hexapod, pose = machine()
    for integrator in ("Euler", "implicitfast", "RK4"):
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
    model = mujoco.MjModel.from_xml_string(_xml(hexapod, pose, integrator, step))
    data = mujoco.MjData(model)
    data.xfrc_applied[model.body("platform").id] = 1e-6 * omega**2 * (J @ shape)
    weights = J @ shape
    mujoco.mj_forward(model, data)
    duration = max(PERIODS * 2 * np.pi / omega, 0.02)
    seen = np.empty(round(duration / step))
    began = time.process_time()
    for i in range(seen.size):
        mujoco.mj_step(model, data)
        moved = np.concatenate([data.qpos[:3] - pose.position, 2 * data.qpos[4:7]])  # small angles
        seen[i] = moved @ weights
    seconds = (time.process_time() - began) / duration
    return _frequency(seen, step) / omega - 1, seconds


def _frequency(seen: Any, step: float) -> float:
    """Angular frequency from the first to the last upward crossing of the mean."""
    x = seen - seen.mean()
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    if up.size < 3 or not np.isfinite(x).all():
        return np.nan
    at = up - x[up] / (x[up + 1] - x[up])
    return 2 * np.pi * (up.size - 1) / ((at[-1] - at[0]) * step)


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
