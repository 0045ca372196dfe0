"""The keys of a design file: what each one means, its unit, its shapes, its range, and the check of one value."""

from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from flexapod.design.units import ALL_UNITS, UNITS, printed, si_unit, to_si
from flexapod.errors import DesignError, shown

FloatArray = NDArray[np.float64]

SHAPES = {
    (): "one number",
    (2,): "two numbers [min, max]",
    (3,): "three numbers [x, y, z]",
    (6,): "six numbers, one for each leg",
    (3, 3): "three rows of three numbers",
    (6, 2): "six pairs [min, max]",
    (6, 3): "six rows [x, y, z]",
    (6, 3, 3): "six matrices of three rows of three numbers",
}


@dataclass(frozen=True)
class Key:
    """What a value must be. `least` and `most` are in SI units; `open_` leaves `least` itself out."""

    meaning: str
    dimension: str | None
    shapes: tuple[tuple[int, ...], ...]
    remedy: str = "Write the number in SI units or put another unit in the key's name."
    least: float | None = None
    most: float | None = None
    open_: bool = False
    symmetric: bool = False

    @property
    def shape_text(self) -> str:
        return " or ".join(SHAPES[shape] for shape in self.shapes)


_ONE: tuple[tuple[int, ...], ...] = ((),)
_LEGS: tuple[tuple[int, ...], ...] = ((), (6,))
_VECTOR = ((3,),)
_JOINTS = ((6, 3),)
_INERTIA = "Write the same number on both sides of the diagonal; principal moments alone stand on it, zeros beside."
_LARGEST = 1e100  # squares and products of such numbers still do not overflow
_DEEPEST = max(len(shape) for shape in SHAPES) + 2  # a little more than any value has: the shape is checked later
_FLAT_ANGLE = 3.141592653589793
_ROW_REMEDY = "Give one row [x, y, z] for each of the six legs."
_ANGLE_REMEDY = "If the number is in degrees, put _deg at the end of the key."


def _part(joint: str) -> dict[str, Key]:
    """The keys of one leg part; `joint` is where its mass centre is measured from."""
    return {
        "mass": Key(
            "mass of this part of the leg",
            "mass",
            _LEGS,
            "Give a mass that is not negative; leave legs.lower and legs.upper both out for massless legs.",
            least=0.0,
        ),
        "mass_center": Key(f"mass centre from the {joint}, leg axes", "length", ((3,), (6, 3))),
        "inertia": Key(
            "inertia about the part's own mass centre, leg axes",
            "inertia",
            ((3, 3), (6, 3, 3)),
            _INERTIA,
            symmetric=True,
        ),
        "rod.mass": Key("mass of a uniform round rod", "mass", _LEGS, "A rod has a mass > 0.", least=0.0, open_=True),
        "rod.length": Key(
            f"length of the rod, which starts at the {joint} and lies along the leg",
            "length",
            _LEGS,
            "A rod has a length > 0.",
            least=0.0,
            open_=True,
        ),
        "rod.radius": Key("radius of the rod", "length", _LEGS, "Leave it out for a thin rod.", least=0.0),
    }


def _circle(plate: str) -> dict[str, Key]:
    return {
        "radius": Key(
            f"radius of the {plate}'s joint circle", "length", _ONE, "Give a radius > 0.", least=0.0, open_=True
        ),
        "angles": Key(
            f"angles of the six {plate} joints about z, from x",
            "angle",
            ((6,),),
            _ANGLE_REMEDY,
            least=-4 * _FLAT_ANGLE,
            most=4 * _FLAT_ANGLE,
        ),
        "height": Key(f"z of the six {plate} joints", "length", _ONE),
    }


def _under(table: str, keys: dict[str, Key]) -> dict[str, Key]:
    return {f"{table}.{key}": rule for key, rule in keys.items()}


_DAMPING = Key("viscous friction", "angular damping", _LEGS, "Give 0 for a joint without friction.", least=0.0)

KEYS: dict[str, Key] = {
    "gravity": Key("gravity, inertial frame", "acceleration", _VECTOR),
    "base.joints": Key("base joints, base frame", "length", _JOINTS, _ROW_REMEDY),
    "base.universal_axes": Key("axes of the universal joints fixed in the base", None, _JOINTS, _ROW_REMEDY),
    **_under("base.circle", _circle("base")),
    "platform.joints": Key("platform joints, platform frame", "length", _JOINTS, _ROW_REMEDY),
    **_under("platform.circle", _circle("platform")),
    "platform.mass": Key(
        "platform with payload",
        "mass",
        _ONE,
        "Give the mass of platform and payload together.",
        least=0.0,
        open_=True,
    ),
    "platform.mass_center": Key("mass centre, platform frame", "length", _VECTOR),
    "platform.inertia": Key(
        "inertia about the mass centre, platform axes",
        "inertia",
        ((3, 3),),
        _INERTIA,
        symmetric=True,
    ),
    "legs.stiffness": Key(
        "axial stiffness",
        "stiffness",
        _LEGS,
        "Use a large finite value for a rigid leg.",
        least=0.0,
        open_=True,
    ),
    "legs.damping.prismatic": Key(
        "viscous friction along the leg", "damping", _LEGS, "Give 0 for a leg without friction.", least=0.0
    ),
    "legs.damping.universal": _DAMPING,
    "legs.damping.spherical": _DAMPING,
    **_under("legs.lower", _part("base joint")),
    **_under("legs.upper", _part("platform joint")),
    "limits.leg_length": Key(
        "shortest and longest leg",
        "length",
        ((2,), (6, 2)),
        "Give [min, max] of the distance between the leg's two joints.",
        least=0.0,
    ),
    "limits.universal_angle": Key(
        "cone half angle at the base joints",
        "angle",
        _ONE,
        _ANGLE_REMEDY,
        least=0.0,
        most=_FLAT_ANGLE,
        open_=True,
    ),
    "limits.spherical_angle": Key(
        "cone half angle at the platform joints",
        "angle",
        _ONE,
        _ANGLE_REMEDY,
        least=0.0,
        most=_FLAT_ANGLE,
        open_=True,
    ),
    "limits.leg_distance": Key(
        "least distance between leg axes", "length", _ONE, "Leave it out for no limit.", least=0.0
    ),
    "home.position": Key("platform frame's origin at home, base frame", "length", _VECTOR),
    "home.orientation": Key(
        "roll, pitch, yaw at home about the fixed axes x, y, z",
        "angle",
        _VECTOR,
        _ANGLE_REMEDY,
        least=-2 * _FLAT_ANGLE,
        most=2 * _FLAT_ANGLE,
    ),
    "cubic.edge": Key("edge of the cube", "length", _ONE, "Give an edge > 0.", least=0.0, open_=True),
    "cubic.height": Key(
        "common height of the six edges, edge / sqrt(3)", "length", _ONE, "Give a height > 0.", least=0.0, open_=True
    ),
    "cubic.middle": Key(
        "share of each edge between its two joints",
        None,
        _ONE,
        "Give a share between 0 and 1, such as 0.7; at 1 the joints of neighbouring legs would coincide.",
        least=0.0,
        most=1.0,
        open_=True,
    ),
    "cubic.center_in_base": Key("cube's centre, base frame", "length", _VECTOR),
    "cubic.center_in_platform": Key("cube's centre, platform frame, at home", "length", _VECTOR),
}

TEXT_KEYS = frozenset({"name", "joints.csv"})
TABLES = frozenset(key.rsplit(".", depth)[0] for key in {*KEYS, *TEXT_KEYS} for depth in range(1, key.count(".") + 1))


def children(table: str) -> list[str]:
    """Names that may stand in a table of the file ("" is the file itself), tables included."""
    start = f"{table}." if table else ""
    known = {*KEYS, *TEXT_KEYS}
    return sorted({key[len(start) :].split(".")[0] for key in known if key.startswith(start)})


def resolve(table: str, key: str) -> tuple[str, str]:
    """A key as written -> (its dotted name without unit, its unit). Raises DesignError for a key that is not one."""
    start = f"{table}." if table else ""
    known = [child for child in children(table) if start + child not in TABLES]
    if key in known:
        rule = KEYS.get(start + key)
        return start + key, si_unit(rule.dimension) if rule else ""
    stems = [child for child in known if key.startswith(f"{child}_")]
    if stems:
        stem = max(stems, key=len)
        unit = key[len(stem) + 1 :]
        rule = KEYS.get(start + stem)
        allowed = UNITS[rule.dimension] if rule and rule.dimension else {}
        if unit in allowed:
            return start + stem, unit
        if unit in ALL_UNITS or not _near(key, [child for child in children(table) if child != stem]):
            _wrong_unit(start + key, start + stem, unit, rule)
    unknown_key(table, key)


def _wrong_unit(key: str, stem: str, unit: str, rule: Key | None) -> NoReturn:
    if rule is None or rule.dimension is None:
        raise DesignError(f"{key} carries the unit {unit!r}; {stem} has none. Write {stem} = ...")
    is_a = f"is no unit of {rule.dimension}" if unit in ALL_UNITS else "is not a unit Flexapod knows"
    allowed = ", ".join(f"{stem.split('.')[-1]}_{known}" for known in UNITS[rule.dimension])
    raise DesignError(f"{key}: {unit!r} {is_a}; {stem} is a {rule.dimension}. Use {stem} (SI) or one of: {allowed}.")


def unknown_key(table: str, key: str) -> NoReturn:
    """Refuse a key, with the nearest keys there are."""
    where = f"[{table}]" if table else "the top level"
    name = f"{table}.{key}" if table else key
    here = children(table)
    start = f"{table}." if table else ""
    near = [start + match for match in _near(key, here)]
    near += [full for full in _elsewhere(key) if full not in near]
    hint = f"Did you mean {' or '.join(near)}? " if near else ""
    raise DesignError(f"{name} is not a key of a design. {hint}Keys of {where}: {', '.join(here)}.")


def _elsewhere(key: str) -> list[str]:
    """Keys of this name in other tables, with the unit that it carries."""
    found = []
    for full in sorted({*KEYS, *TABLES}):
        last = full.split(".")[-1]
        if key == last or (key.startswith(f"{last}_") and key[len(last) + 1 :] in ALL_UNITS):
            found.append(full + key[len(last) :])
    return found


def _near(word: str, known: list[str]) -> list[str]:
    from difflib import get_close_matches  # only a wrong key needs it

    return get_close_matches(word, known, n=2, cutoff=0.72)


def check_value(name: str, value: Any, rule: Key, unit: str | None = None) -> FloatArray:
    """One value as an array in SI units, in the shape it was given. Raises DesignError that says what is wrong."""
    unit = si_unit(rule.dimension) if unit is None else unit
    given = _numbers(name, value, rule)
    if given.shape not in rule.shapes:
        shape = "one number" if given.ndim == 0 else f"shape {' x '.join(map(str, given.shape))}"
        raise DesignError(f"{name} has {shape}; it must be {rule.shape_text}. {rule.remedy}")
    si = to_si(given, rule.dimension, unit) if rule.dimension else given
    _check_each(name, given, si, rule, unit)
    if rule.symmetric:
        si = _symmetric(name, given, si, rule, unit)
    return np.asarray(si + 0.0)  # + 0.0: -0.0 becomes 0.0, so that equal designs have equal bytes


def _numbers(name: str, value: Any, rule: Key) -> FloatArray:
    """The value as float64 of any shape; text, truth values and ragged lists are refused."""
    if hasattr(value, "__array__"):
        value = np.asarray(value)
    found = _not_a_number(value, "")
    if found is not None:
        path, item = found
        kind = "text" if isinstance(item, str) else type(item).__name__
        must = "it must be a number" if path else f"it must be {rule.shape_text}"
        raise DesignError(f"{name}{path} is {shown(item)} ({kind}); {must}. {rule.remedy}")
    try:
        return np.array(value, dtype=np.float64)
    except OverflowError:
        raise DesignError(
            f"{name} holds an integer too large for a number of this machine; it must be finite."
        ) from None
    except ValueError:
        raise DesignError(
            f"{name} has rows of different lengths; it must be {rule.shape_text}. {rule.remedy}"
        ) from None


def _not_a_number(value: Any, path: str, depth: int = 0) -> tuple[str, Any] | None:
    """Where a nested list holds something that is not a number, and what; None if nowhere."""
    if isinstance(value, np.ndarray):
        return None if value.dtype.kind in "iuf" else (path, value.tolist())
    if isinstance(value, list | tuple) and depth <= _DEEPEST:
        found = (_not_a_number(item, f"{path}[{index}]", depth + 1) for index, item in enumerate(value))
        return next((item for item in found if item is not None), None)
    is_number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    return None if is_number else (path, value)


def _check_each(name: str, given: FloatArray, si: FloatArray, rule: Key, unit: str) -> None:
    bad = ~(np.abs(si) < _LARGEST)
    must = "a finite number" if not np.isfinite(given).all() else f"smaller than {_LARGEST:g} in SI units"
    if rule.least is not None and not bad.any():
        bad = si <= rule.least if rule.open_ else si < rule.least
        must = f"{'>' if rule.open_ else '>='} {_in_unit(rule.least, rule, unit)}"
    if rule.most is not None and not bad.any():
        bad = si > rule.most
        must = f"<= {_in_unit(rule.most, rule, unit)}"
    if bad.any():
        index = tuple(np.argwhere(bad)[0])
        place = "".join(f"[{i}]" for i in index)
        value = f"{given[index]:.6g} {printed(unit)}".rstrip()
        raise DesignError(f"{name}{place} is {value}; it must be {must}. {rule.remedy}")


def _in_unit(limit: float, rule: Key, unit: str) -> str:
    shown = limit / float(to_si(1.0, rule.dimension, unit)) if rule.dimension else limit
    return f"{shown:.4g} {printed(unit)}".rstrip() if shown else "0"


def _symmetric(name: str, given: FloatArray, si: FloatArray, rule: Key, unit: str) -> FloatArray:
    """The symmetric part of 3 x 3 matrices that are symmetric but for rounding; others are refused."""
    turned = np.swapaxes(si, -1, -2)
    scale = np.abs(si).max(axis=(-1, -2), keepdims=True)
    bad = np.abs(si - turned) > 1e-9 * scale  # beyond what printing with ten digits does
    if bad.any():
        index = tuple(np.argwhere(bad)[0])
        *leg, i, j = index
        place = "".join(f"[{n}]" for n in leg)
        one, other = given[index], np.swapaxes(given, -1, -2)[index]
        raise DesignError(
            f"{name}{place} is not symmetric: [{i}][{j}] is {one:.6g} and [{j}][{i}] is {other:.6g} {printed(unit)}; "
            f"an inertia must be symmetric. {rule.remedy}"
        )
    return (si + turned) / 2
