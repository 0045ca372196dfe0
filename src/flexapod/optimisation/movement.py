"""What the variables of a search move at all, by slopes and values at several designs, not at the start alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from flexapod.conventions import Array
from flexapod.design.layout import numbers
from flexapod.errors import DesignError, PoseError
from flexapod.optimisation.constraint_quantities import Values
from flexapod.optimisation.derivatives import DesignDerivatives
from flexapod.optimisation.problem import Problem
from flexapod.workspace.sobol import Sobol

_DESIGNS = 8  # spread over the ranges of the variables, besides the start
_POSES = 64  # swept for each
_MOVES = 1e-9  # of the largest value, over the whole range of the variables
_SHARPNESS = 40.0  # of the smooth least frequency


def unmoved(problem: Problem) -> tuple[list[int], bool]:
    """Numbers of the requirements that no variable moves, and whether none moves the objective.

    What cannot be computed is taken to move.
    """
    n = len(problem.map.parameters)
    points = np.vstack([problem.map.unit(problem.map.from_values({})), Sobol(n, 0).points(0, _DESIGNS)])
    still: dict[int, Array | None] = dict.fromkeys(range(-1, len(problem.requirements)))  # -1: the objective
    for u in points:
        try:
            at_design = _Design(problem, u)
        except (DesignError, PoseError):
            continue
        for k, before in list(still.items()):
            value, slope = at_design.quantity(k)
            same = before is None or (value.shape == before.shape and bool(np.allclose(value, before, 1e-9, 1e-9)))
            if not (same and np.isfinite(value).all() and (np.abs(slope).sum(axis=1) < _MOVES).all()):
                del still[k]
            else:
                still[k] = value
        if not still:
            break
    seen = [k for k, value in still.items() if value is not None]
    return [k for k in seen if k >= 0], -1 in seen


class _Design:
    """One design of a search, with what objective and requirements make of it at a few poses."""

    def __init__(self, problem: Problem, u: Array) -> None:
        x, by_u = problem.map.from_unit(u)
        hexapod = problem.map.hexapod_at(x)
        self.problem, self.numbers = problem, numbers(hexapod)
        self.jacobian = problem.map.jacobian(x) * by_u
        self.swept = [problem.sweep(hexapod, group, _POSES, 0) for group in range(len(problem.groups()))]

    def quantity(self, k: int) -> tuple[Array, Array]:
        """Values and slopes of requirement k, or of the objective where k is -1, at the poses that decide it."""
        if k < 0:
            aim = self.problem.objective
            rows, found = self.swept[0]
            chosen = aim.worst_poses(np.nan_to_num(found[aim.quantity]))
            return self._at(rows[chosen], aim.region.from_home, lambda at: aim.derivatives(at, _SHARPNESS))
        r = self.problem.requirements[k]
        if r.region is None:
            return self._at(np.zeros((0, 6)), False, lambda at: _scaled(r.quantity.derivatives(at)))
        group = next(g for g, (_, those) in enumerate(self.problem.groups()) if any(one is r for one in those))
        rows, found = self.swept[group]
        chosen = rows[r.quantity.worst_poses(found, self.numbers, r.side)]
        return self._at(chosen, r.region.from_home, lambda at: _scaled(r.quantity.derivatives(at)))

    def _at(
        self, rows: Array, from_home: bool, derivatives: Callable[[DesignDerivatives], tuple[Array, Array]]
    ) -> tuple[Array, Array]:
        at = DesignDerivatives(self.numbers, self.jacobian, rows, from_home, self.problem.core_joint)
        try:
            return derivatives(at)
        except (ArithmeticError, np.linalg.LinAlgError):
            return np.full(1, np.nan), np.zeros((1, self.jacobian.shape[1]))


def _scaled(found: Values) -> tuple[Array, Array]:
    size = np.abs(found.value).max(initial=0.0) or 1.0
    return found.value / size, found.slope / size
