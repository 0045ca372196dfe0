"""Index against another wish: the designs of which none is better in both (a Pareto front)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, InfeasibleError
from flexapod.optimisation.constraints import Constraint, Requirement
from flexapod.optimisation.design_search import Settings, history, verify
from flexapod.optimisation.global_search import Study, Trial
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.objectives import LeastIndex, Objective
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.variables import JointCircle, Variable

if TYPE_CHECKING:
    import xarray as xr


_HOPELESS = 1e12  # of what is made small, where a design has none


@dataclass(frozen=True, eq=False)
class ParetoFront:
    """Designs from the least of `against` to the highest index.

    designs: m hexapods. index: (m,) rad/s, verified. against: (m,), SI. variables: (m, n), in the unit of each one's
    key, SI where it has none; names: of the variables. hexapod: the design one began with; start: its (index, against).
    name, unit: of `against`. history: Dataset of all finished trials.

    Source: conclusion 1.
    """

    designs: tuple[Hexapod, ...]
    index: Array
    against: Array
    variables: Array
    names: tuple[str, ...]
    hexapod: Hexapod
    start: tuple[float, float]
    name: str
    unit: str
    history: xr.Dataset


def pareto_front(
    hexapod: Hexapod,
    variables: Sequence[Variable | JointCircle],
    against: Constraint,
    objective: Objective | None = None,
    constraints: Sequence[Constraint] = (),
    *,
    trials: int = 300,
    refine: int = 12,
    study: str | Path | None = None,
    **options: Any,
) -> ParetoFront:
    """The highest index (rad/s) for every value of `against`: `TotalMass()`, `Footprint()`, and the like.

    What `against` measures is made small (its bound, if it has one, is kept as well). trials: of a genetic search
    (NSGA-II) that may be stopped, resumed and shared as that of `optimise`. refine: so many points along its front are
    then improved by gradients, each with its own value of `against` as a bound. variables, objective, constraints,
    study and options: as for `optimise`.

    Raises: ArgumentError, InfeasibleError and OutputError as `optimise`.
    Source: conclusion 1; NSGA-II after K. Deb and others (2002).
    """
    settings = Settings(**options)
    aim = LeastIndex() if objective is None else objective
    if not isinstance(against, Constraint) or not hasattr(against, "most"):
        raise ArgumentError(f"against is {against!r}; it must be a constraint with an upper bound, as TotalMass().")
    problem = Problem(hexapod, variables, aim, [*constraints, against], settings.joint, settings.threads)
    traded = problem.requirements[-1]
    if against.most is None:
        problem.requirements[-1] = replace(traded, bound=np.array(np.inf))
    search = Study(
        problem,
        study,
        aim=f"index against {traded.name}",
        directions=("maximize", "minimize"),
        seed=settings.seed,
        sampler="nsga2",
        points=settings.points,
    )
    search.run(trials, lambda x: _both(problem, x, settings), settings.progress, settings.stop)
    found = search.finished()
    feasible = [t for t in found if t.feasible]
    front = _nondominated([t.values for t in feasible])
    if not front:
        raise InfeasibleError(
            f"none of {len(found)} trials keeps every constraint. Loosen a bound, or allow more trials."
        )
    points = _refined(problem, [feasible[i] for i in front], refine, settings)
    return _front(problem, points, history(problem, found), settings)


def _both(problem: Problem, x: Array, settings: Settings) -> tuple[Assessment, tuple[float, ...]]:
    found = problem.assess_at(x, settings.points, settings.seed)
    value = found.values[-1] if np.isfinite(found.values[-1]) else _HOPELESS
    return found, (found.index, float(value))


def _nondominated(values: Sequence[tuple[float, ...]]) -> list[int]:
    """Numbers of the pairs (high, low) that no other beats, from the lowest second value."""
    order = sorted(range(len(values)), key=lambda i: (values[i][1], -values[i][0]))
    kept: list[int] = []
    for i in order:
        if not kept or values[i][0] > values[kept[-1]][0]:
            kept.append(i)
    return kept


def _refined(problem: Problem, front: Sequence[Trial], count: int, settings: Settings) -> list[Array]:
    """Variables of the front's designs, and of `count` improved ones whose bounds are evenly spread along it."""
    xs = [t.x for t in front]
    if count < 1:
        return xs
    traded: Requirement = problem.requirements[-1]
    values = np.array([t.values[1] for t in front])
    levels = np.unique(np.linspace(values[0], values[-1], count))
    for level in levels:
        begin = front[int(np.flatnonzero(values <= level)[-1])].x
        problem.requirements[-1] = replace(traded, bound=np.array(float(level)))
        xs.append(finish(problem, begin, settings.points, settings.seed, settings.stop).x)
    problem.requirements[-1] = traded
    return xs


def _front(problem: Problem, xs: Sequence[Array], trials: xr.Dataset, settings: Settings) -> ParetoFront:
    """Every candidate judged anew, on poses that the search has not seen, and those kept that none beats."""
    start, judged = problem.hexapod, []
    for x in xs:
        design = problem.map.hexapod_at(x)
        seen = verify(problem, design, 4 * settings.points)
        if seen.holds:
            judged.append((x, design, seen.index, seen.checks[-1].value))
    if not judged:
        raise InfeasibleError(
            f"none of {len(xs)} designs on the front keeps every constraint on poses that the search has not seen. "
            "Search with more poses (points)."
        )
    kept = [judged[i] for i in _nondominated([(index, value) for _, _, index, value in judged])]
    begun = verify(problem, start, 4 * settings.points)
    last = problem.requirements[-1]
    return ParetoFront(
        designs=tuple(d.replace({"name": f"{start.name}-{i + 1}"}) for i, (_, d, _, _) in enumerate(kept)),
        index=np.array([index for _, _, index, _ in kept]),
        against=np.array([value for _, _, _, value in kept]),
        variables=np.array([list(problem.map.values(x).values()) for x, _, _, _ in kept]),
        names=tuple(problem.map.names),
        hexapod=start,
        start=(begun.index, begun.checks[-1].value),
        name=last.name,
        unit=last.kind.unit,
        history=trials,
    )
