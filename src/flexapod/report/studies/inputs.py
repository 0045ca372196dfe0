"""What a machine was computed from, number by number, so that a page can be checked, and the machine made again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, LEGS, ROTATIONS, TRANSLATIONS, Array
from flexapod.design.drive import values_of_drive
from flexapod.design.hexapod import Hexapod
from flexapod.design.schema import KEYS, TEXT_KEYS, is_of_each_leg
from flexapod.design.stiffness_laws import TableLaw
from flexapod.design.units import printed, si_unit
from flexapod.pose import Pose
from flexapod.report.study import Column, Section, Table

WORDS = (
    "The design that was computed, after all changes. Joints of the base and axes of its universal joints are in the "
    "base frame, joints and body of the platform in the platform frame, parts of legs in the axes of their leg: mass "
    "centres from their joint. Inertias are about the body's own mass centre."
)
_JOINTS = "legs.joint_stiffness."
_INERTIA = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}


def section(hexapod: Hexapod) -> Section:
    """The part of a page that lists a design."""
    tables = [_joints(hexapod), *_legs(hexapod), *_springs(hexapod), *_drive(hexapod), _bodies(hexapod)]
    tables.append(_further(hexapod))
    return Section("Inputs", tables, [WORDS])


def number(value: float) -> str:
    """A number as it was given: nine digits, without zeros at the end."""
    return f"{value + 0.0:.9g}"


def _texts(values: ArrayLike) -> list[str]:
    return [number(float(value)) for value in np.asarray(values)]


def _joints(hexapod: Hexapod) -> Table:
    columns = [Column("leg", LEGS)]
    for title, points, scale, unit in (
        ("base", hexapod.base_joints, 1e3, "mm"),
        ("platform", hexapod.platform_joints, 1e3, "mm"),
        ("axis", hexapod.universal_axes, 1.0, ""),
    ):
        rows = np.round(scale * points, 9)
        columns += [Column(f"{title} {axis}", _texts(rows[:, k]), unit) for k, axis in enumerate(TRANSLATIONS)]
    return Table(columns, title="Joints, and axes of the universal joints", style="narrow", on="page")


def _legs(hexapod: Hexapod) -> list[Table]:
    """Every number that each leg has for itself, those of its joints' springs apart."""
    values = {
        key: value
        for key, value in hexapod.values().items()
        if key.startswith("legs.") and not key.endswith((".mass", ".mass_center"))  # those stand with the bodies
    }
    joints = {key: values.pop(key) for key in list(values) if key.startswith(_JOINTS)}
    found = [_of_each_leg(values, "legs.", "Legs")]
    return [*found, _of_each_leg(joints, _JOINTS, "Stiffness of the joints")] if joints else found


def _of_each_leg(values: Mapping[str, Any], start: str, title: str) -> Table:
    """A column for each number of the legs, by key without its start."""
    named: dict[str, tuple[str, Array]] = {}  # title -> its key and a number of each leg
    for key, value in values.items():
        name = key.removeprefix(start).replace(".", ", ")
        if key in TEXT_KEYS or not is_of_each_leg(key):
            continue
        if np.shape(value) == (6,):
            named[name] = key, value
        elif np.ndim(value) == 2 and len(value) == 6:
            named |= {f"{name} {k + 1}": (key, value[:, k]) for k in range(value.shape[1])}
    rows, names = _alike([value for _, value in named.values()], LEGS)
    columns = [Column("leg", names)]
    for name, (key, _), column in zip(named, named.values(), rows, strict=True):
        columns.append(Column(name.replace("_", " "), _texts(column), _unit(key)))
    return Table(columns, title=title, style="narrow", on="page")


def _drive(hexapod: Hexapod) -> list[Table]:
    """Screws and gears, and the curve of the motor."""
    if hexapod.drive is None:
        return []
    values = values_of_drive(hexapod.drive)
    found = [_of_each_leg(values, "drive.", "Drive of the legs")]
    curve = {key: value for key, value in values.items() if not is_of_each_leg(key)}
    if curve:
        columns = [
            Column(key.rpartition(".")[2].replace("_", " "), _texts(value), _unit(key)) for key, value in curve.items()
        ]
        found.append(Table(columns, title="Torque and speed of the motors", style="narrow", on="page"))
    return found


def _unit(key: str) -> str:
    return printed(si_unit(KEYS[key].dimension)).replace("m2", "m\u00b2").replace("s2", "s\u00b2")


def _springs(hexapod: Hexapod) -> list[Table]:
    """The table of a stiffness law, and the suspension."""
    found = []
    law, suspension = hexapod.legs.stiffness_law, hexapod.suspension
    if isinstance(law, TableLaw):
        columns = [Column("length", _texts(law.lengths), "m"), Column("stiffness", _texts(law.stiffnesses), "N/m")]
        found.append(Table(columns, title="Stiffness of the legs by their length", style="narrow", on="page"))
    if suspension is not None:
        for title, matrix in (("Stiffness", suspension.stiffness), ("Damping", suspension.damping)):
            columns = [Column("", list(AXES)), *(Column(axis, _texts(matrix[:, k])) for k, axis in enumerate(AXES))]
            words = f"{title} of the suspension, SI units, axes of the base"
            found.append(Table(columns, title=words, style="narrow", on="page"))
    return found


def _alike(columns: Sequence[Array], names: Sequence[str]) -> tuple[list[Array], list[str]]:
    """The rows of all legs; one row where the legs are all the same."""
    if all((column == column[0]).all() for column in columns):
        return [column[:1] for column in columns], ["1 to 6"]
    return list(columns), list(names)


def _bodies(hexapod: Hexapod) -> Table:
    platform = (np.array([hexapod.platform_mass]), hexapod.platform_mass_center[None], hexapod.platform_inertia[None])
    names, masses, centres, inertias = ["platform with payload"], *([part] for part in platform)
    for side in ("lower", "upper"):
        part = getattr(hexapod.legs, side)
        kept, legs = _alike([part.mass, part.mass_center, part.inertia], LEGS)
        names += [f"leg {leg}, {side} part" for leg in legs]
        for found, value in zip((masses, centres, inertias), kept, strict=True):
            found.append(value)
    centre, inertia = np.round(1e3 * np.concatenate(centres), 9), np.concatenate(inertias)
    columns = [Column("body", names), Column("mass", _texts(np.concatenate(masses)), "kg")]
    columns += [Column(f"centre {axis}", _texts(centre[:, k]), "mm") for k, axis in enumerate(TRANSLATIONS)]
    columns += [Column(f"J {name}", _texts(inertia[:, i, j]), "kg m\u00b2") for name, (i, j) in _INERTIA.items()]
    return Table(columns, title="Bodies", style="narrow", on="page")


def _further(hexapod: Hexapod) -> Table:
    facts = {"gravity": f"({', '.join(_texts(hexapod.gravity))}) m/s\u00b2"}
    facts["home"] = "none" if hexapod.home is None else _pose(hexapod.home)
    law, suspension = hexapod.legs.stiffness_law, hexapod.suspension
    if law is not None:
        facts["stiffness law"] = law.kind.name
    if suspension is not None:
        facts["suspension at"] = f"({', '.join(_texts(suspension.point))}) m, platform frame"
    if hexapod.legs.joint_rest is not None:
        facts["joints at rest"] = _pose(hexapod.legs.joint_rest)
    for name, place in hexapod.points.items():
        facts[f"point {name}"] = f"({', '.join(_texts(place))}) m, platform frame"
    facts["limits"] = "; ".join(limits(hexapod)) or "none"
    columns = [Column("", list(facts)), Column("", list(facts.values()))]
    title = "Gravity, home, points and limits" if hexapod.points else "Gravity, home and limits"
    return Table(columns, title=title, style="facts", on="page")


def _pose(pose: Pose) -> str:
    place = ", ".join(f"{axis} {x}" for axis, x in zip(TRANSLATIONS, _texts(pose.position), strict=True))
    turn = np.round(np.degrees(pose.rpy), 9)
    return f"{place} m; " + ", ".join(f"{axis} {x}\u00b0" for axis, x in zip(ROTATIONS, _texts(turn), strict=True))


def limits(hexapod: Hexapod) -> list[str]:
    """The limits of a design in words; nothing where it sets none."""
    given = hexapod.limits
    found = []
    if given.leg_length is not None:
        pairs = np.round(np.reshape(given.leg_length, (-1, 2)) * 1e3, 9)
        found.append("length " + ", ".join(f"{number(low)} to {number(high)} mm" for low, high in pairs))
    for name, most in (("universal", given.universal_angle), ("spherical", given.spherical_angle)):
        if most is not None:
            found.append(f"{name} joint {number(round(float(np.degrees(most)), 9))}\u00b0")
    for name, moment in (("universal", given.universal_moment), ("spherical", given.spherical_moment)):
        if moment is not None:
            found.append(f"moment of {name} joints {number(moment)} N m")
    if given.leg_distance is not None:
        found.append(f"distance of leg axes at least {number(round(1e3 * given.leg_distance, 9))} mm")
    for name, most in (("compression", given.leg_compression), ("tension", given.leg_tension)):
        if most is not None:
            found.append(f"{name} of legs {number(most)} N")
    for name in given.of_motions:
        words = name.removeprefix("leg_")
        found.append(f"{words} of legs {number(getattr(given, name))} {_unit(f'limits.{name}')}, of motions")
    return found
