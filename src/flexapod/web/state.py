"""The machine at one pose: what the page draws and tabulates after each change of a slider."""

from __future__ import annotations

import numpy as np

from flexapod.control.sampling_rate import sampling_time
from flexapod.conventions import LEGS, TWO_PI, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import SingularPoseError
from flexapod.mechanics import linearisation
from flexapod.mechanics.cautions import pose_cautions, unitless_condition
from flexapod.mechanics.joint_limits import in_words, joint_angles, leg_distance, limit_excess
from flexapod.mechanics.kinematics import condition_number, inverse_kinematics
from flexapod.mechanics.mode_shapes import describe_modes, energy_shares
from flexapod.mechanics.modes import natural_modes, near_repeated
from flexapod.pose import Pose
from flexapod.web.answers import DampedModes, Geometry, Limits, Snapshot, StaticLegs
from flexapod.web.requests import Question


def snapshot(question: Question) -> Snapshot:
    """Geometry, frequencies, modes, forces and limits at a pose. Raises PoseError if a leg cannot reach it."""
    hexapod, pose, joint = question.hexapod, question.pose, question.joint
    modes = natural_modes(hexapod, pose, joint=joint)
    described = describe_modes(hexapod, pose, joint=joint)
    angles = joint_angles(hexapod, pose)
    static, damped = _at_rest(question)
    return {
        "pose": list(question.six),
        "geometry": _geometry(hexapod, pose),
        "omega": modes.omega,
        "frequency": modes.omega / TWO_PI,
        "index": modes.omega[0],
        "condition": float(condition_number(hexapod, pose)),
        "shape": modes.shape.T,
        "modes": [{"text": mode.text, "dominant": mode.dominant, "share": mode.share} for mode in described],
        "strain": energy_shares(hexapod, pose, joint=joint).strain.T,
        "damped": None if damped is None else _damped(damped),
        "sampling_time": sampling_time(modes.omega[-1]),
        "legs": {
            "universal": np.round(np.degrees(angles.universal), 9) + 0.0,
            "spherical": np.round(np.degrees(angles.spherical), 9) + 0.0,
            **static,
        },
        "leg_distance": float(leg_distance(hexapod, pose)),
        "limits": _limits(hexapod, pose),
        "warnings": _warnings(question, modes.omega, damped),
        "near_repeated": near_repeated(modes.omega),
    }


def _geometry(hexapod: Hexapod, pose: Pose) -> Geometry:
    """Joints of the plates, and the pose."""
    return {
        "base": hexapod.base_joints,
        "axes": hexapod.universal_axes,
        "platform": hexapod.platform_joints,
        "mass_center": hexapod.platform_mass_center,
        "position": pose.position,
        "matrix": pose.matrix,
    }


def _at_rest(question: Question) -> tuple[StaticLegs, linearisation.DampedModes | None]:
    """Static leg forces at the pose, and the modes of the machine linearised there with gravity, preload and damping.

    At a singular pose there are neither.
    """
    hexapod, pose = question.hexapod, question.pose
    try:
        linear = linearisation.linearise(hexapod, pose, joint=question.joint)
    except SingularPoseError as error:
        length = inverse_kinematics(hexapod, pose)
        return {"length": length, "force": None, "energy": None, "why": str(error)}, None
    rest = linear.rest
    energy = 0.5 * rest.leg_force**2 / hexapod.legs.stiffness
    return {"length": rest.leg_length, "force": rest.leg_force, "energy": energy, "why": ""}, linear.modes()


def _damped(modes: linearisation.DampedModes) -> DampedModes:
    """Frequencies and damping ratios of the damped modes."""
    return {"omega": modes.omega, "frequency": modes.pole.imag / TWO_PI, "ratio": modes.damping_ratio}


def _limits(hexapod: Hexapod, pose: Pose) -> Limits:
    """The limits exceeded, in words, all and by leg, and whether the design has limits."""
    quantities = limit_excess(hexapod, pose)
    words = [word for quantity in quantities for word in in_words(quantity)]
    by_leg = [[word.split(": ", 1)[1] for word in words if word.startswith(f"leg {leg}: ")] for leg in LEGS]
    return {"any": bool(quantities), "ok": not words, "exceeded": words, "by_leg": by_leg}


def _warnings(question: Question, omega: Array, damped: linearisation.DampedModes | None) -> list[str]:
    """The cautions about the pose, without those that the page shows elsewhere: limits, and the design's own."""
    hexapod, pose = question.hexapod, question.pose
    found = pose_cautions(hexapod, pose, omega, unitless_condition(hexapod, pose), damped)
    return [caution.text for caution in found if caution.code not in ("limit", "design")]
