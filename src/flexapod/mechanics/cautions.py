"""Cautions about results at a pose, with their thresholds: one list for the report, the commands and the page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.joint_limits import check_limits
from flexapod.mechanics.kinematics import condition_number
from flexapod.mechanics.modes import near_repeated
from flexapod.mechanics.plausibility import (
    POSES,
    implausible,
    legs_that_cross,
    mean_radius,
    singular_everywhere,
    soft_legs,
)
from flexapod.mechanics.plausibility import Caution as Caution
from flexapod.pose import Pose

if TYPE_CHECKING:
    from flexapod.mechanics.linearisation import DampedModes

SINGULAR = 1e12  # condition number without units from which H is singular to rounding
NEAR_SINGULAR = 100.0  # a leg force up to a hundred times the load; stiffness 1e4 times less in some direction
GROWS = 1e-9  # of the highest frequency: a pole whose real part is larger belongs to a motion that grows
TANGENT_DIFFERS = 0.01  # of a frequency: from here on gravity and preload must not be left out


def platform_radius(hexapod: Hexapod) -> float:
    """Mean distance of the platform joints from their centre, m."""
    return mean_radius(hexapod.platform_joints)


def unitless_condition(hexapod: Hexapod, pose: Pose) -> float:
    """Condition number of H with its moments divided by the platform's radius: that of the thresholds above."""
    return float(condition_number(hexapod, pose, characteristic_length=platform_radius(hexapod)))


def pose_cautions(
    hexapod: Hexapod, pose: Pose, omega: Array, condition: float, damped: DampedModes | None
) -> list[Caution]:
    """All cautions about one pose, the gravest first.

    omega: rad/s. condition: of H without units. damped: modes of the exact tangent; None where no leg forces hold the
    pose.
    """
    return [
        *singularity(condition, singular_everywhere(hexapod, pose, condition)),
        *_unsupported(condition, damped),
        *_stability(damped),
        *(Caution("limit", f"Limit exceeded: {text}.") for text in check_limits(hexapod, pose).exceeded),
        *_angles_without_home(hexapod),
        *legs_that_cross(hexapod, pose),
        *soft_legs(hexapod, pose),
        *implausible(hexapod),
        *(Caution("design", text) for text in hexapod.warnings),
        *_preload(omega, damped),
        *repeats(omega),
    ]


def singularity(condition: float, elsewhere: float | None = None) -> list[Caution]:
    """Whether a pose is singular or near it, by the condition number of H without units.

    elsewhere: the least of them that was found at other poses, where all are singular or nearly so.
    """
    if condition <= NEAR_SINGULAR:
        return []
    code, numbers, remedy = "singular", {"condition": condition}, "Choose another pose, or move the joints."
    text = (
        "The pose is singular: the platform can move without stretching any leg, so the index is 0, and no leg forces "
        "hold it against every load. Leg forces, the tangent and sensitivities are not available here."
    )
    if condition < SINGULAR:
        code, remedy = "near_singular", "Keep away from here, or move the joints."
        text = (
            f"Near a singular pose: the condition number of H is {condition:.3g} without units, so some load needs leg "
            f"forces about {condition:.1g} times as large."
        )
    if elsewhere is not None:
        numbers["elsewhere"] = elsewhere
        remedy = (
            f"No pose helps: at all of {POSES} others that were tried the condition number is {elsewhere:.1g} or more. "
            "The joints are placed so that the machine is singular everywhere, as those of two similar hexagons are: "
            "move them."
        )
    return [Caution(code, f"{text} {remedy}", numbers)]


def repeats(omega: Array) -> list[Caution]:
    """Modes whose frequencies are nearly the same."""
    found = []
    for modes in mode_clusters(omega):
        if len(modes) > 1:
            names = ", ".join(str(i + 1) for i in modes[:-1]) + f" and {modes[-1] + 1}"
            low, high = f"{omega[modes[0]]:.6g}", f"{omega[modes[-1]]:.6g}"
            values = low if low == high else f"{low} to {high}"
            text = (
                f"Modes {names} are nearly repeated ({values} rad/s). Read them "
                "together: any mixture of their shapes is as good a mode, and a small change of the design turns them."
            )
            numbers = {"first": modes[0] + 1, "last": modes[-1] + 1, "omega": float(omega[modes[0]])}
            found.append(Caution("near_repeated", text, numbers))
    return found


def mode_clusters(omega: Array) -> list[list[int]]:
    """The modes, numbered from 0, with near-repeated ones together: [[0, 1], [2], [3], [4, 5]]."""
    joined = set(near_repeated(omega))
    clusters = [[0]]
    for i in range(5):
        if (i, i + 1) in joined:
            clusters[-1].append(i + 1)
        else:
            clusters.append([i + 1])
    return clusters


def _unsupported(condition: float, damped: DampedModes | None) -> list[Caution]:
    if damped is None and condition < SINGULAR:
        return [Caution("unsupported", "No leg forces hold this pose: the tangent is not available.")]
    return []


def _stability(damped: DampedModes | None) -> list[Caution]:
    if damped is None:
        return []
    found = []
    for i, (pole, ratio) in enumerate(zip(damped.pole, damped.damping_ratio, strict=True)):
        numbers = {"mode": i + 1, "damping_ratio": float(ratio)}
        if pole.real > GROWS * damped.omega[-1]:
            motion = "falls away" if pole.imag == 0 else "swings ever wider"
            text = (
                f"Not stable at rest: tangent mode {i + 1} grows (damping ratio {ratio:.3g}); under its own weight the "
                f"platform {motion} from this pose. Stiffen the legs or lower the mass centre."
            )
            found.append(Caution("unstable", text, numbers))
        elif pole.imag == 0:
            text = f"Tangent mode {i + 1} does not vibrate: damping is above critical. Check legs.damping."
            found.append(Caution("overdamped", text, numbers))
    return found


def _angles_without_home(hexapod: Hexapod) -> list[Caution]:
    limits = hexapod.limits
    if hexapod.home is not None or (limits.universal_angle is None and limits.spherical_angle is None):
        return []
    return [
        Caution(
            "no_home",
            "Joint angles are measured from the z axes, for the design has no home pose. Add [home] to the design: its "
            "joints are then neutral there.",
        )
    ]


def _preload(omega: Array, damped: DampedModes | None) -> list[Caution]:
    if damped is None:
        return []
    change = np.abs(damped.omega / omega - 1.0)
    worst = int(np.argmax(change))
    if change[worst] < TANGENT_DIFFERS:
        return []
    text = (
        f"Weight and preload change mode {worst + 1} from {omega[worst]:.4g} to {damped.omega[worst]:.4g} rad/s. "
        "Rely on the exact tangent here: Eq. 5 leaves them out."
    )
    numbers = {"mode": worst + 1, "omega": float(omega[worst]), "tangent_omega": float(damped.omega[worst])}
    return [Caution("preload", text, numbers)]
