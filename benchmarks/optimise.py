"""Worst-case optimisation of manipulator II in six variables, with 1e6 poses of its workspace an evaluation.

Evaluations per second of the compiled sweep, alone and as a trial of the search, against the same sweep in NumPy
(batched LAPACK on blocks of poses), interleaved; then the time to the optimum. `FLEXAPOD_BENCH_POSES` sets the poses
(default 1e6), `FLEXAPOD_BENCH_TRIALS` the trials (default 30).
"""

import os
import time

import numpy as np

import flexapod as fx
from benchmarks._arrays import array_matrices
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds
from flexapod.optimisation.global_search import Study
from flexapod.optimisation.local_search import finish
from flexapod.optimisation.problem import Problem

POSES = int(float(os.environ.get("FLEXAPOD_BENCH_POSES", "1e6")))
TRIALS = int(os.environ.get("FLEXAPOD_BENCH_TRIALS", "30"))
SHARE = 20  # the NumPy sweep does one of so many of the poses, and its rate is told
BLOCK = 20_000
HALF, ANGLE = 0.005, np.radians(5)


def problem() -> Problem:
    """Radii, half angles and turn of the joint circles, height: least index within the same footprint and stroke."""
    workspace = fx.Workspace.about_home(HALF, ANGLE)
    variables = [
        fx.optimisation.JointCircle("base", radius=(0.02, 0.03), half_angle=(0.1, 0.95)),
        fx.optimisation.JointCircle("platform", radius=(0.03, 0.06), half_angle=(0.1, 0.95), turn=(-1.4, -0.6)),
        fx.Variable("home.position[2]", 0.07, 0.1),
    ]
    limits = [fx.optimisation.Footprint(), fx.optimisation.Stroke()]
    return Problem(fx.load("mukherjee-ii"), variables, fx.LeastIndex(workspace), limits, "universal", None)


def numpy_index(hexapod: fx.Hexapod, rows: np.ndarray) -> float:
    """The least index of poses (n, 6) by NumPy alone: J_p of platform and legs, H, eigenvalues of J_p^-1 H K H^T."""
    least = np.inf
    for first in range(0, len(rows), BLOCK):
        J, H = array_matrices(np, hexapod, rows[first : first + BLOCK])
        L = np.linalg.inv(np.linalg.cholesky(J))
        B = L @ H * np.sqrt(hexapod.legs.stiffness)
        least = min(least, float(np.linalg.eigvalsh(B @ B.swapaxes(1, 2))[:, 0].min()))
    return float(np.sqrt(max(least, 0.0)))


def contests(plan: Plan) -> list[Contest]:
    """The least index over the workspace, which is what a trial of a worst-case design search has to find."""
    poses = plan.size(POSES, 2000)
    p = problem()
    start = p.map.from_values({})
    hexapod = p.map.hexapod_at(start)
    rows = fx.workspace.low_discrepancy(p.box(hexapod), poses).rows(0, max(poses // SHARE, 100))
    ours = float(fx.sweep(hexapod, rows, quantities="omega_1").omega_1.values.min())
    error = abs(numpy_index(hexapod, rows) / ours - 1)
    trial = cpu_seconds(lambda: p.assess_at(start, poses), poses / 1e6)
    theirs = cpu_seconds(lambda: numpy_index(hexapod, rows), len(rows) / 1e6)
    contenders = [
        Contender(OURS, "flexapod", f"{poses} poses, descent, stroke", trial),
        Contender("NumPy + LAPACK", "numpy", "lowest frequencies alone", theirs, error, 1e-6),
    ]
    return [Contest("Worst case of a design", "million poses", "least frequency, relative", contenders)]


def main() -> None:
    p = problem()
    start = p.map.from_values({})
    hexapod = p.map.hexapod_at(start)
    box = p.box(hexapod)
    rows = fx.workspace.low_discrepancy(box, POSES).rows(0, POSES)
    few = rows[: POSES // SHARE]
    assert abs(numpy_index(hexapod, few) / fx.sweep(hexapod, few, quantities="omega_1").omega_1.values.min() - 1) < 1e-6
    rounds = [(timed(lambda: p.assess_at(start, POSES)), timed(lambda: numpy_index(hexapod, few))) for _ in range(3)]
    ours, theirs = (min(times) for times in zip(*rounds, strict=True))
    print(f"one evaluation ({POSES} poses, descent, stroke): {ours:.3f} s, {1 / ours:.3g} evaluations/s")
    print(f"the lowest frequencies alone in NumPy: {theirs * SHARE:.2f} s, {theirs * SHARE / ours:.0f} times as long")

    began = time.perf_counter()
    study = Study(p, samples=POSES)

    def evaluate(x: np.ndarray):
        found = p.assess_at(x, POSES)
        return found, (found.index,)

    study.run(TRIALS, evaluate)
    searched = time.perf_counter() - began
    best = max((t for t in study.finished() if t.feasible), key=lambda t: t.values[0])
    end = finish(p, best.x, POSES)
    whole = time.perf_counter() - began
    print(f"{TRIALS} trials: {best.values[0]:.5g} rad/s in {searched:.1f} s, {TRIALS / searched:.3g} evaluations/s")
    print(
        f"optimum: {end.assessment.index:.6g} rad/s (start {p.assess(p.hexapod, POSES).index:.5g}) after {whole:.1f} s"
    )
    sweeps = TRIALS + 3 * (end.rounds + 1)
    print(f"its {sweeps} sweeps alone would take NumPy {sweeps * theirs * SHARE:.0f} s")


def timed(function) -> float:
    began = time.perf_counter()
    function()
    return time.perf_counter() - began


if __name__ == "__main__":
    main()
