"""Poses per second: the sweep's kernel, NumPy with LAPACK in batches, JAX if installed, Pinocchio pose by pose.

All compute the same: the lowest frequency, or all six, and cond(H), of the paper's manipulator I at random poses. They
take turns; what is printed is the median over the turns, and the median of each turn's ratio to NumPy. The share of the
peak is useful work (each sum, product, quotient and root of each pose once, counted by running the kernel over a scalar
that counts) over what a loop of independent multiply-adds of the same vector width reaches in the same turn.
"""

import multiprocessing
import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from statistics import median

import numpy as np

import flexapod as fx
from flexapod import _core

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

TURNS = 9
KERNEL_POSES, BATCH_POSES, PINOCCHIO_POSES = 400_000, 4_000, 20
TASKS = {"omega_1 + cond_H": ("omega_1", "cond_H"), "all six + cond_H": ("omega", "cond_H")}
THREADS = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def random_poses(n: int) -> np.ndarray:
    middle, half = np.array([0.1, 0.2, 0.8, 0, 0, 0]), np.array([0.15, 0.15, 0.15, 0.3, 0.3, 0.3])
    return middle + half * np.random.default_rng(1).uniform(-1, 1, (n, 6))


def no_limits() -> np.ndarray:
    return np.concatenate([np.zeros(36), np.tile([-np.inf, np.inf], 6), [np.inf, np.inf, -np.inf]])


def bits(quantities: tuple[str, ...]) -> int:
    return sum(_core.SWEEP[q] for q in quantities)


# --- the kernel, in a process of its own for each instruction set ---------------------------------------------------


def kernel_rate(quantities: tuple[str, ...], threads: int) -> float:
    design, poses = fx.load("mukherjee-i").packed, random_poses(KERNEL_POSES)
    arguments = design, True, poses, bits(quantities), no_limits(), threads
    _core.sweep(*arguments)
    return KERNEL_POSES / seconds(lambda: _core.sweep(*arguments))


def peak_rate() -> float:
    """FLOP/s of one thread."""
    rounds = 4_000_000
    start = time.perf_counter()
    return _core.peak_flops(rounds) / (time.perf_counter() - start)


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


# --- the same in arrays: NumPy, and JAX under jit(vmap) -------------------------------------------------------------


def array_modes(xp, hexapod: fx.Hexapod, poses):
    """J_p and H by matrices over the leading axes of `poses`, then LAPACK: (omega ascending, cond_H)."""
    R = rotations(xp, poses[..., 3:])
    q = xp.einsum("...ij,kj->...ki", R, xp.asarray(hexapod.platform_joints))
    S = poses[..., None, :3] + q - xp.asarray(hexapod.base_joints)
    L = xp.linalg.norm(S, axis=-1, keepdims=True)
    s = S / L
    y = xp.cross(xp.broadcast_to(xp.asarray(hexapod.universal_axes), s.shape), s)
    y = y / xp.linalg.norm(y, axis=-1, keepdims=True)
    axes = xp.stack([s, y, xp.cross(s, y)], axis=-1)  # leg axes as columns
    H = xp.swapaxes(xp.concatenate([s, xp.cross(q, s)], axis=-1), -1, -2)
    J = platform_matrix(xp, hexapod, R) + leg_matrices(xp, hexapod, axes, L[..., None], q)
    root_K = np.sqrt(hexapod.legs.stiffness)
    B = xp.linalg.solve(xp.linalg.cholesky(J), H * root_K)
    sigma_H = xp.linalg.svd(H, compute_uv=False)
    return xp.linalg.svd(B, compute_uv=False)[..., ::-1], sigma_H[..., 0] / sigma_H[..., -1]


def leg_matrices(xp, hexapod, axes, L, q):
    """The sum of the legs' inertias at the platform, from partial velocities in leg axes (universal joints)."""
    k = xp.einsum("...lij,li->...lj", axes, xp.asarray(hexapod.universal_axes))  # k in leg axes: (k.s, 0, k.z)
    tau = (k[..., 0] / k[..., 2])[..., None, None]
    W = (tau * np.array([[0.0, 1, 0], [0, 0, 0], [0, 0, 0]]) + np.array([[0.0, 0, 0], [0, 0, -1], [0, 1, 0]])) / L
    Q = 0.0
    for part, moves in ((hexapod.legs.lower, 0.0), (hexapod.legs.upper, 1.0)):
        G = moves * np.eye(3) - tilde(np, np.asarray(part.mass_center)) @ W
        m = np.asarray(part.mass)[:, None, None]
        Q = Q + m * (xp.swapaxes(G, -1, -2) @ G) + xp.swapaxes(W, -1, -2) @ (np.asarray(part.inertia) @ W)
    Q = axes @ Q @ xp.swapaxes(axes, -1, -2)
    qt = tilde(xp, q)
    side = xp.concatenate([xp.broadcast_to(xp.eye(3), qt.shape), qt], axis=-2)
    return (side @ Q @ xp.swapaxes(side, -1, -2)).sum(axis=-3)


def platform_matrix(xp, hexapod, R):
    M, r = hexapod.platform_mass, tilde(xp, R @ np.asarray(hexapod.platform_mass_center))
    I = R @ np.asarray(hexapod.platform_inertia) @ xp.swapaxes(R, -1, -2) - M * r @ r
    top = xp.concatenate([xp.broadcast_to(M * xp.eye(3), r.shape), -M * r], axis=-1)
    return xp.concatenate([top, xp.concatenate([M * r, I], axis=-1)], axis=-2)


def tilde(xp, a):
    zero = xp.zeros_like(a[..., 0])
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    rows = ([zero, -z, y], [z, zero, -x], [-y, x, zero])
    return xp.stack([xp.stack(row, axis=-1) for row in rows], axis=-2)


def rotations(xp, rpy):
    (cr, cp, cy), (sr, sp, sy) = ([f(rpy[..., i]) for i in range(3)] for f in (xp.cos, xp.sin))
    rows = (
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    )
    return xp.stack([xp.stack(row, axis=-1) for row in rows], axis=-2)


def numpy_rate(hexapod, poses) -> float:
    return len(poses) / seconds(lambda: array_modes(np, hexapod, poses))


def jax_contender(hexapod, poses) -> Callable[[], float] | None:
    try:
        import jax
        import jax.numpy as jnp
    except ImportError:
        return None
    jax.config.update("jax_enable_x64", True)
    run = jax.jit(jax.vmap(lambda pose: array_modes(jnp, hexapod, pose)))
    jax.block_until_ready(run(poses))  # compiles
    return lambda: len(poses) / seconds(lambda: jax.block_until_ready(run(poses)))


# --- Pinocchio, pose by pose -----------------------------------------------------------------------------------------


class PinocchioModes:
    """One model for all poses: fixed base, free platform, six universal and prismatic legs cut at the platform."""

    def __init__(self, hexapod) -> None:
        import pinocchio as pin

        from engine import _add_legs, _add_platform

        self.pin, self.hexapod, self.model = pin, hexapod, pin.Model()
        origin, home = fx.Pose([0, 0, 0]), fx.home_pose(hexapod)
        _add_platform(self.model, hexapod, origin)
        self.legs = _add_legs(self.model, hexapod, home, origin, parent=0)
        self.data = self.model.createData()
        self.home = self._leg_coordinates(home)

    def _leg_coordinates(self, pose):
        """Turn about k from a fixed direction, tilt, length; one row a leg."""
        h = self.hexapod
        S = pose.matrix @ h.platform_joints[..., None]
        S = S[..., 0] + pose.position - h.base_joints
        k = h.universal_axes
        y = np.cross(k, S)
        along = np.einsum("ij,ij->i", k, S)
        fixed = np.cross(k, np.roll(k, 1, axis=1) + np.array([0.3, -0.2, 0.1]))
        turn = np.arctan2(np.einsum("ij,ij->i", k, np.cross(fixed, y)), np.einsum("ij,ij->i", fixed, y))
        return np.stack([turn, -np.arctan2(along, np.linalg.norm(y, axis=1)), np.linalg.norm(S, axis=1)], axis=1)

    def __call__(self, six):
        pin, model, data = self.pin, self.model, self.data
        pose = fx.Pose.from_rpy(*six)
        q = pin.neutral(model)
        q[:7] = pin.SE3ToXYZQUAT(pin.SE3(np.array(pose.matrix), np.array(pose.position)))
        q[7:] = (self._leg_coordinates(pose) - self.home).ravel()
        mass = np.triu(pin.crba(model, data, q))
        mass += np.triu(mass, 1).T
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        frame = [
            [pin.getFrameJacobian(model, data, f, pin.LOCAL_WORLD_ALIGNED)[:3] for f in (leg.end, leg.socket)]
            for leg in self.legs
        ]
        closure = np.vstack([end - socket for end, socket in frame])
        allowed = np.zeros((24, 6))
        allowed[:6] = np.kron(np.eye(2), pose.matrix.T)
        allowed[6:] = np.linalg.solve(closure[:, 6:], -closure[:, :6] @ allowed[:6])
        H = allowed[8::3].T  # rates of the prismatic joints
        B = np.linalg.solve(np.linalg.cholesky(allowed.T @ mass @ allowed), H * np.sqrt(self.hexapod.legs.stiffness))
        sigma_H = np.linalg.svd(H, compute_uv=False)
        return np.linalg.svd(B, compute_uv=False)[::-1], sigma_H[0] / sigma_H[-1]


# --- the contest -----------------------------------------------------------------------------------------------------


def check(hexapod, poses, pinocchio) -> None:
    """All contenders compute the same: to rounding times the condition."""
    found = _core.sweep(hexapod.packed, True, poses, bits(("omega", "cond_H")), no_limits(), 1)
    omega, cond_H = array_modes(np, hexapod, poses)
    error = np.abs(found["omega"] / omega - 1).max(axis=1) / (omega[:, 5] / omega[:, 0])
    assert error.max() < 1e-13, error.max()
    assert np.abs(found["cond_H"] / cond_H - 1).max() < 1e-9
    for six, exact in zip(poses[:PINOCCHIO_POSES], omega, strict=False):
        np.testing.assert_allclose(pinocchio(six)[0], exact, rtol=1e-9)


def main() -> None:
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
    peaks = {f"peak {name}": lambda k=kernel: k(peak_rate) for name, kernel in kernels.items()}
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
        flops = _core.sweep_flops(hexapod.packed, True, random_poses(2_000), bits(quantities))
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
