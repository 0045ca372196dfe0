"""A sampling planner: a polyline of feasible points between two, in a box (OMPL's BIT*)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from flexapod.conventions import Array
from flexapod.optional import needed

BATCHES, BATCH = 40, 120
_PARTS = ("base", "geometric", "util")
_AFTER_FOUND = 6  # batches spent on shorter ways once there is one


class Search(NamedTuple):
    """points: (n, k), from start to goal, or None where none was found; batches of samples drawn."""

    points: Array | None
    batches: int


def search(
    met: Callable[[Array], np.ndarray],
    ends: Array,
    low: Array,
    high: Array,
    *,
    step: float,
    seed: int = 0,
    progress: Callable[[float], object] | None = None,
) -> Search:
    """A short polyline from ends[0] to ends[1] within [low, high] whose every point meets met((n, k)) -> (n,) bool.

    Lines are checked at points `step` apart. The same seed gives the same line. Raises MissingExtraError without OMPL.
    """
    base, geometric, util = (needed(f"ompl.{part}", "plan", "planning a path needs OMPL") for part in _PARTS)
    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed + 1)
    space = _space(base, low, high)
    information = base.SpaceInformation(space)
    information.setStateValidityChecker(lambda state: bool(met(_point(state, low.size)[None])[0]))
    lines = _line_checker(base, information, met, low.size, step)
    information.setMotionValidator(lines)
    information.setup()
    problem = base.ProblemDefinition(information)
    problem.setStartAndGoalStates(*(_state(space, end) for end in ends))
    problem.setOptimizationObjective(base.PathLengthOptimizationObjective(information))
    planner = geometric.BITstar(information)
    planner.setSamplesPerBatch(BATCH)
    planner.setProblemDefinition(problem)
    planner.setup()
    found_at: list[int] = []

    def done() -> bool:
        batches = planner.numBatches()
        if progress is not None:
            progress(batches / BATCHES)
        if not found_at and np.isfinite(planner.bestCost().value()):
            found_at.append(batches)
        return batches >= BATCHES or (bool(found_at) and batches >= found_at[0] + _AFTER_FOUND)

    planner.solve(base.PlannerTerminationCondition(done))
    points = None
    if problem.hasExactSolution():
        points = np.array([_point(state, low.size) for state in problem.getSolutionPath().getStates()])
    return Search(points, int(planner.numBatches()))


def _space(base: Any, low: Array, high: Array) -> Any:
    space = base.RealVectorStateSpace(low.size)
    bounds = base.RealVectorBounds(low.size)
    for i in range(low.size):
        bounds.setLow(i, float(low[i]))
        bounds.setHigh(i, float(high[i]))
    space.setBounds(bounds)
    return space


def _state(space: Any, point: Array) -> Any:
    state = space.allocState()
    for i, value in enumerate(point):
        state[i] = float(value)
    return state


def _point(state: Any, size: int) -> Array:
    return np.array([state[i] for i in range(size)])


def _line_checker(base: Any, information: Any, met: Callable[[Array], np.ndarray], size: int, step: float) -> Any:
    class Lines(base.MotionValidator):
        """Checks all points of a line in one call, the ends and the middle first."""

        def checkMotion(self, first: Any, second: Any, *_: Any) -> bool:
            a, b = _point(first, size), _point(second, size)
            count = max(2, int(np.ceil(np.linalg.norm(b - a) / step)) + 1)
            shares = np.linspace(0.0, 1.0, count)[:, None]
            coarse = shares[:: max(1, count // 6)]
            return bool(met(a + (b - a) * coarse).all() and met(a + (b - a) * shares).all())

    return Lines(information)
