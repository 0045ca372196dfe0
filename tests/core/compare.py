"""The core compiled by other compilers and for other processors, against the installed one.

    python tests/core/compare.py

Each build that this machine has the tools for (clang++; aarch64-linux-gnu-g++ with qemu-aarch64) runs the kernel of the
sweeps and the equations of motion over random poses of the packaged designs. Rounding may differ, nothing else.
"""

import shutil
import subprocess
import sys
import tempfile
from functools import reduce
from operator import or_
from pathlib import Path
from typing import NamedTuple

import numpy as np

import flexapod as fx
from flexapod import _core

ROOT = Path(__file__).resolve().parents[2]
OPTIONS = [
    "-std=c++20",
    "-O3",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-ffp-contract=fast",
    "-Wall",
    "-Wextra",
    "-Werror",
]
POSES = 203  # not a multiple of any number of lanes
LENGTHS = {"omega": 6, "cond_H": 1, "leg_length": 6, "leg_distance": 1, "leg_force": 1, "lowest_stiffness": 1}
LENGTHS |= {"universal_angle": 6, "spherical_angle": 6, "omega_1_gradient": 6, "status": 1, "within_limits": 1}
CENTER = {"mukherjee-i": (0.0, 0.0, 0.89), "mukherjee-ii": (0.0, 0.0, 0.085)}  # where a design has no home
JOINT = _core.Joint.universal
TOLERANCE = 1e-11  # of the largest number of a pose; conditions here are below 1e3

LIMITS = _core.SweepLimits(  # as in check.cpp
    neutral=np.tile([0, 0, 1.0], 12),
    leg_length=np.tile([0, 1.0], 6),
    universal_angle=0.5,
    spherical_angle=0.5,
    leg_distance=0.01,
    universal_moment=np.inf,
    spherical_moment=np.inf,
)


class Build(NamedTuple):
    compiler: str
    options: tuple[str, ...] = ()
    run_by: tuple[str, ...] = ()

    def missing(self) -> list[str]:
        return [tool for tool in (self.compiler, *self.run_by[:1]) if shutil.which(tool) is None]

    def __str__(self) -> str:
        return " ".join([self.compiler, *self.options, *(["under", self.run_by[0]] if self.run_by else [])])


BUILDS = [
    Build("g++"),
    Build("g++", ("-DFLEXAPOD_PLAIN",)),
    Build(next(filter(shutil.which, ["clang++", "clang++-19", "clang++-16", "clang++-14"]), "clang++")),
    Build("aarch64-linux-gnu-g++", ("-static",), ("qemu-aarch64",)),
]


class Problem:
    """A machine, poses and motions about its middle, and what the installed core makes of them."""

    def __init__(self, name: str) -> None:
        hexapod, rng = fx.load(name), np.random.default_rng(5)
        home = hexapod.home
        middle = np.array([*CENTER[name], 0, 0, 0]) if home is None else np.array([*home.position, *home.rpy])
        poses = middle + rng.uniform(-0.1, 0.1, (POSES, 6)) * np.repeat([middle[2], 1.0], 3)
        motions = np.concatenate(
            [fx.Motion(fx.Pose.from_rpy(*poses.T)).packed[:, :12], rng.normal(size=(POSES, 12))], 1
        )
        self.input = np.concatenate([hexapod.packed, poses.ravel(), motions.ravel()]).tobytes()
        self.expected = _core.sweep(hexapod.packed, JOINT, poses, reduce(or_, _core.SweepQuantity), LIMITS, 1)
        rest = np.tile(fx.Motion(fx.Pose([0.0, 0.0, 0.0])).packed, (POSES, 1))
        force, wrench = np.zeros((POSES, 6)), np.ones((POSES, 6))
        self.expected["acceleration"] = _core.forward_dynamics(hexapod.packed, JOINT, motions, rest, force, wrench)


def difference(problem: Problem, output: bytes) -> float:
    """The largest difference of a pose's numbers, relative to the largest of them; infinite if a number is missing."""
    numbers = np.frombuffer(output)
    worst = []
    for name, length in (LENGTHS | {"acceleration": 6}).items():
        part, numbers = np.split(numbers, [POSES * length])
        found, expected = part.reshape(POSES, length), problem.expected[name].reshape(POSES, length).astype(float)
        scale = np.maximum(np.abs(expected).max(axis=1), 1e-9)
        worst.append((np.abs(found - expected).max(axis=1) / scale).max())
    return max(worst) if numbers.size == 0 and np.isfinite(worst).all() else np.inf


def check(build: Build, problems: dict[str, Problem], folder: Path) -> bool:
    program = folder / "check"
    sources = [ROOT / "tests" / "core" / "check.cpp", ROOT / "src" / "core" / "sweep" / "kernel.cpp"]
    options = [*OPTIONS, *build.options, f"-I{ROOT / 'src' / 'core'}", '-DFLEXAPOD_ISA="check"']
    subprocess.run([build.compiler, *options, *map(str, sources), "-o", str(program)], check=True)
    worst, lanes = 0.0, ""
    for problem in problems.values():
        done = subprocess.run([*build.run_by, str(program)], input=problem.input, capture_output=True, check=True)
        worst, lanes = max(worst, difference(problem, done.stdout)), done.stderr.decode().strip()
    good = worst <= TOLERANCE
    print(f"{build}: {lanes}, largest relative difference {worst:.1e}, {'good' if good else 'TOO LARGE'}")
    return good


def main() -> int:
    problems = {name: Problem(name) for name in fx.packaged_designs()}
    good = []
    with tempfile.TemporaryDirectory() as folder:
        for build in BUILDS:
            if build.missing():
                print(f"{build}: not tried, {' and '.join(build.missing())} not here")
            else:
                good.append(check(build, problems, Path(folder)))
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
