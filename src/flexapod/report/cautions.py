"""What a reader of a report must beware of, in words with the numbers behind them."""

from __future__ import annotations

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.conditioning import SINGULAR, singularity
from flexapod.mechanics.kinematics import check_limits
from flexapod.mechanics.linearisation import DampedModes
from flexapod.pose import Pose

TANGENT_DIFFERS = 0.01  # of a frequency: more than this, and gravity and preload must not be left out


def cautions(
    hexapod: Hexapod,
    pose: Pose,
    omega: Array,
    clusters: list[list[int]],
    condition: float,
    damped: DampedModes | None,
) -> list[str]:
    """Warnings, the gravest first.

    clusters: modes, near-repeated ones together. condition: of H without units. damped: modes of the tangent, if any.
    """
    return [
        *singularity(condition),
        *_no_rest(condition, damped),
        *_stability(damped),
        *(f"Limit exceeded: {text}." for text in check_limits(hexapod, pose).exceeded),
        *_angles_without_home(hexapod),
        *hexapod.warnings,
        *_preload(omega, damped),
        *_repeats(omega, clusters),
    ]


def _no_rest(condition: float, damped: DampedModes | None) -> list[str]:
    if damped is None and condition < SINGULAR:
        return ["No leg forces hold this pose: the tangent is not available."]
    return []


def _stability(damped: DampedModes | None) -> list[str]:
    if damped is None:
        return []
    found = []
    for i, (pole, ratio) in enumerate(zip(damped.pole, damped.damping_ratio, strict=True)):
        if pole.real > 1e-9 * damped.omega[-1]:
            motion = "falls away" if pole.imag == 0 else "swings ever wider"
            found.append(
                f"Not stable at rest: tangent mode {i + 1} grows (damping ratio {ratio:.3g}); under its own weight the "
                f"platform {motion} from this pose. Stiffen the legs or lower the mass centre."
            )
        elif pole.imag == 0:
            found.append(f"Tangent mode {i + 1} does not vibrate: damping is above critical. Check legs.damping.")
    return found


def _angles_without_home(hexapod: Hexapod) -> list[str]:
    limits = hexapod.limits
    if hexapod.home is not None or (limits.universal_angle is None and limits.spherical_angle is None):
        return []
    return [
        "Joint angles are measured from the z axes, for the design has no home pose. Add [home] to the design: its "
        "joints are then neutral there."
    ]


def _preload(omega: Array, damped: DampedModes | None) -> list[str]:
    if damped is None:
        return []
    change = np.abs(damped.omega / omega - 1.0)
    worst = int(np.argmax(change))
    if change[worst] < TANGENT_DIFFERS:
        return []
    return [
        f"Weight and preload change mode {worst + 1} from {omega[worst]:.4g} to {damped.omega[worst]:.4g} rad/s. "
        "Rely on the exact tangent here: Eq. 5 leaves them out."
    ]


def _repeats(omega: Array, clusters: list[list[int]]) -> list[str]:
    found = []
    for modes in clusters:
        if len(modes) > 1:
            names = ", ".join(str(i + 1) for i in modes[:-1]) + f" and {modes[-1] + 1}"
            low, high = f"{omega[modes[0]]:.6g}", f"{omega[modes[-1]]:.6g}"
            values = low if low == high else f"{low} to {high}"
            found.append(
                f"Modes {names} are nearly repeated ({values} rad/s). Read them "
                "together: any mixture of their shapes is as good a mode, and a small change of the design turns them."
            )
    return found
