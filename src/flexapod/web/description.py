"""A design as the page shows it: its numbers by key, main parameters, home pose, pose box, warnings and TOML text."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from flexapod.design.hexapod import Hexapod
from flexapod.design.schema import KEYS, TEXT_KEYS, rule_of
from flexapod.design.units import printed, si_unit
from flexapod.web import pose_ranges
from flexapod.web.answers import Design, Field
from flexapod.web.designs import Source, built, original
from flexapod.web.laws import law_choices, law_of
from flexapod.web.parameters import main_parameters

Shapes = tuple[tuple[int, ...], ...]
_OPTIONAL = (
    "limits.",
    "home.",
    "legs.loss_factor",
    "legs.series_stiffness",
    "legs.joint_stiffness.",
    "legs.joint_rest.",
    "suspension.",
    "drive.",
)


def fields() -> list[Field]:
    """Every key of a design file that holds numbers, with its meaning, unit and shapes, for the form.

    Short forms and points are changed in the file.
    """
    shorthand = re.compile(r"\.(circle|rod)\.|^cubic\.|^legs\.stiffness_law\.area$")
    return [
        {
            "key": _field_key(key),
            "meaning": rule.meaning,
            "unit": "°" if rule.dimension == "angle" else printed(si_unit(rule.dimension)),
            "shapes": _shapes(key, rule.shapes),
            "optional": key.startswith(_OPTIONAL),
            "laws": law_of(key),
        }
        for key, rule in KEYS.items()
        if not shorthand.search(key)
    ]


def _shapes(key: str, shapes: Shapes) -> list[list[int]]:
    """The shapes of a field; a suspension begins with the six numbers of a diagonal."""
    diagonal = [[6]] if shapes == ((6, 6),) and key.startswith("suspension.") else []
    return [*diagonal, *(list(shape) for shape in shapes)]


def described(source: Source) -> Design:
    """All that the page shows of a design itself. Raises InvalidDesign with every field that is wrong."""
    hexapod = built(source)
    return {
        **pose_ranges.drawn(hexapod),
        "digest": hexapod.digest,
        "warnings": list(hexapod.warnings),
        "values": _values(hexapod),
        "laws": law_choices(hexapod),
        "parameters": main_parameters(hexapod, original(source.text)),
        "toml": source.text if source.changes == "{}" else hexapod.to_toml(),
    }


def _field_key(key: str) -> str:
    """A key as the form has it: angles in degrees, as people write them."""
    return f"{key}_deg" if rule_of(key).dimension == "angle" else key


def _values(hexapod: Hexapod) -> dict[str, Any]:
    """Every number of a design by the key of its field."""
    values: dict[str, Any] = {}
    for key, value in hexapod.values().items():
        if key in TEXT_KEYS:
            values[key] = value
        elif rule_of(key).dimension == "angle":
            values[_field_key(key)] = np.round(np.degrees(value), 12).tolist()
        else:
            values[key] = value.tolist()
    return values
