"""Stiffness laws on the page: those that the legs may have, each as stiff at home as the legs that are there."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.stiffness_laws import LAWS, TABLE, keys_of
from flexapod.design.universal_axes import legs_at
from flexapod.mechanics.springs import axial_stiffness
from flexapod.web import pose_ranges
from flexapod.web.geometry import pose_at

CONSTANT = "constant"  #: the kind of legs without a law
_OIL = 1e9  # Pa, usual of oil with hoses
_DEAD = 0.05  # of the stroke
_AROUND = 0.2  # of a leg's length, to each side, where the design does not limit it


def law_of(key: str) -> list[str]:
    """The kinds of law that a key of a design file is a number of; none for a key of the legs themselves."""
    name = key.removeprefix(f"{TABLE}.")
    return [kind for kind, law in LAWS.items() if name != key and name in keys_of(law)]


def law_choices(hexapod: Hexapod) -> dict[str, dict[str, Any]]:
    """By kind, the changes that give the legs this law, as stiff at home as they are; none where they are not known."""
    pose = pose_at(pose_ranges.home(hexapod))
    length = np.linalg.norm(legs_at(hexapod.base_joints, hexapod.platform_joints, pose), axis=1)
    whole = axial_stiffness(hexapod, length)[0]
    if not np.isfinite(whole).all():  # at a pose outside the range of the law that is there
        return {}
    stiffness = 1.0 / (1.0 / whole - hexapod.legs.series_compliance)
    least, most = _range(hexapod, length)
    laws = {
        "screw": _screw(stiffness, length, least),
        "hydraulic": _oil(stiffness, length, least, most),
        "table": {
            "lengths": np.linspace(least.min(), most.max(), 3).tolist(),
            "stiffnesses": [float(stiffness.mean())] * 3,
        },
    }
    chosen: dict[str, dict[str, Any]] = {CONSTANT: {TABLE: None, "legs.stiffness": stiffness.tolist()}}
    return chosen | {kind: {TABLE: {"kind": kind, **numbers}} for kind, numbers in laws.items()}


def _range(hexapod: Hexapod, length: Array) -> tuple[Array, Array]:
    """Shortest and longest legs, m, (6,)."""
    if hexapod.limits.leg_length is None:
        return (1 - _AROUND) * length, (1 + _AROUND) * length
    pairs = np.broadcast_to(hexapod.limits.leg_length, (6, 2))
    return np.minimum(pairs[:, 0], length), np.maximum(pairs[:, 1], length)


def _screw(stiffness: Array, length: Array, least: Array) -> dict[str, Any]:
    """At home the screw yields as much as all the rest."""
    zero = 0.9 * least
    return {
        "fixed": (2 * stiffness).tolist(),
        "axial_rigidity": (2 * stiffness * (length - zero)).tolist(),
        "zero_length": zero.tolist(),
    }


def _oil(stiffness: Array, length: Array, least: Array, most: Array) -> dict[str, Any]:
    """Equal areas."""
    stroke = most - least
    dead = _DEAD * stroke
    area = stiffness / _OIL / (1 / (length - least + dead) + 1 / (most - length + dead))
    both = {name: area.tolist() for name in ("area_1", "area_2")} | {
        name: dead.tolist() for name in ("dead_1", "dead_2")
    }
    return {"bulk_modulus": _OIL, "stroke": stroke.tolist(), "shortest": least.tolist(), **both}
