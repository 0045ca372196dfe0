"""Search for the design with the highest objective: trials, a local search by gradients, and a verification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from flexapod.checks import one_of, whole
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, InfeasibleError
from flexapod.optimisation.design_results import Check, OptimalDesign, Verification
from flexapod.optimisation.global_search import OnTrial, Progress, Stop, Study, Trial
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.objectives import LeastIndex, MeanIndex, Objective
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.requirements import Constraint
from flexapod.optimisation.variables import JointCircle, Variable
from flexapod.pose import Pose
from flexapod.workspace.worst import worst_pose

if TYPE_CHECKING:
    import xarray as xr

_FINISHED_FROM = 3  # best trials that are finished by gradients
_AGREE = 1e-3  # relative amount by which the dense sweep may lie below what the finish reported
_SEED = 77_003  # added for the verifying sweep: it uses none of the poses that the search has seen


@dataclass(frozen=True)
class Settings:
    """How a search is made: see `optimise` and `pareto_front`."""

    samples: int
    seed: int
    stop: Stop | None
    verify: int = 0


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
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
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
    seed : int, optional
        Seed of the search.
    threads : int, optional
        Number of threads. All cores by default.
    progress : callable, optional
        Called with the share of the trials done, from 0 to 1.
    on_trial : callable, optional
        Called before each trial with the number of trials finished, the number wanted and the best objective so far
        (NaN without one).
    stop : callable, optional
        Called between trials; the search ends early when it returns True.

    Returns
    -------
    OptimalDesign
        The design, verified on poses that the search has not seen.

    Raises
    ------
    ArgumentError
        If bounds contradict each other, or another argument is invalid.
    DesignError
        If `hexapod` is not a Hexapod.
    InfeasibleError
        If a given start breaks a constraint, or no design that keeps them all was found.
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
    begin = _start(problem, start, settings)
    found: list[Trial] = []
    if trials:
        search = Study(problem, study, seed=seed, sampler=sampler, samples=samples)
        search.run(trials, lambda x: _one(problem, x, settings), progress, on_trial, stop)
        found = search.finished()
    best_x, best, evaluations = _finish_best(problem, begin, found, settings)
    if not best.feasible:
        raise InfeasibleError(
            f"no design that keeps every constraint was found in {len(found)} trials; the nearest one breaks: "
            f"{problem.violations(best)}. Loosen a bound, widen the variables, or allow more trials."
        )
    return _told(problem, best_x, found, evaluations, settings, began)


def _told(
    problem: Problem, x: Array, found: Sequence[Trial], evaluations: int, settings: Settings, began: float
) -> OptimalDesign:
    """The result, verified; the design one began with is judged on the same poses."""
    design, start = problem.map.hexapod_at(x), problem.hexapod
    checked, by_start = verify(problem, design, settings.verify), verify(problem, start, settings.verify)
    return OptimalDesign(
        hexapod=design.replace({"name": f"{start.name}-optimised"}),
        variables=problem.map.values(x),
        at_bounds=_at_bounds(problem, x),
        index=checked.index,
        start=start,
        start_index=by_start.index,
        searched_index=max((t.values[0] for t in found if t.feasible), default=float("nan")),
        coincident=_coincident(problem, design, checked.pose),
        verification=checked,
        start_checks=by_start.checks,
        history=history(problem, found),
        evaluations=evaluations,
        seconds=perf_counter() - began,
    )


def _start(problem: Problem, start: Mapping[str, float] | None, settings: Settings) -> Array:
    """The variables to begin with. A start that was given must keep the constraints."""
    x = problem.map.from_values(start or {})
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


def _finish_best(
    problem: Problem, begin: Array, found: Sequence[Trial], settings: Settings
) -> tuple[Array, Assessment, int]:
    """Finishes the start and the best trials by gradients; what denser sweeps find worse is finished anew."""
    order = sorted(found, key=lambda t: (not t.feasible, -t.values[0] if t.feasible else t.violation))
    starts = [t.x for t in _apart(problem, order)] or [begin]
    if not any(np.array_equal(x, begin) for x in starts):
        starts.append(begin)
    best_x, best, evaluations = begin, None, 0
    for x in starts:
        ended = finish(problem, x, settings.samples, settings.seed, settings.stop)
        evaluations += ended.evaluations
        if ended.assessment.better_than(best):
            best_x, best = ended.x, ended.assessment
    assert best is not None
    for dense in (4 * settings.samples, settings.verify):
        seen = problem.assess_at(best_x, dense, settings.seed + _SEED)
        if seen.feasible and seen.index >= (1 - _AGREE) * best.index:
            continue
        ended = finish(problem, best_x, dense, settings.seed + _SEED, settings.stop)
        evaluations += ended.evaluations
        best_x, best = ended.x, ended.assessment
    return best_x, best, evaluations


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


def verify(problem: Problem, hexapod: Hexapod, samples: int) -> Verification:
    """Sweeps every workspace of a problem at poses that no search has seen, and descends from the worst."""
    found = problem.assess(hexapod, samples, _SEED + 1)
    index, pose = found.index, None
    box = problem.box(hexapod)
    if box is not None and index > 0:
        worst = worst_pose(
            hexapod,
            box,
            joint=problem.joint,
            samples=samples,
            seed=_SEED + 2,
            threads=problem.threads,
            all_poses=True,
        )
        index, pose = min(index, worst.omega_1), worst.pose
    elif not isinstance(problem.objective, MeanIndex):
        rows, swept = problem.sweep(hexapod, 0, samples, 0)
        pose = rows[problem.objective.worst_poses(np.nan_to_num(swept[problem.objective.quantity]))[0]]
    return Verification(samples, index, pose, _checks(problem, found))


def _checks(problem: Problem, found: Assessment) -> tuple[Check, ...]:
    checks = []
    for r, value, margin in zip(problem.requirements, found.values, found.margins, strict=True):
        bound = float(r.bound.min() if r.side == "most" else r.bound.max())
        kept = bool(margin >= -10 * 1e-6)  # ten times what the search allows itself: it is another sweep
        checks.append(Check(r.name, r.quantity.unit, r.side, float(value), bound, float(margin), kept))
    return tuple(checks)


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
    return xr.Dataset(data, {"trial": order}, {"design": problem.hexapod.name, "digest": problem.hexapod.digest})
