"""The parts of a design: legs with their bodies and friction, and limits; frozen and checked."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.design.home import Home
from flexapod.design.packing import PLACES
from flexapod.design.schema import KEYS
from flexapod.design.shorthands import rod
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown, told_apart


class Value:
    """A frozen bundle of read-only arrays, equal and hashed by value; copies and pickles are built and checked anew."""

    def state(self) -> dict[str, Any]:
        """What the bundle is made from, by field."""
        return {item.name: getattr(self, item.name) for item in fields(self) if item.init}  # type: ignore[arg-type]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and bytes_of(self) == bytes_of(other)

    def __hash__(self) -> int:
        return hash(bytes_of(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(type(self), **self.state()), ()

    def set_checked(self, name: str, value: Any, key: str, shape: tuple[int, ...] | None = None) -> None:
        """Store a checked value, spread over the legs when `shape` says so."""
        array = check_value(key, value, KEYS[key])
        if shape is not None:
            array = np.broadcast_to(array, shape).copy()
        array.flags.writeable = False
        object.__setattr__(self, name, array)


def bytes_of(value: Any) -> bytes:
    """Every number of a design in one string of bytes; parts that are left out are marked."""
    if isinstance(value, Home):
        return b"(" + bytes_of(value.position) + b"," + bytes_of(value.rpy) + b")"
    if isinstance(value, Value):
        compared = (getattr(value, item.name) for item in fields(value) if item.init and item.compare)  # type: ignore[arg-type]
        return b"(" + b",".join(map(bytes_of, compared)) + b")"
    if isinstance(value, Mapping):
        return b"{" + b",".join(key.encode() + bytes_of(item) for key, item in value.items()) + b"}"
    if isinstance(value, np.ndarray):
        return str(value.shape).encode() + value.tobytes()
    return repr(value).encode()


@dataclass(frozen=True, eq=False, repr=False)
class LegPart(Value):
    """Lower or upper part of the legs; one value given for all six legs is spread over them.

    Parameters
    ----------
    mass : array_like
        Mass in kg, stored as (6,).
    mass_center : array_like
        Mass centre in leg axes, from the base joint (lower part) or the platform joint (upper part), m, stored as
        (6, 3).
    inertia : array_like
        Inertia about the part's own mass centre in leg axes, kg m2, stored as (6, 3, 3). Three numbers are the
        principal moments about the leg axes x (along the leg), y and z.

    Raises
    ------
    DesignError
        For numbers of another shape, that are not finite, or that no part can have.

    Notes
    -----
    The parts of Appendix A of the paper. An inertia that no rigid body can have is kept, with a warning in
    `Hexapod.warnings`.

    Examples
    --------
    >>> part = fx.design.LegPart(3.0, [0.2, 0, 0], [0.003, 0.04, 0.04])
    >>> part.inertia.shape
    (6, 3, 3)
    """

    mass: Array
    mass_center: Array
    inertia: Array

    def __post_init__(self) -> None:
        self.set_checked("mass", self.mass, "legs.lower.mass", (6,))
        self.set_checked("mass_center", self.mass_center, "legs.lower.mass_center", (6, 3))
        self.set_checked("inertia", self.inertia, "legs.lower.inertia", (6, 3, 3))

    @classmethod
    def massless(cls) -> LegPart:
        """No mass and no inertia, for legs that are springs and nothing else."""
        return cls(np.zeros(()), np.zeros(3), np.zeros((3, 3)))

    @classmethod
    def rod(cls, mass: ArrayLike, length: ArrayLike, radius: ArrayLike = 0.0, *, upper: bool = False) -> LegPart:
        """A uniform round rod along the leg that begins at the leg's joint.

        Parameters
        ----------
        mass : array_like
            Mass in kg, one or six.
        length, radius : array_like
            Length and radius in m, one or six each; radius 0 is a thin rod.
        upper : bool
            False: from the base joint upwards (lower part). True: from the platform joint downwards.

        Returns
        -------
        LegPart
            The part, as `[legs.lower.rod]` of a design file makes it.
        """
        given = {"mass": mass, "length": length, "radius": radius}
        keys = {name: f"legs.lower.rod.{name}" for name in given}
        m, l, r = (check_value(keys[name], value, KEYS[keys[name]]) for name, value in given.items())
        return cls(m, *rod(m, l, r, -1.0 if upper else 1.0))


@dataclass(frozen=True, eq=False, repr=False)
class Damping(Value):
    """Viscous friction in the joints of the legs; zero where left out.

    Parameters
    ----------
    prismatic : array_like
        Along the leg, N s/m, one or six, stored as (6,).
    universal, spherical : array_like
        In the base joint and in the platform joint, N m s/rad, one or six, stored as (6,).

    Raises
    ------
    DesignError
        For numbers of another shape, below zero, or not finite.

    Notes
    -----
    Section 4.1 of the paper: forces and moments proportional to the joint's rate.

    Examples
    --------
    >>> fx.design.Damping(prismatic=200.0).prismatic.tolist()
    [200.0, 200.0, 200.0, 200.0, 200.0, 200.0]
    """

    prismatic: Array = field(default_factory=lambda: np.zeros(6))
    universal: Array = field(default_factory=lambda: np.zeros(6))
    spherical: Array = field(default_factory=lambda: np.zeros(6))

    def __post_init__(self) -> None:
        for item in fields(self):
            self.set_checked(item.name, getattr(self, item.name), f"legs.damping.{item.name}", (6,))


@dataclass(frozen=True, eq=False, repr=False)
class Legs(Value):
    """The six legs of a hexapod.

    Parameters
    ----------
    stiffness : array_like
        Axial stiffness of everything in series from joint to joint, N/m, one or six, stored as (6,).
    damping : Damping, optional
        Viscous friction; none where left out.
    lower, upper : LegPart, optional
        The parts on the base joint and on the platform joint; massless where left out.
    more : mapping, optional
        Further numbers of the legs, one or six each, by the keys of a design file below `legs`. There are none yet:
        it is for numbers that are added to the core and to the schema.

    Raises
    ------
    DesignError
        For a stiffness of another shape, or not > 0, and for an unknown key in `more`.

    Notes
    -----
    Leg axes: x from base joint to platform joint, y = k x s normalised, z = x cross y, where k is the axis of the
    universal joint that is fixed in the base and s the leg's direction (Eqs 2 to 4 and Section 4.1 of the paper).

    Examples
    --------
    >>> legs = fx.design.Legs(2e7, fx.design.Damping(prismatic=200.0))
    >>> float(legs.stiffness[5])
    20000000.0
    """

    stiffness: Array
    damping: Damping = field(default_factory=Damping)
    lower: LegPart = field(default_factory=LegPart.massless)
    upper: LegPart = field(default_factory=LegPart.massless)
    more: Mapping[str, ArrayLike] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._set_more()
        self.set_checked("stiffness", self.stiffness, "legs.stiffness", (6,))
        for name, kind in (("damping", Damping), ("lower", LegPart), ("upper", LegPart)):
            if not isinstance(getattr(self, name), kind):
                raise DesignError(f"legs.{name} is {shown(getattr(self, name))}; it must be a {kind.__name__}.")

    def _set_more(self) -> None:
        """Check the further numbers, fill in those left out, and spread them over the legs."""
        for key in self.more:
            if key not in more_keys():
                raise DesignError(
                    f"legs.{key} is not a further number of the legs; there are: {more_keys() or 'none'}."
                )
        full = {}
        for key in more_keys():
            rule = KEYS[f"legs.{key}"]
            array = check_value(f"legs.{key}", self.more.get(key, rule.default), rule)
            full[key] = np.broadcast_to(array, PLACES[f"legs.{key}"].shape)
        object.__setattr__(self, "more", full)


@functools.cache
def more_keys() -> tuple[str, ...]:
    """Keys below `legs` of numbers that the core has and no attribute of `Legs` names."""
    named = {"stiffness", *(f"damping.{item.name}" for item in fields(Damping))}
    named |= {f"{part}.{item.name}" for part in ("lower", "upper") for item in fields(LegPart)}
    keys = (key.removeprefix("legs.") for key in PLACES if key.startswith("legs."))
    return tuple(key for key in keys if key not in named)


@dataclass(frozen=True, eq=False, repr=False)
class Limits(Value):
    """What the joints and legs allow; None is no limit.

    Parameters
    ----------
    leg_length : array_like, optional
        Shortest and longest distance between a leg's joints, m, (2,) or (6, 2).
    universal_angle, spherical_angle : float, optional
        Cone half angle of a base joint and of a platform joint, from the leg's direction at home, rad.
    leg_distance : float, optional
        Least distance between two leg axes, m.

    Raises
    ------
    DesignError
        For numbers that no limit can have, or a shortest length above the longest.

    Notes
    -----
    The paper's machines have no limits. `flexapod.check_limits` says whether a pose keeps them.

    Examples
    --------
    >>> fx.design.Limits(leg_length=[0.5, 0.75], universal_angle=np.radians(45)).leg_length.tolist()
    [0.5, 0.75]
    """

    leg_length: Array | None = None
    universal_angle: float | None = None
    spherical_angle: float | None = None
    leg_distance: float | None = None

    def __post_init__(self) -> None:
        if self.leg_length is not None:
            self.set_checked("leg_length", self.leg_length, "limits.leg_length")
            pairs = np.reshape(self.leg_length, (-1, 2))
            wrong = np.flatnonzero(pairs[:, 0] >= pairs[:, 1])
            if wrong.size:
                place = f"[{wrong[0]}]" if len(pairs) > 1 else ""
                low, high = told_apart(float(pairs[wrong[0], 0]), float(pairs[wrong[0], 1]), (6, 6))
                raise DesignError(
                    f"limits.leg_length{place} is [{low}, {high}] m; the first must be < the second. "
                    "Give the shortest length first."
                )
        for name in ("universal_angle", "spherical_angle", "leg_distance"):
            value = getattr(self, name)
            if value is not None:
                key = f"limits.{name}"
                object.__setattr__(self, name, float(check_value(key, value, KEYS[key])))

    @property
    def given(self) -> bool:
        """Whether anything is limited."""
        return any(getattr(self, item.name) is not None for item in fields(self))
