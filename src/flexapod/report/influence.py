"""What the dynamic stability index depends on most: exact sensitivities as the effect of small, comparable changes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.modes import natural_modes
from flexapod.mechanics.sensitivity import Sensitivity, frequency_sensitivity
from flexapod.pose import Pose

MOVE = 0.01  # of the distance of the farthest platform joint from the platform's reference point
NOTHING = 5e-6  # relative changes of the index below this are left out: they would print as 0.000 %

#: Springs beside constant ones along the legs, in words.
_SPRINGS = {
    "legs.series_stiffness": "springs in series with the legs",
    "legs.joint_stiffness.universal": "stiffness of the base joints",
    "legs.joint_stiffness.spherical": "stiffness of the platform joints",
    "legs.joint_stiffness.torsion": "torsional stiffness of the joints",
    "legs.stiffness_law.fixed": "fixed stiffness of the legs",
    "legs.stiffness_law.axial_rigidity": "axial rigidity of the legs",
    "legs.stiffness_law.bulk_modulus": "bulk modulus of the oil",
    "legs.stiffness_law.stiffnesses": "stiffness of all legs at all lengths",
    "suspension.stiffness": "stiffness of the suspension",
}


class Influence(NamedTuple):
    """A change of the design and what it does to the index.

    change: what is changed, and by how much. effect: relative change of the index, to first order (0.01 is 1 %).
    direction: for a move, the unit vector (base or platform frame) in which it raises the index most; else None.
    group: "mass", "stiffness" or "geometry".
    """

    change: str
    effect: float
    direction: tuple[float, float, float] | None
    group: str


def influences(hexapod: Hexapod, pose: Pose, joint: JointModel, modes: list[int]) -> list[Influence]:
    """Effects on the index, largest first.

    modes: those that make up the index, more than one where the lowest is (nearly) repeated: then the effect is that on
    their mean, which is well defined where the single modes' are not.
    """
    omega = natural_modes(hexapod, pose, joint=joint).omega[modes].mean()
    d = frequency_sensitivity(hexapod, pose, joint=joint)
    plain = {name: by[modes].mean(axis=0) / omega for name, by in d._asdict().items() if name != "springs"}
    springs = {key: by[modes].mean(axis=0) / omega for key, by in d.springs.items()}
    relative = Sensitivity(**plain, springs=springs)
    move = MOVE * float(np.linalg.norm(hexapod.platform_joints, axis=1).max())
    step = f"{move * 1e3:.2g} mm"
    found = [*_masses(hexapod, relative), *_stiffness(hexapod, relative)]
    center = relative.platform_mass_center
    found.append(_moved(f"platform mass centre moved by {step}", center, move))
    for plate, by in (("base", relative.base_joints), ("platform", relative.platform_joints)):
        found += [_moved(f"{plate} joint {i + 1} moved by {step}", by[i], move) for i in range(6)]
    return sorted((one for one in found if abs(one.effect) > NOTHING), key=_rank)


def _masses(hexapod: Hexapod, relative: Sensitivity) -> list[Influence]:
    legs = hexapod.legs
    upper = np.triu(hexapod.platform_inertia * relative.platform_inertia).sum()
    parts = {
        "platform mass": hexapod.platform_mass * relative.platform_mass,
        "platform inertia": upper,
        "mass of the legs' lower parts": (legs.lower.mass * relative.lower_mass).sum(),
        "mass of the legs' upper parts": (legs.upper.mass * relative.upper_mass).sum(),
    }
    return [Influence(f"{name} + 1 %", 0.01 * float(value), None, "mass") for name, value in parts.items()]


def _stiffness(hexapod: Hexapod, relative: Sensitivity) -> list[Influence]:
    found: dict[str, float] = {}
    if hexapod.legs.stiffness_law is None:
        each = hexapod.legs.stiffness * relative.stiffness
        found = {f"stiffness of leg {i + 1}": each[i] for i in range(6)} | {"stiffness of all legs": each.sum()}
    values = hexapod.values()
    for key, name in _SPRINGS.items():
        if key in relative.springs and key in values:
            products = values[key] * relative.springs[key]
            found[name] = np.triu(products).sum() if key == "suspension.stiffness" else products.sum()
    return [Influence(f"{name} + 1 %", 0.01 * float(value), None, "stiffness") for name, value in found.items()]


def _rank(one: Influence) -> tuple[float, str]:
    return -round(abs(one.effect), 7), one.change  # rounded: equal effects in order of their names


def _moved(change: str, gradient: Array, move: float) -> Influence:
    steepness = float(np.linalg.norm(gradient))
    direction = tuple((gradient / steepness + 0.0).tolist()) if steepness else None
    return Influence(change, steepness * move, direction, "geometry")


def leading(found: list[Influence], most: dict[str, int]) -> list[Influence]:
    """The largest of each group, as many as `most` says, in order."""
    left = dict(most)
    kept = []
    for one in found:
        left[one.group] -= 1
        if left[one.group] >= 0:
            kept.append(one)
    return kept
