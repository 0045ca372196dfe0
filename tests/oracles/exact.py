"""Natural frequencies in 50-digit arithmetic, from the partial-velocity form of the theory: an oracle for rounding.

It shares no formula with the core, which works in leg axes and never forms the matrices W, G_d, G_u below.
"""

import mpmath as mp


def natural_frequencies(hexapod, pose, joint: str = "universal", digits: int = 50) -> list:
    """The six frequencies (rad/s, ascending) as mpmath numbers, base at the origin."""
    with mp.workdps(digits):
        t, R = _column(pose.position), mp.matrix(pose.matrix.tolist())
        center = R * _column(hexapod.platform_mass_center)
        J = _seen_from(center, mp.mpf(hexapod.platform_mass) * mp.eye(3))
        J[3:, 3:] += R * mp.matrix(hexapod.platform_inertia.tolist()) * R.T
        B = mp.zeros(6)
        for i in range(6):
            q = R * _column(hexapod.platform_joints[i])
            S = t + q - _column(hexapod.base_joints[i])
            s = S / mp.norm(S)
            J += _seen_from(q, _leg_inertia(hexapod, i, S, joint))
            root = mp.sqrt(float(hexapod.legs.stiffness[i]))
            B[:3, i], B[3:, i] = root * s, root * _cross(q, s)
        return sorted(mp.svd_r(mp.inverse(mp.cholesky((J + J.T) / 2)) * B, compute_uv=False))


def _leg_inertia(hexapod, i: int, S, joint: str):
    """Q_p = m_d G_d^T G_d + m_u G_u^T G_u + W^T (I_d + I_u) W."""
    length, k = mp.norm(S), _column(hexapod.universal_axes[i])
    s = S / length
    y = _cross(k, s)
    y = y / mp.norm(y)
    axes = mp.matrix(3, 3)
    axes[:, 0], axes[:, 1], axes[:, 2] = s, y, _cross(s, y)
    n = _cross(k, y)
    P = mp.eye(3) - (s * n.T / (n.T * s)[0] if joint == "universal" else mp.zeros(3))
    W = P * _tilde(s) / length
    lower, upper = hexapod.legs.lower, hexapod.legs.upper
    G_d = -_tilde(axes * _column(lower.mass_center[i])) * W
    G_u = mp.eye(3) - _tilde(axes * _column(upper.mass_center[i])) * W
    inertia = axes * mp.matrix((lower.inertia[i] + upper.inertia[i]).tolist()) * axes.T
    return float(lower.mass[i]) * G_d.T * G_d + float(upper.mass[i]) * G_u.T * G_u + W.T * inertia * W


def _seen_from(q, Q):
    """Inertia Q at the arm q, seen at the reference point."""
    G = mp.zeros(3, 6)
    G[:, :3], G[:, 3:] = mp.eye(3), -_tilde(q)
    return G.T * Q * G


def _column(values):
    return mp.matrix([mp.mpf(float(v)) for v in values])


def _cross(a, b):
    return mp.matrix([a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)])


def _tilde(a):
    return mp.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
