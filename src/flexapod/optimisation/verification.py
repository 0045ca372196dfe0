"""Designs judged on poses that no search has seen: the one that a search begins with, and the one that it ends with."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from flexapod.design.hexapod import Hexapod
from flexapod.errors import DesignError, InfeasibleError, PoseError
from flexapod.optimisation.design_results import Check, VariableRange, Verification
from flexapod.optimisation.movement import unmoved
from flexapod.optimisation.objectives import MeanIndex
from flexapod.optimisation.problem import NO_INDEX, Assessment, Problem
from flexapod.workspace.worst import worst_pose

SEED = 987_654_321  # of verifying sweeps: they use none of the poses that a search has seen


def verify(problem: Problem, hexapod: Hexapod, samples: int) -> Verification:
    """Sweeps every workspace of a problem at poses that no search has seen, and descends from the worst."""
    found = problem.assess(hexapod, samples, SEED + 1)
    index, pose = found.index, None
    box = problem.box(hexapod)
    if box is not None and index > 0:
        worst = worst_pose(
            hexapod,
            box,
            joint=problem.joint,
            samples=samples,
            seed=SEED + 2,
            threads=problem.threads,
            all_poses=True,
        )
        index, pose = 0.0 if worst.singular else min(index, worst.omega_1), worst.pose
    elif not isinstance(problem.objective, MeanIndex):
        rows, swept = problem.sweep(hexapod, 0, samples, 0)
        pose = rows[problem.objective.worst_poses(np.nan_to_num(swept[problem.objective.quantity]))[0]]
    return Verification(samples, index, pose, problem.checks(found))


def verified(
    problem: Problem, hexapod: Hexapod, samples: int, known: Assessment, points: int, failures: list[str]
) -> Verification:
    """`verify`, or what is `known` already from a sweep of `points` poses: a search is not lost at its end."""
    try:
        return verify(problem, hexapod, samples)
    except Exception as error:
        failures.append(
            f"{hexapod.name} could not be verified at {samples} poses ({told(error)}); {points} poses give its numbers."
        )
        return Verification(points, known.index, None, problem.checks(known))


def told(error: Exception) -> str:
    """An error in words, without the full stop."""
    return f"{error or type(error).__name__}".rstrip(".")


@dataclass(frozen=True)
class Beginning:
    """What is known before a search.

    verified: the design that it begins with. breaks: what this design breaks, in words. unmoved: the names of what no
    variable moves. failures: what went wrong, in words.
    """

    verified: Verification
    breaks: tuple[str, ...]
    unmoved: tuple[str, ...]
    ranges: dict[str, VariableRange]
    failures: tuple[str, ...]

    @property
    def keeps(self) -> bool:
        """Whether the design keeps every constraint and the bounds of the variables."""
        return not self.breaks and not any(one.outside for one in self.ranges.values())


def begin(problem: Problem, samples: int, always: Collection[int] = ()) -> Beginning:
    """Judges the design that a search begins with, and takes out of the search what no variable moves.

    A bound that is the design's own is what the verification finds, where this is looser. always: numbers of the
    requirements that stay in the search. Raises InfeasibleError where the design breaks what no variable moves.
    """
    failures: list[str] = []
    try:
        known = problem.assess(problem.hexapod, min(samples, 2**12))
    except (DesignError, PoseError, ArithmeticError, np.linalg.LinAlgError):
        known = problem.nothing()
    seen = verified(problem, problem.hexapod, samples, known, min(samples, 2**12), failures)
    seen = replace(seen, checks=tuple(_own(problem, k, check) for k, check in enumerate(seen.checks)))
    still, aim = unmoved(problem)
    names = [problem.requirements[k].name for k in still] + [repr(problem.objective)] * aim
    still = [k for k in still if k not in always]
    broken = [seen.checks[k].words for k in still if not seen.checks[k].kept]
    if broken:
        raise InfeasibleError(
            f"no variable moves what the design breaks: {'; '.join(broken)}. Loosen the bound, or vary what it depends "
            "on."
        )
    problem.hold(still, seen.checks)
    breaks = [check.words for check in seen.checks if not check.kept] + [NO_INDEX] * (seen.index <= 0)
    return Beginning(seen, tuple(breaks), tuple(names), problem.map.ranges(), tuple(failures))


def _own(problem: Problem, k: int, check: Check) -> Check:
    """The check of the design itself; it keeps a bound of its own by definition."""
    r = problem.requirements[k]
    if not r.own or not np.isfinite(check.value):
        return check
    bound = max(check.value, check.bound) if r.side == "most" else min(check.value, check.bound)
    problem.requirements[k] = replace(r, bound=np.array(bound))
    return replace(check, bound=bound, margin=max(check.margin, 0.0), kept=True)
