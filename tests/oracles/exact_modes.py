"""Frequencies and condition of a pose in 50-digit arithmetic, from the partial velocities of a leg's bodies.

Written apart from the core: inertia by Q_p = m_d G_d^T G_d + m_u G_u^T G_u + W^T (I_d + I_u) W (corrections, part A);
springs in joints by the rates of their angles, and a suspension by its twist. Matrices are arrays of mpmath's numbers:
those of mpmath itself take several times as long.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from mpmath import mp

from flexapod.design.packing import PLACES

DIGITS = 50


@dataclass(frozen=True, eq=False)
class ExactModes:
    omega: np.ndarray  # (6,) ascending, as float64
    cond_B: float
    H: np.ndarray  # (6, 6) exact: wrench for each leg's unit force

    @cached_property
    def cond_H(self) -> float:
        with mp.workdps(DIGITS):
            sigma = singular_values(self.H)
            return float(sigma[5] / sigma[0])


def exact_modes(hexapod, pose, universal: bool = True) -> ExactModes:
    """`pose`: six float64 numbers, metres and radians, taken as exact."""
    with mp.workdps(DIGITS):
        R, t = rotation(*exact(pose[3:])), exact(pose[:3])
        H, J = np.zeros((6, 6), dtype=object), platform_inertia(hexapod, R)
        for i in range(6):
            q = R @ exact(hexapod.platform_joints[i])
            S = t + q - exact(hexapod.base_joints[i])
            L = norm(S)
            s = S / L
            H[:, i] = np.concatenate([s, cross(q, s)])
            side = np.concatenate([np.eye(3, dtype=object), tilde(q)])
            J = J + side @ leg_inertia(hexapod, i, s, L, universal) @ side.T
        compliance = 1 / exact(hexapod.legs.stiffness) + exact(hexapod.packed[PLACES["legs.series_compliance"]])
        L, F = inverse(mp.cholesky(mp.matrix(J.tolist()))), H * [1 / mp.sqrt(c) for c in compliance]
        sigma = square_roots(hexapod, R, t, L, F, universal) if hexapod.sprung else singular_values(L @ F)
        return ExactModes(np.array([float(x) for x in sigma]), float(sigma[5] / sigma[0]), H)


def square_roots(hexapod, R, t, L, F, universal) -> list:
    """Roots of the eigenvalues of L K L^T with all springs; so many digits that their squares lose none."""
    with mp.workdps(3 * DIGITS):
        K = F @ F.T + joint_stiffness(hexapod, R, t, universal)
        if hexapod.suspension is not None:
            twist = np.eye(6, dtype=object)
            twist[:3, 3:] = -tilde(R @ exact(hexapod.suspension.point))
            K = K + twist.T @ exact(hexapod.suspension.stiffness) @ twist
        return sorted(mp.sqrt(x) for x in mp.eigsy(mp.matrix((L @ K @ L.T).tolist()), eigvals_only=True))


def joint_stiffness(hexapod, R, t, universal):
    springs, K = hexapod.legs.joint_stiffness, np.zeros((6, 6), dtype=object)
    for i in range(6):
        q = R @ exact(hexapod.platform_joints[i])
        S = t + q - exact(hexapod.base_joints[i])
        length = norm(S)
        s, k = S / length, exact(hexapod.universal_axes[i])
        y = cross(k, s)
        sine = norm(y)
        y = y / sine
        z = cross(s, y)
        n = cross(k, y) if universal else s
        velocity = np.concatenate([np.eye(3, dtype=object), -tilde(q)], axis=1)
        leg = across(s, n) @ tilde(s) / length @ velocity
        turn = np.concatenate([np.zeros((3, 3), dtype=object), np.eye(3, dtype=object)], axis=1) - leg
        rates = np.stack([z @ leg / (sine if universal else 1), y @ leg, y @ turn, z @ turn, s @ turn])
        stiff = [*springs.universal[i], springs.spherical[i], springs.spherical[i], springs.torsion[i]]
        K = K + rates.T * exact(stiff) @ rates
    return K


def singular_values(A) -> list:
    return sorted(mp.svd_r(mp.matrix(A.tolist()), compute_uv=False))


def leg_inertia(hexapod, i, s, L, universal):
    k = exact(hexapod.universal_axes[i])
    y = cross(k, s)
    y = y / norm(y)
    n = cross(k, y) if universal else s
    W = across(s, n) @ tilde(s) / L
    axes = np.stack([s, y, cross(s, y)], axis=1)
    Q = np.zeros((3, 3), dtype=object)
    for name, from_base in (("lower", True), ("upper", False)):
        part = getattr(hexapod.legs, name)
        G = -tilde(axes @ exact(part.mass_center[i])) @ W
        if not from_base:
            G = G + np.eye(3, dtype=object)
        turned = axes.T @ W
        Q = Q + exact(part.mass[i]) * (G.T @ G) + turned.T @ exact(part.inertia[i]) @ turned
    return Q


def platform_inertia(hexapod, R):
    M, r = exact(hexapod.platform_mass), tilde(R @ exact(hexapod.platform_mass_center))
    about = R @ exact(hexapod.platform_inertia) @ R.T - r @ r * M
    return np.block([[np.eye(3, dtype=object) * M, -r * M], [r * M, about]])


def rotation(roll, pitch, yaw):
    (cr, cp, cy), (sr, sp, sy) = ([f(a) for a in (roll, pitch, yaw)] for f in (mp.cos, mp.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def exact(x) -> np.ndarray:
    """Numbers of float64 as they are."""
    return np.vectorize(lambda c: mp.mpf(float(c)), otypes=[object])(x)


def inverse(A) -> np.ndarray:
    return np.array((A**-1).tolist())


def norm(a):
    return mp.sqrt(a @ a)


def across(s, n):
    """(3, 3): takes away what lies along s, seen along n."""
    return np.eye(3, dtype=object) - np.outer(s, n) / (n @ s)


def tilde(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def cross(a, b):
    return tilde(a) @ b
