"""The design of a 6-UPS hexapod: frozen, checked once, SI units, legs 1 to 6 (in arrays and in [brackets], 0 to 5)."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod import _core
from flexapod._suggestions import Suggesting, suggests
from flexapod.conventions import JOINT_MODELS, Array, JointModel
from flexapod.design import changes as design_changes
from flexapod.design import design_file
from flexapod.design.compiled import CompiledHexapod
from flexapod.design.drive import Drive, values_of_drive
from flexapod.design.flexible_joints import Suspension
from flexapod.design.geometry_checks import joint_warnings, platform_warnings, unit_axes, warnings_of_part
from flexapod.design.home import Home
from flexapod.design.packing import packed
from flexapod.design.parts import Damping, LegPart, Legs, Limits
from flexapod.design.points import Points, values_of_points
from flexapod.design.short_forms import ShortForm, standing
from flexapod.design.shorthands import circle_table, expand
from flexapod.design.spring_checks import check_springs
from flexapod.design.tables import DEFAULT_GRAVITY, complete, flatten
from flexapod.design.universal_axes import default_axes
from flexapod.design.value import ADDED, Value, bytes_of
from flexapod.design.values import parts_of, values_of_legs, values_of_suspension
from flexapod.errors import DesignError, shown
from flexapod.output_files import write_file
from flexapod.pose import Pose, PoseLike

_WORDS = {
    "load": "flexapod.load(name or path)",
    "mass": "platform_mass",
    "inertia": "platform_inertia",
    "mass_center": "platform_mass_center",
    "stiffness": "legs.stiffness",
    "damping": "legs.damping",
    "leg_length": "limits.leg_length, or flexapod.inverse_kinematics(hexapod)",
    "pose": "home",
    "joints": "base_joints or platform_joints",
    "copy": "replace",
    "to_dict": "values",
    "plot": "flexapod.plots.machine(hexapod)",
}


@suggests(_WORDS)
@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Hexapod(Value, metaclass=Suggesting):
    """A 6-UPS Stewart platform; it never changes, `replace` makes another one.

    Make one with `flexapod.load`, `from_circles`, `from_toml`, or from its parts.

    Parameters
    ----------
    name : str
        What the machine is called.
    gravity : array_like
        Gravity in the inertial frame, m/s2, (3,).
    base_joints : array_like
        Joints on the base, base frame, m, (6, 3).
    universal_axes : array_like, optional
        Axes of the universal joints that are fixed in the base, base frame, (6, 3), made unit vectors. Left out, they
        are tangent to the circle of the base joints; a leg that is within 15 degrees of its tangent at home gets the
        axis across it that is nearest to z.
    platform_joints : array_like
        Joints on the platform, platform frame, m, (6, 3).
    platform_mass : float
        Mass of platform and payload, kg.
    platform_mass_center : array_like
        Mass centre of platform and payload, platform frame, m, (3,).
    platform_inertia : array_like
        Inertia about the mass centre, platform axes, kg m2, (3, 3), or three principal moments.
    legs : Legs
        Stiffness, friction and bodies of the legs, and the stiffness of their joints.
    limits : Limits, optional
        What joints and legs allow.
    home : Pose or array_like, optional
        Pose of the platform in the base frame that is taken where none is given: a Pose, or x, y, z in m and roll,
        pitch, yaw in rad. It is kept as a `Pose`.
    suspension : Suspension, optional
        A spring and damper between base and platform beside the legs.
    points : mapping, optional
        Points of the platform by name, (3,) m each, in the platform's frame, such as the vertex of a mirror. What
        studies take as `point` may be such a name. Kept in the order of the names.
    drive : Drive, optional
        Screw, gear and motor of the legs, for the motors' torques along a path; no part of the machine's dynamics.
    short_forms : tuple, optional
        The circles, cube and rods of a design file that joints and bodies were made by. `replace` changes their
        numbers and `to_toml` writes them; those that do not make the other values are left out. Designs of the same
        numbers are equal, however they were given.

    Attributes
    ----------
    warnings : tuple of str
        What is odd about the design but can be computed, in words.

    Raises
    ------
    DesignError
        For anything that is not a hexapod, with what is wrong and what to do.

    See Also
    --------
    flexapod.load : Read a packaged design or a design file.

    Notes
    -----
    Section 4 and Appendix A of the paper. The frames and signs are those of docs/conventions.md.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> machine.replace({"platform.mass_t": 2}).platform_mass
    2000.0
    >>> fx.Hexapod(
    ...     base_joints=machine.base_joints,
    ...     platform_joints=machine.platform_joints,
    ...     platform_mass=500.0,
    ...     platform_mass_center=[0, 0, 0.1],
    ...     platform_inertia=[40, 40, 60],
    ...     legs=fx.design.Legs(2e7),
    ...     home=[0, 0, 2.4, 0, 0, 0],
    ... ).home
    Pose(x=0 y=0 z=2.4 m, roll=0 pitch=0 yaw=0 deg)
    """

    name: str = "hexapod"
    gravity: Array = field(default_factory=DEFAULT_GRAVITY.copy)
    base_joints: Array
    universal_axes: Array = None  # type: ignore[assignment]  # a design without them gets the default
    platform_joints: Array
    platform_mass: float
    platform_mass_center: Array
    platform_inertia: Array
    legs: Legs
    limits: Limits = field(default_factory=Limits)
    home: Pose | None = None
    suspension: Suspension | None = None
    points: Mapping[str, Array] = field(default_factory=Points)
    drive: Drive | None = field(default=None, metadata=ADDED)
    short_forms: tuple[ShortForm, ...] = field(default=(), compare=False)
    warnings: tuple[str, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        if not (isinstance(self.short_forms, tuple) and all(isinstance(form, ShortForm) for form in self.short_forms)):
            raise DesignError(f"short_forms is {shown(self.short_forms)}; it must be a tuple, as another design has.")
        flatten({"name": self.name})
        for name, key in _KEYS.items():
            if name != "universal_axes" or self.universal_axes is not None:
                self.set_checked(name, getattr(self, name), key)
        object.__setattr__(self, "platform_mass", float(self.platform_mass))
        for part, kind in (("legs", Legs), ("limits", Limits)):
            if not isinstance(getattr(self, part), kind):
                raise DesignError(f"{part} is {shown(getattr(self, part))}; it must be a {kind.__name__}.")
        if self.suspension is not None and not isinstance(self.suspension, Suspension):
            raise DesignError(f"suspension is {shown(self.suspension)}; it must be a Suspension.")
        if self.drive is not None and not isinstance(self.drive, Drive):
            raise DesignError(f"drive is {shown(self.drive)}; it must be a Drive.")
        object.__setattr__(self, "points", Points(self.points))
        if self.home is not None:
            object.__setattr__(self, "home", Home.of(self.home))
        axes = self.universal_axes
        if axes is None:
            axes = default_axes(self.base_joints, self.platform_joints, self.home)
        object.__setattr__(self, "universal_axes", unit_axes(axes))
        check_springs(self)
        warnings = joint_warnings(self.base_joints, self.platform_joints) + platform_warnings(self.platform_inertia)
        for side in ("lower", "upper"):
            warnings += warnings_of_part(f"legs.{side}", getattr(self.legs, side).inertia)
        object.__setattr__(self, "warnings", tuple(warnings))
        if self.short_forms:
            object.__setattr__(self, "short_forms", standing(self.short_forms, self.values()))

    @classmethod
    def from_circles(
        cls,
        base_radius: float,
        platform_radius: float,
        height: float,
        *,
        platform_mass: float,
        platform_inertia: ArrayLike,
        stiffness: ArrayLike,
        base_half_angle: float | None = None,
        platform_half_angle: float | None = None,
        base_angles: ArrayLike | None = None,
        platform_angles: ArrayLike | None = None,
        degrees: bool = False,
        platform_mass_center: ArrayLike = (0.0, 0.0, 0.0),
        damping: Damping | ArrayLike = 0.0,
        lower: LegPart | None = None,
        upper: LegPart | None = None,
        limits: Limits | None = None,
        gravity: ArrayLike = DEFAULT_GRAVITY,
        name: str = "hexapod",
    ) -> Hexapod:
        """A machine whose joints stand on two circles, as `[base.circle]` and `[platform.circle]` of a design file.

        Parameters
        ----------
        base_radius, platform_radius : float
            Radii of the joint circles, m. The circles lie in the planes z = 0 of their frames, around the origin.
        height : float
            Height of the platform's circle above the base's at home, m.
        platform_mass : float
            Mass of platform and payload, kg.
        platform_inertia : array_like
            Inertia about the mass centre, kg m2, (3, 3), or three principal moments.
        stiffness : array_like
            Axial stiffness of the legs, N/m, one or six.
        base_half_angle, platform_half_angle : float, optional
            Angle between a joint and the middle of its pair, rad. The pairs on the base are in the directions 60, 180
            and 300 degrees from x (legs 1 and 2, 3 and 4, 5 and 6), those on the platform in 0, 120 and 240 degrees
            (legs 6 and 1, 2 and 3, 4 and 5).
        base_angles, platform_angles : array_like, optional
            Instead of a half angle, the direction of each leg's joint about z, from x, rad, (6,).
        degrees : bool
            Whether the angles are given in degrees.
        platform_mass_center : array_like
            Mass centre of platform and payload, platform frame, m.
        damping : Damping or array_like
            Friction of the joints; numbers are that along the legs, N s/m.
        lower, upper : LegPart, optional
            Bodies of the legs, such as `LegPart.rod`; massless where left out.
        limits : Limits, optional
            What joints and legs allow.
        gravity : array_like
            Gravity in the inertial frame, m/s2.
        name : str
            What the machine is called.

        Returns
        -------
        Hexapod
            The machine, with tangent universal axes and the home pose at `height`.

        Raises
        ------
        DesignError
            For numbers that make no hexapod, or if a plate has neither or both of half angle and angles.

        Examples
        --------
        >>> machine = fx.Hexapod.from_circles(
        ...     0.5, 0.3, 0.5, base_half_angle=10, platform_half_angle=10, degrees=True,
        ...     platform_mass=60.0, platform_inertia=[2, 2, 4], stiffness=2e7,
        ... )
        >>> fx.inverse_kinematics(machine).round(4).tolist()
        [0.6002, 0.6002, 0.6002, 0.6002, 0.6002, 0.6002]
        """
        tables = {
            "name": name,
            "gravity": gravity,
            "base": {"circle": circle_table("base", base_radius, base_half_angle, base_angles, degrees)},
            "platform": {
                "circle": circle_table("platform", platform_radius, platform_half_angle, platform_angles, degrees),
                "mass": platform_mass,
                "mass_center": platform_mass_center,
                "inertia": platform_inertia,
            },
            "legs": {"stiffness": stiffness},
            "home": {"position": [0.0, 0.0, height]},
        }
        values, forms = expand(flatten(tables))
        machine = cls.from_values(complete(values), forms)
        friction = damping if isinstance(damping, Damping) else Damping(damping)  # type: ignore[arg-type]
        lower, upper = (LegPart.massless() if part is None else part for part in (lower, upper))
        legs = Legs(machine.legs.stiffness, friction, lower, upper)
        return dataclasses.replace(machine, legs=legs, limits=Limits() if limits is None else limits)

    @classmethod
    def from_values(cls, values: Mapping[str, Any], short_forms: Iterable[ShortForm] = ()) -> Hexapod:
        """A design from checked values by file key, as `values` gives them, and the short forms that made them.

        Raises
        ------
        DesignError
            For values that make no hexapod, or lack some.
        """
        given = parts_of(values, _KEYS)
        return cls(**given, short_forms=tuple(short_forms) if isinstance(short_forms, Iterable) else short_forms)

    @classmethod
    def from_toml(cls, text: str) -> Hexapod:
        """A design from the text of a design file.

        Raises
        ------
        DesignError
            For text that is no design, with the key and the remedy.
        """
        return cls.from_values(*design_file.read_text(text))

    def values(self) -> dict[str, Any]:
        """The whole design by dotted file key: text for `name`, arrays in SI units for all else."""
        values: dict[str, Any] = {"name": self.name}
        values |= {key: np.asarray(getattr(self, name)) for name, key in _KEYS.items()}
        values |= values_of_legs(self.legs)
        for item in fields(Limits):
            limit = getattr(self.limits, item.name)
            if limit is not None:
                values[f"limits.{item.name}"] = np.asarray(limit)
        if self.home is not None:
            values |= {"home.position": self.home.position, "home.orientation": self.home.rpy}
        values |= values_of_suspension(self.suspension) | values_of_points(self.points)
        return values | values_of_drive(self.drive)

    def replace(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Hexapod:
        """This design with changes, by the keys of a design file.

        Parameters
        ----------
        changes : mapping, optional
            Key to new value: `{"platform.mass": 400, "legs.stiffness_N_per_um[2]": 10}`. A unit may end a key, indices
            count from 0. Text is read as TOML; None takes an optional key or table out.
        **more
            Keys without a dot, such as `gravity=[0, 0, 0]`.

        Returns
        -------
        Hexapod
            The changed design. A number of a short form that the design was given by (`base.circle.radius`,
            `cubic.edge`, `legs.upper.rod.mass`) makes it anew with the others that it has. Universal joint axes stay as
            they are when joints are moved one by one or the home pose is another, and default ones are the default
            again with another `base.circle` or `cubic`.

        Raises
        ------
        DesignError
            For an unknown key, with the nearest ones, or a value that it cannot have.
        """
        if not isinstance(changes, Mapping | None):
            raise DesignError(f"changes is {shown(changes)}; it must be a mapping from keys of a design to new values.")
        changes = {**(changes or {}), **more}
        return self.from_values(*design_changes.changed(self.values(), self.short_forms, changes))

    def to_toml(self) -> str:
        """This design as a commented TOML file; `from_toml` gives the same numbers bit for bit."""
        values = self.values()
        if not self.legs.lower.mass.any() and not self.legs.upper.mass.any():
            massless = LegPart.massless()
            if self.legs.lower == massless and self.legs.upper == massless:
                values = {
                    key: value for key, value in values.items() if not key.startswith(("legs.lower", "legs.upper"))
                }
        return design_file.write_text(values, self.short_forms)

    def save(self, path: str | Path) -> None:
        """Write the design to a TOML file without loss.

        Raises
        ------
        OutputError
            Where the file cannot be written.
        """
        write_file(path, self.to_toml())

    @cached_property
    def packed(self) -> Array:
        """The design's numbers in the core's order (`flexapod._core.DESIGN_LAYOUT`), read-only."""
        return packed(self.values())

    @cached_property
    def one_pose(self) -> dict[str, _core.OnePose]:
        """What answers a call for one pose, by joint model."""
        return {joint: _core.OnePose(self.packed, _core.Joint[joint]) for joint in JOINT_MODELS}

    def compiled(self, *, base: PoseLike | None = None, joint: JointModel = "universal") -> CompiledHexapod:
        """This machine for loops that call it very often, with plain arrays whose shapes are all that is checked.

        Parameters
        ----------
        base : Pose or array_like, optional
            Pose of the base in the inertial frame, in which it rests. Left out, the base frame is the inertial frame.
        joint : {"universal", "spin_free"}
            Model of the base joints.

        Returns
        -------
        CompiledHexapod
            Its methods take and give arrays of one state.

        Raises
        ------
        PoseError
            For a base that is not one pose.
        ArgumentError
            For an unknown joint model.
        """
        return CompiledHexapod(self, base, joint)

    @cached_property
    def digest(self) -> str:
        """Sixteen hex digits that tell designs apart by their numbers (not by their names)."""
        numbers = self.packed.astype("<f8")
        content = numbers[: _core.plain_size].tobytes() + bytes_of(self.limits) + bytes_of(self.home)
        springs = {key: value for key, value in self.values().items() if key.startswith(SPRINGS)}
        if springs:  # designs without them have the digest that they had before there were any
            content += bytes_of(springs)
        if self.points:
            content += bytes_of(self.points)
        if self.drive is not None:
            content += bytes_of(self.drive)
        return hashlib.sha256(content).hexdigest()[:16]

    @property
    def rest(self) -> Pose | None:
        """Pose in which joints and suspension are without force: the design's `legs.joint_rest`, or home."""
        return self.home if self.legs.joint_rest is None else self.legs.joint_rest

    @property
    def sprung(self) -> bool:
        """Whether there are springs in the joints, or a suspension."""
        return self.legs.joint_stiffness.any or self.suspension is not None

    def __repr__(self) -> str:
        stiffness = np.unique(self.legs.stiffness)
        k = f"{stiffness[0]:.4g}" + (f" to {stiffness[-1]:.4g}" if stiffness.size > 1 else "") + " N/m"
        if self.legs.stiffness_law is not None:
            k = f"stiffness by a {self.legs.stiffness_law.kind.name} law"
        leg_mass = self.legs.lower.mass.mean() + self.legs.upper.mass.mean()
        notes = f", {len(self.warnings)} warning{'s' * (len(self.warnings) > 1)}" if self.warnings else ""
        return (
            f"<Hexapod {self.name!r}: platform {self.platform_mass:.4g} kg, legs of {leg_mass:.4g} kg "
            f"and {k}{notes}, digest {self.digest}>"
        )


#: Beginnings of the keys of springs other than constant ones along the legs, and of their losses.
SPRINGS = ("legs.series_stiffness", "legs.loss_factor", "legs.stiffness_law.", "legs.joint_", "suspension.")
#: Fields of a Hexapod that are numbers, and their keys in a design file.
_KEYS = {
    "gravity": "gravity",
    "base_joints": "base.joints",
    "universal_axes": "base.universal_axes",
    "platform_joints": "platform.joints",
    "platform_mass": "platform.mass",
    "platform_mass_center": "platform.mass_center",
    "platform_inertia": "platform.inertia",
}
