"""The design of a 6-UPS hexapod: frozen, checked once, SI units, legs 1 to 6 (in arrays and in [brackets], 0 to 5)."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.design import design_file
from flexapod.design.design_file import packaged_designs, parse_assignments, template
from flexapod.design.schema import KEYS, FloatArray, check_value
from flexapod.errors import DesignError

__all__ = [
    "Damping",
    "Hexapod",
    "Home",
    "LegPart",
    "Legs",
    "Limits",
    "load",
    "packaged_designs",
    "parse_assignments",
    "template",
]


class _Value:
    """A frozen bundle of read-only arrays, equal and hashed by value; copies and pickles are built and checked anew."""

    def _state(self) -> tuple[Any, ...]:
        return tuple(getattr(self, item.name) for item in fields(self) if item.init)  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and _bytes(self) == _bytes(other)

    def __hash__(self) -> int:
        return hash(_bytes(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._state()

    def _set(self, name: str, value: Any, key: str, shape: tuple[int, ...] | None = None) -> None:
        """Store a checked value, spread over the legs when `shape` says so."""
        array = check_value(key, value, KEYS[key])
        if shape is not None:
            array = np.broadcast_to(array, shape).copy()
        array.flags.writeable = False
        object.__setattr__(self, name, array)


def _bytes(value: Any) -> bytes:
    """Every number of a design in one string of bytes; parts that are left out are marked."""
    if isinstance(value, _Value):
        return b"(" + b",".join(map(_bytes, value._state())) + b")"
    if isinstance(value, np.ndarray):
        return str(value.shape).encode() + value.tobytes()
    return repr(value).encode()


@dataclass(frozen=True, eq=False, repr=False)
class LegPart(_Value):
    """Lower or upper part of the legs. One value given for all six legs is spread over them.

    mass: (6,) kg. mass_center: (6, 3) m, leg axes, from the base joint (lower) or the platform joint (upper). inertia:
    (6, 3, 3) kg m2 about the part's own mass centre, leg axes.

    Raises: DesignError for numbers of another shape, that are not finite, or that no part can have.
    Source: Appendix A, as part D reads it.
    """

    mass: FloatArray  #: (6,) kg
    mass_center: FloatArray  #: (6, 3) m, leg axes, from the base joint (lower) or the platform joint (upper)
    inertia: FloatArray  #: (6, 3, 3) kg m2 about the part's own mass centre, leg axes

    def __post_init__(self) -> None:
        self._set("mass", self.mass, "legs.lower.mass", (6,))
        self._set("mass_center", self.mass_center, "legs.lower.mass_center", (6, 3))
        self._set("inertia", self.inertia, "legs.lower.inertia", (6, 3, 3))

    @classmethod
    def massless(cls) -> "LegPart":
        """No mass and no inertia, for legs that are springs and nothing else."""
        return cls(np.zeros(()), np.zeros(3), np.zeros((3, 3)))


@dataclass(frozen=True, eq=False, repr=False)
class Damping(_Value):
    """Viscous friction in the joints of the legs, zero where left out.

    prismatic: (6,) N s/m. universal, spherical: (6,) N m s/rad.

    Raises: DesignError for numbers of another shape, below zero, or not finite.
    Source: Section 4.1; E4.
    """

    prismatic: FloatArray = field(default_factory=lambda: np.zeros(6))  #: (6,) N s/m
    universal: FloatArray = field(default_factory=lambda: np.zeros(6))  #: (6,) N m s/rad
    spherical: FloatArray = field(default_factory=lambda: np.zeros(6))  #: (6,) N m s/rad

    def __post_init__(self) -> None:
        for joint in ("prismatic", "universal", "spherical"):
            self._set(joint, getattr(self, joint), f"legs.damping.{joint}", (6,))


@dataclass(frozen=True, eq=False, repr=False)
class Legs(_Value):
    """The six legs. Leg axes: x from base to platform joint, y = k x s normalised, z = x cross y.

    stiffness: (6,) N/m. damping: `Damping`. lower, upper: `LegPart`; legs without mass where left out.

    Raises: DesignError for a stiffness of another shape, or not > 0.
    Source: Eqs 2 to 4 and Section 4.1; E6.
    """

    stiffness: FloatArray  #: (6,) N/m
    damping: Damping = field(default_factory=Damping)
    lower: LegPart = field(default_factory=LegPart.massless)
    upper: LegPart = field(default_factory=LegPart.massless)

    def __post_init__(self) -> None:
        self._set("stiffness", self.stiffness, "legs.stiffness", (6,))


@dataclass(frozen=True, eq=False, repr=False)
class Limits(_Value):
    """What the joints and legs allow; None is no limit.

    leg_length: (2,) or (6, 2) m, shortest and longest. universal_angle, spherical_angle: rad, cone half angle from the
    direction at home. leg_distance: m, least distance between leg axes.

    Raises: DesignError for numbers that no limit can have, or a shortest length above the longest.
    Source: own; the paper's machines have no limits.
    """

    leg_length: FloatArray | None = None  #: (2,) or (6, 2), shortest and longest, m
    universal_angle: float | None = None  #: cone half angle from the direction at home, rad
    spherical_angle: float | None = None  #: cone half angle from the direction at home, rad
    leg_distance: float | None = None  #: least distance between leg axes, m

    def __post_init__(self) -> None:
        if self.leg_length is not None:
            self._set("leg_length", self.leg_length, "limits.leg_length")
            pairs = np.reshape(self.leg_length, (-1, 2))
            wrong = np.flatnonzero(pairs[:, 0] >= pairs[:, 1])
            if wrong.size:
                place = f"[{wrong[0]}]" if len(pairs) > 1 else ""
                low, high = pairs[wrong[0]]
                raise DesignError(
                    f"limits.leg_length{place} is [{low:.6g}, {high:.6g}] m; the first must be < the second. "
                    "Give the shortest length first."
                )
        for name in ("universal_angle", "spherical_angle", "leg_distance"):
            value = getattr(self, name)
            if value is not None:
                key = f"limits.{name}"
                object.__setattr__(self, name, float(check_value(key, value, KEYS[key])))


@dataclass(frozen=True, eq=False, repr=False)
class Home(_Value):
    """The neutral pose. Unpacks as `position, rpy = home`."""

    position: FloatArray  #: (3,) m, platform frame's origin in the base frame
    rpy: FloatArray = field(default_factory=lambda: np.zeros(3))  #: (3,) rad about the fixed axes x, y, z

    def __post_init__(self) -> None:
        self._set("position", self.position, "home.position")
        self._set("rpy", self.rpy, "home.orientation")

    def __iter__(self) -> Iterator[FloatArray]:
        return iter((self.position, self.rpy))


@dataclass(frozen=True, eq=False, repr=False)
class Hexapod(_Value):
    """A 6-UPS Stewart platform. Make one with `flexapod.load` or from its parts; change one with `replace`.

    gravity: (3,) m/s2, inertial frame. base_joints: (6, 3) m, and universal_axes: (6, 3), made unit vectors, both in
    the base frame. platform_joints: (6, 3) m, platform frame. platform_mass: kg, with payload; platform_mass_center:
    (3,) m, platform frame; platform_inertia: (3, 3) kg m2 about the mass centre, platform axes. legs: `Legs`. limits:
    `Limits`. home: position (3,) m and roll, pitch, yaw (3,) rad of the platform in the base frame, or None. name:
    text. warnings: in words, what is odd about the design but can be computed.

    Raises: DesignError, which says what is wrong and what to do, for anything that is not a hexapod. So does every
    function for a `hexapod` that is not one of these.
    Source: Section 4 and Appendix A, as part D reads it.
    """

    name: str
    gravity: FloatArray  #: (3,) m/s2, inertial frame
    base_joints: FloatArray  #: (6, 3) m, base frame
    universal_axes: FloatArray  #: (6, 3) unit vectors fixed in the base, base frame
    platform_joints: FloatArray  #: (6, 3) m, platform frame
    platform_mass: float  #: kg, with payload
    platform_mass_center: FloatArray  #: (3,) m, platform frame
    platform_inertia: FloatArray  #: (3, 3) kg m2 about the mass centre, platform axes
    legs: Legs
    limits: Limits = field(default_factory=Limits)
    home: Home | None = None
    warnings: tuple[str, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        design_file.flatten({"name": self.name})
        self._set("gravity", self.gravity, "gravity")
        self._set("base_joints", self.base_joints, "base.joints")
        self._set("universal_axes", self.universal_axes, "base.universal_axes")
        self._set("platform_joints", self.platform_joints, "platform.joints")
        self._set("platform_mass", self.platform_mass, "platform.mass")
        object.__setattr__(self, "platform_mass", float(self.platform_mass))
        self._set("platform_mass_center", self.platform_mass_center, "platform.mass_center")
        self._set("platform_inertia", self.platform_inertia, "platform.inertia")
        for part, kind in (("legs", Legs), ("limits", Limits), ("home", Home)):
            given = getattr(self, part)
            if not isinstance(given, kind) and not (part == "home" and given is None):
                raise DesignError(f"{part} is {given!r}; it must be a {kind.__name__}.")
        object.__setattr__(self, "universal_axes", _unit_axes(self.universal_axes))
        _check_apart("base.joints", self.base_joints)
        _check_apart("platform.joints", self.platform_joints)
        warnings = _check_platform_inertia(self.platform_inertia)
        warnings += _warn_of_part("legs.lower", self.legs.lower) + _warn_of_part("legs.upper", self.legs.upper)
        object.__setattr__(self, "warnings", tuple(warnings))

    @classmethod
    def from_values(cls, values: Mapping[str, Any]) -> "Hexapod":
        """A design from checked values by file key, as `values` gives them.

        Raises: DesignError for values that make no hexapod.
        """

        def part(name: str) -> LegPart:
            return LegPart(*(values[f"legs.{name}.{key}"] for key in ("mass", "mass_center", "inertia")))

        damping = Damping(*(values[f"legs.damping.{joint}"] for joint in ("prismatic", "universal", "spherical")))
        return cls(
            name=values.get("name", "hexapod"),
            gravity=values["gravity"],
            base_joints=values["base.joints"],
            universal_axes=values["base.universal_axes"],
            platform_joints=values["platform.joints"],
            platform_mass=values["platform.mass"],
            platform_mass_center=values["platform.mass_center"],
            platform_inertia=values["platform.inertia"],
            legs=Legs(values["legs.stiffness"], damping, part("lower"), part("upper")),
            limits=Limits(**{item.name: values.get(f"limits.{item.name}") for item in fields(Limits)}),
            home=Home(values["home.position"], values["home.orientation"]) if "home.position" in values else None,
        )

    @classmethod
    def from_toml(cls, text: str) -> "Hexapod":
        """A design from the text of a design file.

        Raises: DesignError for text that is no design, with the key and the remedy.
        """
        return cls.from_values(design_file.read_text(text))

    def values(self) -> dict[str, Any]:
        """The whole design by dotted file key: text for `name`, arrays in SI units for all else."""
        values: dict[str, Any] = {
            "name": self.name,
            "gravity": self.gravity,
            "base.joints": self.base_joints,
            "base.universal_axes": self.universal_axes,
            "platform.joints": self.platform_joints,
            "platform.mass": np.array(self.platform_mass),
            "platform.mass_center": self.platform_mass_center,
            "platform.inertia": self.platform_inertia,
            "legs.stiffness": self.legs.stiffness,
        }
        values |= {f"legs.damping.{item.name}": getattr(self.legs.damping, item.name) for item in fields(Damping)}
        for part in ("lower", "upper"):
            given = getattr(self.legs, part)
            values |= {f"legs.{part}.{item.name}": getattr(given, item.name) for item in fields(LegPart)}
        for item in fields(Limits):
            limit = getattr(self.limits, item.name)
            if limit is not None:
                values[f"limits.{item.name}"] = np.asarray(limit)
        if self.home is not None:
            values |= {"home.position": self.home.position, "home.orientation": self.home.rpy}
        return values

    def replace(self, changes: Mapping[str, Any]) -> "Hexapod":
        """This design with changes, by the file's keys: `{"platform.mass": 400, "legs.stiffness_N_per_um[2]": 10}`.

        Text is read as TOML; None takes an optional key or table out. Universal joint axes stay as they are when
        joints are moved one by one, and become tangent again with a new `base.circle` or `cubic`.

        Raises: DesignError for a key that is none, or a value that it cannot have.
        """
        return self.from_values(design_file.changed(self.values(), changes))

    def to_toml(self) -> str:
        """This design as a commented TOML file; `from_toml` gives the same numbers bit for bit."""
        values = self.values()
        if not self.legs.lower.mass.any() and not self.legs.upper.mass.any():
            massless = LegPart.massless()
            if self.legs.lower == massless and self.legs.upper == massless:
                values = {
                    key: value for key, value in values.items() if not key.startswith(("legs.lower", "legs.upper"))
                }
        return design_file.write_text(values)

    def save(self, path: str | Path) -> None:
        """Write the design to a TOML file without loss.

        Raises: OSError where the file cannot be written.
        """
        Path(path).write_text(self.to_toml(), encoding="utf-8", newline="\n")

    @cached_property
    def packed(self) -> FloatArray:
        """The design as the core takes it: 211 numbers, read-only.

        gravity, base joints, axes, platform joints, platform body; then leg by leg stiffness, the three frictions,
        lower and upper body. A body is mass, mass centre, and inertia as xx yy zz xy xz yz.
        """
        legs = self.legs
        frictions = (legs.damping.prismatic, legs.damping.universal, legs.damping.spherical)
        per_leg = np.concatenate(
            [np.stack([legs.stiffness, *frictions], axis=1), _packed_part(legs.lower), _packed_part(legs.upper)], axis=1
        )
        joints = (self.base_joints, self.universal_axes, self.platform_joints)
        platform = ([self.platform_mass], self.platform_mass_center, _six(self.platform_inertia))
        packed = np.concatenate([self.gravity, *(array.ravel() for array in joints), *platform, per_leg.ravel()])
        packed.flags.writeable = False
        return packed

    @cached_property
    def digest(self) -> str:
        """Sixteen hex digits that tell designs apart by their numbers (not by their names)."""
        content = self.packed.astype("<f8").tobytes() + _bytes(self.limits) + _bytes(self.home)
        return hashlib.sha256(content).hexdigest()[:16]

    def __repr__(self) -> str:
        stiffness = np.unique(self.legs.stiffness)
        k = f"{stiffness[0]:.4g}" + (f" to {stiffness[-1]:.4g}" if stiffness.size > 1 else "")
        leg_mass = self.legs.lower.mass.mean() + self.legs.upper.mass.mean()
        notes = f", {len(self.warnings)} warnings" if self.warnings else ""
        return (
            f"<Hexapod {self.name!r}: platform {self.platform_mass:.4g} kg, legs of {leg_mass:.4g} kg "
            f"and {k} N/m{notes}, digest {self.digest}>"
        )


def load(name_or_path: str | Path) -> Hexapod:
    """A packaged design by its name, or a design file (.toml) by its path: name_or_path. In SI units.

    Raises: DesignError for a name or file that is no design, with the reason and the remedy.
    Source: own; what a packaged design is taken from stands in its file.
    """
    path = design_file.find(name_or_path)
    values = design_file.read_file(path)
    try:
        return Hexapod.from_values(values)
    except DesignError as error:
        raise DesignError(f"{path}: {error}") from error


def _six(inertia: ArrayLike) -> FloatArray:
    """xx yy zz xy xz yz of symmetric matrices (..., 3, 3)."""
    matrix = np.asarray(inertia, dtype=np.float64)
    return matrix[..., [0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def _packed_part(part: LegPart) -> FloatArray:
    return np.concatenate([part.mass[:, None], part.mass_center, _six(part.inertia)], axis=1)


def _unit_axes(axes: FloatArray) -> FloatArray:
    """Axes of length 1. Those that have it but for rounding stay as they are, so that saved designs read back equal."""
    square = (axes * axes).sum(axis=1)
    zero = np.flatnonzero(square < 1e-24)
    if zero.size:
        leg = zero[0]
        raise DesignError(
            f"base.universal_axes[{leg}] is {axes[leg].tolist()}; it must have a direction. "
            "Give a vector of any length, or leave universal_axes out for axes tangent to the base circle."
        )
    near_one = np.abs(square - 1) < 16 * np.finfo(float).eps
    unit = np.where(near_one[:, None], axes, axes / np.sqrt(square)[:, None]) + 0.0
    unit.flags.writeable = False
    return np.asarray(unit)


def _check_apart(key: str, joints: FloatArray) -> None:
    span = np.ptp(joints, axis=0).max()
    for one in range(6):
        for other in range(one + 1, 6):
            if np.linalg.norm(joints[one] - joints[other]) <= 1e-9 * span:
                raise DesignError(
                    f"{key}[{one}] and {key}[{other}] coincide at {joints[one].tolist()} m; the six joints must be "
                    "apart. Move one of them: a joint has a size, a millimetre is enough."
                )


def _flaw(inertia: FloatArray) -> str:
    """Why no rigid body has this inertia; "" when one has. Tolerance: rounding of numbers printed with 9 digits."""
    moments = np.linalg.eigvalsh(inertia)
    slack = 1e-9 * np.abs(moments).max()
    if moments[0] < -slack:
        return f"its smallest principal moment is {moments[0]:.3g} kg m2, below zero"
    if moments[2] > moments[0] + moments[1] + slack:
        return (
            f"its largest principal moment {moments[2]:.4g} kg m2 exceeds the sum of the other two, "
            f"{moments[0] + moments[1]:.4g}"
        )
    return ""


def _check_platform_inertia(inertia: FloatArray) -> list[str]:
    moments = np.linalg.eigvalsh(inertia)
    if moments[0] <= 1e-14 * np.abs(moments).max():
        raise DesignError(
            f"platform.inertia is not positive definite: its smallest principal moment is {moments[0]:.3g} kg m2; it "
            "must be > 0. Check the signs and sizes of its entries; it is taken about the mass centre, not the origin."
        )
    flaw = _flaw(inertia)
    return [f"platform.inertia: no rigid body has it; {flaw}. Results are computed with it as given."] if flaw else []


def _warn_of_part(key: str, part: LegPart) -> list[str]:
    flaws = [_flaw(inertia) for inertia in part.inertia]
    legs = [leg for leg, flaw in enumerate(flaws) if flaw]
    if not legs:
        return []
    which = "all legs" if len(legs) == 6 else f"legs {', '.join(str(leg + 1) for leg in legs)}"
    return [f"{key}.inertia ({which}): no rigid body has it; {flaws[legs[0]]}. Results are computed with it as given."]
