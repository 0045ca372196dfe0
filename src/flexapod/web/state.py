"""The machine at one pose: what the page draws and tabulates after each change of a slider."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexapod.conventions import LEGS, TWO_PI, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.at_rest import PoseState, pose_state
from flexapod.mechanics.cautions import GRAVE, Tangent
from flexapod.mechanics.joint_limits import joint_angles, leg_distance, limit_excess
from flexapod.mechanics.kinematics import condition_number, inverse_kinematics
from flexapod.mechanics.mode_shapes import energy_shares
from flexapod.mechanics.modes import advised_sampling_time, near_repeated
from flexapod.mechanics.springs import axial_stiffness
from flexapod.pose import Pose
from flexapod.web.answers import DampedModes, Geometry, Limits, LoneMode, Snapshot, StaticLegs
from flexapod.web.geometry import pose_at


def snapshot(hexapod: Hexapod, six: Sequence[float], joint: JointModel = "universal") -> Snapshot:
    """Geometry, frequencies, modes, forces and limits at a pose. Raises PoseError if a leg cannot reach it.

    six: x, y, z in m, roll, pitch, yaw in degrees.
    """
    pose = pose_at(six)
    state = pose_state(hexapod, pose, joint=joint)
    modes = state.modes
    strain = energy_shares(hexapod, pose, joint=joint).strain
    angles = joint_angles(hexapod, pose)
    return {
        "pose": list(six),
        "stability": state.stability,
        "geometry": _geometry(hexapod, pose),
        "omega": modes.omega,
        "frequency": modes.omega / TWO_PI,
        "index": modes.omega[0],
        "condition": state.condition_shown(condition_number(hexapod, pose)),
        "shape": modes.shape.T,
        "modes": [{"text": mode.text, "dominant": mode.dominant, "share": mode.share} for mode in state.descriptions],
        "strain": np.where(modes.omega > 0, strain, np.nan).T,
        "damped": None if state.tangent is None else _damped(state.tangent),
        "sampling_time": advised_sampling_time(modes.omega[-1]),
        "legs": {
            "universal": np.round(np.degrees(angles.universal), 9) + 0.0,
            "spherical": np.round(np.degrees(angles.spherical), 9) + 0.0,
            **_static(hexapod, pose, state),
        },
        "leg_distance": float(leg_distance(hexapod, pose)),
        "limits": _limits(hexapod, pose, joint),
        "grave": [one.text for one in state.cautions if one.code in GRAVE],
        "warnings": [one.text for one in state.cautions if one.code not in (*GRAVE, "limit", "design")],
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


def _static(hexapod: Hexapod, pose: Pose, state: PoseState) -> StaticLegs:
    """Static leg forces at the pose; there are none at a singular one."""
    if state.linear is None:
        length = inverse_kinematics(hexapod, pose)
        why = next(one.text for one in state.cautions if one.code in ("singular", "unsupported"))
        return {"length": length, "force": None, "energy": None, "why": why}
    rest = state.linear.rest
    stiffness, _ = axial_stiffness(hexapod, rest.unstretched_length)
    energy = 0.5 * rest.leg_force**2 / stiffness
    return {"length": rest.leg_length, "force": rest.leg_force, "energy": energy, "why": ""}


def _damped(tangent: Tangent) -> DampedModes:
    """The damped modes in the order of the undamped ones that move alike, and those that are like none."""
    modes, pairs = tangent.modes, tangent.pairs
    frequency = np.where(modes.pole.imag > 0, modes.pole.imag, np.nan) / TWO_PI
    alone: list[LoneMode] = [
        {"text": tangent.words[j].text, "frequency": float(frequency[j]), "ratio": float(modes.damping_ratio[j])}
        for j in pairs.alone
    ]
    return {
        "omega": pairs.beside(modes.omega),
        "frequency": pairs.beside(frequency),
        "ratio": pairs.beside(modes.damping_ratio),
        "overlap": pairs.overlap,
        "alone": alone,
    }


def _limits(hexapod: Hexapod, pose: Pose, joint: JointModel) -> Limits:
    """The limits exceeded, in words, all and by leg, and whether the design has limits."""
    quantities = limit_excess(hexapod, pose, joint=joint)
    words = [word for quantity in quantities for word in quantity.in_words()]
    by_leg = [[word.split(": ", 1)[1] for word in words if word.startswith(f"leg {leg}: ")] for leg in LEGS]
    return {"any": bool(quantities), "ok": not words, "exceeded": words, "by_leg": by_leg}
