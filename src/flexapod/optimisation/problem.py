"""A design problem: variables, objective and constraints, and what a given design makes of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexapod.checks import thread_count
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME, numbers
from flexapod.errors import ArgumentError, DesignError, PoseError, shown
from flexapod.mechanics.inputs import as_hexapod, as_joint
from flexapod.optimisation.constraint_quantities import ConstraintQuantity, Side
from flexapod.optimisation.design_map import DesignMap
from flexapod.optimisation.design_results import Check
from flexapod.optimisation.objectives import Objective
from flexapod.optimisation.requirements import Constraint, Requirement
from flexapod.optimisation.variables import JointCircle, Variable
from flexapod.workspace.box import Box
from flexapod.workspace.box_minimum import quick_minimum
from flexapod.workspace.quantities import evaluate, index_and_gradient
from flexapod.workspace.region import Region

NO_INDEX = "the index is zero: a pose is singular, or out of the legs' reach"
FEASIBLE = 1e-6  # relative amount by which a bound may be passed, for rounding of the search that ends on it
_AGREED = 10 * FEASIBLE  # the same in a verification, which is another sweep
_NO_MARGIN = -1e3  # where a quantity has no value
_STARTS = 16  # of a descent
_MEASURED = 2**14  # poses swept for bounds that are what the design has itself


@dataclass(frozen=True)
class Assessment:
    """What a design makes of a problem. index rad/s (0 where none can be computed); margins: the least one of each
    requirement, relative, >= 0 where it is kept; values, bounds: its extreme value there, and the bound of that one."""

    index: float
    margins: Array
    values: Array
    bounds: Array

    @property
    def feasible(self) -> bool:
        return bool((self.margins >= -FEASIBLE).all()) and self.index > 0

    @property
    def violation(self) -> float:
        return float(-np.minimum(self.margins, 0).sum())

    def better_than(self, other: Assessment | None) -> bool:
        """Feasible designs before others, those by index; others by how far they are from it."""
        if other is None or self.feasible != other.feasible:
            return other is None or self.feasible
        return self.index > other.index if self.feasible else self.violation < other.violation


class Problem:
    """`hexapod`'s variables, the objective to raise and the requirements to keep."""

    def __init__(
        self,
        hexapod: Hexapod,
        variables: Sequence[Variable | JointCircle],
        objective: Objective,
        constraints: Sequence[Constraint],
        joint: JointModel,
        threads: int | None,
    ) -> None:
        self.hexapod, self.objective, self.joint = as_hexapod(hexapod), objective, joint
        self.core_joint, self.threads = as_joint(joint), thread_count(threads)
        self.map = DesignMap(hexapod, variables)
        constraints = [constraints] if isinstance(constraints, Constraint) else list(constraints)
        wrong = [c for c in constraints if not isinstance(c, Constraint)]
        if wrong:
            raise ArgumentError(f"constraints holds {shown(wrong[0])}, which is no constraint of flexapod.")
        if isinstance(objective, type) or not hasattr(objective, "region"):
            raise ArgumentError(f"objective is {shown(objective)}; give a LeastIndex, a MeanIndex or a Dexterity.")
        self._check_home([objective.region])
        self.requirements: list[Requirement] = []
        for constraint in constraints:
            self.requirements += constraint.requirements(hexapod, objective.region, self._measure)
        self.held: dict[int, Check] = {}  # requirements that no variable moves, by their numbers among all, as checked
        self._check_home([r.region for r in self.requirements if r.region is not None])
        self._check_bounds()

    def _check_home(self, regions: Sequence[Region]) -> None:
        if self.hexapod.home is None and any(region.from_home for region in regions):
            raise ArgumentError(
                f"the objective or a constraint is measured at home, but {self.hexapod.name!r} names no home pose. "
                "Give a box, a pose, or a home: home.position of the design, on the command line --set."
            )

    def _check_bounds(self) -> None:
        """Two requirements that no design can keep together are refused with both named."""
        for low in self.requirements:
            for high in self.requirements:
                same = low.quantity.describe() == high.quantity.describe()
                if low.side == "least" and high.side == "most" and same and np.any(low.bound > high.bound):
                    unit = low.quantity.unit
                    raise ArgumentError(
                        f"{low.name} must be at least {low.bound.max():.6g} {unit} and {high.name} at most "
                        f"{high.bound.min():.6g} {unit}: no design can keep both."
                    )

    def _measure(self, quantity: ConstraintQuantity, side: Side, region: Region | None) -> Array:
        own = numbers(self.hexapod)
        found: dict[str, Any] = {}
        if region is not None:
            self._check_home([region])
            rows = region.rows(own[HOME], _MEASURED)
            found = evaluate(self.hexapod, rows, quantity.quantities, self.joint, self.threads)
        return quantity.measure(found, own, side)

    def groups(self) -> list[tuple[Region, list[Requirement]]]:
        """Regions with the requirements that hold there; that of the objective comes first."""
        found: dict[str, tuple[Region, list[Requirement]]] = {}
        found[json.dumps(self.objective.region.describe())] = (self.objective.region, [])
        for requirement in self.requirements:
            if requirement.region is not None:
                name = json.dumps(requirement.region.describe())
                found.setdefault(name, (requirement.region, []))[1].append(requirement)
        return list(found.values())

    def sweep(self, hexapod: Hexapod, group: int, samples: int, seed: int) -> tuple[Array, dict[str, Any]]:
        """Poses of one of the `groups`, and every quantity that objective and requirements need there."""
        region, requirements = self.groups()[group]
        wanted = {name for requirement in requirements for name in requirement.quantity.quantities}
        wanted |= {self.objective.quantity} if group == 0 else set()
        rows = region.rows(numbers(hexapod)[HOME], samples, seed)
        return rows, evaluate(hexapod, rows, tuple(sorted(wanted)), self.joint, self.threads)

    def box(self, hexapod: Hexapod) -> Box | None:
        """The box over which the least frequency is to be found between the poses of a sweep; None where none is."""
        return self.objective.region.box(numbers(hexapod)[HOME]) if self.objective.quantity == "omega_1" else None

    def assess(self, hexapod: Hexapod, samples: int, seed: int = 0) -> Assessment:
        """Sweeps `samples` poses of every workspace, and descends from the lowest ones."""
        own = numbers(hexapod)
        values = {id(r): r.quantity.measure({}, own, r.side) for r in self.requirements if r.region is None}
        index = 0.0
        for group, (_, requirements) in enumerate(self.groups()):
            rows, found = self.sweep(hexapod, group, samples, seed)
            if group == 0:
                index = self.objective.index(found[self.objective.quantity])
                box = self.box(hexapod)
                if box is not None and index > 0:
                    starts = rows[np.argsort(found["omega_1"])[:_STARTS]]
                    least = quick_minimum(index_and_gradient(hexapod, self.joint), starts, box.low, box.high)
                    index = min(index, least)
            values |= {id(r): r.quantity.measure(found, own, r.side) for r in requirements}
        made = []
        for r in self.requirements:
            value = values[id(r)]
            margin = np.nan_to_num(r.margins(value), nan=_NO_MARGIN, posinf=-_NO_MARGIN, neginf=_NO_MARGIN)
            worst = int(np.argmin(margin))
            made.append((margin[worst], value[worst], np.broadcast_to(r.bound, value.shape)[worst]))
        return Assessment(index, *np.array(made).reshape(-1, 3).T)

    def assess_at(self, x: Array, samples: int, seed: int = 0) -> Assessment:
        """The same for values of the variables; those that make no hexapod have no index and keep nothing."""
        try:
            return self.assess(self.map.hexapod_at(x), samples, seed)
        except (DesignError, PoseError, ArithmeticError, np.linalg.LinAlgError):
            return self.nothing()  # of this design: the arguments were checked when the problem was made

    def nothing(self) -> Assessment:
        """What is made of a design of which nothing can be computed."""
        none = np.full(len(self.requirements), np.nan)
        return Assessment(0.0, np.full(len(self.requirements), _NO_MARGIN), none, none)

    def checks(self, found: Assessment) -> tuple[Check, ...]:
        """Every requirement as it was assessed, those that no variable moves among them."""
        made = []
        for r, value, bound, margin in zip(self.requirements, found.values, found.bounds, found.margins, strict=True):
            kept = bool(margin >= -_AGREED)
            made.append(Check(r.name, r.quantity.unit, r.side, float(value), float(bound), float(margin), kept))
        left = iter(made)
        return tuple(self.held.get(k) or next(left) for k in range(len(made) + len(self.held)))

    def hold(self, numbers: Sequence[int], checks: Sequence[Check]) -> None:
        """Takes requirements that no variable moves out of the search; `checks` has what the start makes of all."""
        self.held = {k: checks[k] for k in numbers}
        self.requirements = [r for k, r in enumerate(self.requirements) if k not in self.held]

    def violations(self, assessment: Assessment) -> str:
        """In words: every requirement that is not kept, with its value and its bound."""
        words = [check.words for check in self.checks(assessment) if check.margin < -FEASIBLE]
        return "; ".join(words or [NO_INDEX])

    def describe(self) -> dict[str, Any]:
        """Everything that makes this problem and no other."""
        return {
            "design": f"{self.hexapod.name!r} (digest {self.hexapod.digest})",
            "variables": self.map.describe(),
            "objective": self.objective.describe(),
            "constraints": [r.describe() for r in self.requirements],
            "joint": self.joint,
        }
