"""What the short forms of a design file stand for: tables of joints, circles, the cubic configuration, rods, axes."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from flexapod.conventions import TWO_PI, Array
from flexapod.design.home import home_of
from flexapod.design.schema import KEYS
from flexapod.design.short_forms import ShortForm
from flexapod.design.universal_axes import default_axes_of
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, PoseError
from flexapod.pose import Pose
from flexapod.rotations import FIXED

Values = dict[str, Any]  # dotted key -> array in SI units, or text

#: Tables of short keys, and the plain keys that they stand for.
MAKES = {
    "home.turned": ("home.position", "home.orientation"),  # first: tables of joints may need the home pose
    "base.circle": ("base.joints",),
    "platform.circle": ("platform.joints",),
    "cubic": ("base.joints", "platform.joints"),
    **{
        f"legs.{part}.rod": tuple(f"legs.{part}.{key}" for key in ("mass", "mass_center", "inertia"))
        for part in ("lower", "upper")
    },
}
#: What a new one also takes the place of.
BESIDE = {
    "base.circle": ("base.universal_axes",),
    "cubic": ("base.universal_axes", "home.position", "home.orientation"),
}
#: Keys that set several others, and these.
SETS: dict[str, tuple[str, ...]] = {
    "legs.stiffness_law.area": ("legs.stiffness_law.area_1", "legs.stiffness_law.area_2")
}
#: What a table needs, by its last name: keys, or pairs of keys of which it takes one.
NEEDS: dict[str, tuple[str | tuple[str, str], ...]] = {
    "circle": ("radius", ("angles", "half_angle")),
    "cubic": (("edge", "height"), "middle"),
    "rod": ("mass", "length"),
    "turned": ("position", "angles"),
}


def expand(values: Values, directory: Path | None = None) -> tuple[Values, tuple[ShortForm, ...]]:
    """The same design in plain keys only, and the short forms that were given.

    Raises DesignError where a short form and its plain keys are both given. directory: where files that the design
    names are looked for; without it none is read, so that a text from elsewhere cannot make this computer read files.
    """
    values = dict(values)
    for key, keys in SETS.items():
        if key in values:
            one = values.pop(key)
            for other in keys:
                if other in values:
                    raise DesignError(f"{key} and {other} are both given, and both set {other}. Leave one of them out.")
                values[other] = one
    given: dict[str, Values] = {}
    made: dict[str, Values] = {}
    for table, keys in MAKES.items():
        if table == "base.circle":
            _expand_table(values, directory)
        short = _take(values, table)
        if short:
            _refuse_both(values, table, *keys)
            _check_complete(short, table)
            given[table] = short
            made[table] = {key: check_value(key, value, KEYS[key]) for key, value in make(table, short).items()}
            values |= made[table]
    if "cubic" in made and not {"home.position", "home.orientation"} & values.keys():
        in_base, in_platform = cube_centers(given["cubic"])
        made["cubic"] |= {"home.position": in_base - in_platform + 0.0, "home.orientation": np.zeros(3)}
        values |= made["cubic"]
    if {"base.joints", "platform.joints"} <= values.keys() and "base.universal_axes" not in values:
        values["base.universal_axes"] = default_axes_of(values)
        for table in {"base.circle", "cubic"} & made.keys():
            made[table]["base.universal_axes"] = values["base.universal_axes"]
    return values, tuple(ShortForm(table, given[table], made[table]) for table in given)


def make(table: str, given: Mapping[str, Any]) -> dict[str, Any]:
    """What the numbers of a short form stand for, by plain key; complex numbers keep their derivatives."""
    if table == "home.turned":
        return turned(given)
    if table == "cubic":
        lower, upper = cubic(_edge(given), given["middle"])
        in_base, in_platform = cube_centers(given)
        return {"base.joints": lower + in_base, "platform.joints": upper + in_platform}
    if table.endswith(".rod"):
        center, inertia = rod(
            given["mass"], given["length"], given.get("radius", 0.0), 1.0 if "lower" in table else -1.0
        )
        mass = np.broadcast_to(given["mass"], 6) + 0.0
        return dict(zip(MAKES[table], (mass, center, inertia), strict=True))
    plate = table.split(".")[0]
    angles = given["angles"] if "angles" in given else pair_angles(plate, given["half_angle"])
    return {f"{plate}.joints": circle(given["radius"], angles, given.get("height", 0.0)) + 0.0}


def turned(given: Mapping[str, Any]) -> dict[str, Array]:
    """Home from angles of any order about any point of the platform."""
    try:
        home = Pose.from_angles(
            given["position"],
            given["angles"],
            given.get("rotation_order", FIXED),
            pivot=given.get("pivot", (0.0, 0.0, 0.0)),
        )
    except PoseError as error:
        raise DesignError(f"home.turned: {error}") from None
    return {"home.position": home.position + 0.0, "home.orientation": home.rpy}


def circle(radius: Any, angles: Any, height: Any) -> Array:
    """Six joints on a circle about z, shape (6, 3)."""
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(6, height)], axis=1)


def circle_table(plate: str, radius: float, half_angle: Any, angles: Any, degrees: bool) -> Values:
    """The table [base.circle] or [platform.circle] of a plate given by half angle or angles."""
    if (half_angle is None) == (angles is None):
        raise DesignError(
            f"{plate}_half_angle and {plate}_angles are {'both missing' if angles is None else 'both given'}; give one "
            "of them: half the angle between the joints of a pair, or the angles of all six joints."
        )
    unit = "deg" if degrees else "rad"
    if angles is None:
        check_value(f"{plate}_half_angle", half_angle, KEYS[f"{plate}.circle.half_angle"], unit)
        angles = pair_angles(plate, half_angle, 360.0 if degrees else TWO_PI)
    return {"radius": radius, f"angles_{unit}": angles}


def pair_angles(plate: str, half_angle: Any, turn: float = TWO_PI) -> Array:
    """Angles of six joints in three pairs, on the base legs 1 and 2 first, on the platform 6 and 1. turn: a whole."""
    first = turn / 6 if plate == "base" else 0.0
    angles = first + np.repeat([0.0, turn / 3, 2 * turn / 3], 2) + np.tile([-1.0, 1.0], 3) * half_angle
    return angles if plate == "base" else np.append(angles[1:], angles[0] + turn)


def stands_in_pairs(plate: str, angles: Array) -> bool:
    """Whether the six joints of a circle are the pairs that a half angle stands for."""
    away = np.angle(np.exp(1j * (angles - pair_angles(plate, 0.0))))
    half = np.abs(away).mean()
    return bool(np.abs(away - (pair_angles(plate, half) - pair_angles(plate, 0.0))).max() < 1e-6)


def cubic(edge: Any, middle: Any) -> tuple[Array, Array]:
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


def _edge(given: Mapping[str, Any]) -> Any:
    return given["edge"] if "edge" in given else given["height"] * np.sqrt(3)


def cube_centers(given: Mapping[str, Any]) -> tuple[Any, Any]:
    """The cube's centre in the base frame, by default with the base joints at z = 0, and in the platform frame."""
    lower, _ = cubic(_edge(given), given["middle"])
    in_base = given.get("center_in_base", np.array([0.0, 0.0, 1.0]) * -lower[0, 2])
    return in_base, given.get("center_in_platform", np.zeros(3))


def rod(mass: Any, length: Any, radius: Any, side: float) -> tuple[Array, Array]:
    """Mass centre (6, 3) and inertia (6, 3, 3) of a uniform round rod along the leg, from its joint (side 1 or -1)."""
    mass, length, radius = (np.broadcast_to(value, (6,)) for value in (mass, length, radius))
    along, across = mass * radius**2 / 2, mass * (3 * radius**2 + length**2) / 12
    inertia = np.zeros((6, 3, 3), dtype=across.dtype)
    inertia[:, 0, 0], inertia[:, 1, 1], inertia[:, 2, 2] = along, across, across
    return np.stack([side * length / 2, np.zeros(6), np.zeros(6)], axis=1), inertia


def _take(values: Values, table: str) -> Values:
    """Remove and return the keys of one table."""
    start = f"{table}."
    found = {key[len(start) :]: value for key, value in values.items() if key.startswith(start)}
    for key in found:
        del values[start + key]
    return found


def _check_complete(given: Values, table: str) -> None:
    """Refuses a short form in which something is missing, or given twice."""
    for need in NEEDS[table.split(".")[-1]]:
        if isinstance(need, str):
            if need not in given:
                rule = KEYS[f"{table}.{need}"]
                must = f"Add {need} = {rule.shape_text} to [{table}]."
                raise DesignError(f"{table}.{need} is missing ({rule.meaning}). {must}")
            continue
        one, other = need
        if (one in given) == (other in given):
            which = "both given" if one in given else "both missing"
            meanings = " or ".join(f"{key} ({KEYS[f'{table}.{key}'].meaning})" for key in need)
            raise DesignError(f"{table}.{one} and {table}.{other} are {which}. Give one of them: {meanings}.")


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

    for key, value in read_joints(directory / given, home_of(values)).items():
        if value is not None:
            _refuse_both(values, "joints", key)
            values[key] = check_value(key, value, KEYS[key])
