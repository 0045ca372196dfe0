"""`optimise`: search for the design with the highest index, finish it by gradients, and verify it on a denser sweep."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, InfeasibleError
from flexapod.optimisation.constraints import Constraint
from flexapod.optimisation.global_search import Progress, Stop, Study, Trial
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.objectives import LeastIndex, MeanIndex, Objective
from flexapod.optimisation.problem import Assessment, Problem
from flexapod.optimisation.variables import JointCircle, Variable
from flexapod.pose import Pose
from flexapod.workspace.worst import worst_pose

if TYPE_CHECKING:
    import xarray as xr

_FINISHED_FROM = 3  # best trials that are finished by gradients
_AGREE = 1e-3  # relative amount by which the dense sweep may lie below what the finish reported
_SEED = 77_003  # added for the verifying sweep: it uses none of the poses that the search has seen


@dataclass(frozen=True)
class Check:
    """One constraint of a design: its extreme value and bound (SI), and the relative margin (>= 0 where kept)."""

    name: str
    unit: str
    side: str
    value: float
    bound: float
    margin: float
    kept: bool


@dataclass(frozen=True)
class Verification:
    """A sweep of `points` poses of every workspace that the search has not seen, and descents from the worst.

    index: rad/s, the least found; pose: where (six numbers; None for a mean). checks: every constraint there.
    """

    points: int
    index: float
    pose: Array | None
    checks: tuple[Check, ...]

    @property
    def holds(self) -> bool:
        return all(check.kept for check in self.checks)


@dataclass(frozen=True, eq=False)
class OptimalDesign:
    """What `optimise` found.

    hexapod: the design; variables: its values by name, in their keys' units; at_bounds: those on a bound. index: rad/s,
    as verified (for Dexterity: 1/cond(H)); start: the design one began with; start_index: its index, verified alike.
    searched_index: best of the trials, before the gradient (NaN without trials). coincident: frequencies within 0.1 %
    of the lowest at the worst pose: where more than one, the optimum lies where modes meet. verification, start_checks:
    every constraint with its value, bound and margin. history: Dataset of the finished trials. evaluations: of designs.
    seconds: of the search, s.

    Source: conclusion 1.
    """

    hexapod: Hexapod
    variables: dict[str, float]
    at_bounds: tuple[str, ...]
    index: float
    start: Hexapod
    start_index: float
    searched_index: float
    coincident: int
    verification: Verification
    start_checks: tuple[Check, ...]
    history: xr.Dataset
    evaluations: int
    seconds: float

    @property
    def gain(self) -> float:
        """index / start_index - 1; infinite for a start of index zero."""
        return self.index / self.start_index - 1 if self.start_index > 0 else float("inf")


def optimise(
    hexapod: Hexapod,
    variables: Sequence[Variable | JointCircle],
    objective: Objective | None = None,
    constraints: Sequence[Constraint] = (),
    *,
    trials: int = 200,
    start: Mapping[str, float] | None = None,
    study: str | Path | None = None,
    **options: Any,
) -> OptimalDesign:
    """The design with the highest objective (rad/s), within bounds and constraints.

    variables: `Variable` and `JointCircle`. objective: `LeastIndex` at a pose (default: home) or over a workspace,
    `MeanIndex` over a path, or, for comparison, `Dexterity`. constraints: such as `Footprint` or `Stroke`. trials: of
    the global search (0: gradients from the start only). start: values by name, in the keys' units; default: the
    design's own. study: an SQLite file; the search goes on from what is in it, and other processes may work on it at
    once. Options: joint, seed=0, sampler="tpe" or "sobol", points=4096 poses a trial, verify=131072 poses of the last
    sweep, threads, progress, stop.

    Raises: ArgumentError for contradictory bounds; InfeasibleError for a given start that breaks a constraint and where
    no design that keeps them all was found; OutputError for a study file of another design or problem.
    Source: conclusion 1; J. Bergstra and others (2011) for the trials, D. Kraft (1988) for the gradients.
    """
    began = perf_counter()
    settings = Settings(**options)
    aim = LeastIndex() if objective is None else objective
    problem = Problem(hexapod, variables, aim, constraints, settings.joint, settings.threads)
    if isinstance(trials, bool) or not isinstance(trials, int) or trials < 0:
        raise ArgumentError(f"trials is {trials!r}; it must be a whole number, 0 or more.")
    begin = _start(problem, start, settings)
    found: list[Trial] = []
    if trials:
        search = Study(problem, study, seed=settings.seed, sampler=settings.sampler, points=settings.points)
        search.run(trials, lambda x: _one(problem, x, settings), settings.progress, settings.stop)
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


@dataclass(frozen=True)
class Settings:
    """How a search is made; see `optimise`."""

    joint: JointModel = "universal"
    seed: int = 0
    sampler: str = "tpe"
    points: int = 2**12
    verify: int = 2**17
    threads: int | None = None
    progress: Progress | None = None
    stop: Stop | None = None

    def __post_init__(self) -> None:
        for name, least in (("points", 1), ("verify", 2 * self.points)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or value < least:
                reason = "" if name == "points" else ": twice the poses of a trial, so that it can tell more"
                raise ArgumentError(f"{name} is {value!r}; it must be a whole number, at least {least}{reason}.")


def _start(problem: Problem, start: Mapping[str, float] | None, settings: Settings) -> Array:
    """The variables to begin with. A start that was given must keep the constraints."""
    x = problem.map.from_values(start or {})
    if start is not None:
        found = problem.assess_at(x, settings.points, settings.seed)
        if not found.feasible:
            raise InfeasibleError(
                f"the start breaks: {problem.violations(found)}. Give another start, or none, or loosen the bound."
            )
    return x


def _one(problem: Problem, x: Array, settings: Settings) -> tuple[Assessment, tuple[float, ...]]:
    found = problem.assess_at(x, settings.points, settings.seed)
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
        ended = finish(problem, x, settings.points, settings.seed, settings.stop)
        evaluations += ended.evaluations
        if ended.assessment.better_than(best):
            best_x, best = ended.x, ended.assessment
    assert best is not None
    for dense in (4 * settings.points, settings.verify):
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


def verify(problem: Problem, hexapod: Hexapod, points: int) -> Verification:
    """Sweeps every workspace of a problem at poses that no search has seen, and descends from the worst."""
    found = problem.assess(hexapod, points, _SEED + 1)
    index, pose = found.index, None
    box = problem.box(hexapod)
    if box is not None and index > 0:
        worst = worst_pose(hexapod, box, joint=problem.joint, samples=points, seed=_SEED + 2, threads=problem.threads)
        index, pose = min(index, worst.omega_1), worst.pose
    elif not isinstance(problem.objective, MeanIndex):
        rows, swept = problem.sweep(hexapod, 0, points, 0)
        pose = rows[problem.objective.held(np.nan_to_num(swept[problem.objective.quantity]))[0]]
    return Verification(points, index, pose, _checks(problem, found))


def _checks(problem: Problem, found: Assessment) -> tuple[Check, ...]:
    checks = []
    for r, value, margin in zip(problem.requirements, found.values, found.margins, strict=True):
        bound = float(r.bound.min() if r.side == "most" else r.bound.max())
        kept = bool(margin >= -10 * 1e-6)  # ten times what the search allows itself: it is another sweep
        checks.append(Check(r.name, r.kind.unit, r.side, float(value), bound, float(margin), kept))
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
        {"units": aim.unit, "label": aim.label, "long_name": repr(aim)},
    )
    if found and len(found[0].values) > 1:
        data["against"] = ("trial", [t.values[1] for t in found])
    data["feasible"] = ("trial", np.array([t.feasible for t in found], dtype=bool))
    return xr.Dataset(data, {"trial": order}, {"design": problem.hexapod.name, "digest": problem.hexapod.digest})
