"""Frequencies and condition of a pose in 50-digit arithmetic, from the partial velocities of a leg's bodies.

Written apart from the core: inertia by Q_p = m_d G_d^T G_d + m_u G_u^T G_u + W^T (I_d + I_u) W (corrections, part A);
springs in joints by the rates of their angles, and a suspension by its twist.
"""

from typing import NamedTuple

import numpy as np
from mpmath import mp

from flexapod.design.packing import PLACES

DIGITS = 50


class ExactModes(NamedTuple):
    omega: np.ndarray  # (6,) ascending, as float64
    cond_B: float
    cond_H: float


def exact_modes(hexapod, pose, universal: bool = True) -> ExactModes:
    """`pose`: six float64 numbers, metres and radians, taken as exact."""
    with mp.workdps(DIGITS):
        R, t = rotation(*(mp.mpf(float(a)) for a in pose[3:])), vector(pose[:3])
        H, J = mp.zeros(6), platform_inertia(hexapod, R)
        for i in range(6):
            q = R * vector(hexapod.platform_joints[i])
            S = t + q - vector(hexapod.base_joints[i])
            L = mp.norm(S)
            s = S / L
            H[0:3, i], H[3:6, i] = s, tilde(q) * s
            Q = leg_inertia(hexapod, i, s, L, universal)
            side = mp.zeros(6, 3)
            side[0:3, :], side[3:6, :] = mp.eye(3), tilde(q)
            J += side * Q * side.T
        compliance = [1 / mp.mpf(float(k)) for k in hexapod.legs.stiffness]
        series = [mp.mpf(float(c)) for c in hexapod.packed[PLACES["legs.series_compliance"]]]
        root_K = mp.diag([1 / mp.sqrt(a + b) for a, b in zip(compliance, series, strict=True)])
        L, F = mp.cholesky(J) ** -1, H * root_K
        sigma = square_roots(hexapod, R, t, L, F, universal) if hexapod.sprung else singular_values(L * F)
        sigma_H = singular_values(H)
        omega = np.array([float(x) for x in sigma])
        return ExactModes(omega, float(sigma[5] / sigma[0]), float(sigma_H[5] / sigma_H[0]))


def square_roots(hexapod, R, t, L, F, universal) -> list:
    """Roots of the eigenvalues of L K L^T with all springs; so many digits that their squares lose none."""
    with mp.workdps(3 * DIGITS):
        K = F * F.T + joint_stiffness(hexapod, R, t, universal)
        if hexapod.suspension is not None:
            p = R * vector(hexapod.suspension.point)
            twist = mp.eye(6)
            twist[0:3, 3:6] = -tilde(p)
            K += twist.T * mp.matrix(hexapod.suspension.stiffness.tolist()) * twist
        return sorted(mp.sqrt(x) for x in mp.eigsy(L * K * L.T, eigvals_only=True))


def joint_stiffness(hexapod, R, t, universal):
    springs, K = hexapod.legs.joint_stiffness, mp.zeros(6)
    for i in range(6):
        q = R * vector(hexapod.platform_joints[i])
        S = t + q - vector(hexapod.base_joints[i])
        length = mp.norm(S)
        s, k = S / length, vector(hexapod.universal_axes[i])
        y = cross(k, s)
        sine = mp.norm(y)
        y = y / sine
        z = cross(s, y)
        n = cross(k, y) if universal else s
        velocity = mp.zeros(3, 6)
        velocity[:, 0:3], velocity[:, 3:6] = mp.eye(3), -tilde(q)
        leg = (mp.eye(3) - s * n.T / dot(n, s)) * tilde(s) / length * velocity
        turn = mp.zeros(3, 6)
        turn[:, 3:6] = mp.eye(3)
        turn = turn - leg
        rates = [z.T * leg / (sine if universal else 1), y.T * leg, y.T * turn, z.T * turn, s.T * turn]
        stiff = [*springs.universal[i], springs.spherical[i], springs.spherical[i], springs.torsion[i]]
        for rate, stiffness in zip(rates, stiff, strict=True):
            K += mp.mpf(float(stiffness)) * rate.T * rate
    return K


def singular_values(A) -> list:
    return sorted(mp.svd_r(A, compute_uv=False))


def leg_inertia(hexapod, i, s, L, universal):
    k = vector(hexapod.universal_axes[i])
    y = cross(k, s)
    y = y / mp.norm(y)
    n = cross(k, y) if universal else s
    P = mp.eye(3) - s * n.T / dot(n, s)
    W = P * tilde(s) / L
    axes = mp.zeros(3)
    axes[:, 0], axes[:, 1], axes[:, 2] = s, y, cross(s, y)
    Q = mp.zeros(3)
    for name, from_base in (("lower", True), ("upper", False)):
        part = getattr(hexapod.legs, name)
        r = axes * vector(part.mass_center[i])
        G = -tilde(r) * W + (mp.zeros(3) if from_base else mp.eye(3))
        inertia = axes * mp.matrix(part.inertia[i].tolist()) * axes.T
        Q += mp.mpf(float(part.mass[i])) * G.T * G + W.T * inertia * W
    return Q


def platform_inertia(hexapod, R):
    M, r = mp.mpf(hexapod.platform_mass), tilde(R * vector(hexapod.platform_mass_center))
    J = mp.zeros(6)
    J[0:3, 0:3], J[0:3, 3:6], J[3:6, 0:3] = M * mp.eye(3), -M * r, M * r
    J[3:6, 3:6] = R * mp.matrix(hexapod.platform_inertia.tolist()) * R.T - M * r * r
    return J


def rotation(roll, pitch, yaw):
    (cr, cp, cy), (sr, sp, sy) = ([f(a) for a in (roll, pitch, yaw)] for f in (mp.cos, mp.sin))
    return mp.matrix(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def vector(x):
    return mp.matrix([mp.mpf(float(c)) for c in x])


def dot(a, b):
    return (a.T * b)[0]


def tilde(a):
    return mp.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def cross(a, b):
    return tilde(a) * b
