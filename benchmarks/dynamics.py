"""One evaluation of the forward dynamics inside the core, and Pinocchio's constrained dynamics of the same machine.

The core's time is that of one call with many states over their number: base moving, all frictions on, a leg force and a
wrench, the exact joint model. Pinocchio's is one call of `constraintDynamics` from Python, the call
included, on a fixed base, with its model, data and joint coordinates ready. Both take turns.
"""

import time
from statistics import median

import numpy as np
from tests.helpers.states import draw_state

import flexapod as fx
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds
from benchmarks._vibration import machine, vibration
from flexapod import _core

LIMIT = 1.5  # us
STATES, COPIES = 200, 10  # short calls, so that a busy machine leaves some of them undisturbed
TURNS = 201
MACHINES = ("mukherjee-i", "mukherjee-ii", "motion-base")


def core_call(hexapod: fx.Hexapod):
    """A call of the core that evaluates STATES * COPIES states."""
    rng = np.random.default_rng(35)
    drawn = [draw_state(hexapod, rng) for _ in range(STATES)]
    columns = [
        [s.platform.packed for s in drawn],
        [s.base.packed for s in drawn],
        [s.leg_force for s in drawn],
        [np.concatenate([s.force, s.moment]) for s in drawn],
    ]
    rows = [np.tile(np.array(column), (COPIES, 1)) for column in columns]
    return lambda: _core.forward_dynamics(hexapod.packed, _core.Joint.universal, *rows)


def contests(plan: Plan) -> list[Contest]:
    """Forward dynamics of one machine, whose legs all tools can have: inside the core, and by one call from Python."""
    hexapod, pose = machine()
    force = 3.0 * hexapod.platform_mass * np.array([1.0, 2.0, -1.0, 0.5, -0.3, 1.5])
    core, calls = core_call(hexapod), plan.size(100, 2)
    own = cpu_seconds(lambda: fx.forward_dynamics(hexapod, fx.Motion(pose), leg_force=force), repeats=calls)
    contenders = [
        Contender(OURS, "flexapod", "in the core, many states a call", cpu_seconds(core, STATES * COPIES)),
        Contender(OURS, "flexapod", "fx.forward_dynamics, one state a call", own),
    ]
    if plan.has("pin"):
        contenders.append(_pinocchio(hexapod, pose, calls))
    if plan.has("mujoco-core"):
        contenders.append(_mujoco(hexapod, pose, calls))
    return [Contest("Equations of motion", "state", "acceleration of the platform, relative", contenders)]


def _pinocchio(hexapod: fx.Hexapod, pose: fx.Pose, calls: int) -> Contender:
    from benchmarks._pinocchio import bench_constraint_dynamics

    bench = bench_constraint_dynamics(hexapod, pose)
    motion = fx.Motion(pose, bench.velocity[:3], bench.velocity[3:])
    ours = np.concatenate(fx.forward_dynamics(hexapod, motion, leg_force=bench.leg_force))
    error = float(np.linalg.norm(bench.acceleration - ours) / np.linalg.norm(ours))
    call = cpu_seconds(bench.run, repeats=calls)
    return Contender("Pinocchio", "pin", "constraintDynamics, a call", call, error, 1e-8)


def _mujoco(hexapod: fx.Hexapod, pose: fx.Pose, calls: int) -> Contender:
    """At rest, with a wrench of a few times the weight. Its closures are stiff, not rigid: it agrees to a per cent."""
    import mujoco

    from benchmarks._mujoco import STEPS, Simulation

    weight, size = 9.81 * hexapod.platform_mass, float(np.linalg.norm(hexapod.platform_joints[0]))
    force, moment = 3 * weight * np.array([1.0, -2.0, 0.5]), 3 * weight * size * np.array([0.5, -0.3, 1.0])
    wrench = np.concatenate([force, moment])
    run = Simulation(vibration(hexapod, pose, 0)._replace(wrench=wrench), "Euler", STEPS[-1])
    run.start()
    holding = fx.hold(hexapod, pose).leg_force
    ours = np.concatenate(fx.forward_dynamics(hexapod, fx.Motion(pose), leg_force=holding, force=force, moment=moment))
    at = run.model.joint("platform").dofadr[0]
    error = float(np.linalg.norm(run.data.qacc[at : at + 6] - ours) / np.linalg.norm(ours))
    call = cpu_seconds(lambda: mujoco.mj_forward(run.model, run.data), repeats=calls)
    return Contender("MuJoCo", "mujoco-core", "mj_forward, a call, soft closures", call, error, 0.01)


def microseconds(call, times: int = 1) -> float:
    """Wall time of a call, the mean of some."""
    start = time.perf_counter()
    for _ in range(times):
        call()
    return (time.perf_counter() - start) / times * 1e6


def main() -> None:
    """Print both times of every machine and their ratio, taken turn by turn."""
    from benchmarks._pinocchio import bench_constraint_dynamics

    print(
        f"{'machine':14s} {'flexapod least':>15s} {'median':>8s} {'pinocchio least':>16s} {'median':>8s} {'ratio':>6s}"
    )
    for name in MACHINES:
        hexapod = fx.load(name)
        core, pinocchio = core_call(hexapod), bench_constraint_dynamics(hexapod, fx.Pose(hexapod.home.position))
        turns = []
        for _ in range(TURNS):
            turns.append((microseconds(core) / (STATES * COPIES), microseconds(pinocchio.run, 100)))
        mine, theirs = zip(*turns, strict=True)
        ratio = median(b / a for a, b in turns)
        verdict = "met" if min(mine) <= LIMIT else "NOT MET"
        print(
            f"{name:14s} {min(mine):12.2f} us {median(mine):5.2f} us {min(theirs):13.1f} us {median(theirs):5.1f} us "
            f"{ratio:6.1f}  (at most {LIMIT} us: {verdict}; Pinocchio {pinocchio.iterations} iterations, "
            f"error {pinocchio.error:.0e})"
        )


if __name__ == "__main__":
    main()
