"""Sweeps of poses as users have them, on all threads: an array, a `Pose` of matrices or of SciPy's rotations.

Wall time. The rate of each is compared with that of the array, whose numbers the kernel takes as they are.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

import flexapod as fx
from benchmarks._contest import OURS, Contender, Contest, Plan, take_turns
from benchmarks._machine import all_cores
from benchmarks.certify import machine_of

POSES, TURNS = 2_000_000, 11
LEAST = 0.85  # of the array's rate


def contests(plan: Plan) -> list[Contest]:
    """The same poses in each of the forms."""
    hexapod, count = machine_of("motion-base"), plan.size(POSES, 4000)
    spread = np.random.default_rng(1).uniform(-0.1, 0.1, (count, 6))
    six = np.array([0, 0, 2.4, 0, 0, 0]) + spread
    position, rotations = six[:, :3].copy(), Rotation.from_euler("xyz", six[:, 3:])
    of_matrices, of_rotations = fx.Pose(position, rotations.as_matrix()), fx.Pose(position, rotations)
    ours = fx.sweep(hexapod, six).omega_1.values

    def contender(how: str, poses: Callable[[], Any]) -> Contender:
        error = float(np.abs(fx.sweep(hexapod, poses()).omega_1.values / ours - 1).max())
        return Contender(OURS, "flexapod", how, wall_seconds(lambda: fx.sweep(hexapod, poses()), count), error, 1e-11)

    return [
        Contest(
            "Sweep of poses, all threads",
            "pose",
            "omega_1, relative",
            [
                contender(f"array of {count} rows of six", lambda: six),
                contender("a Pose of matrices", lambda: of_matrices),
                contender("a Pose of SciPy's rotations", lambda: of_rotations),
                contender("the Pose made of rotations first", lambda: fx.Pose(position, rotations)),
            ],
        )
    ]


def wall_seconds(call: Callable[[], Any], units: float) -> Callable[[], float]:
    """A `run` of a contender: time that passes on all cores, for one unit."""

    def run() -> float:
        with all_cores():
            began = time.perf_counter()
            call()
            return (time.perf_counter() - began) / units

    return run


def main() -> None:
    """Print the rate of every form as a share of the array's."""
    (contest,) = contests(Plan(quick=False))
    for record in take_turns(contest, TURNS):
        verdict = "met" if 1 / record.ratio >= LEAST else "NOT MET"
        rate = 1 / record.time
        print(f"{record.how:36s} {rate:9.3g} poses/s, {1 / record.ratio:5.0%} (at least {LEAST:.0%}: {verdict})")


if __name__ == "__main__":
    main()
