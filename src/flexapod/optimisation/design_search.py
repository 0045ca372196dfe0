"""Search for the design with the highest objective: trials, a local search by gradients, and a verification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flexapod.checks import one_of, whole
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.origin import origin
from flexapod.errors import ArgumentError, InfeasibleError
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.global_search import OnTrial, Stop, Study, Trial
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.objectives import LeastIndex, Objective
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.proved_design import certified, check_provable
from flexapod.optimisation.requirements import Constraint
from flexapod.optimisation.variables import JointCircle, Variable
from flexapod.optimisation.verification import Beginning, begin, told, verified
from flexapod.pose import Pose
from flexapod.progress import ProgressLike, with_progress

if TYPE_CHECKING:
    import xarray as xr

_FINISHED_FROM = 3  # best trials that are finished by gradients
_AGREE = 1e-3  # relative amount by which the dense sweep may lie below what the finish reported
_DENSE = 77_003  # added to the seed of a denser sweep
_SAME = 1e-9  # relative difference of indices that is rounding


@dataclass(frozen=True)
class Settings:
    """How a search is made: see `optimise` and `pareto_front`."""

    samples: int
    seed: int
    stop: Stop | None
    verify: int = 0

    @property
    def stopped(self) -> bool:
        return self.stop is not None and self.stop()


@with_progress("search")
def optimise(
    hexapod: Hexapod,
    variables: Sequence[Variable | JointCircle],
    objective: Objective | None = None,
    constraints: Sequence[Constraint] = (),
    *,
    trials: int = 200,
    start: Mapping[str, float] | None = None,
    study: str | Path | None = None,
    sampler: Literal["tpe", "sobol"] = "tpe",
    joint: JointModel = "universal",
    samples: int = 2**12,
    verify: int = 2**17,
    certify: bool = False,
    seed: int = 0,
    threads: int | None = None,
    progress: ProgressLike = None,
    on_trial: OnTrial | None = None,
    stop: Stop | None = None,
) -> OptimalDesign:
    """Search for the design with the highest objective within bounds and constraints.

    Parameters
    ----------
    hexapod : Hexapod
        The design to start from.
    variables : sequence of Variable and JointCircle
        What may change.
    objective : Objective, optional
        What is raised: `LeastIndex` over a region, `MeanIndex` over poses, or, for comparison, `Dexterity`. The index
        at the home pose by default.
    constraints : sequence of Constraint, optional
        What has to be kept, such as `Footprint` or `Stroke`.
    trials : int, optional
        Number of trials of the global search. With 0, only the local search from the start is made.
    start : mapping of str to float, optional
        Values of variables by name, in the units of their keys, to start from. The design's own by default.
    study : str or path-like, optional
        An SQLite file that keeps the trials. The search goes on from what is in it, and several processes may work on
        it at once.
    sampler : {"tpe", "sobol"}, optional
        How trials are chosen: by tree-structured Parzen estimators, or as a Sobol sequence.
    joint : {"universal", "spin_free"}, optional
        Model of the joints between base and legs.
    samples : int, optional
        Number of poses of a region that a trial looks at.
    verify : int, optional
        Number of poses of the verification, at least twice `samples`.
    certify : bool, optional
        Whether it is also proved what the index of the result is at least over the whole region, to 1 % of what is
        found, in at most five minutes: `verification.certificate`. For a `LeastIndex`.
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
    OptimalDesign
        The design, verified on poses that the search has not seen. Where none better than `hexapod` was found, it is
        `hexapod` itself.

    Raises
    ------
    ArgumentError
        If bounds contradict each other, or another argument is invalid.
    DesignError
        If `hexapod` is not a Hexapod.
    InfeasibleError
        If a given start breaks a constraint, if the design breaks one that no variable moves, or if no design that
        keeps them all was found.
    OutputError
        If the study file belongs to another design or problem, or cannot be used.

    Notes
    -----
    The global search follows Bergstra and others [1]_. The best trials are then improved by sequential quadratic
    programming [2]_ with exact derivatives; the smallest index over a region is a semi-infinite constraint, solved by
    exchange of the poses that matter.

    References
    ----------
    .. [1] J. Bergstra, R. Bardenet, Y. Bengio and B. Kegl, Algorithms for hyper-parameter optimization, NIPS (2011).
    .. [2] D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28 (1988).

    Examples
    --------
    >>> hexapod = fx.load("precision-positioner")
    >>> found = fx.optimise(hexapod, fx.Variable("platform.mass", 20, 40), trials=0)
    >>> found.at_bounds, found.index > found.start_index
    (('platform.mass',), True)
    """
    began = perf_counter()
    whole(trials, "trials", 0)
    one_of(sampler, "sampler", ("tpe", "sobol"))
    whole(samples, "samples")
    if whole(verify, "verify") < 2 * samples:
        raise ArgumentError(
            f"verify is {verify}; it must be at least {2 * samples}: twice the poses of a trial, so that it can tell "
            "more."
        )
    aim = LeastIndex() if objective is None else objective
    problem = Problem(hexapod, variables, aim, constraints, joint, threads)
    settings = Settings(samples, whole(seed, "seed", 0), stop, verify)
    if certify:
        check_provable(problem)
    search = Study(problem, study, seed=seed, sampler=sampler, samples=samples) if trials else None
    begun = begin(problem, settings.verify)
    first = _start(problem, start, settings)
    found: list[Trial] = []
    if search is not None:
        search.run(trials, lambda x: _one(problem, x, settings), progress or None, on_trial, stop)
        found = search.finished()
    best = _finish_best(problem, first, found, settings)
    if not best.assessment.feasible and not begun.keeps:
        raise InfeasibleError(
            f"no design that keeps every constraint was found in {len(found)} trials; the nearest one breaks: "
            f"{problem.violations(best.assessment)}. Loosen a bound, widen the variables, or allow more trials."
        )
    result = _told(problem, begun, best, found, settings, began)
    return certified(problem, result, stop) if certify else result


def _told(
    problem: Problem, begun: Beginning, best: _Best, found: Sequence[Trial], settings: Settings, began: float
) -> OptimalDesign:
    """The result, verified on the same poses as the design one began with; that design itself where it is better."""
    start, ranges = problem.hexapod, problem.map.ranges()
    failures = [*begun.failures, *best.failures]
    design, checked = start, begun.verified
    variables = {name: one.before for name, one in ranges.items()}
    at_bounds: tuple[str, ...] = ()
    if best.assessment.feasible:
        ended = problem.map.hexapod_at(best.x)
        seen = verified(problem, ended, settings.verify, best.assessment, settings.samples, failures)
        if seen.index > (0 if begun.breaks else (1 + _SAME) * begun.verified.index):
            design, checked = ended.replace({"name": f"{start.name}-optimised"}), seen
            variables, at_bounds = problem.map.values(best.x), _at_bounds(problem, best.x)
    return OptimalDesign(
        hexapod=design,
        variables=variables,
        ranges=ranges,
        at_bounds=at_bounds,
        index=checked.index,
        start=start,
        start_index=begun.verified.index,
        searched_index=max((t.values[0] for t in found if t.feasible), default=float("nan")),
        coincident=_coincident(problem, design, checked.pose),
        verification=checked,
        start_checks=begun.verified.checks,
        start_breaks=begun.breaks,
        unmoved=begun.unmoved,
        failures=tuple(failures),
        stopped=settings.stopped,
        history=history(problem, found),
        evaluations=best.evaluations,
        seconds=perf_counter() - began,
    )


def _start(problem: Problem, start: Mapping[str, float] | None, settings: Settings) -> Array:
    """The variables to begin with. A start that was given must keep the constraints."""
    x = problem.map.from_values({} if start is None else start)
    if start is not None:
        found = problem.assess_at(x, settings.samples, settings.seed)
        if not found.feasible:
            raise InfeasibleError(
                f"the start breaks: {problem.violations(found)}. Give another start, or none, or loosen the bound."
            )
    return x


def _one(problem: Problem, x: Array, settings: Settings) -> tuple[Assessment, tuple[float, ...]]:
    found = problem.assess_at(x, settings.samples, settings.seed)
    return found, (found.index,)


@dataclass
class _Best:
    """The best end of the local searches, and what went wrong on the way."""

    x: Array
    assessment: Assessment
    message: str = ""
    ends: int = 0
    evaluations: int = 0
    failures: list[str] = field(default_factory=list)

    def finish(self, problem: Problem, x: Array, samples: int, seed: int, stop: Stop | None, anew: bool) -> None:
        """Finishes x, and takes the end where it is better, or `anew` where it was judged on denser poses."""
        try:
            ended = finish(problem, x, samples, seed, stop)
        except Exception as error:  # the trials and the other ends are not lost with it
            self.failures.append(f"A local search ended early: {told(error)}.")
            return
        self.evaluations += ended.evaluations
        self.ends += 1
        if anew or self.ends == 1 or ended.assessment.better_than(self.assessment):
            self.x, self.assessment, self.message = ended.x, ended.assessment, ended.message


def _finish_best(problem: Problem, begin: Array, found: Sequence[Trial], settings: Settings) -> _Best:
    """Finishes the start and the best trials by gradients; what denser sweeps find worse is finished anew."""
    order = sorted(found, key=lambda t: (not t.feasible, -t.values[0] if t.feasible else t.violation))
    starts = [t.x for t in _apart(problem, order)] or [begin]
    if not any(np.array_equal(x, begin) for x in starts):
        starts.append(begin)
    best = _Best(starts[0], problem.nothing())
    for x in starts:
        best.finish(problem, x, settings.samples, settings.seed, settings.stop, anew=False)
    if not best.ends:
        best.assessment = problem.assess_at(best.x, settings.samples, settings.seed)
    for dense in (4 * settings.samples, settings.verify):
        seen = problem.assess_at(best.x, dense, settings.seed + _DENSE)
        if not (seen.feasible and seen.index >= (1 - _AGREE) * best.assessment.index):
            best.finish(problem, best.x, dense, settings.seed + _DENSE, settings.stop, anew=True)
    if best.message:
        best.failures.append(
            f"The local search did not converge ({best.message}): there may be a better design near this one."
        )
    return best


def _apart(problem: Problem, order: Sequence[Trial]) -> list[Trial]:
    """The best trials that are not next to a better one."""
    kept: list[Trial] = []
    for trial in order[:100]:
        u = problem.map.unit(trial.x)
        if all(np.abs(u - problem.map.unit(other.x)).max() > 0.1 for other in kept):
            kept.append(trial)
        if len(kept) == _FINISHED_FROM:
            break
    return kept


def _at_bounds(problem: Problem, x: Array) -> tuple[str, ...]:
    u = problem.map.unit(x)
    return tuple(n for n, at in zip(problem.map.names, (u < 1e-6) | (u > 1 - 1e-6), strict=True) if at)


def _coincident(problem: Problem, hexapod: Hexapod, pose: Array | None) -> int:
    if pose is None:
        return 1
    from flexapod.mechanics.modes import natural_modes

    omega = natural_modes(hexapod, Pose.from_rpy(*pose), joint=problem.joint).omega
    return int((omega <= omega[0] * 1.001).sum())


def history(problem: Problem, found: Sequence[Trial]) -> xr.Dataset:
    """The finished trials: every variable, the objectives, whether feasible."""
    import xarray as xr

    aim, order = problem.objective, [t.number for t in found]
    x = np.array([t.x for t in found]).reshape(len(found), len(problem.map.names))
    data: dict[str, Any] = {p.name: ("trial", x[:, k] / p.unit) for k, p in enumerate(problem.map.parameters)}
    data["index"] = (
        "trial",
        [t.values[0] for t in found],
        {"units": aim.unit or "1", "label": aim.label, "long_name": repr(aim)},
    )
    if found and len(found[0].values) > 1:
        data["against"] = ("trial", [t.values[1] for t in found])
    data["feasible"] = ("trial", np.array([t.feasible for t in found], dtype=bool))
    return xr.Dataset(data, {"trial": order}, {**origin(problem.hexapod)})
