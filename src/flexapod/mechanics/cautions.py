"""Cautions about results at a pose, with their thresholds: one list for the report, the commands and the page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod import _core
from flexapod.conventions import AXES, Array, Complex, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.inputs import states
from flexapod.mechanics.joint_limits import check_limits
from flexapod.mechanics.kinematics import condition_number
from flexapod.mechanics.leg_bending import bending_caution, leg_bending
from flexapod.mechanics.limited import together
from flexapod.mechanics.linearisation import DampedModes, Linearisation
from flexapod.mechanics.mode_pairs import ModePairs
from flexapod.mechanics.mode_shapes import ModeDescription, twist_of_center
from flexapod.mechanics.modes import mode_clusters
from flexapod.mechanics.plausibility import (
    POSES,
    implausible,
    legs_that_cross,
    mean_radius,
    singular_everywhere,
    soft_legs,
)
from flexapod.mechanics.plausibility import Caution as Caution
from flexapod.mechanics.statics import Equilibrium
from flexapod.pose import Pose

SINGULAR = 1e12  # condition number without units from which H is singular to rounding
NEAR_SINGULAR = 100.0  # a leg force up to a hundred times the load; stiffness 1e4 times less in some direction
GROWS = 1e-9  # of the highest frequency: a pole whose real part is larger belongs to a motion that grows
TANGENT_DIFFERS = 0.01  # of a frequency: from here on gravity and preload must not be left out
ALONG_AXIS = np.radians(2.0)  # a leg that is nearer to its universal joint's axis spins at each small motion

#: Codes of cautions that come first, before exceeded limits.
GRAVE = ("singular", "near_singular", "unsupported", "unstable")
#: Those that matter at a pose which was found by its index alone: the index does not show them.
UNHELD = ("singular", "unsupported", "unstable", "axis_along_leg")
#: Those that are no fault of a design, or are told of it in another way.
NO_FAULT = ("limit", "design", "no_home", "near_singular", "near_repeated", "preload", "shapes_differ", "overdamped")


class Tangent(NamedTuple):
    """Modes of the exact tangent at a pose, in words too, and which undamped mode each is like."""

    modes: DampedModes
    words: list[ModeDescription]
    pairs: ModePairs


def listed(words: Sequence[str]) -> str:
    """Words as a list in a sentence: a, b and c."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def platform_radius(hexapod: Hexapod) -> float:
    """Mean distance of the platform joints from their centre, m."""
    return mean_radius(hexapod.platform_joints)


def unitless_condition(hexapod: Hexapod, pose: Pose) -> float:
    """Condition number of H with its moments divided by the platform's radius: that of the thresholds above."""
    return float(condition_number(hexapod, pose, characteristic_length=platform_radius(hexapod)))


def is_singular(condition: float) -> bool:
    """Whether a pose is singular to rounding, by the condition number of H without units."""
    return not condition < SINGULAR


def grows(modes: DampedModes) -> NDArray[np.bool_]:
    """Which damped modes grow, by more than rounding, (6,)."""
    return np.asarray(modes.pole.real > GROWS * modes.omega[-1])


def stands(modes: DampedModes) -> bool:
    """Whether the machine stays at rest: no mode grows."""
    return not grows(modes).any()


def other_than_vibration(pole: complex, grown: bool) -> str:
    """What a damped mode does that grows or does not vibrate; "" for one that vibrates and decays."""
    if grown:
        return "swings ever wider" if pole.imag else "falls over"
    return "" if pole.imag else "does not vibrate"


def response_cautions(linear: Linearisation) -> list[Caution]:
    """What to say of a response about rest: that nothing approaches it where the machine does not stay at rest."""
    damped = linear.modes()
    if stands(damped):
        return []
    count, growth = int(grows(damped).sum()), float(damped.pole.real.max())
    text = (
        f"Not stable at rest: {count} mode{'s' * (count > 1)} of the machine grow{'s' * (count == 1)} (e-fold in "
        f"{1 / growth:.2g} s), under its own weight it falls over. The response is that of the linear equations; no "
        "motion of the machine approaches it. Stiffen the legs, lower the mass centre, or control it."
    )
    return [Caution("unstable", text, {"modes": count, "growth": growth})]


def response_attributes(linear: Linearisation) -> dict[str, str]:
    """Attributes of a Dataset of responses: whether the machine stands at rest, and what that means for them."""
    found = response_cautions(linear)
    return {"stability": "falls over" if found else "stable", "caution": found[0].text if found else ""}


def pose_cautions(
    hexapod: Hexapod,
    pose: Pose,
    omega: Array,
    condition: float,
    tangent: Tangent | None,
    rest: Equilibrium | None = None,
    *,
    joint: JointModel = "universal",
) -> list[Caution]:
    """All cautions about one pose, the gravest first.

    omega: rad/s. condition: of H without units. tangent: modes of the exact tangent; None where no leg forces hold the
    pose. rest: those forces, or None.
    """
    exceeded = check_limits(hexapod, pose, joint=joint).exceeded
    return [
        *singularity(condition, singular_everywhere(hexapod, pose, condition)),
        *_unsupported(condition, tangent),
        *([] if tangent is None else _stability(hexapod, pose, tangent)),
        *axes_along_legs(hexapod, pose),
        *(Caution("limit", f"Limit exceeded: {text}.", {"times": n}) for text, n in together(exceeded).items()),
        *_angles_without_home(hexapod),
        *legs_that_cross(hexapod, pose),
        *([] if rest is None else soft_legs(hexapod, rest)),
        *implausible(hexapod),
        *(Caution("design", text) for text in hexapod.warnings),
        *([] if tangent is None else _preload(omega, tangent)),
        *bending_caution(leg_bending(hexapod, pose), float(omega[-1])),
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
            names = listed([str(i + 1) for i in modes])
            low, high = f"{omega[modes[0]]:.6g}", f"{omega[modes[-1]]:.6g}"
            values = low if low == high else f"{low} to {high}"
            text = (
                f"Modes {names} are nearly repeated ({values} rad/s). Read them "
                "together: any mixture of their shapes is as good a mode, and a small change of the design turns them."
            )
            numbers = {"first": modes[0] + 1, "last": modes[-1] + 1, "omega": float(omega[modes[0]])}
            found.append(Caution("near_repeated", text, numbers))
    return found


def axes_along_legs(hexapod: Hexapod, pose: Pose) -> list[Caution]:
    """Legs that lie nearly along the axis of their universal joint, which then spins them."""
    s = states(hexapod, pose)
    _, sine = _core.leg_fit(hexapod.packed, s.platform, s.base)
    found = []
    for leg in np.flatnonzero(sine[0] < np.sin(ALONG_AXIS)):
        angle = float(np.degrees(np.arcsin(sine[0, leg])))
        text = (
            f"Leg {leg + 1} is {angle:.2g} degrees from the axis of its universal joint: the joint spins the leg at "
            "each small motion of the platform, and the inertia of the spinning leg lowers the frequencies. Give "
            f"base.universal_axes[{leg}] a direction across the leg."
        )
        found.append(Caution("axis_along_leg", text, {"leg": int(leg) + 1, "angle_deg": angle}))
    return found


def _unsupported(condition: float, tangent: Tangent | None) -> list[Caution]:
    if tangent is None and not is_singular(condition):
        return [Caution("unsupported", "No leg forces hold this pose: the tangent is not available.")]
    return []


def _stability(hexapod: Hexapod, pose: Pose, tangent: Tangent) -> list[Caution]:
    damped, growing = tangent.modes, grows(tangent.modes)
    found = []
    if growing.any():
        ways = listed([_falling(hexapod, pose, tangent, int(i)) for i in np.flatnonzero(growing)])
        text = (
            f"Not stable at rest: under its own weight the platform {ways}. What assumes small motions about rest does "
            "not hold here. Stiffen the legs or lower the mass centre."
        )
        numbers = {"modes": int(growing.sum()), "growth": float(damped.pole.real.max())}
        found.append(Caution("unstable", text, numbers))
    for i in np.flatnonzero(~growing & (damped.pole.imag == 0) & (damped.omega > GROWS * damped.omega[-1])):
        name = _named(tangent, int(i))
        text = f"With damping {name} does not vibrate: it is above critical. Check legs.damping."
        found.append(Caution("overdamped", text, {"mode": int(i) + 1, "damping_ratio": float(damped.damping_ratio[i])}))
    return found


def _named(tangent: Tangent, mode: int) -> str:
    """The mode of Eq. 5 beside which a damped mode stands, or its own number among the damped ones."""
    beside = np.flatnonzero(tangent.pairs.damped == mode)
    return f"mode {beside[0] + 1}" if beside.size else f"tangent mode {mode + 1}"


def _falling(hexapod: Hexapod, pose: Pose, tangent: Tangent, mode: int) -> str:
    """How a mode that grows moves the platform's joints most: by a turn or by a translation of the mass centre."""
    pole, shape = tangent.modes.pole[mode], tangent.modes.shape[:, mode]
    axis = AXES[int(np.argmax(_travel(hexapod, pose, shape)))]
    how = f"tips over in {axis}" if axis in AXES[3:] else f"falls away along {axis}"
    if pole.imag:
        how = f"swings ever wider in {axis}"
    return f"{how} ({_named(tangent, mode)}, e-fold in {1 / pole.real:.2g} s)"


def _travel(hexapod: Hexapod, pose: Pose, shape: Complex) -> Array:
    """Amounts of a twist along and about x, y, z of the mass centre, m: turns times the platform's radius."""
    twist = np.abs(np.linalg.solve(twist_of_center(hexapod, pose), shape))
    return np.concatenate([twist[:3], platform_radius(hexapod) * twist[3:]])


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


def _preload(omega: Array, tangent: Tangent) -> list[Caution]:
    damped, pairs = tangent.modes, tangent.pairs
    vibrates = pairs.beside((damped.pole.imag > 0) & ~grows(damped)) == 1
    change = np.where(vibrates, np.abs(pairs.beside(damped.omega) / np.where(omega > 0, omega, np.nan) - 1.0), np.nan)
    change = np.nan_to_num(change)
    worst = int(np.argmax(change))
    found = []
    if change[worst] >= TANGENT_DIFFERS:
        new = float(damped.omega[pairs.damped[worst]])
        text = (
            f"Weight and preload change mode {worst + 1} from {omega[worst]:.4g} to {new:.4g} rad/s. "
            "Rely on the exact tangent here: Eq. 5 leaves them out."
        )
        numbers = {"mode": worst + 1, "omega": float(omega[worst]), "tangent_omega": new}
        found.append(Caution("preload", text, numbers))
    if pairs.alone:
        which = listed([str(j + 1) for j in pairs.alone])
        text = (
            f"Weight, preload and damping change the shapes of the modes: tangent modes {which} are like none of Eq. 5."
        )
        found.append(Caution("shapes_differ", text, {"modes": len(pairs.alone)}))
    return found
