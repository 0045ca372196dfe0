"""Constraints of a design search. A bound that is left out is what the design to start from has itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import ClassVar, Literal, get_args

import numpy as np

from flexapod.checks import one_of, positive
from flexapod.design.hexapod import Hexapod
from flexapod.design.parts import Limits
from flexapod.errors import ArgumentError
from flexapod.optimisation import constraint_quantities as quantities
from flexapod.optimisation.constraint_quantities import ConstraintQuantity, Side
from flexapod.optimisation.requirements import Constraint, Measure, OneBound, Requirement, own_region, requirement
from flexapod.showing import in_notebooks
from flexapod.workspace.region import Region, RegionLike

Plate = Literal["base", "platform"]


@in_notebooks
@dataclass(frozen=True)
class Footprint(Constraint):
    """Keep the joints of a plate within a circle about the middle of the circle that encloses them now.

    Parameters
    ----------
    most : float, optional
        Largest radius, m.
    plate : {"base", "platform"}, optional
        The plate.

    Examples
    --------
    >>> hexapod = fx.load("mukherjee-ii")
    >>> base = fx.optimisation.JointCircle("base", radius=(0.02, 0.03))
    >>> found = fx.optimise(hexapod, base, constraints=[fx.optimisation.Footprint()], trials=0)
    >>> found.verification.holds
    True
    """

    most: float | None = None
    plate: Plate = "base"

    def requirements(self, hexapod: Hexapod, region: Region, measure: Measure) -> list[Requirement]:
        """List what a design has to keep; see `Constraint.requirements`."""
        one_of(self.plate, "footprint: the plate", get_args(Plate))
        joints = hexapod.base_joints if self.plate == "base" else hexapod.platform_joints
        (x, y), _ = quantities.enclosing_circle(joints[:, :2])
        quantity = quantities.Radius(self.plate, float(x), float(y))
        return [requirement(f"footprint of the {self.plate}", quantity, "most", self.most, None, measure)]


@in_notebooks
@dataclass(frozen=True)
class TotalMass(OneBound):
    """Bound the mass of the platform with its payload and all legs.

    Parameters
    ----------
    most : float, optional
        Largest mass, kg.
    """

    most: float | None = None

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        return "total mass", quantities.Mass()


@in_notebooks
@dataclass(frozen=True)
class Stroke(OneBound):
    """Bound the difference of the longest and the shortest length of each leg.

    Parameters
    ----------
    most : float, optional
        Largest difference, m.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    most: float | None = None
    region: RegionLike = field(default=None, kw_only=True)

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        return "leg stroke", quantities.LegStroke()


@in_notebooks
@dataclass(frozen=True)
class LegLength(Constraint):
    """Bound the length of every leg.

    Parameters
    ----------
    least, most : float, optional
        Shortest and longest length, m. If both are left out, both are what the design to start from has.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    least: float | None = None
    most: float | None = None
    region: RegionLike = field(default=None, kw_only=True)

    def requirements(self, hexapod: Hexapod, region: Region, measure: Measure) -> list[Requirement]:
        """List what a design has to keep; see `Constraint.requirements`."""
        for side, bound in (("lower", self.least), ("upper", self.most)):
            if bound is not None:
                positive(bound, f"leg length: the {side} bound", "m")
        if self.least is not None and self.most is not None and not self.least < self.most:
            raise ArgumentError(
                f"leg length: the bounds are {self.least:.6g} and {self.most:.6g} m, which contradict each other; the "
                "lower bound must be < the upper one."
            )
        where, quantity = own_region(self, region), quantities.LegLengths()
        both = self.least is None and self.most is None
        found = []
        if self.least is not None or both:
            found.append(requirement("shortest leg", quantity, "least", self.least, where, measure))
        if self.most is not None or both:
            found.append(requirement("longest leg", quantity, "most", self.most, where, measure))
        return found


@in_notebooks
@dataclass(frozen=True)
class JointAngle(OneBound):
    """Bound the angle by which every joint of one kind turns from where it is at home.

    Parameters
    ----------
    joint : {"universal", "spherical"}
        The kind of joint.
    most : float, optional
        Largest angle, rad.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    joint: Literal["universal", "spherical"]
    most: float | None = None
    region: RegionLike = field(default=None, kw_only=True)

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        one_of(self.joint, "joint angle: the joint", ("universal", "spherical"))
        return f"{self.joint} joint angle", quantities.JointAngles(self.joint)


@in_notebooks
@dataclass(frozen=True)
class LegClearance(OneBound):
    """Bound the distance of the axes of any two legs.

    Parameters
    ----------
    least : float, optional
        Smallest distance, m.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    least: float | None = None
    region: RegionLike = field(default=None, kw_only=True)
    side: ClassVar[Side] = "least"

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        return "leg clearance", quantities.LegDistance()


@in_notebooks
@dataclass(frozen=True)
class ConditionNumber(OneBound):
    """Bound the condition number of the force transformation, with lengths in m.

    Parameters
    ----------
    most : float, optional
        Largest condition number, > 1.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    most: float | None = None
    region: RegionLike = field(default=None, kw_only=True)

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        if self.most is not None and positive(self.most, "condition number: the bound") <= 1:
            raise ArgumentError(f"condition number: the bound is {self.most}; no H has less than 1.")
        return "condition number", quantities.Conditioning()


@in_notebooks
@dataclass(frozen=True)
class Deflection(OneBound):
    """Bound the displacement of the platform under a static force in any direction.

    The displacement follows from the stiffness H K H^T of the legs at the reference point, without a moment.

    Parameters
    ----------
    most : float, optional
        Largest displacement, m.
    force : float, optional
        The force, N; the weight of the platform by default.
    region : region_like, optional
        Where it holds; the region of the objective by default.
    """

    most: float | None = None
    force: float | None = None
    region: RegionLike = field(default=None, kw_only=True)

    def quantity(self, hexapod: Hexapod) -> tuple[str, ConstraintQuantity]:
        """Return the name and the quantity that is bounded."""
        if self.force is not None:
            positive(self.force, "static deflection: the force", "N")
        elif not hexapod.gravity.any():
            raise ArgumentError("static deflection: without gravity the platform has no weight. Give a force in N.")
        return "static deflection", quantities.StaticDeflection(self.force)


@in_notebooks
@dataclass(frozen=True)
class DesignLimits(Constraint):
    """Keep the limits of the design itself: lengths, clearance and forces of legs, angles and moments of joints.

    Forces are those of rest under the machine's weight. Limits of leg rate, acceleration and power are of a motion,
    which poses do not have: they are not kept.

    Parameters
    ----------
    region : region_like, optional
        Where they hold; the region of the objective by default.
    """

    region: RegionLike = field(default=None, kw_only=True)

    def requirements(self, hexapod: Hexapod, region: Region, measure: Measure) -> list[Requirement]:
        """List what a design has to keep; see `Constraint.requirements`."""
        limits, where = hexapod.limits, own_region(self, region)
        found: list[Requirement] = []
        if limits.leg_length is not None:
            pairs = np.reshape(limits.leg_length, (-1, 2))
            low, high = (np.asarray(bound) for bound in (pairs[0] if len(pairs) == 1 else pairs.T))
            if np.all(low > 0):
                found.append(Requirement("shortest leg", quantities.LegLengths(), "least", low, where))
            found.append(Requirement("longest leg", quantities.LegLengths(), "most", high, where))
        for joint in ("universal", "spherical"):
            most = getattr(limits, f"{joint}_angle")
            if most is not None:
                found += JointAngle(joint, most, region=where).requirements(hexapod, region, measure)
        if limits.leg_distance:
            found += LegClearance(limits.leg_distance, region=where).requirements(hexapod, region, measure)
        found += [*_moment_limits(limits, where), *_force_limits(limits, where)]
        if not found:
            motions = f" of poses (those of {', '.join(limits.of_motions)} are of motions)" * bool(limits.of_motions)
            raise ArgumentError(
                f"{hexapod.name!r} has no [limits]{motions} to respect. Add them, or leave DesignLimits out."
            )
        return found


def _moment_limits(limits: Limits, where: Region) -> Iterator[Requirement]:
    for joint in ("universal", "spherical"):
        most = getattr(limits, f"{joint}_moment")
        if most is not None:
            quantity = quantities.JointMoments(joint)
            yield Requirement(f"moment of {joint} joints", quantity, "most", np.array(most), where)


def _force_limits(limits: Limits, where: Region) -> Iterator[Requirement]:
    for sense in ("compression", "tension"):
        most = getattr(limits, f"leg_{sense}")
        if most == 0:
            raise ArgumentError(
                f"limits.leg_{sense} is 0 N; a search takes margins as parts of the limit, which must be > 0 for it. "
                "Give a small force in its place."
            )
        if most is not None:
            quantity = quantities.LegForces(sense)
            yield Requirement(f"{sense} of legs at rest", quantity, "most", np.array(most), where)
