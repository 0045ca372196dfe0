"""The machine at one pose, as the page draws and tabulates it: one answer for one change of a slider."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.control.sampling_rate import sampling_time
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.kinematics import (
    condition_number,
    in_words,
    inverse_kinematics,
    joint_angles,
    leg_distance,
    limit_excess,
)
from flexapod.mechanics.linearisation import linearise
from flexapod.mechanics.modes import ModeDescription, describe_modes, energy_shares, natural_modes, near_repeated
from flexapod.pose import Pose
from flexapod.web.requests import Question

NEAR_SINGULAR = 1e6  #: cond(H) above which the page warns: a leg force then errs by 1e6 times what a length does


def snapshot(question: Question) -> dict[str, Any]:
    """Geometry, frequencies, modes, forces and limits at a pose. Raises PoseError where no leg can take it."""
    hexapod, pose, joint = question.hexapod, question.pose, question.joint
    modes = natural_modes(hexapod, pose, joint=joint)
    condition = float(condition_number(hexapod, pose))
    angles = joint_angles(hexapod, pose)
    limits = _limits(hexapod, pose)
    static, damped = _at_rest(question)
    repeated = near_repeated(modes.omega)
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
        "sampling_time": sampling_time(modes.omega[-1]),
        "legs": {
            "universal": np.round(np.degrees(angles.universal), 9) + 0.0,
            "spherical": np.round(np.degrees(angles.spherical), 9) + 0.0,
            **static,
        },
        "leg_distance": leg_distance(hexapod, pose),
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


def _described(question: Question) -> list[ModeDescription]:
    return describe_modes(question.hexapod, question.pose, joint=question.joint)


def _strain(question: Question) -> np.ndarray:
    """Share of each leg in each mode's strain energy, modes first."""
    return energy_shares(question.hexapod, question.pose, joint=question.joint).strain.T


def _at_rest(question: Question) -> tuple[dict[str, Any], dict[str, Any] | None]:
    """Legs that hold the pose: lengths, forces, energy in their springs; and the exact tangent's modes there.

    These have gravity, preload and damping. No forces and no modes where nothing holds the pose.
    """
    hexapod, pose = question.hexapod, question.pose
    try:
        linear = linearise(hexapod, pose, joint=question.joint)
    except SingularPoseError as error:
        length = inverse_kinematics(hexapod, pose)
        return {"length": length, "force": None, "energy": None, "why": str(error)}, None
    rest, modes = linear.rest, linear.modes()
    energy = 0.5 * rest.leg_force**2 / hexapod.legs.stiffness
    static = {"length": rest.leg_length, "force": rest.leg_force, "energy": energy, "why": ""}
    damped = {"omega": modes.omega, "frequency": modes.pole.imag / (2 * np.pi), "ratio": modes.damping_ratio}
    return static, damped


def _limits(hexapod: Hexapod, pose: Pose) -> dict[str, Any]:
    """What is exceeded, in words, in all and by leg, and whether anything is limited at all."""
    quantities = limit_excess(hexapod, pose)
    words = [word for quantity in quantities for word in in_words(quantity)]
    by_leg = [[word.split(": ", 1)[1] for word in words if word.startswith(f"leg {leg}: ")] for leg in range(1, 7)]
    return {"any": bool(quantities), "ok": not words, "exceeded": words, "by_leg": by_leg}


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
