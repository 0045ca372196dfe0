"""Simulations and forward dynamics, compiled for each instruction set: all compute the same and share no function."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import flexapod as fx
from flexapod import _core

WORK = """
import json
import numpy as np
import flexapod as fx
from flexapod import _core
from flexapod.simulation.integrator import IntegratorOptions, equations, integrate
hexapod, pose = fx.load("mukherjee-ii"), fx.Pose([0, 0, 0.085])
base = fx.harmonic("z", 1e-5, 700.0) + fx.harmonic("roll", 1e-3, 300.0)
run = fx.simulation.SimulationRun(hexapod, pose, base_motion=base, force=fx.harmonic("x", 0.5, 90.0))
found = integrate([run], [0.004, 0.01], options=IntegratorOptions(rtol=1e-10), works=True)
moving = fx.Motion(pose, [0.1, -0.2, 0.3], [1.0, 2.0, -1.5])
a, alpha = fx.forward_dynamics(hexapod, moving, leg_force=[1, 2, -1, 0.5, -0.3, 1.5])
eq = equations(run)
rate = eq.rates(1e-4, eq.start() + 1e-4)
rows = (found.relative, found.work, found.platform, np.concatenate([a, alpha]), rate)
print(json.dumps([_core.simd(), *(row.ravel().tolist() for row in rows)]))
"""


def outcome(isa):
    environment = {**os.environ, "FLEXAPOD_SIMD": isa}
    done = subprocess.run([sys.executable, "-c", WORK], env=environment, capture_output=True, text=True, check=True)
    used, *rows = json.loads(done.stdout)
    assert used == isa
    return [np.array(row) for row in rows]


def test_every_instruction_set_simulates_the_same():
    first, *others = (outcome(isa) for isa in _core.simd_available())
    assert all(np.abs(row).max() > 0 for row in first)
    for other in others:
        for a, b in zip(first, other, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-8, atol=1e-9 * np.abs(a).max())


def test_inertia_that_is_not_positive_definite_gives_no_acceleration():
    hexapod = fx.load("mukherjee-ii")
    hopeless = hexapod.replace({"legs.lower.inertia": -0.1 * np.eye(3), "platform.inertia": 1e-9 * np.eye(3)})
    a, alpha = fx.forward_dynamics(hopeless, fx.Pose([0, 0, 0.085]))
    assert np.isnan([a, alpha]).all()


def test_kernels_share_no_function_with_the_rest():
    """A function that two files define is linked once: one for a new processor would then run on an old one."""
    root = Path(__file__).parents[2]
    objects = [path for isa in ("avx2", "avx512") for path in root.glob(f"build/*/CMakeFiles/kernel_{isa}.dir/**/*.o")]
    if not objects or not shutil.which("nm"):
        pytest.skip("the core's object files, or nm, are not here")
    for path in objects:
        lines = subprocess.run(["nm", str(path)], capture_output=True, text=True, check=True).stdout.splitlines()
        shared = [line.split()[-1] for line in lines if line.split()[-2] in ("W", "u")]
        assert not [name for name in shared if "flexapod_avx" not in name], path
