"""The paper's Eqs 6-34 written out, with every error of the print on a switch: the oracle for the misprints.

It shares no formula with the core, which never forms Eqs 24 and 25, and none with the package's misprints, which are
differences. Legs do not spin (W.s = 0, as in the paper). Inertial axes throughout, one leg after the other.
"""

from typing import NamedTuple

import numpy as np

E_3 = np.eye(3)


class Printed(NamedTuple):
    J_p: np.ndarray
    J_b: np.ndarray
    eta: np.ndarray


def tilde(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def equations(hexapod, platform, base, errors=()) -> Printed:
    """J_p, J_b and eta of Eq. 34 with the errors named ("E1" to "E5") as printed and all others corrected."""
    g = hexapod.gravity
    turned, w_p = platform.pose.matrix, platform.angular_velocity
    M, R_p = hexapod.platform_mass, turned @ hexapod.platform_mass_center
    I = turned @ hexapod.platform_inertia @ turned.T
    about = I + M * (R_p @ R_p * E_3 - np.outer(R_p, R_p))
    J_p = np.block([[M * E_3, -M * tilde(R_p)], [M * tilde(R_p), about]])
    J_b = np.zeros((6, 6))
    weight = M * (np.cross(w_p, np.cross(w_p, R_p)) - g)
    eta = np.concatenate([weight, np.cross(w_p, I @ w_p) + M * np.cross(R_p, (w_p @ R_p) * w_p - g)])
    # Eq. 34's moment M R_p x (w.R_p) w is M R_p x (w x (w x R_p)), the other part being along R_p.
    for i in range(6):
        q_p, q_b, Q_p, Q_b, V, f = leg(hexapod, i, platform, base, errors)
        J_p += np.block([[Q_p, -Q_p @ tilde(q_p)], [tilde(q_p) @ Q_p, -tilde(q_p) @ Q_p @ tilde(q_p)]])
        eta += np.concatenate([V, np.cross(q_p, V) - f])
        forces = np.hstack([Q_b, -Q_b @ tilde(q_b)])
        moments = tilde(q_p) @ forces
        J_b[:3] += forces
        if "E5" in errors:  # Eq. 33: - q_p Q_b t_p'' + q_p Q_b q_b alpha_p on the left
            J_p[3:] -= moments
        else:
            J_b[3:] += moments
    return Printed(J_p, J_b, eta)


def leg(hexapod, i, platform, base, errors):
    """q_p, q_b, Q_p, Q_b, V and f of a leg (Eqs 6-25)."""
    lower, upper = hexapod.legs.lower, hexapod.legs.upper
    m_d, m_u = lower.mass[i], upper.mass[i]
    C_u, C_p, C_s = (getattr(hexapod.legs.damping, name)[i] for name in ("universal", "prismatic", "spherical"))
    w_p, w_b, g = platform.angular_velocity, base.angular_velocity, hexapod.gravity
    q_p = platform.pose.matrix @ hexapod.platform_joints[i]
    q_b = base.pose.matrix @ hexapod.base_joints[i]
    S = q_p + platform.pose.position - q_b - base.pose.position  # Eq. 6
    L = np.linalg.norm(S)
    s = S / L
    y = np.cross(base.pose.matrix @ hexapod.universal_axes[i], s)
    T = np.column_stack([s, y / np.linalg.norm(y), np.cross(s, y / np.linalg.norm(y))])
    r_d, r_u = T @ lower.mass_center[i], L * s + T @ upper.mass_center[i]
    I = T @ (lower.inertia[i] + upper.inertia[i]) @ T.T

    S_dot = np.cross(w_p, q_p) + platform.velocity - np.cross(w_b, q_b) - base.velocity  # Eq. 7
    L_dot, W = s @ S_dot, np.cross(s, S_dot) / L
    turning_base = np.cross(w_b, np.cross(w_b, q_b))
    U_1 = np.cross(w_p, np.cross(w_p, q_p)) - turning_base  # Eq. 9
    U_2 = (np.cross(s, U_1) - 2 * L_dot * W) / L  # Eq. 15
    U_3 = np.cross(U_2, r_d) + np.cross(W, np.cross(W, r_d)) + turning_base  # Eq. 18
    U_4 = np.cross(U_2, r_u) + np.cross(W, np.cross(W, r_u)) + 2 * L_dot * np.cross(W, s) + turning_base  # Eq. 19
    if "E3" not in errors:
        U_4 = U_4 + (s @ U_1 + L * W @ W) * s
    f = C_s * (W - w_p)
    friction = C_u * W if "E4" in errors else C_u * (W - w_b)
    U_5 = (
        m_d * np.cross(r_d, U_3) + m_u * np.cross(r_u, U_4) + I @ U_2 + np.cross(W, I @ W)
        - np.cross(m_d * r_d + m_u * r_u, g) + friction + f
    )  # Eq. 22  # fmt: skip
    V = (m_u * s @ U_4 + C_p * L_dot - m_u * s @ g) * s - np.cross(s, U_5) / L  # Eq. 21

    square = m_d * r_d @ r_d + m_u * r_u @ r_u
    on_unit = square / L if "E1" in errors else square / L**2
    x_d, x_u = np.cross(s, r_d), np.cross(s, r_u)
    turning = (m_d * np.outer(x_d, x_d) + m_u * np.outer(x_u, x_u) + tilde(s) @ I @ tilde(s)) / L**2
    along = np.outer(s, s)
    Q_p = (
        (m_u * (1 + 2 * s @ r_u / L) - square / L**2) * along + on_unit * E_3
        - m_u / L * (np.outer(s, r_u) + np.outer(r_u, s)) - turning
    )  # Eq. 24  # fmt: skip
    twice = 1 if "E2" in errors else 2
    Q_b = (
        (twice * m_u * s @ r_u / L - square / L**2) * along + on_unit * E_3
        - m_u / L * (np.outer(s, r_u) + s @ r_u * E_3) + m_d / L * (np.outer(r_d, s) - s @ r_d * E_3) - turning
    )  # Eq. 25  # fmt: skip
    return q_p, q_b, Q_p, Q_b, V, f
