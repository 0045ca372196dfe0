"""The parts of a design: legs with their bodies and friction, and limits; frozen and checked."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod.conventions import Array
from flexapod.design.flexible_joints import JointStiffness
from flexapod.design.home import Home
from flexapod.design.packing import PLACES, series_compliance
from flexapod.design.schema import KEYS
from flexapod.design.shorthands import rod
from flexapod.design.stiffness_laws import LAWS, StiffnessLaw
from flexapod.design.value import ADDED, Value
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown, told_apart

MOST_IN_SERIES = 5  #: springs with one leg
#: Fields of `Limits` that a motion can exceed, and no machine at rest.
_OF_A_MOTION = ("leg_rate", "leg_acceleration", "leg_power")


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
    stiffness : array_like or None
        Axial stiffness of the leg between its joints, N/m, one or six, stored as (6,). With a stiffness law it is left
        out, and stored as NaN.
    damping : Damping, optional
        Viscous friction; none where left out.
    lower, upper : LegPart, optional
        The parts on the base joint and on the platform joint; massless where left out.
    more : mapping, optional
        Further numbers of the legs, one or six each, by the keys of a design file below `legs`. There are none yet:
        it is for numbers that are added to the core and to the schema.
    series_stiffness : array_like, optional
        Further axial springs in series with the leg (joints, mounts), N/m: one number, n numbers for all legs, or six
        rows of n, stored as (6, n); none where left out.
    loss_factor : array_like, optional
        Structural loss factor of the axial springs, one or six, stored as (6,).
    joint_stiffness : JointStiffness, optional
        Springs in the joints; none where left out.
    joint_rest : Pose or array_like, optional
        Pose of the platform in the base frame in which joints and suspension are without force, as `home` is given;
        the home pose where left out.
    stiffness_law : ScrewLaw, HydraulicLaw or TableLaw, optional
        Axial stiffness by the leg's length, in place of `stiffness`.

    Raises
    ------
    DesignError
        For a stiffness of another shape, or not > 0, for an unknown key in `more`, and if both or neither of
        `stiffness` and `stiffness_law` are given.

    Notes
    -----
    Leg axes: x from base joint to platform joint, y = k x s normalised, z = x cross y, where k is the axis of the
    universal joint that is fixed in the base and s the leg's direction (Eqs 2 to 4 and Section 4.1 of the paper).
    With springs in series a leg of stiffness k is one of 1 / (1 / k + 1 / k_1 + ...).

    Examples
    --------
    >>> legs = fx.design.Legs(2e7, fx.design.Damping(prismatic=200.0))
    >>> float(legs.stiffness[5])
    20000000.0
    >>> stiff = fx.design.Legs(50e6, series_stiffness=[94e6, 94e6])
    >>> round(1e-6 / float(1 / stiff.stiffness[0] + stiff.series_compliance[0]), 2)  # N/um, joint to joint
    24.23
    """

    stiffness: Array
    damping: Damping = field(default_factory=Damping)
    lower: LegPart = field(default_factory=LegPart.massless)
    upper: LegPart = field(default_factory=LegPart.massless)
    more: Mapping[str, ArrayLike] = field(default_factory=dict)
    series_stiffness: Array = field(default_factory=lambda: np.zeros((6, 0)))
    loss_factor: Array = field(default_factory=lambda: np.zeros(6))
    joint_stiffness: JointStiffness = field(default_factory=JointStiffness)
    joint_rest: Home | None = None
    stiffness_law: StiffnessLaw | None = None

    def __post_init__(self) -> None:
        self._set_more()
        self._set_axial()
        self.set_checked("loss_factor", self.loss_factor, "legs.loss_factor", (6,))
        parts = {"damping": Damping, "lower": LegPart, "upper": LegPart, "joint_stiffness": JointStiffness}
        for name, kind in parts.items():
            if not isinstance(getattr(self, name), kind):
                raise DesignError(f"legs.{name} is {shown(getattr(self, name))}; it must be a {kind.__name__}.")
        if self.joint_rest is not None:
            object.__setattr__(self, "joint_rest", Home.of(self.joint_rest, "legs.joint_rest"))

    @property
    def series_compliance(self) -> Array:
        """Of the springs in series with each leg together, m/N, (6,)."""
        compliance: Array = series_compliance(self.series_stiffness)
        return compliance

    @functools.cached_property
    def spring_losses(self) -> Array:
        """Structural loss factor of each spring in the core's order, (42,), read-only; none of a suspension's."""
        leg = np.array(_core.SPRING_LEGS)  # first those along the legs, then those of the joints; -1: suspension
        along = np.arange(len(leg)) < 6
        found = np.where(along, self.loss_factor[leg], np.where(leg >= 0, self.joint_stiffness.loss_factor[leg], 0.0))
        found.flags.writeable = False
        return found

    def _set_axial(self) -> None:
        """Check the stiffness, or the law in its place, and the springs in series."""
        law = self.stiffness_law
        if law is not None and not isinstance(law, tuple(LAWS.values())):
            names = " or ".join(kind.__name__ for kind in LAWS.values())
            raise DesignError(f"legs.stiffness_law is {shown(law)}; it must be a {names}.")
        if law is None:
            if self.stiffness is None:
                raise DesignError("legs.stiffness and legs.stiffness_law are both missing; give one of them.")
            self.set_checked("stiffness", self.stiffness, "legs.stiffness", (6,))
        elif self.stiffness is None or (isinstance(self.stiffness, np.ndarray) and np.isnan(self.stiffness).all()):
            self.hold("stiffness", np.full(6, np.nan))
        else:
            raise DesignError(
                "legs.stiffness and [legs.stiffness_law] are both given, and both say how stiff the legs are. Leave "
                "one of them out."
            )
        series = np.asarray(self.series_stiffness)
        if series.shape == (6, 0):
            self.hold("series_stiffness", series)
            return
        if series.shape == (6,):
            raise DesignError(
                "legs.series_stiffness has six numbers, which may be one for each leg or six in series with every leg. "
                "Write six rows: [[94e6], [94e6], ...] for one spring at each leg."
            )
        array = check_value("legs.series_stiffness", series, KEYS["legs.series_stiffness"])
        if array.shape[-1:] > (MOST_IN_SERIES,):
            raise DesignError(
                f"legs.series_stiffness has {array.shape[-1]} springs in series with a leg; there may be "
                f"{MOST_IN_SERIES} at most. Put two in one: 1 / (1 / k_1 + 1 / k_2)."
            )
        self.hold("series_stiffness", np.broadcast_to(np.atleast_1d(array), (6, np.atleast_1d(array).shape[-1])))

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
    first = (key for key, place in PLACES.items() if key.startswith("legs.") and place.max() < _core.plain_size)
    keys = (key.removeprefix("legs.") for key in first)
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
    universal_moment, spherical_moment : float, optional
        Largest bending moment that the stiffness of a base joint and of a platform joint may make, N m.
    leg_compression, leg_tension : float, optional
        Greatest force with which a leg pushes base and platform apart, and with which it pulls them together, N.
    leg_rate, leg_acceleration : float, optional
        Greatest speed (m/s) and acceleration (m/s2) of a leg's extension.
    leg_power : float, optional
        Greatest mechanical power of a leg's actuator, force times rate, W, whether it drives or brakes.

    Raises
    ------
    DesignError
        For numbers that no limit can have, or a shortest length above the longest.

    Notes
    -----
    The paper's machines have no limits. `flexapod.check_limits` says whether a pose at rest keeps those of lengths,
    angles, distances, moments, and of leg forces under the machine's weight. Those of speeds, accelerations and power
    are of a motion: `flexapod.envelope`, `flexapod.plan_path` and `flexapod.paths.path_loads` say whether they are
    kept, and whether forces are on the way; `flexapod.load_cases` takes other loads at rest.

    Examples
    --------
    >>> fx.design.Limits(leg_length=[0.5, 0.75], universal_angle=np.radians(45)).leg_length.tolist()
    [0.5, 0.75]
    """

    leg_length: Array | None = None
    universal_angle: float | None = None
    spherical_angle: float | None = None
    leg_distance: float | None = None
    universal_moment: float | None = field(default=None, metadata=ADDED)
    spherical_moment: float | None = field(default=None, metadata=ADDED)
    leg_compression: float | None = field(default=None, metadata=ADDED)
    leg_tension: float | None = field(default=None, metadata=ADDED)
    leg_rate: float | None = field(default=None, metadata=ADDED)
    leg_acceleration: float | None = field(default=None, metadata=ADDED)
    leg_power: float | None = field(default=None, metadata=ADDED)

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
        for item in fields(self):
            name, value = item.name, getattr(self, item.name)
            if name != "leg_length" and value is not None:
                key = f"limits.{name}"
                object.__setattr__(self, name, float(check_value(key, value, KEYS[key])))

    @property
    def given(self) -> bool:
        """Whether poses at rest are limited: lengths, angles, distances and forces of the legs, moments of joints."""
        return any(getattr(self, item.name) is not None for item in fields(self) if item.name not in _OF_A_MOTION)

    @property
    def of_motions(self) -> tuple[str, ...]:
        """Names of the limits given that only a motion can exceed: speeds, accelerations and power of the legs."""
        return tuple(name for name in _OF_A_MOTION if getattr(self, name) is not None)
