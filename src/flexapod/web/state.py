"""The machine at one pose, as the page draws and tabulates it: one answer for one change of a slider."""

from __future__ import annotations

from typing import Any

import numpy as np

import flexapod as fx
from flexapod.errors import SingularPoseError
from flexapod.hexapod import Hexapod
from flexapod.kinematics import limit_excess
from flexapod.pose import Pose
from flexapod.web.asking import Question

NEAR_SINGULAR = 1e6  #: cond(H) above which the page warns: a leg force then errs by 1e6 times what a length does


def snapshot(question: Question) -> dict[str, Any]:
    """Geometry, frequencies, modes, forces and limits at a pose. Raises PoseError where no leg can take it."""
    hexapod, pose, joint = question.hexapod, question.pose, question.joint
    modes = fx.natural_modes(hexapod, pose, joint)
    condition = float(fx.condition_number(hexapod, pose))
    angles = fx.joint_angles(hexapod, pose)
    limits = _limits(hexapod, pose)
    static, damped = _static(hexapod, pose), _damped(question)
    repeated = fx.near_repeated(modes.omega)
    return {
        "pose": list(question.six),
        "geometry": _geometry(hexapod, pose),
        "omega": modes.omega,
        "frequency": modes.omega / (2 * np.pi),
        "index": modes.omega[0],
        "condition": condition,
        "shape": modes.shape.T,
        "modes": [{"text": d.text, "dominant": d.dominant, "share": d.share} for d in _described(question)],
        "strain": _strain(question),
        "damped": damped,
        "sampling_time": fx.sampling_time(modes.omega[-1]),
        "legs": {
            "length": fx.inverse_kinematics(hexapod, pose),
            "universal": np.round(np.degrees(angles.universal), 9) + 0.0,
            "spherical": np.round(np.degrees(angles.spherical), 9) + 0.0,
            **static,
        },
        "leg_distance": fx.leg_distance(hexapod, pose),
        "limits": limits,
        "warnings": _warnings(condition, repeated, static, damped),
        "near_repeated": repeated,
    }


def _geometry(hexapod: Hexapod, pose: Pose) -> dict[str, Any]:
    return {
        "base": hexapod.base_joints,
        "axes": hexapod.universal_axes,
        "platform": hexapod.platform_joints,
        "mass_center": hexapod.platform_mass_center,
        "position": pose.position,
        "matrix": pose.matrix,
    }


def _described(question: Question) -> list[fx.ModeDescription]:
    return fx.describe_modes(question.hexapod, question.pose, question.joint)


def _strain(question: Question) -> np.ndarray:
    """Share of each leg in each mode's strain energy, modes first."""
    return fx.energy_shares(question.hexapod, question.pose, question.joint).strain.T


def _static(hexapod: Hexapod, pose: Pose) -> dict[str, Any]:
    """Leg forces that hold the pose, and the energy their springs store."""
    try:
        force = fx.hold(hexapod, pose).leg_force
    except SingularPoseError as error:
        return {"force": None, "energy": None, "why": str(error)}
    return {"force": force, "energy": 0.5 * force**2 / hexapod.legs.stiffness, "why": ""}


def _damped(question: Question) -> dict[str, Any] | None:
    """Modes of the exact tangent at rest, with gravity, preload and damping; None where no rest exists."""
    try:
        modes = fx.linearise(question.hexapod, question.pose, joint=question.joint).modes()
    except SingularPoseError:
        return None
    return {"omega": modes.omega, "frequency": modes.pole.imag / (2 * np.pi), "ratio": modes.damping_ratio}


def _limits(hexapod: Hexapod, pose: Pose) -> dict[str, Any]:
    """Which legs exceed what, in words for each leg, and whether anything is limited at all."""
    by_leg: list[list[str]] = [[] for _ in range(6)]
    quantities = limit_excess(hexapod, pose)
    for quantity in quantities:
        value = np.atleast_1d(quantity.value)
        name, unit = quantity.what.rsplit(" ", 1)
        least, most = np.broadcast_to(quantity.least, value.shape), np.broadcast_to(quantity.most, value.shape)
        if value.size != 6:
            continue
        for leg in np.flatnonzero((value < least) | (value > most)):
            side, bound = ("below", least[leg]) if value[leg] < least[leg] else ("above", most[leg])
            by_leg[leg].append(f"{name} {value[leg]:.4g} {unit} is {side} {bound:.4g} {unit}")
    check = fx.check_limits(hexapod, pose)
    return {"any": bool(quantities), "ok": bool(check.ok), "exceeded": list(check.exceeded), "by_leg": by_leg}


def _warnings(
    condition: float, repeated: list[tuple[int, int]], static: dict[str, Any], damped: dict[str, Any] | None
) -> list[str]:
    words = []
    if not condition < NEAR_SINGULAR:
        words.append(f"This pose is singular or nearly so: cond(H) is {condition:.3g}. The legs cannot hold it.")
    elif static["why"]:
        words.append(static["why"])
    if repeated:
        pairs = ", ".join(f"{i + 1} and {j + 1}" for i, j in repeated)
        words.append(f"Modes {pairs} nearly repeat: their shapes are any mixture of the two.")
    if damped is not None and np.any(damped["ratio"] < -1e-9):
        words.append("With gravity and preload a motion grows by itself: this pose is not stable at rest.")
    return words
