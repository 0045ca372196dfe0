"""One evaluation of the forward dynamics inside the core, and Pinocchio's constrained dynamics of the same machine.

The core's time is that of one call with many states over their number: base moving, all frictions on, a leg force and a
wrench, the exact joint model. Pinocchio's is one call of `constraintDynamics` from Python, the call
included, on a fixed base, with its model, data and joint coordinates ready. Both take turns.
"""

import sys
import time
from pathlib import Path
from statistics import median

import numpy as np

import flexapod as fx
from flexapod import _core

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
from engine import bench_constraint_dynamics
from states import draw_state

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
    return lambda: _core.forward_dynamics(hexapod.packed, True, *rows)


def microseconds(call, times: int = 1) -> float:
    """Wall time of a call, the mean of some."""
    start = time.perf_counter()
    for _ in range(times):
        call()
    return (time.perf_counter() - start) / times * 1e6


def main() -> None:
    """Print both times of every machine and their ratio, taken turn by turn."""
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
