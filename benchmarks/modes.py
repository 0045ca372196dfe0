"""Natural frequencies at one pose, by one call from Python: what a user's own loop or optimiser pays.

The machine is manipulator II with legs that all tools can have.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import flexapod as fx
from benchmarks._arrays import array_modes
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds
from benchmarks._vibration import WANTED, machine


def contests(plan: Plan) -> list[Contest]:
    """Six natural frequencies at one pose."""
    hexapod, pose = machine()
    six = np.concatenate([pose.position, np.zeros(3)])
    ours = fx.natural_modes(hexapod, pose).omega

    def contender(tool: str, package: str, how: str, omega: Callable[[], Any], calls: int, limit: float) -> Contender:
        error = None if tool == OURS else float(np.abs(omega() / ours - 1).max())
        return Contender(tool, package, how, cpu_seconds(omega, repeats=plan.size(calls, 1)), error, limit)

    found = [
        contender(OURS, "flexapod", "fx.natural_modes", lambda: fx.natural_modes(hexapod, pose).omega, 300, 0),
        contender("NumPy + LAPACK", "numpy", "as for many poses", lambda: array_modes(np, hexapod, six)[0], 30, 1e-8),
    ]
    if plan.has("pin"):
        from benchmarks._pinocchio import PinocchioModes

        modes = PinocchioModes(hexapod)
        found.append(contender("Pinocchio", "pin", "crba and Jacobians, LAPACK", lambda: modes(six)[0], 30, 1e-8))
    if plan.has("exudyn"):
        from benchmarks._exudyn import Machine

        tied = Machine(hexapod, pose)
        found.append(contender("Exudyn", "exudyn", "ComputeODE2Eigenvalues", tied.frequencies, 10, WANTED))
    return [Contest("Natural frequencies, one pose", "call", "frequencies, relative", found)]
