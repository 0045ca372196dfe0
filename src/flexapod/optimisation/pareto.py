"""Pareto fronts: the designs of which none is better in both the index and another quantity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flexapod.checks import whole
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, InfeasibleError, shown
from flexapod.optimisation.design_results import VariableRange
from flexapod.optimisation.design_search import Settings, history
from flexapod.optimisation.global_search import OnTrial, Stop, Study, Trial
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.objectives import LeastIndex, Objective
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.requirements import Constraint, Requirement
from flexapod.optimisation.variables import JointCircle, Variable
from flexapod.optimisation.verification import Beginning, begin, told, verify
from flexapod.progress import ProgressLike, with_progress
from flexapod.showing import drawn, in_notebooks

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


_INFEASIBLE = 1e12  # of what is made small, where a design has none


@in_notebooks
@dataclass(frozen=True, eq=False)
class ParetoFront:
    """Designs of which none is better in both the index and another quantity, as `flexapod.pareto_front` found them.

    Attributes
    ----------
    designs : tuple of Hexapod
        m designs, from the smallest of `against` to the highest index.
    index : ndarray, shape (m,)
        Their indices as verified, rad/s.
    against : ndarray, shape (m,)
        Their values of the other quantity, SI.
    variables : ndarray, shape (m, n)
        Their variables, in the unit of each one's key, or SI where it has none.
    names : tuple of str
        Names of the variables.
    hexapod : Hexapod
        The design to start from.
    start : tuple of float
        Its index and its value of the other quantity.
    start_breaks : tuple of str
        What the design to start from breaks, in words; empty where it keeps every constraint.
    ranges : dict of str to VariableRange
        Where the variables began and their bounds, by name.
    unmoved : tuple of str
        Names of the constraints, or of the objective, that no variable moves.
    failures : tuple of str
        What went wrong on the way, in words.
    stopped : bool
        Whether `stop` ended the search early.
    name, unit : str
        Name and unit of the other quantity.
    history : xarray.Dataset
        All finished trials.
    """

    designs: tuple[Hexapod, ...]
    index: Array
    against: Array
    variables: Array
    names: tuple[str, ...]
    hexapod: Hexapod
    start: tuple[float, float]
    start_breaks: tuple[str, ...]
    ranges: dict[str, VariableRange]
    unmoved: tuple[str, ...]
    failures: tuple[str, ...]
    stopped: bool
    name: str
    unit: str
    history: xr.Dataset

    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draw the front among all trials: `plots.optimisation.front`."""
        return drawn(self, ax=ax)


@with_progress("Pareto front")
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
    joint: JointModel = "universal",
    samples: int = 2**12,
    seed: int = 0,
    threads: int | None = None,
    progress: ProgressLike = None,
    on_trial: OnTrial | None = None,
    stop: Stop | None = None,
) -> ParetoFront:
    """Search for the highest objective at every value of another quantity.

    Parameters
    ----------
    hexapod : Hexapod
        The design to start from.
    variables : sequence of Variable and JointCircle
        What may change.
    against : Constraint
        The other quantity, which is made small: a constraint with an upper bound, such as `TotalMass` or `Footprint`.
        Its bound, if it is given, is kept as well.
    objective : Objective, optional
        What is raised: `LeastIndex` over a region, `MeanIndex` over poses, or, for comparison, `Dexterity`. The index
        at the home pose by default.
    constraints : sequence of Constraint, optional
        What has to be kept, such as `Footprint` or `Stroke`.
    trials : int, optional
        Number of trials of the genetic search.
    refine : int, optional
        Number of points along the front that are then improved by gradients, each with its own value of `against` as a
        bound.
    study : str or path-like, optional
        An SQLite file that keeps the trials. The search goes on from what is in it, and several processes may work on
        it at once.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.
    samples : int, optional
        Number of poses of a region that a trial looks at.
    seed : int, optional
        Seed of the search.
    threads : int, optional
        Number of threads. All cores by default.
    progress : callable or False, optional
        Called with the share of the trials done, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.
    on_trial : callable, optional
        Called before each trial with the number of trials finished, the number wanted and the best objective so far
        (NaN without one).
    stop : callable, optional
        Called between trials; the search ends early when it returns True.

    Returns
    -------
    ParetoFront
        The designs, verified on poses that the search has not seen.

    Raises
    ------
    ArgumentError
        If bounds contradict each other, no variable moves `against`, or another argument is invalid.
    DesignError
        If `hexapod` is not a Hexapod.
    InfeasibleError
        If no design that keeps every constraint was found, or if the design breaks one that no variable moves.
    OutputError
        If the study file belongs to another design or problem, or cannot be used.

    Notes
    -----
    The genetic algorithm NSGA-II of Deb and others [1]_, then the local search of `flexapod.optimise`.

    References
    ----------
    .. [1] K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, A fast and elitist multiobjective genetic algorithm: NSGA-II,
       IEEE Transactions on Evolutionary Computation 6 (2002).

    Examples
    --------
    >>> hexapod = fx.load("precision-positioner")
    >>> mass = fx.Variable("platform.mass", 20, 40)
    >>> front = fx.pareto_front(hexapod, mass, fx.optimisation.TotalMass(50.0), trials=6, refine=0, samples=8)
    >>> bool(front.against.max() <= 50.0)
    True
    """
    whole(trials, "trials")
    whole(refine, "refine", 0)
    settings = Settings(whole(samples, "samples"), whole(seed, "seed", 0), stop)
    aim = LeastIndex() if objective is None else objective
    if not isinstance(against, Constraint) or not hasattr(against, "most"):
        raise ArgumentError(
            f"against is {shown(against)}; it must be a constraint with an upper bound, as TotalMass()."
        )
    problem = Problem(hexapod, variables, aim, [*constraints, against], joint, threads)
    traded = problem.requirements[-1]
    if against.most is None:
        problem.requirements[-1] = replace(traded, bound=np.array(np.inf))
    search = Study(
        problem,
        study,
        aim=f"index against {traded.name}",
        directions=("maximize", "minimize"),
        seed=seed,
        sampler="nsga2",
        samples=samples,
    )
    last = len(problem.requirements) - 1
    begun = begin(problem, 4 * settings.samples, always=[last])
    if traded.name in begun.unmoved:
        raise ArgumentError(f"no variable moves the {traded.name}, so that nothing can be traded for it. Vary another.")
    search.run(trials, lambda x: _both(problem, x, settings), progress or None, on_trial, stop)
    found = search.finished()
    feasible = [t for t in found if t.feasible]
    front = _nondominated([t.values for t in feasible])
    if not front:
        raise InfeasibleError(
            f"none of {len(found)} trials keeps every constraint. Loosen a bound, or allow more trials."
        )
    failures = list(begun.failures)
    points = _refined(problem, [feasible[i] for i in front], refine, settings, failures)
    return _front(problem, begun, points, history(problem, found), settings, failures)


@dataclass(frozen=True)
class _Point:
    """A candidate for the front, verified: its index, and its value of the other quantity."""

    x: Array
    design: Hexapod
    index: float
    against: float


def _both(problem: Problem, x: Array, settings: Settings) -> tuple[Assessment, tuple[float, ...]]:
    found = problem.assess_at(x, settings.samples, settings.seed)
    value = found.values[-1] if np.isfinite(found.values[-1]) else _INFEASIBLE
    return found, (found.index, float(value))


def _nondominated(values: Sequence[tuple[float, ...]]) -> list[int]:
    """Numbers of the pairs (high, low) that no other beats, from the lowest second value."""
    order = sorted(range(len(values)), key=lambda i: (values[i][1], -values[i][0]))
    kept: list[int] = []
    for i in order:
        if not kept or values[i][0] > values[kept[-1]][0]:
            kept.append(i)
    return kept


def _refined(
    problem: Problem, front: Sequence[Trial], count: int, settings: Settings, failures: list[str]
) -> list[Array]:
    """Variables of the front's designs, and of `count` improved ones whose bounds are evenly spread along it."""
    xs = [t.x for t in front]
    if count < 1:
        return xs
    traded: Requirement = problem.requirements[-1]
    values = np.array([t.values[1] for t in front])
    levels = np.unique(np.linspace(values[0], values[-1], count))
    for level in levels:
        first = front[int(np.flatnonzero(values <= level)[-1])].x
        problem.requirements[-1] = replace(traded, bound=np.array(float(level)))
        try:
            xs.append(finish(problem, first, settings.samples, settings.seed, settings.stop).x)
        except Exception as error:  # the trials and the other points are not lost with it
            failures.append(f"A local search ended early: {told(error)}.")
    problem.requirements[-1] = traded
    return xs


def _judged(
    problem: Problem, begun: Beginning, xs: Sequence[Array], settings: Settings, failures: list[str]
) -> list[_Point]:
    """Every candidate that keeps the constraints on poses that the search has not seen; the start is one of them."""
    start, seen = problem.hexapod, begun.verified
    found = [_Point(problem.map.own(), start, seen.index, seen.checks[-1].value)] if begun.keeps else []
    for x in xs:
        try:
            design = problem.map.hexapod_at(x)
            seen = verify(problem, design, 4 * settings.samples)
        except Exception as error:
            failures.append(f"A design of the front could not be verified: {told(error)}.")
            continue
        if seen.holds:
            found.append(_Point(x, design, seen.index, seen.checks[-1].value))
    if not found:
        raise InfeasibleError(
            f"none of {len(xs)} designs on the front keeps every constraint on poses that the search has not seen. "
            "Search with more poses (samples)."
        )
    return [found[i] for i in _nondominated([(one.index, one.against) for one in found])]


def _front(
    problem: Problem,
    begun: Beginning,
    xs: Sequence[Array],
    trials: xr.Dataset,
    settings: Settings,
    failures: list[str],
) -> ParetoFront:
    start, last = problem.hexapod, problem.requirements[-1]
    kept = _judged(problem, begun, xs, settings, failures)
    return ParetoFront(
        designs=tuple(one.design.replace({"name": f"{start.name}-{i + 1}"}) for i, one in enumerate(kept)),
        index=np.array([one.index for one in kept]),
        against=np.array([one.against for one in kept]),
        variables=np.array([list(problem.map.values(one.x).values()) for one in kept]),
        names=tuple(problem.map.names),
        hexapod=start,
        start=(begun.verified.index, begun.verified.checks[-1].value),
        start_breaks=begun.breaks,
        ranges=begun.ranges,
        unmoved=begun.unmoved,
        failures=tuple(failures),
        stopped=settings.stopped,
        name=last.name,
        unit=last.quantity.unit,
        history=trials,
    )
