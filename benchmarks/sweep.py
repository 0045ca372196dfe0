"""Poses per second: the sweep's kernel, NumPy with LAPACK in batches, JAX if installed, Pinocchio pose by pose.

All compute the same: the lowest frequency, or all six, and cond(H), of the paper's manipulator I at random poses. They
take turns; what is printed is the median over the turns, and the median of each turn's ratio to NumPy. The share of the
peak is useful work (each sum, product, quotient and root of each pose once, counted by running the kernel over a scalar
that counts) over what a loop of independent multiply-adds of the same vector width reaches in the same turn.
"""

import multiprocessing
import os
import subprocess
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import reduce
from operator import or_
from pathlib import Path
from statistics import median

import numpy as np

import flexapod as fx
from benchmarks._arrays import array_modes
from benchmarks._contest import OURS, Contender, Contest, Plan, cpu_seconds
from flexapod import _core

TURNS = 9
BENCH = Path(__file__).parents[1] / "build" / "bench" / "flexapod_bench"
KERNEL_POSES, BATCH_POSES, PINOCCHIO_POSES = 400_000, 4_000, 20
TASKS = {"omega_1 + cond_H": ("omega_1", "cond_H"), "all six + cond_H": ("omega", "cond_H")}
THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def random_poses(n: int) -> np.ndarray:
    middle, half = np.array([0.1, 0.2, 0.8, 0, 0, 0]), np.array([0.15, 0.15, 0.15, 0.3, 0.3, 0.3])
    return middle + half * np.random.default_rng(1).uniform(-1, 1, (n, 6))


def bits(quantities: tuple[str, ...]) -> _core.SweepQuantity:
    return reduce(or_, (_core.SweepQuantity[q] for q in quantities))


# --- the kernel, in a process of its own for each instruction set ---------------------------------------------------


def kernel_rate(quantities: tuple[str, ...], threads: int) -> float:
    design, poses = fx.load("mukherjee-i").packed, random_poses(KERNEL_POSES)
    arguments = design, _core.Joint.universal, poses, bits(quantities), _core.SweepLimits(), threads
    _core.sweep(*arguments)
    return KERNEL_POSES / seconds(lambda: _core.sweep(*arguments))


def bench(*arguments: str, given: bytes = b"") -> float:
    """What the program that `make bench` builds prints."""
    if not BENCH.exists():
        raise SystemExit("the operations of a pose and the processor's peak need a program of their own: make bench")
    return float(subprocess.run([BENCH, *arguments], input=given, capture_output=True, check=True).stdout)


def peak_rate(instruction_set: str) -> float:
    """FLOP/s of one thread."""
    return bench("peak", instruction_set, "4000000")


def flops_of_a_pose(hexapod, quantities: tuple[str, ...]) -> float:
    """Sums, products, quotients and roots, the mean over random poses."""
    numbers = hexapod.packed.tobytes() + random_poses(2_000).tobytes()
    return bench("flops", str(bits(quantities).value), given=numbers)


def seconds(call: Callable) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


class Kernel:
    def __init__(self, name: str) -> None:
        os.environ["FLEXAPOD_SIMD"] = name  # read when the process imports the core
        self.pool = ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn"))
        assert self.pool.submit(_core_name).result() == name
        del os.environ["FLEXAPOD_SIMD"]

    def __call__(self, function: Callable, *arguments) -> float:
        return self.pool.submit(function, *arguments).result()


def _core_name() -> str:
    return _core.simd()


# --- the same by others ----------------------------------------------------------------------------------------------


def numpy_rate(hexapod, poses) -> float:
    return len(poses) / seconds(lambda: array_modes(np, hexapod, poses))


def jax_modes(hexapod) -> Callable:
    """The same under jit(vmap), in double precision: waits for the result."""
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    run = jax.jit(jax.vmap(lambda pose: array_modes(jnp, hexapod, pose)))
    return lambda poses: jax.block_until_ready(run(poses))


def jax_contender(hexapod, poses) -> Callable[[], float] | None:
    try:
        run = jax_modes(hexapod)
    except ImportError:
        return None
    run(poses)  # compiles
    return lambda: len(poses) / seconds(lambda: run(poses))


# --- for the table of all tools --------------------------------------------------------------------------------------

BATCHES = (250, 1000, 4000, 16000)


def contests(plan: Plan) -> list[Contest]:
    """The lowest frequency and cond(H) of many poses, on one core."""
    hexapod = fx.load("mukherjee-i")
    poses, few = random_poses(plan.size(KERNEL_POSES, 4000)), random_poses(plan.size(PINOCCHIO_POSES, 4))
    quantities = TASKS["omega_1 + cond_H"]
    isa = _core.simd()
    contenders = [
        Contender(
            OURS,
            "flexapod",
            f"fx.sweep, {len(poses)} poses, {isa}",
            cpu_seconds(lambda: fx.sweep(hexapod, poses, quantities=quantities, threads=1), len(poses)),
        ),
        _batched(plan, hexapod, "NumPy + LAPACK", "numpy", lambda poses: array_modes(np, hexapod, poses)),
    ]
    if plan.has("jax"):
        contenders.append(_batched(plan, hexapod, "JAX", "jax", jax_modes(hexapod)))
    if plan.has("pin"):
        from benchmarks._pinocchio import PinocchioModes

        modes = PinocchioModes(hexapod)
        found = [modes(six) for six in few]
        error = _error(hexapod, few, np.array([omega for omega, _ in found]), np.array([c for _, c in found]))
        run = cpu_seconds(lambda: [modes(six) for six in few], len(few))
        contenders.append(Contender("Pinocchio", "pin", "crba and Jacobians pose by pose, LAPACK", run, error, 1e-8))
    return [Contest("Pose sweep", "pose", "omega_1 and cond(H), relative", contenders)]


def _batched(plan: Plan, hexapod, tool: str, package: str, modes: Callable) -> Contender:
    """A tool that takes poses in batches, of the size that suits it best."""
    runs = {}
    for size in BATCHES[: plan.size(len(BATCHES), 1)]:
        batch = random_poses(size)
        error = _error(hexapod, batch, *modes(batch))  # compiles, where there is something to compile
        runs[size] = Contender(
            tool,
            package,
            f"batches of {size}" + (", jit(vmap), compiled before" if tool == "JAX" else ""),
            cpu_seconds(lambda batch=batch: modes(batch), size, max(1, 4000 // size)),
            error,
            1e-8,
        )
    return min(runs.values(), key=lambda c: min(c.run() for _ in range(3)))


def _error(hexapod, poses, omega, cond_H) -> float:
    ours = fx.sweep(hexapod, poses, quantities=("omega_1", "cond_H"))
    pairs = ((np.asarray(omega)[:, 0], ours.omega_1.values), (np.asarray(cond_H), ours.cond_H.values))
    return max(float(np.abs(theirs / own - 1).max()) for theirs, own in pairs)


# --- the sweep in depth ----------------------------------------------------------------------------------------------


def check(hexapod, poses, pinocchio) -> None:
    """All contenders compute the same: to rounding times the condition."""
    found = _core.sweep(hexapod.packed, _core.Joint.universal, poses, bits(("omega", "cond_H")), _core.SweepLimits(), 1)
    omega, cond_H = array_modes(np, hexapod, poses)
    error = np.abs(found["omega"] / omega - 1).max(axis=1) / (omega[:, 5] / omega[:, 0])
    assert error.max() < 1e-13, error.max()
    assert np.abs(found["cond_H"] / cond_H - 1).max() < 1e-9
    for six, exact in zip(poses[:PINOCCHIO_POSES], omega, strict=False):
        np.testing.assert_allclose(pinocchio(six)[0], exact, rtol=1e-9)


def main() -> None:
    from benchmarks._pinocchio import PinocchioModes

    hexapod, poses = fx.load("mukherjee-i"), random_poses(BATCH_POSES)
    pinocchio = PinocchioModes(hexapod)
    check(hexapod, poses, pinocchio)
    kernels = {name: Kernel(name) for name in _core.simd_available()}
    contenders: dict[str, Callable[[], float]] = {}
    for task, quantities in TASKS.items():
        for name, kernel in kernels.items():
            for threads in sorted({1, THREADS}):
                label = f"{task:17s} {name:8s} {threads} thread{'s' * (threads > 1)}"
                contenders[label] = lambda k=kernel, q=quantities, t=threads: k(kernel_rate, q, t)
    contenders["both              NumPy + LAPACK"] = lambda: numpy_rate(hexapod, poses)
    jax = jax_contender(hexapod, poses)
    if jax:
        contenders["both              JAX jit(vmap)"] = jax
    contenders["both              Pinocchio"] = lambda: (
        PINOCCHIO_POSES / seconds(lambda: [pinocchio(six) for six in poses[:PINOCCHIO_POSES]])
    )
    peaks = {f"peak {name}": lambda name=name: peak_rate(name) for name in kernels}
    turns = [{label: run() for label, run in (contenders | peaks).items()} for _ in range(TURNS)]
    report(hexapod, contenders, turns)
    for kernel in kernels.values():
        kernel.pool.shutdown()


def report(hexapod, contenders, turns) -> None:
    print(f"{'':42s} {'poses/s':>10s} {'best':>10s} {'x NumPy':>8s}")
    for label in contenders:
        rate = [turn[label] for turn in turns]
        ratio = median(turn[label] / turn["both              NumPy + LAPACK"] for turn in turns)
        print(f"{label:42s} {median(rate):10.3g} {max(rate):10.3g} {ratio:8.1f}")
    for task, quantities in TASKS.items():
        flops = flops_of_a_pose(hexapod, quantities)
        shares = []
        for name in _core.simd_available():
            label = f"{task:17s} {name:8s} 1 thread"
            share = median(flops * turn[label] / turn[f"peak {name}"] for turn in turns)
            shares.append(f"{name} {share:.0%} of {median(turn[f'peak {name}'] for turn in turns) / 1e9:.0f} GFLOP/s")
        print(f"{task}: {flops:.0f} flops a pose; share of the peak, one thread: {', '.join(shares)}")
    if not any("JAX" in label for label in contenders):
        print("JAX is not installed: pip install jax to compare with it")


if __name__ == "__main__":
    main()
