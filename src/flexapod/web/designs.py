"""Designs for the page: text and changes to a hexapod, errors at their fields, the chief numbers, the pose box."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from flexapod.design import design_file
from flexapod.design.hexapod import Hexapod
from flexapod.design.schema import KEYS, TABLES, TEXT_KEYS
from flexapod.design.units import printed, si_unit
from flexapod.errors import DesignError
from flexapod.pose import Pose


class Source(NamedTuple):
    """A design as a page holds it: the text of its file, and changes to it as JSON text of an object."""

    text: str
    changes: str = "{}"


class FieldError(NamedTuple):
    """What is wrong with one key of a design; `line` counts from 1, 0 where it is nowhere in the text."""

    key: str
    message: str
    line: int


class InvalidDesign(DesignError):
    """A design with all its errors, each at its field."""

    def __init__(self, errors: list[FieldError]) -> None:
        super().__init__(errors[0].message)
        self.errors = errors


@lru_cache(maxsize=256)
def built(source: Source) -> Hexapod:
    """The hexapod of a source. Raises InvalidDesign with every field that is wrong."""
    changes = json.loads(source.changes)
    hexapod = _of_text(source.text)
    return _changed(hexapod, changes) if changes else hexapod


@lru_cache(maxsize=64)
def _of_text(text: str) -> Hexapod:
    try:
        return Hexapod.from_toml(text)
    except DesignError as error:
        raise InvalidDesign(_errors_in(text, error)) from error


def _errors_in(text: str, error: DesignError) -> list[FieldError]:
    """The error that stopped the reading, or every key of the text that is wrong by itself."""
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError):
        line = re.search(r"at line (\d+)", str(error))
        return [FieldError("", str(error), int(line[1]) if line else 0)]
    found = [e for path, value in _leaves(tables) for e in _error_of_key(path, value, text)]
    return found or [FieldError(_key_in(str(error)), str(error), _line_of(text, _key_in(str(error))))]


def _leaves(tables: Mapping[str, Any], start: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], Any]]:
    result: list[tuple[tuple[str, ...], Any]] = []
    for key, value in tables.items():
        path = (*start, key)
        result += _leaves(value, path) if isinstance(value, Mapping) and ".".join(path) in TABLES else [(path, value)]
    return result


def _error_of_key(path: tuple[str, ...], value: Any, text: str) -> list[FieldError]:
    alone = value
    for name in reversed(path):
        alone = {name: alone}
    try:
        design_file.flatten(alone)
    except DesignError as error:
        key = ".".join(path)
        return [FieldError(_key_in(key) or key, str(error), _line_of(text, key))]
    return []


def _key_in(message: str) -> str:
    """The first key of a design file that a message names, without unit or index."""
    known = sorted({*KEYS, *TEXT_KEYS}, key=len, reverse=True)
    places = [(message.find(key), -len(key), key) for key in known if key in message]
    return min(places)[2] if places else ""


def _line_of(text: str, key: str) -> int:
    """The line where a dotted key (its unit aside) is set in a design file; 0 if it is not."""
    table, _, last = key.rpartition(".")
    here = ""
    for number, line in enumerate(text.splitlines(), 1):
        header = re.match(r"\s*\[([\w.]+)\]\s*(#.*)?$", line)
        if header:
            here = header[1].strip()
        elif here == table and re.match(rf"\s*{re.escape(last)}(_\w+)?\s*=", line):
            return number
    return 0


def _changed(hexapod: Hexapod, changes: dict[str, Any]) -> Hexapod:
    try:
        return _apply(hexapod, changes)
    except DesignError as error:
        alone = []
        for key, value in changes.items():
            try:
                _apply(hexapod, {key: value})
            except DesignError as its_own:
                alone.append(FieldError(key, str(its_own), 0))
        raise InvalidDesign(alone or [FieldError(_key_in(str(error)), str(error), 0)]) from error


def _apply(hexapod: Hexapod, changes: dict[str, Any]) -> Hexapod:
    plain = {key: value for key, value in changes.items() if key not in _RADII}
    if plain:
        hexapod = hexapod.replace(plain)
    for key in _RADII & changes.keys():
        plate = key.split(".")[0]
        joints = getattr(hexapod, f"{plate}_joints")
        value = changes[key]
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < 1e6:
            raise DesignError(f"{key} is {value!r} m; it must be a number > 0.")
        hexapod = hexapod.replace({f"{plate}.joints": joints * [*(2 * [value / _radius(joints)]), 1.0]})
    return hexapod


def _radius(joints: Any) -> float:
    """Mean distance of the joints from the plate's z axis, m."""
    return float(np.hypot(joints[:, 0], joints[:, 1]).mean())


_RADII = {"base.radius", "platform.radius"}  #: keys of the page only: joints scaled from the z axis


class Chief(NamedTuple):
    """A number of the design with a slider: its key, name, unit, how to read it, whether the slider is logarithmic."""

    key: str
    label: str
    unit: str
    read: Callable[[Hexapod], float]
    logarithmic: bool = True


CHIEF = (
    Chief("platform.mass", "Platform + payload", "kg", lambda h: h.platform_mass),
    Chief("legs.stiffness", "Leg stiffness", "N/m", lambda h: float(h.legs.stiffness.mean())),
    Chief("legs.damping.prismatic", "Leg damping", "N s/m", lambda h: float(h.legs.damping.prismatic.mean())),
    Chief("base.radius", "Base radius", "m", lambda h: _radius(h.base_joints)),
    Chief("platform.radius", "Platform radius", "m", lambda h: _radius(h.platform_joints)),
    Chief("platform.mass_center[2]", "Mass centre, z", "m", lambda h: float(h.platform_mass_center[2]), False),
    Chief("legs.lower.mass", "Lower leg mass", "kg", lambda h: float(h.legs.lower.mass.mean())),
    Chief("legs.upper.mass", "Upper leg mass", "kg", lambda h: float(h.legs.upper.mass.mean())),
)


def fields() -> list[dict[str, Any]]:
    """Every plain key of a design file with its meaning, unit and shapes, for the form."""
    short = re.compile(r"\.(circle|rod)\.|^cubic\.")
    return [
        {
            "key": _shown(key),
            "meaning": rule.meaning,
            "unit": "°" if rule.dimension == "angle" else printed(si_unit(rule.dimension)),
            "shapes": [list(shape) for shape in rule.shapes],
            "optional": key.startswith(("limits.", "home.")),
        }
        for key, rule in KEYS.items()
        if not short.search(key)
    ]


def described(source: Source) -> dict[str, Any]:
    """All that the page shows of a design itself: numbers by key, chief numbers, home, box, warnings, its TOML."""
    hexapod = built(source)
    original = _of_text(source.text)
    return {
        "name": hexapod.name,
        "digest": hexapod.digest,
        "warnings": list(hexapod.warnings),
        "values": _values(hexapod),
        "chief": [
            {
                "key": chief.key,
                "label": chief.label,
                "unit": chief.unit,
                "logarithmic": chief.logarithmic,
                "original": chief.read(original),
                "value": chief.read(hexapod),
                "size": _radius(original.base_joints),
            }
            for chief in CHIEF
        ],
        "home": home(hexapod),
        "box": box(hexapod),
        "leg": _leg_at(hexapod, home(hexapod)),
        "toml": source.text if source.changes == "{}" else hexapod.to_toml(),
    }


def _shown(key: str) -> str:
    """A key as the form has it: angles in degrees, as people write them."""
    return f"{key}_deg" if KEYS[key].dimension == "angle" else key


def _values(hexapod: Hexapod) -> dict[str, Any]:
    """Every number of a design by the key of its field."""
    values: dict[str, Any] = {}
    for key, value in hexapod.values().items():
        if key in TEXT_KEYS:
            values[key] = value
        elif KEYS[key].dimension == "angle":
            values[_shown(key)] = np.round(np.degrees(value), 12).tolist()
        else:
            values[key] = value.tolist()
    return values


def _leg_at(hexapod: Hexapod, six: list[float]) -> float:
    """Mean distance of the legs' joints at a pose, m: how long to draw the parts of a leg."""
    pose = Pose.from_rpy(*six[:3], *np.radians(six[3:]))
    ends = pose.position + hexapod.platform_joints @ pose.matrix.T
    return float(np.linalg.norm(ends - hexapod.base_joints, axis=1).mean())


def home(hexapod: Hexapod) -> list[float]:
    """The home pose in m and degrees; without one in the design, the platform over the base at a usual height."""
    if hexapod.home is not None:
        position, rpy = hexapod.home
        return [*position.tolist(), *np.round(np.degrees(rpy), 12).tolist()]
    base, platform = hexapod.base_joints, hexapod.platform_joints
    centre = base.mean(axis=0) - platform.mean(axis=0)
    height = 1.2 * _radius(base)
    if hexapod.limits.leg_length is not None:
        offset = np.linalg.norm((platform + centre - base)[:, :2], axis=1)
        middle = np.asarray(hexapod.limits.leg_length).reshape(-1, 2).mean(axis=1)
        height = float(np.sqrt(np.maximum(middle**2 - offset**2, (0.2 * middle) ** 2)).mean())
    x, y, z = centre.tolist()
    return [x, y, z + height, 0.0, 0.0, 0.0]


def box(hexapod: Hexapod) -> dict[str, list[float]]:
    """Ranges of the pose that the sliders and sweeps start with, m and degrees, around home.

    As far as the legs' stroke takes the platform where the design limits it, otherwise a quarter of a leg's length.
    """
    at = np.array(home(hexapod))
    reach = 0.25 * _leg_at(hexapod, at.tolist())
    if hexapod.limits.leg_length is not None:
        pairs = np.asarray(hexapod.limits.leg_length).reshape(-1, 2)
        reach = min(reach, 0.6 * float((pairs[:, 1] - pairs[:, 0]).mean()))
    turn = min(30.0, float(np.degrees(reach / max(_radius(hexapod.platform_joints), 1e-9))))
    span = np.array([_rounded(v) for v in (reach, reach, reach, turn, turn, turn)])
    return {"low": np.round(at - span, 9).tolist(), "high": np.round(at + span, 9).tolist()}


def _rounded(value: float) -> float:
    """One significant digit and a half, so that sliders end at numbers people read."""
    return float(f"{value:.1e}")
