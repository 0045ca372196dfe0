"""The machine at one pose, as the page draws and tabulates it: one answer for one change of a slider."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.control.sampling_rate import sampling_time
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics.cautions import pose_cautions, unitless_condition
from flexapod.mechanics.kinematics import (
    condition_number,
    in_words,
    inverse_kinematics,
    joint_angles,
    leg_distance,
    limit_excess,
)
from flexapod.mechanics.linearisation import DampedModes, linearise
from flexapod.mechanics.modes import ModeDescription, describe_modes, energy_shares, natural_modes, near_repeated
from flexapod.pose import Pose
from flexapod.web.requests import Question


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
        "damped": None if damped is None else _damped(damped),
        "sampling_time": sampling_time(modes.omega[-1]),
        "legs": {
            "universal": np.round(np.degrees(angles.universal), 9) + 0.0,
            "spherical": np.round(np.degrees(angles.spherical), 9) + 0.0,
            **static,
        },
        "leg_distance": leg_distance(hexapod, pose),
        "limits": limits,
        "warnings": _warnings(question, modes.omega, damped),
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


def _at_rest(question: Question) -> tuple[dict[str, Any], DampedModes | None]:
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
    return static, modes


def _damped(modes: DampedModes) -> dict[str, Any]:
    return {"omega": modes.omega, "frequency": modes.pole.imag / (2 * np.pi), "ratio": modes.damping_ratio}


def _limits(hexapod: Hexapod, pose: Pose) -> dict[str, Any]:
    """What is exceeded, in words, in all and by leg, and whether anything is limited at all."""
    quantities = limit_excess(hexapod, pose)
    words = [word for quantity in quantities for word in in_words(quantity)]
    by_leg = [[word.split(": ", 1)[1] for word in words if word.startswith(f"leg {leg}: ")] for leg in range(1, 7)]
    return {"any": bool(quantities), "ok": not words, "exceeded": words, "by_leg": by_leg}


def _warnings(question: Question, omega: np.ndarray, damped: DampedModes | None) -> list[str]:
    """The cautions about the pose, without those that the page shows elsewhere: limits, and the design's own."""
    hexapod, pose = question.hexapod, question.pose
    found = pose_cautions(hexapod, pose, omega, unitless_condition(hexapod, pose), damped)
    return [caution.text for caution in found if caution.code not in ("limit", "design")]
