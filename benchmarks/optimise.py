"""Worst-case optimisation of manipulator II in six variables, with 1e6 poses of its workspace an evaluation.

Evaluations per second of the compiled sweep, alone and as a trial of the search, against the same sweep in NumPy
(batched LAPACK on blocks of poses), interleaved; then the time to the optimum. `FLEXAPOD_BENCH_POSES` sets the poses
(default 1e6), `FLEXAPOD_BENCH_TRIALS` the trials (default 30).
"""

import os
import time

import numpy as np

import flexapod as fx
from flexapod.optimal.finish import finish
from flexapod.optimal.problem import Problem
from flexapod.optimal.search import Study

POSES = int(float(os.environ.get("FLEXAPOD_BENCH_POSES", "1e6")))
TRIALS = int(os.environ.get("FLEXAPOD_BENCH_TRIALS", "30"))
SHARE = 20  # the NumPy sweep does one of so many of the poses, and its rate is told
BLOCK = 20_000
HALF, ANGLE = 0.005, np.radians(5)


def problem() -> Problem:
    """Radii, half angles and turn of the joint circles, height: least index within the same footprint and stroke."""
    workspace = fx.Workspace.about_home(HALF, ANGLE)
    variables = [
        fx.JointCircle("base", radius=(0.02, 0.03), half_angle=(0.1, 0.95)),
        fx.JointCircle("platform", radius=(0.03, 0.06), half_angle=(0.1, 0.95), turn=(-1.4, -0.6)),
        fx.Variable("home.position[2]", 0.07, 0.1),
    ]
    limits = [fx.Footprint(), fx.Stroke()]
    return Problem(fx.load("mukherjee-ii"), variables, fx.LeastIndex(workspace), limits, "universal", None)


def numpy_index(hexapod: fx.Hexapod, rows: np.ndarray) -> float:
    """The least index of poses (n, 6) by NumPy alone: J_p of platform and legs, H, eigenvalues of J_p^-1 H K H^T."""
    least = np.inf
    for first in range(0, len(rows), BLOCK):
        J, H = numpy_matrices(hexapod, rows[first : first + BLOCK])
        L = np.linalg.inv(np.linalg.cholesky(J))
        B = L @ H * np.sqrt(hexapod.legs.stiffness)
        least = min(least, float(np.linalg.eigvalsh(B @ B.swapaxes(1, 2))[:, 0].min()))
    return float(np.sqrt(max(least, 0.0)))


def numpy_matrices(hexapod: fx.Hexapod, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """J_p and H, (n, 6, 6), from the partial velocities of the legs' parts."""
    R = fx.Pose.from_rpy(*rows.T).matrix
    q = hexapod.platform_joints @ R.swapaxes(1, 2)
    S = rows[:, None, :3] + q - hexapod.base_joints
    length = np.linalg.norm(S, axis=2, keepdims=True)
    s, k = S / length, hexapod.universal_axes
    y = np.cross(k, s)
    y /= np.linalg.norm(y, axis=2, keepdims=True)
    axes = np.stack([s, y, np.cross(s, y)], axis=2)
    n = np.cross(k, y)
    P = np.eye(3) - s[..., None] * n[..., None, :] / (n * s).sum(axis=2)[..., None, None]
    W = P @ skew(s) / length[..., None]
    Q = np.zeros((*s.shape[:2], 3, 3))
    for part, lower in ((hexapod.legs.lower, True), (hexapod.legs.upper, False)):
        r = np.einsum("nlij,li->nlj", axes, part.mass_center) + (0 if lower else S)
        G = -skew(r) @ W + (0 if lower else s[..., None] * s[..., None, :])
        inertia = axes.swapaxes(2, 3) @ part.inertia @ axes
        Q += part.mass[:, None, None] * G.swapaxes(2, 3) @ G + W.swapaxes(2, 3) @ inertia @ W
    reach = np.concatenate([np.broadcast_to(np.eye(3), (*s.shape[:2], 3, 3)), -skew(q)], axis=3)
    J = (reach.swapaxes(2, 3) @ Q @ reach).sum(axis=1)
    center = R @ hexapod.platform_mass_center
    body = np.concatenate([np.broadcast_to(np.eye(3), R.shape), -skew(center)], axis=2)
    J += hexapod.platform_mass * body.swapaxes(1, 2) @ body
    J[:, 3:, 3:] += R @ hexapod.platform_inertia @ R.swapaxes(1, 2)
    return J, np.concatenate([s, np.cross(q, s)], axis=2).swapaxes(1, 2)


def skew(v: np.ndarray) -> np.ndarray:
    out = np.zeros((*v.shape, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return out - out.swapaxes(-1, -2)


def main() -> None:
    p = problem()
    start = p.map.from_values({})
    hexapod = p.map.hexapod_at(start)
    box = p.box(hexapod)
    rows = fx.low_discrepancy(box, POSES).rows(0, POSES)
    few = rows[: POSES // SHARE]
    assert abs(numpy_index(hexapod, few) / fx.sweep(hexapod, few, "omega_1").omega_1.values.min() - 1) < 1e-6
    rounds = [(timed(lambda: p.assess_at(start, POSES)), timed(lambda: numpy_index(hexapod, few))) for _ in range(3)]
    ours, theirs = (min(times) for times in zip(*rounds, strict=True))
    print(f"one evaluation ({POSES} poses, descent, stroke): {ours:.3f} s, {1 / ours:.3g} evaluations/s")
    print(f"the lowest frequencies alone in NumPy: {theirs * SHARE:.2f} s, {theirs * SHARE / ours:.0f} times as long")

    began = time.perf_counter()
    study = Study(p, points=POSES)

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
