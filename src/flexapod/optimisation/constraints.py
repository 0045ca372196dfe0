"""What a better design must respect. A bound that is left out is what the design to start from has itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError
from flexapod.optimisation import constraint_quantities
from flexapod.optimisation.constraint_quantities import Kind, Side, Values
from flexapod.optimisation.derivatives import Slopes
from flexapod.workspace.region import Region, RegionLike, as_region

Where = RegionLike
Plate = Literal["base", "platform"]


@dataclass(frozen=True)
class Requirement:
    """A kind of quantity, its bound (one number, or one a leg) on one side, and where it holds (None: everywhere)."""

    name: str
    kind: Kind
    side: Side
    bound: Array
    over: Region | None

    def margins(self, value: Array, column: Array | None = None) -> Array:
        """Relative margins, >= 0 where the bound is kept."""
        bound = (
            np.broadcast_to(self.bound, value.shape) if column is None or not self.bound.ndim else self.bound[column]
        )
        sign = 1.0 if self.side == "most" else -1.0
        if self.kind.log:
            with np.errstate(divide="ignore"):
                return np.asarray(sign * np.log(bound / value))
        return np.asarray(sign * (1 - value / bound))

    def smooth_margins(self, at: Slopes) -> tuple[Array, Array]:
        """Margins at the poses held, and their derivatives by the variables."""
        found: Values = self.kind.slopes(at)
        margin = self.margins(found.value, found.column)
        bound = self.bound[found.column] if self.bound.ndim else np.broadcast_to(self.bound, found.value.shape)
        sign = -1.0 if self.side == "most" else 1.0
        scale = found.value if self.kind.log else bound
        return margin, sign * found.slope / scale[:, None]

    def describe(self) -> dict[str, Any]:
        over = None if self.over is None else self.over.describe()
        return {
            "name": self.name,
            "kind": repr(self.kind) if self.kind.__dict__ else type(self.kind).__name__,
            "side": self.side,
            "bound": self.bound.tolist(),
            "over": over,
        }


class Constraint:
    """Something bounded; a subclass says what in `requirements`."""

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """over: the objective's places, for constraints that name none. measure: what the design has itself."""
        raise NotImplementedError


Measure = Callable[[Kind, Side, Region | None], Array]


def _one(
    name: str, kind: Kind, side: Side, bound: float | None, over: Region | None, measure: Measure
) -> list[Requirement]:
    if bound is None:
        values = measure(kind, side, over)
        bound = float(values.max() if side == "most" else values.min())
    if not (np.isfinite(bound) and bound > 0):
        raise ArgumentError(f"{name}: the bound is {bound} {kind.unit}; it must be a finite number > 0.")
    return [Requirement(name, kind, side, np.array(float(bound)), over)]


@dataclass(frozen=True)
class Footprint(Constraint):
    """The plate's joints stay within a circle about the middle of what they fill now.

    most: its radius, m; default: what the design has. plate: "base" or "platform".

    Source: own.
    """

    most: float | None = None
    plate: Plate = "base"

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a plate that is none and a bound that none can keep.
        """
        if self.plate not in get_args(Plate):
            raise ArgumentError(f"footprint: the plate is {self.plate!r}; it must be 'base' or 'platform'.")
        joints = hexapod.base_joints if self.plate == "base" else hexapod.platform_joints
        (x, y), radius = constraint_quantities.enclosing_circle(joints[:, :2])
        kind = constraint_quantities.Radius(self.plate, float(x), float(y))
        return _one(
            f"footprint of the {self.plate}", kind, "most", radius if self.most is None else self.most, None, measure
        )


@dataclass(frozen=True)
class TotalMass(Constraint):
    """Platform with payload and all legs weigh at most `most`, kg; default: what the design has.

    Source: own.
    """

    most: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        return _one("total mass", constraint_quantities.Mass(), "most", self.most, None, measure)


@dataclass(frozen=True)
class _Everywhere(Constraint):
    over: Where = field(default=None, kw_only=True)

    def _over(self, default: Region) -> Region:
        return default if self.over is None else as_region(self.over)


@dataclass(frozen=True)
class Stroke(_Everywhere):
    """No leg is longer than at its shortest by more than a stroke.

    most: m; default: what the design has. over: poses; default: those of the objective.

    Source: own.
    """

    most: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        return _one("leg stroke", constraint_quantities.LegStroke(), "most", self.most, self._over(over), measure)


@dataclass(frozen=True)
class LegLength(_Everywhere):
    """Every leg is between `least` and `most` (m) long; both left out: what the design has.

    over: poses; default: those of the objective.

    Source: own.
    """

    least: float | None = None
    most: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        if self.least is not None and self.most is not None and not self.least < self.most:
            raise ArgumentError(
                f"leg length: the bounds are {self.least:.6g} and {self.most:.6g} m, which contradict each other; the "
                "lower bound must be < the upper one."
            )
        where, kind = self._over(over), constraint_quantities.LegLengths()
        both = self.least is None and self.most is None
        found = []
        if self.least is not None or both:
            found += _one("shortest leg", kind, "least", self.least, where, measure)
        if self.most is not None or both:
            found += _one("longest leg", kind, "most", self.most, where, measure)
        return found


@dataclass(frozen=True)
class JointAngle(_Everywhere):
    """No joint of the kind turns by more than an angle from where it is at home.

    joint: "universal" or "spherical". most: rad; default: what the design has. over: poses; default: those of the
    objective.

    Source: own.
    """

    joint: Literal["universal", "spherical"]
    most: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        return _one(
            f"{self.joint} joint angle",
            constraint_quantities.JointAngles(self.joint),
            "most",
            self.most,
            self._over(over),
            measure,
        )


@dataclass(frozen=True)
class LegClearance(_Everywhere):
    """The axes of any two legs stay apart.

    least: m; default: what the design has. over: poses; default: those of the objective.

    Source: own.
    """

    least: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        return _one(
            "leg clearance", constraint_quantities.LegDistance(), "least", self.least, self._over(over), measure
        )


@dataclass(frozen=True)
class ConditionNumber(_Everywhere):
    """cond(H), in metres, is bounded.

    most: a number > 1; default: what the design has. over: poses; default: those of the objective.

    Source: Section 3.
    """

    most: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        if self.most is not None and self.most <= 1:
            raise ArgumentError(f"condition number: the bound is {self.most}; no H has less than 1.")
        return _one(
            "condition number", constraint_quantities.Conditioning(), "most", self.most, self._over(over), measure
        )


@dataclass(frozen=True)
class Deflection(_Everywhere):
    """A static force in any direction moves the platform by at most `most`, m.

    From the stiffness H K H^T of the legs at the reference point, without moment. most: default what the design has.
    force: N; default: the platform's weight. over: poses; default: those of the objective.

    Source: own.
    """

    most: float | None = None
    force: float | None = None

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a bound that none can keep.
        """
        if self.force is not None and not self.force > 0:
            raise ArgumentError(f"static deflection: the force is {self.force} N; it must be > 0.")
        if self.force is None and not hexapod.gravity.any():
            raise ArgumentError("static deflection: without gravity the platform has no weight. Give a force in N.")
        return _one(
            "static deflection", constraint_quantities.Sag(self.force), "most", self.most, self._over(over), measure
        )


@dataclass(frozen=True)
class DesignLimits(_Everywhere):
    """The limits of the design itself: leg lengths (m), joint angles (rad), clearance (m).

    over: poses; default: those of the objective.

    Source: own.
    """

    def requirements(self, hexapod: Hexapod, over: Region, measure: Measure) -> list[Requirement]:
        """What a design has to keep. over: the objective's poses. measure: gives what the design has itself.

        Raises: ArgumentError for a design without limits.
        """
        limits, where = hexapod.limits, self._over(over)
        found: list[Requirement] = []
        if limits.leg_length is not None:
            pairs = np.reshape(limits.leg_length, (-1, 2))
            low, high = pairs[0] if len(pairs) == 1 else pairs.T
            if np.all(low > 0):
                found.append(
                    Requirement("shortest leg", constraint_quantities.LegLengths(), "least", np.asarray(low), where)
                )
            found.append(
                Requirement("longest leg", constraint_quantities.LegLengths(), "most", np.asarray(high), where)
            )
        for name in ("universal", "spherical"):
            most = getattr(limits, f"{name}_angle")
            if most is not None:
                found += JointAngle(name, most, over=where).requirements(hexapod, over, measure)
        if limits.leg_distance:
            found += LegClearance(limits.leg_distance, over=where).requirements(hexapod, over, measure)
        if not found:
            raise ArgumentError(f"{hexapod.name!r} has no [limits] to respect. Add them, or leave DesignLimits out.")
        return found
