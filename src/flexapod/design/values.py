"""Legs and suspension of a design from its values by file key, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

from flexapod.design.drive import drive_of
from flexapod.design.flexible_joints import JointStiffness, Suspension
from flexapod.design.home import home_of
from flexapod.design.parts import Damping, LegPart, Legs, Limits, more_keys
from flexapod.design.points import points_of
from flexapod.design.stiffness_laws import law_of, values_of_law
from flexapod.errors import DesignError, shown


def parts_of(values: Mapping[str, Any], keys: Mapping[str, str]) -> dict[str, Any]:
    """What a Hexapod is made from, out of its values by file key. keys: those of its own numbers, by attribute.

    Raises DesignError for what is no mapping, or lacks a key.
    """
    if not isinstance(values, Mapping):
        raise DesignError(f"values is {shown(values)}; it must be a mapping, as Hexapod.values() gives it.")
    try:
        return {
            "name": values.get("name", "hexapod"),
            **{name: values[key] for name, key in keys.items()},
            "legs": legs_of(values),
            "limits": Limits(**{item.name: values.get(f"limits.{item.name}") for item in fields(Limits)}),
            "home": home_of(values),
            "suspension": suspension_of(values),
            "points": points_of(values),
            "drive": drive_of(values),
        }
    except (KeyError, TypeError) as error:  # TypeError: a part of the legs without some of its numbers
        raise DesignError(f"values lacks a key ({error}); it must hold every one of Hexapod.values().") from error


def legs_of(values: Mapping[str, Any]) -> Legs:
    """The legs of a design. Raises DesignError for values that no legs can have."""

    def bundle(kind: Any, table: str) -> Any:
        given = [item.name for item in fields(kind) if f"{table}.{item.name}" in values]
        return kind(**{name: values[f"{table}.{name}"] for name in given})

    return Legs(
        values.get("legs.stiffness"),  # type: ignore[arg-type]  # None beside a stiffness law
        bundle(Damping, "legs.damping"),
        bundle(LegPart, "legs.lower"),
        bundle(LegPart, "legs.upper"),
        more={key: values[f"legs.{key}"] for key in more_keys()},
        series_stiffness=values.get("legs.series_stiffness", np.zeros((6, 0))),
        loss_factor=values.get("legs.loss_factor", np.zeros(6)),
        joint_stiffness=bundle(JointStiffness, "legs.joint_stiffness"),
        joint_rest=home_of(values, "legs.joint_rest"),
        stiffness_law=law_of(values),
    )


def values_of_legs(legs: Legs) -> dict[str, Any]:
    """Legs by dotted file key, keys before the tables below them, without springs and losses that are not there."""
    values = {} if legs.stiffness_law is not None else {"legs.stiffness": legs.stiffness}
    if legs.series_stiffness.size:
        values["legs.series_stiffness"] = legs.series_stiffness
    if legs.loss_factor.any():
        values["legs.loss_factor"] = legs.loss_factor
    values |= {f"legs.{key}": np.asarray(value) for key, value in legs.more.items()}
    values |= values_of_law(legs.stiffness_law)
    values |= _values_of(legs.damping, "legs.damping")
    if legs.joint_stiffness.given:
        values |= _values_of(legs.joint_stiffness, "legs.joint_stiffness")
    if legs.joint_rest is not None:
        values |= {
            "legs.joint_rest.position": legs.joint_rest.position,
            "legs.joint_rest.orientation": legs.joint_rest.rpy,
        }
    for part in ("lower", "upper"):
        values |= _values_of(getattr(legs, part), f"legs.{part}")
    return dict(sorted(values.items(), key=lambda item: item[0].count(".")))


def suspension_of(values: Mapping[str, Any]) -> Suspension | None:
    """The suspension of a design, where it has one. Raises DesignError for one that cannot be."""
    given = [item.name for item in fields(Suspension) if f"suspension.{item.name}" in values]
    if given == ["point"]:
        raise DesignError("suspension.point is given without stiffness and damping. Add one of them, or leave it out.")
    return Suspension(**{name: values[f"suspension.{name}"] for name in given}) if given else None


def values_of_suspension(suspension: Suspension | None) -> dict[str, Any]:
    """A suspension by dotted file key."""
    return {} if suspension is None else _values_of(suspension, "suspension")


def _values_of(part: Any, table: str) -> dict[str, Any]:
    return {f"{table}.{item.name}": getattr(part, item.name) for item in fields(part)}
