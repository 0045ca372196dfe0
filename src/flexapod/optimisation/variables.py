"""What a search may change: bounded variables, each tied to numbers of the design by a smooth map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from flexapod.checks import number, one_of, several
from flexapod.conventions import TWO_PI, Array
from flexapod.design import layout
from flexapod.design.hexapod import Hexapod
from flexapod.design.key import Key
from flexapod.design.units import UNITS, si_unit, to_si
from flexapod.design.universal_axes import keeps_tangents
from flexapod.errors import ArgumentError, shown, told_apart
from flexapod.optimisation.parameters import AffineMap, CircleMap, Kind, Parameter, Part
from flexapod.showing import in_notebooks

Range = tuple[float, float]
#: The parts of a joint circle and their dimensions.
CIRCLE = {"radius": "length", "half_angle": "angle", "turn": "angle", "height": "length"}


@in_notebooks
@dataclass(frozen=True)
class Variable:
    """A bounded number that sets, adds to or scales numbers of the design.

    Parameters
    ----------
    targets : str, sequence of str or mapping of str to float
        A key of the design file with indices, counted from 0 (`[:]` is all), in the unit of the key; several keys that
        are kept equal; or keys with the factor that each has of the variable.
    low, high : float
        Bounds, in the unit of the first key; ratios if `kind` is "scale".
    kind : {"set", "add", "scale"}, optional
        Whether the numbers are the variable, or what they were plus or times it.
    name : str, optional
        Name in results; the key by default.
    log : bool, optional
        Whether its logarithm is searched, for numbers that span decades.

    Examples
    --------
    All legs equally stiff; the platform's joints raised together; two joints kept as mirror images:

    >>> stiffness = fx.Variable("legs.stiffness_N_per_um", 10, 80)
    >>> height = fx.Variable("platform.joints[:][2]", -0.02, 0.02, kind="add")
    >>> mirrored = fx.Variable({"base.joints[0][1]": 1, "base.joints[5][1]": -1}, 0.05, 0.2)
    """

    targets: str | Sequence[str] | Mapping[str, float]
    low: float
    high: float
    kind: Kind = "set"
    name: str = ""
    log: bool = False

    def parts(self, hexapod: Hexapod) -> list[Part]:
        """Make the map of this variable for a design.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of AffineMap
            The map.

        Raises
        ------
        ArgumentError
            If this cannot be a variable of the design.
        """
        if not isinstance(self.name, str):
            raise ArgumentError(f"name is {shown(self.name)}; the name of a variable must be text.")
        one_of(self.kind, f"{self._name}: kind", get_args(Kind))
        if not isinstance(self.log, bool):
            raise ArgumentError(f"{self._name}: log is {shown(self.log)}; it must be True or False.")
        factors = self._factors()
        unit = layout.entries(next(iter(factors)))[2] if self.kind != "scale" else 1.0
        named = layout.unit_name(next(iter(factors))) if self.kind != "scale" else ""
        low, high = (
            number(bound, f"{self._name}: the {side} bound", named) * unit
            for side, bound in (("lower", self.low), ("upper", self.high))
        )
        parameter = Parameter(self._name, low, high, unit, self.log, unit_name=named)
        parameter.check()
        found = [(layout.entries(key), factor) for key, factor in factors.items()]
        places = [layout.present(hexapod, place) for (place, _, _), _ in found]
        index = np.concatenate(places)
        factor = np.concatenate([np.full(len(place), factor) for place, (_, factor) in zip(places, found, strict=True)])
        if self.kind != "scale":
            for (_, rule, _), scale in found:
                self._check_range(parameter, rule, scale)
        base = layout.own(hexapod, index, self._name)
        return [AffineMap(parameter, index, factor, base, self.kind)]

    @property
    def _name(self) -> str:
        if self.name:
            return self.name
        keys = list(self._factors())
        return keys[0] if len(keys) == 1 else f"{keys[0]}.."

    def _factors(self) -> dict[str, float]:
        if isinstance(self.targets, str):
            return {self.targets: 1.0}
        if isinstance(self.targets, Mapping):
            found = {str(key): number(factor, f"the factor of {key}") for key, factor in self.targets.items()}
        else:
            keys = self.targets if isinstance(self.targets, Sequence) else []
            found = dict.fromkeys((str(key) for key in keys), 1.0)
        if not found or not all(found.values()):
            raise ArgumentError(f"{self.targets!r} ties nothing; give one key or more, with factors that are not 0.")
        return found

    def _check_range(self, parameter: Parameter, rule: Key, factor: float) -> None:
        """Bounds that leave the range a design allows are refused at once, not trial by trial."""
        if self.kind != "set":
            return
        low, high = sorted((parameter.low * factor, parameter.high * factor))
        if rule.least is not None and (low < rule.least or (rule.open_ and low <= rule.least)):
            sign = ">" if rule.open_ else ">="
            told, bound = told_apart(low, rule.least, (6, 6))
            raise ArgumentError(
                f"{self._name} may go down to {told}, but {rule.meaning} must be {sign} {bound} (SI). "
                "Raise its lower bound."
            )
        if rule.most is not None and high > rule.most:
            told, bound = told_apart(high, rule.most, (6, 6))
            raise ArgumentError(
                f"{self._name} may go up to {told}, but {rule.meaning} must be <= {bound} (SI). Lower its upper bound."
            )


@in_notebooks
@dataclass(frozen=True)
class JointCircle:
    """The joints of a plate as three mirror-symmetric pairs, 120 degrees apart on a circle about its z axis.

    Parameters
    ----------
    plate : {"base", "platform"}
        The plate.
    radius : float or tuple of float, optional
        Radius of the circle, m: a pair (low, high) makes a variable, a number holds it, and left out it is what the
        design has (the mean over its joints, if they are not on such a circle).
    half_angle : float or tuple of float, optional
        Angle between a joint and the middle of its pair, rad, in the same way.
    turn : float or tuple of float, optional
        Angle of the middle of the first pair from x, rad, in the same way.
    height : float or tuple of float, optional
        Height of the joints, m, in the same way.
    axes : {"tangent", "keep"}, optional
        Whether the axes of the base's universal joints become tangents of the circle, or stay as they are. Those of
        legs that the design has within 15 degrees of the tangent at home stay in any case.
    units : mapping of str to str, optional
        Other units than m and rad, by the name of the part, such as "mm" for radius.

    Notes
    -----
    Which legs form a pair is read from the joints of the design. The variables are named after plate and part:
    `base.circle.radius`, or `base.circle.radius_mm` with that unit.

    Examples
    --------
    >>> circle = fx.optimisation.JointCircle("base", radius=(0.1, 0.2), half_angle=(0.05, 0.5))
    >>> same = fx.optimisation.JointCircle("base", radius=(100, 200), half_angle=(0.05, 0.5), units={"radius": "mm"})
    """

    plate: Literal["base", "platform"]
    radius: float | Range | None = None
    half_angle: float | Range | None = None
    turn: float | Range | None = None
    height: float | Range | None = None
    axes: Literal["tangent", "keep"] = "tangent"
    units: Mapping[str, str] = field(default_factory=dict, hash=False, kw_only=True)

    def parts(self, hexapod: Hexapod) -> list[Part]:
        """Make the map of this circle for a design.

        Parameters
        ----------
        hexapod : Hexapod
            The design.

        Returns
        -------
        list of CircleMap
            The map.

        Raises
        ------
        ArgumentError
            If this cannot be a circle of the design.
        """
        one_of(self.plate, "plate of a joint circle", ("base", "platform"))
        one_of(self.axes, "axes of a joint circle", ("tangent", "keep"))
        if self._of_the_design(hexapod):
            return self._variables(hexapod)
        joints = hexapod.base_joints if self.plate == "base" else hexapod.platform_joints
        third, side, own = _pairs(joints)
        if not isinstance(self.units, Mapping):
            raise ArgumentError(f"units is {shown(self.units)}; give a mapping, such as {{'radius': 'mm'}}.")
        for part in self.units:
            one_of(part, "units of a joint circle: the part", CIRCLE)
        four = [self._part(name, own[name]) for name in CIRCLE]
        least = four[0].low if isinstance(four[0], Parameter) else four[0]
        if least <= 0:
            raise ArgumentError(f"{self.plate}.circle.radius may go down to {least:.6g} m; it must be > 0.")
        tangent = keeps_tangents(hexapod.base_joints, hexapod.platform_joints, hexapod.home)
        follow = tangent & (self.plate == "base" and self.axes == "tangent")
        return [CircleMap(self.plate, four, third, side, follow)]

    def _of_the_design(self, hexapod: Hexapod) -> bool:
        """Whether the design has this circle and its joints stay where they are on it."""
        given = [getattr(self, name) is not None for name in ("half_angle", "turn")]
        pairs = all(np.shape(part) == (2,) for part in (self.radius, self.height) if part is not None)
        return not any(given) and pairs and any(form.table == f"{self.plate}.circle" for form in hexapod.short_forms)

    def _variables(self, hexapod: Hexapod) -> list[Part]:
        """Radius and height as numbers of the design's own circle, on which the joints may be anywhere."""
        found: list[Part] = []
        for name in ("radius", "height"):
            given, unit = getattr(self, name), self.units.get(name)
            if given is not None:
                key = f"{self.plate}.circle.{name}" + (f"_{unit}" if unit else "")
                found += Variable(key, *given).parts(hexapod)
        return found

    def _part(self, name: str, own: float) -> Parameter | float:
        """A variable between its bounds, or the number that holds this part."""
        given, dimension = getattr(self, name), CIRCLE[name]
        if given is None:
            return own
        unit, title = si_unit(dimension), f"{self.plate}.circle.{name}"
        if name in self.units:
            unit = one_of(self.units[name], f"the unit of {title}", UNITS[dimension])
            title += f"_{unit}"
        scale = float(to_si(1.0, dimension, unit))
        if not several(given):
            return scale * number(given, title, unit)
        if len(given) != 2:
            raise ArgumentError(f"{title} is {shown(given)}; give a number, or a pair (least, most).")
        low, high = (scale * number(bound, f"a bound of {title}", unit) for bound in given)
        parameter = Parameter(title, low, high, scale, start=own, unit_name=unit)
        parameter.check()
        return parameter


def _pairs(joints: Array) -> tuple[Array, Array, dict[str, float]]:
    """Which third (0, 1, 2) and which side (-1, 1) of a pair each joint is on, and the circle that fits best."""
    angle = np.arctan2(joints[:, 1], joints[:, 0])
    order = np.argsort(angle)
    gaps = np.diff(angle[order], append=angle[order[0]] + TWO_PI)
    first = 0 if gaps[0::2].sum() <= gaps[1::2].sum() else 1  # the joints that are nearer together are pairs
    third, side = np.empty(6), np.empty(6)
    for k in range(3):
        third[order[(first + 2 * k) % 6]] = third[order[(first + 2 * k + 1) % 6]] = k
        side[order[(first + 2 * k) % 6]], side[order[(first + 2 * k + 1) % 6]] = -1, 1
    relative = angle - third * TWO_PI / 3
    turn = float(np.angle(np.exp(1j * relative).mean()))
    half = float((side * np.angle(np.exp(1j * (relative - turn)))).mean())
    radius = float(np.hypot(joints[:, 0], joints[:, 1]).mean())
    return third, side, {"radius": radius, "half_angle": half, "turn": turn, "height": float(joints[:, 2].mean())}
