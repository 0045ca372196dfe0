"""The last part of a search: sequential quadratic programming on exact derivatives.

Maximising the least index over a workspace is a semi-infinite problem. It is solved by exchange (Blankenship, Falk): a
few poses are held, the design is improved for them (SLSQP, with the least index t as one more variable), then the
workspace is searched anew with that design, and the poses where it is worst are held as well, until none is worse.
At each pose the six frequencies stand under one smooth minimum, a symmetric function of them: so it has a derivative
where the lowest are equal, as they are at most optima. It is made sharper from round to round.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME, numbers
from flexapod.errors import DesignError, PoseError
from flexapod.optimisation.derivatives import DesignDerivatives
from flexapod.optimisation.problem import FEASIBLE, Assessment, Problem
from flexapod.optimisation.requirements import Requirement
from flexapod.workspace.worst import WorstPose, worst_pose

_SHARPNESS = (40.0, 400.0, 4000.0, 4000.0, 4000.0)
_ROUNDS = 14  # at most, also of those that are made anew
_BROKEN = 0.02  # sum of margins broken, from which a round led astray: legs have passed through one another, say
_SLACK = 1e-7  # bounds are kept by this much more than asked, so that rounding does not break them
_PINNED = -1e-9  # instead of it, where a bound can only just be kept: at the end of a variable's range, for one
_SMOOTH = 4e-3  # by which a smooth extreme may pass a bound that the extreme itself keeps: 2 log(6) / 1000
_STEEP = 1e-3  # slope over the whole range of the variables from which a margin has room for all of the slack
_STILL = 1e-9  # slope over that range below which no step moves a margin
_CLOSE = 1e-5  # relative gain of a round below which the finish ends
_FAR = 5.0  # most that a margin counts: what is far from its bound decides nothing


@dataclass
class _Held:
    """Poses held for the objective or for one requirement; those of one batch belong together."""

    requirement: Requirement | None
    from_home: bool
    rows: Array  # (k, 6), measured from home where from_home


@dataclass(frozen=True)
class Finished:
    """Best design of a finish: variables (SI), what it makes of the problem, and how often anything was evaluated.

    message: why no round converged, in words; empty where one did, or none was made.
    """

    x: Array
    assessment: Assessment
    evaluations: int
    rounds: int
    message: str


def finish(
    problem: Problem, start: Array, samples: int, seed: int = 0, stop: Callable[[], bool] | None = None
) -> Finished:
    """Improves variables x from a start, in rounds. The start itself is returned where nothing better was found.

    A round that ends far beyond a bound is made anew from the best design, with the poses held that it was broken at:
    from a design whose legs have passed through one another no gradient leads back.
    """
    best_x, best = start, assess_anew(problem, start, samples, seed)
    held: list[_Held] = []
    u, evaluations, rounds = problem.map.unit(start), 0, 0
    _hold(problem, start, held, samples, seed)
    messages = [] if held else ["its start makes no hexapod"]
    left = list(_SHARPNESS) if held else []
    while left and rounds < _ROUNDS and not (stop is not None and stop()):
        rounds += 1
        local = _Local(problem, held, left[0])
        u = local.solve(u)
        evaluations += local.evaluations
        messages.append(local.message)
        x = problem.map.from_unit(u)[0]
        found = assess_anew(problem, x, samples, seed + rounds)
        gain = found.index / best.index - 1 if best.feasible and best.index > 0 else 1.0
        if found.better_than(best):
            best_x, best = x, found
        if left[0] == _SHARPNESS[-1] and found.feasible and gain < _CLOSE:
            break
        _hold(problem, x, held, samples, seed + rounds)
        if best.feasible and found.violation > _BROKEN:
            u = problem.map.unit(best_x)
        else:
            del left[0]
    return Finished(best_x, best, evaluations, rounds, messages[-1] if messages and all(messages) else "")


def assess_anew(problem: Problem, x: Array, samples: int, seed: int) -> Assessment:
    """As `Problem.assess_at`, with the least index over a box found to the last digit: sweep, then L-BFGS-B."""
    found = problem.assess_at(x, samples, seed)
    if found.index <= 0:
        return found
    hexapod = problem.map.hexapod_at(x)
    return replace(found, index=least_index(problem, hexapod, found.index, samples, seed))


def least_index(problem: Problem, hexapod: Hexapod, index: float, samples: int, seed: int) -> float:
    """The index, lowered to what a descent from the worst poses of a sweep finds."""
    worst = _worst(problem, hexapod, samples, seed)
    return index if worst is None else min(index, worst.omega_1)


def _worst(problem: Problem, hexapod: Hexapod, samples: int, seed: int) -> WorstPose | None:
    """The worst pose of the objective's box; None where it has none."""
    box = problem.box(hexapod)
    if box is None:
        return None
    return worst_pose(
        hexapod, box, joint=problem.joint, samples=samples, starts=6, seed=seed, threads=problem.threads, all_poses=True
    )


def _hold(problem: Problem, x: Array, held: list[_Held], samples: int, seed: int) -> None:
    """Adds the poses where this design is worst."""
    try:
        hexapod = problem.map.hexapod_at(x)
    except DesignError:
        return
    own = numbers(hexapod)
    for group, (region, requirements) in enumerate(problem.groups()):
        rows, found = problem.sweep(hexapod, group, samples, seed)
        origin = own[HOME] if region.from_home else np.zeros(6)
        if group == 0:
            chosen = rows[problem.objective.worst_poses(np.nan_to_num(found[problem.objective.quantity]))]
            with suppress(PoseError):  # the sweep's own worst poses are held then
                worst = _worst(problem, hexapod, samples, seed)
                if worst is not None:
                    chosen = np.concatenate([[pose for _, pose in worst.minima], chosen])
            if region.box(own[HOME]) is not None or not held:
                _add(held, None, region.from_home, chosen - origin)
        for requirement in requirements:
            worst_rows = requirement.quantity.worst_poses(found, own, requirement.side)
            _add(held, requirement, region.from_home, rows[worst_rows] - origin)
    if not any(h.requirement is not None and h.requirement.region is None for h in held):
        for requirement in problem.requirements:
            if requirement.region is None:
                held.append(_Held(requirement, False, np.zeros((0, 6))))


def _add(held: list[_Held], requirement: Requirement | None, from_home: bool, rows: Array) -> None:
    if any(h.requirement is requirement and np.array_equal(h.rows, rows) for h in held):
        return
    held.append(_Held(requirement, from_home, rows))


class _Local:
    """The problem with poses held: variables u in the unit cube, and t = ln(index / index at the start)."""

    def __init__(self, problem: Problem, held: Sequence[_Held], sharpness: float) -> None:
        self.problem, self.held, self.sharpness = problem, held, sharpness
        self.evaluations, self.message = 0, ""
        self._at: Array | None = None
        self._found: tuple[Array, Array, Array, Array] | None = None

    def solve(self, u: Array) -> Array:
        from scipy.optimize import minimize

        n = len(u)
        index = self._evaluate(u)[0]
        self._reference = float(index.min())
        start = np.append(u, 0.0)
        toward = np.zeros(n + 1)
        toward[-1] = -1.0
        margin = self._evaluate(u)[2]
        pinned = np.where(margin > -_SMOOTH, np.minimum(margin, _PINNED), _PINNED)  # no worse than now
        for slack in (np.full(len(margin), _SLACK), pinned):
            end = minimize(
                lambda z: -z[-1],
                start,
                jac=lambda z: toward,
                method="SLSQP",
                bounds=[(0.0, 1.0)] * n + [(-10.0, 10.0)],
                constraints={"type": "ineq", "fun": partial(self._margins, slack=slack), "jac": self._slopes},
                options={"maxiter": 120, "ftol": 1e-9},
            )
            found = np.clip(end.x[:-1], 0.0, 1.0) if np.isfinite(end.x).all() else u
            self.message = "" if end.success else str(end.message)
            if end.success or self._evaluate(found)[2].min(initial=0.0) >= -FEASIBLE:
                break
        return found

    def _margins(self, z: Array, slack: Array) -> Array:
        index, _, margin, by_margin = self._evaluate(z[:-1])
        steep = np.minimum(1.0, np.abs(by_margin).sum(axis=1) / _STEEP)
        room = np.where(slack > 0, slack * steep, slack)
        return np.concatenate([index - self._reference - z[-1], margin - room])

    def _slopes(self, z: Array) -> Array:
        _, by_index, _, by_margin = self._evaluate(z[:-1])
        last = np.concatenate([np.full(len(by_index), -1.0), np.zeros(len(by_margin))])
        return np.concatenate([np.concatenate([by_index, by_margin]), last[:, None]], axis=1)

    def _evaluate(self, u: Array) -> tuple[Array, Array, Array, Array]:
        """Logarithms of the index at the poses held and margins, with their derivatives by u."""
        if self._at is None or not np.array_equal(u, self._at):
            self._at, self._found = u.copy(), self._compute(u)
            self.evaluations += 1
        assert self._found is not None
        return self._found

    def _compute(self, u: Array) -> tuple[Array, Array, Array, Array]:
        design = self.problem.map
        x, by_u = design.from_unit(u)
        own, jacobian = design.numbers(x), design.jacobian(x) * by_u
        index: list[tuple[Array, Array]] = []
        margin: list[tuple[Array, Array]] = [(np.zeros(0), np.zeros((0, len(u))))]
        for held in self.held:
            rows = held.rows + own[HOME] if held.from_home else held.rows
            at = DesignDerivatives(own, jacobian, rows, held.from_home, self.problem.core_joint)
            if held.requirement is None:
                index.append(self.problem.objective.derivatives(at, self.sharpness))
            else:
                margin.append(_bounded(*held.requirement.margin_derivatives(at)))
        parts = [np.concatenate(part) for part in (*zip(*index, strict=True), *zip(*margin, strict=True))]
        return parts[0], np.nan_to_num(parts[1]), parts[2], parts[3]


def _bounded(margin: Array, slope: Array) -> tuple[Array, Array]:
    """Margins and slopes as the search takes them: cut off far away, and kept where they are kept and nothing moves
    them here, lest rounding breaks a bound that no step can mend."""
    near = np.clip(np.nan_to_num(margin, nan=-_FAR, posinf=_FAR, neginf=-_FAR), -_FAR, _FAR)
    slope = np.where((np.abs(near) < _FAR)[:, None], np.nan_to_num(slope), 0.0)
    still = np.abs(slope).sum(axis=1) < _STILL
    near = np.where(still & (near >= -FEASIBLE), np.maximum(near, 0.0), near)
    return near, np.where(still[:, None], 0.0, slope)
