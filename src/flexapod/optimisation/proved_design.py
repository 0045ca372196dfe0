"""What is proved of the index of a design that a search ended with."""

from __future__ import annotations

from dataclasses import replace

from flexapod.certificates.index import certify
from flexapod.errors import ArgumentError
from flexapod.optimisation.design_results import OptimalDesign
from flexapod.optimisation.global_search import Stop
from flexapod.optimisation.objectives import LeastIndex
from flexapod.optimisation.problem import Problem

GAP, LONGEST = 0.01, 300.0  # of a proof: how close it is to come, and how long it may take, s


def check_provable(problem: Problem) -> None:
    """Raises ArgumentError where the objective is not the least index over a region."""
    if not isinstance(problem.objective, LeastIndex):
        raise ArgumentError(
            f"certify is True, but the objective is {problem.objective!r}; only a least index can be proved. Leave it "
            "out, or take LeastIndex."
        )


def certified(problem: Problem, found: OptimalDesign, stop: Stop | None) -> OptimalDesign:
    """The result with a certificate of its index; the index is the lower one where the proof meets a lower pose."""
    proof = certify(
        found.hexapod,
        problem.objective.region,
        gap=GAP,
        joint=problem.joint,
        time_limit=LONGEST,
        threads=problem.threads,
        stop=stop,
    )
    seen = replace(found.verification, certificate=proof)
    if proof.upper < found.index:
        seen = replace(seen, index=proof.upper, pose=proof.pose)
    return replace(found, verification=seen, index=seen.index)
