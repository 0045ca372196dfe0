"""One call for one pose: the public functions, which check everything, and the handle for loops, which checks shapes.

The motion base of the packaged designs, on legs of constant stiffness; pose, motion and loads are made before, as a
control loop has them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import flexapod as fx
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds, take_turns
from benchmarks.certify import machine_of

TURNS = 21
LIMITS = {"fx.linearise": 10.0, "fx": 6.0, "compiled": 1.5}  # us


def calls() -> dict[str, Callable[[], Any]]:
    """Each call by its name."""
    hexapod, pose = machine_of("motion-base"), fx.Pose.from_rpy(0.05, 0.02, 2.4, 0.03, -0.02, 0.04)
    six, force = np.concatenate([pose.position, pose.rpy]), np.full(6, 5000.0)
    moving = fx.Motion(pose, [0.1, 0, 0.2], [0, 0.1, 0], [1, 0, 0.5], [0, 0.2, 0.1])
    handle, zero = hexapod.compiled(), np.zeros(6)
    twist = np.concatenate([moving.velocity, moving.angular_velocity])
    acceleration = np.concatenate([moving.acceleration, moving.angular_acceleration])
    return {
        "fx.natural_modes": lambda: fx.natural_modes(hexapod, pose),
        "fx.natural_modes, six numbers": lambda: fx.natural_modes(hexapod, six),
        "fx.stability_index": lambda: fx.stability_index(hexapod, pose),
        "fx.inverse_kinematics": lambda: fx.inverse_kinematics(hexapod, pose),
        "fx.forward_dynamics": lambda: fx.forward_dynamics(hexapod, moving, leg_force=force),
        "fx.inverse_dynamics": lambda: fx.inverse_dynamics(hexapod, moving),
        "fx.linearise": lambda: fx.linearise(hexapod, pose),
        "compiled().stability_index": lambda: handle.stability_index(six),
        "compiled().natural_frequencies": lambda: handle.natural_frequencies(six),
        "compiled().leg_lengths": lambda: handle.leg_lengths(six),
        "compiled().jacobian": lambda: handle.jacobian(six),
        "compiled().forward_dynamics": lambda: handle.forward_dynamics(six, twist, force, zero),
        "compiled().inverse_dynamics": lambda: handle.inverse_dynamics(six, twist, acceleration, zero),
        "compiled().linearised": lambda: handle.linearised(six),
    }


def contests(plan: Plan) -> list[Contest]:
    """Every call in turn."""
    repeats = plan.size(2000, 2)
    return [
        Contest(
            "One call for one pose",
            "call",
            "",
            [Contender(OURS, "flexapod", name, cpu_seconds(call, repeats=repeats)) for name, call in calls().items()],
        )
    ]


def main() -> None:
    """Print the time of every call beside what it may take."""
    (contest,) = contests(Plan(quick=False))
    for record in take_turns(contest, TURNS):
        limit = next(limit for start, limit in LIMITS.items() if record.how.startswith(start))
        least = 1e6 * min(record.seconds)
        verdict = "met" if 1e6 * record.time <= limit else "NOT MET"
        print(
            f"{record.how:32s} median {1e6 * record.time:6.2f} us, least {least:6.2f} us (at most {limit:g}: {verdict})"
        )


if __name__ == "__main__":
    main()
