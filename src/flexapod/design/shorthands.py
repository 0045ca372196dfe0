"""What the short forms of a design file stand for: tables of joints, circles, the cubic configuration, rods, axes."""

from pathlib import Path
from typing import Any

import numpy as np

from flexapod.conventions import TWO_PI, Array
from flexapod.design.schema import KEYS, Key
from flexapod.design.universal_axes import default_axes
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError
from flexapod.pose import Pose, rpy_matrix

_HALF_ANGLE = Key("angle between a joint and the middle of its pair", "angle", ((),), least=0.0, open_=True)

Values = dict[str, Any]  # dotted key -> array in SI units, or text


def expand(values: Values, directory: Path | None = None) -> Values:
    """The same design in plain keys only. Raises DesignError where a short form and its plain keys are both given.

    directory: where files that the design names are looked for; without it none is read, so that a text from elsewhere
    cannot make this computer read files.
    """
    values = dict(values)
    _expand_table(values, directory)
    for plate in ("base", "platform"):
        _expand_circle(values, plate)
    _expand_cubic(values)
    for part, side in (("lower", 1.0), ("upper", -1.0)):
        _expand_rod(values, f"legs.{part}", side)
    if {"base.joints", "platform.joints"} <= values.keys() and "base.universal_axes" not in values:
        joints = values["base.joints"], values["platform.joints"]
        values["base.universal_axes"] = default_axes(*joints, _home(values))
    return values


def circle(radius: float, angles: Array, height: float) -> Array:
    """Six joints on a circle about z, shape (6, 3)."""
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(6, height)], axis=1)


def circle_table(plate: str, radius: float, half_angle: float | None, angles: Any, degrees: bool) -> Values:
    """The table [base.circle] or [platform.circle] of a plate given by half angle or angles, in legs' order."""
    if (half_angle is None) == (angles is None):
        raise DesignError(
            f"{plate}_half_angle and {plate}_angles are {'both missing' if angles is None else 'both given'}; give one "
            "of them: half the angle between the joints of a pair, or the angles of all six joints."
        )
    unit = "deg" if degrees else "rad"
    if angles is None:
        check_value(f"{plate}_half_angle", half_angle, _HALF_ANGLE, unit)
        first = 60.0 if plate == "base" else 0.0
        middles = first + np.repeat([0.0, 120.0, 240.0], 2)
        angles = (middles if degrees else np.radians(middles)) + np.tile([-1.0, 1.0], 3) * half_angle
        if plate == "platform":  # legs 6 and 1 are its first pair
            angles = np.append(angles[1:], angles[0] + (360.0 if degrees else TWO_PI))
    return {"radius": radius, f"angles_{unit}": angles}


def cubic(edge: float, middle: float) -> tuple[Array, Array]:
    """Lower and upper joints of the six legs about the cube's centre, each (6, 3).

    The cube stands on a corner. Its legs are the edges between the three corners next to the lowest one and the three
    next to the highest one, in order of their angle about z; `middle` is the share of each edge between its joints.
    """
    height = edge / np.sqrt(3)
    lower_angle = np.deg2rad([0.0, 120.0, 120.0, 240.0, 240.0, 0.0])
    upper_angle = np.deg2rad([60.0, 60.0, 180.0, 180.0, 300.0, 300.0])
    lower = circle(np.sqrt(2) * height, lower_angle, -height / 2)
    upper = circle(np.sqrt(2) * height, upper_angle, height / 2)
    center, half = (upper + lower) / 2, (upper - lower) / 2
    return center - middle * half, center + middle * half


def rod(mass: Array, length: Array, radius: Array, side: float) -> tuple[Array, Array]:
    """Mass centre (6, 3) and inertia (6, 3, 3) of a uniform round rod along the leg, from its joint (side 1 or -1)."""
    mass, length, radius = (np.broadcast_to(value, (6,)) for value in (mass, length, radius))
    along, across = mass * radius**2 / 2, mass * (3 * radius**2 + length**2) / 12
    inertia = np.zeros((6, 3, 3))
    inertia[:, 0, 0], inertia[:, 1, 1], inertia[:, 2, 2] = along, across, across
    return np.stack([side * length / 2, np.zeros(6), np.zeros(6)], axis=1), inertia


def _home(values: Values) -> Pose | None:
    """The home pose, where the values have one."""
    if "home.position" not in values:
        return None
    return Pose(values["home.position"], rpy_matrix(values.get("home.orientation", np.zeros(3))))


def _take(values: Values, table: str) -> Values:
    """Remove and return the keys of one table."""
    start = f"{table}."
    found = {key[len(start) :]: value for key, value in values.items() if key.startswith(start)}
    for key in found:
        del values[start + key]
    return found


def _need(given: Values, table: str, *keys: str) -> None:
    for key in keys:
        if key not in given:
            rule = KEYS[f"{table}.{key}"]
            raise DesignError(f"{table}.{key} is missing ({rule.meaning}). Add {key} = {rule.shape_text} to [{table}].")


def _refuse_both(values: Values, table: str, *keys: str) -> None:
    for key in keys:
        if key in values:
            raise DesignError(f"{key} and [{table}] are both given, and both set {key}. Leave one of them out.")


def _expand_table(values: Values, directory: Path | None) -> None:
    given = values.pop("joints.csv", None)
    if given is None:
        return
    if directory is None:
        raise DesignError(
            f"joints.csv is {given!r}: a file is read only for a design file that names it, opened with flexapod.load "
            "or by a command. Elsewhere use hexapod.replace(flexapod.design.read_joints(...)), or give base.joints and "
            "platform.joints."
        )
    for short in ("base.circle", "platform.circle", "cubic"):
        if any(key.startswith(f"{short}.") for key in values):
            raise DesignError(f"[{short}] and [joints] are both given, and both set joints. Leave one of them out.")
    _refuse_both(values, "joints", "base.joints", "platform.joints")
    from flexapod.design.joint_table import read_joints  # the reader of tables is needed for designs with a table only

    for key, value in read_joints(directory / given, _home(values)).items():
        if value is not None:
            _refuse_both(values, "joints", key)
            values[key] = check_value(key, value, KEYS[key])


def _expand_circle(values: Values, plate: str) -> None:
    table = f"{plate}.circle"
    given = _take(values, table)
    if given:
        _refuse_both(values, table, f"{plate}.joints")
        _need(given, table, "radius", "angles")
        values[f"{plate}.joints"] = circle(given["radius"], given["angles"], given.get("height", 0.0)) + 0.0


def _expand_cubic(values: Values) -> None:
    given = _take(values, "cubic")
    if not given:
        return
    _refuse_both(values, "cubic", "base.joints", "platform.joints")
    if ("edge" in given) == ("height" in given):
        which = "both given" if "edge" in given else "both missing"
        raise DesignError(
            f"cubic.edge and cubic.height are {which}. Give one of them: the cube's edge, or edge / sqrt(3), "
            "the height of the legs' edges."
        )
    _need(given, "cubic", "middle")
    edge = given.get("edge", given.get("height", 0.0) * np.sqrt(3))
    lower, upper = cubic(float(edge), float(given["middle"]))
    in_base = given.get("center_in_base", np.array([0.0, 0.0, -lower[0, 2]]))
    in_platform = given.get("center_in_platform", np.zeros(3))
    values["base.joints"] = check_value("base.joints", lower + in_base, KEYS["base.joints"])
    values["platform.joints"] = check_value("platform.joints", upper + in_platform, KEYS["platform.joints"])
    if "home.position" not in values and "home.orientation" not in values:
        values["home.position"] = in_base - in_platform + 0.0


def _expand_rod(values: Values, table: str, side: float) -> None:
    given = _take(values, f"{table}.rod")
    if given:
        _refuse_both(values, f"{table}.rod", *(f"{table}.{key}" for key in ("mass", "mass_center", "inertia")))
        _need(given, f"{table}.rod", "mass", "length")
        center, inertia = rod(given["mass"], given["length"], given.get("radius", np.zeros(())), side)
        values |= {f"{table}.mass": given["mass"], f"{table}.mass_center": center, f"{table}.inertia": inertia}
