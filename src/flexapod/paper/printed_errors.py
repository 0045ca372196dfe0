"""The errors in the printed equations, each as what it adds to the terms of Eq. 34 that the core computes.

The mechanics stay where they are: an error is a difference of a leg's inertia, of its force or of the loads, carried
into J_p, J_b and eta as Eq. 34 carries them. Numbers are those of the list of corrections in docs/theory.md. E7 and
E8 are no terms of Eq. 34: the first errs in what is done with its solution, the second in a unit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.mechanics.dynamics import EquationsOfMotion, equations_of_motion
from flexapod.pose import Motion


class State(NamedTuple):
    """A machine in motion with its loads, as `fx.forward_dynamics` takes them."""

    hexapod: Hexapod
    platform: Motion
    base: Motion
    leg_force: Array  # (6,) N
    force: Array  # (3,) N, platform's axes
    moment: Array  # (3,) N m, platform's axes


class Legs(NamedTuple):
    """The six legs at a state, inertial axes, in the paper's symbols."""

    L: Array  # (6,) m
    s: Array  # (6, 3)
    q_p: Array  # (6, 3) m
    q_b: Array  # (6, 3) m
    r_d: Array  # (6, 3) m, mass centres from the base joint
    r_u: Array  # (6, 3) m
    W: Array  # (6, 3, 3) 1/m: a leg's angular velocity from its joints' relative velocity


class Terms(NamedTuple):
    """What an error adds to Eq. 34: J_p (6, 6), J_b (6, 6), eta (6,)."""

    J_p: Array
    J_b: Array
    eta: Array


Misprint = Callable[[State, Legs, EquationsOfMotion], Terms]


def acceleration(state: State, errors: tuple[str, ...] = (), joint: JointModel = "universal") -> Array:
    """(6,) acceleration of the platform's reference point (m/s2) and angular (rad/s2), with errors as printed.

    errors: of "E1" to "E6"; none gives what `fx.forward_dynamics` gives.
    """
    e = printed(state, errors, joint)
    turned = state.platform.pose.matrix
    load = np.concatenate([turned @ state.force, turned @ state.moment])
    base = np.concatenate([state.base.acceleration, state.base.angular_acceleration])
    return np.asarray(np.linalg.solve(e.J_p, e.H @ state.leg_force + load + e.J_b @ base - e.eta))


def printed(state: State, errors: tuple[str, ...], joint: JointModel = "universal") -> EquationsOfMotion:
    """The terms of Eq. 34 with errors as printed. E5, which is made of J_b, comes after those that change J_b."""
    e = equations_of_motion(state.hexapod, state.platform, base=state.base, joint=joint)
    legs = legs_at(state, joint)
    for name in sorted(errors):
        added = MISPRINTS[name](state, legs, e)
        e = e._replace(J_p=e.J_p + added.J_p, J_b=e.J_b + added.J_b, eta=e.eta + added.eta)
    return e


def legs_at(state: State, joint: JointModel) -> Legs:
    """Where the legs are (Eq. 6) and how they turn: W = P s~/L with P = E - s n^T/(n.s), or P = E for "spin_free"."""
    h, turned, turned_base = state.hexapod, state.platform.pose.matrix, state.base.pose.matrix
    q_p, q_b = h.platform_joints @ turned.T, h.base_joints @ turned_base.T
    S = q_p + state.platform.pose.position - q_b - state.base.pose.position
    L = np.linalg.norm(S, axis=1)
    s, k = S / L[:, None], h.universal_axes @ turned_base.T
    y = np.cross(k, s)
    y /= np.linalg.norm(y, axis=1)[:, None]
    axes = np.stack([s, y, np.cross(s, y)], axis=-1)
    r_d = np.einsum("lij,lj->li", axes, h.legs.lower.mass_center)
    r_u = S + np.einsum("lij,lj->li", axes, h.legs.upper.mass_center)
    W = _tilde(s) / L[:, None, None]
    if joint == "universal":
        n = np.cross(k, y)
        spin = np.einsum("li,lij->lj", n, W) / np.sum(n * s, axis=1)[:, None]
        W = W - s[:, :, None] * spin[:, None, :]
    return Legs(L, s, q_p, q_b, r_d, r_u, W)


def _e1(state: State, legs: Legs, _: EquationsOfMotion) -> Terms:
    """Eqs 24, 25: (m_d r_d^2 + m_u r_u^2)/L E_3 in Q_p and Q_b, which is no mass, for .../L^2 E_3."""
    lower, upper = state.hexapod.legs.lower, state.hexapod.legs.upper
    inertia = lower.mass * _square(legs.r_d) + upper.mass * _square(legs.r_u)
    Q = (inertia * (1 / legs.L - 1 / legs.L**2))[:, None, None] * np.eye(3)
    return _of_legs(legs, Q, Q)


def _e2(state: State, legs: Legs, _: EquationsOfMotion) -> Terms:
    """Eq. 25: m_u (s.r_u)/L s s^T in Q_b, for twice that."""
    along = state.hexapod.legs.upper.mass * np.sum(legs.s * legs.r_u, axis=1) / legs.L
    Q_b = -along[:, None, None] * legs.s[:, :, None] * legs.s[:, None, :]
    return _of_legs(legs, np.zeros((6, 3, 3)), Q_b)


def _e3(state: State, legs: Legs, _: EquationsOfMotion) -> Terms:
    """Eq. 19: U_4 without (s.U_1 + L W.W) s, the velocity part of the leg's lengthening."""
    w_p, w_b = state.platform.angular_velocity, state.base.angular_velocity
    U_1 = np.cross(w_p, np.cross(w_p, legs.q_p)) - np.cross(w_b, np.cross(w_b, legs.q_b))
    S_dot = state.platform.velocity + np.cross(w_p, legs.q_p) - state.base.velocity - np.cross(w_b, legs.q_b)
    across = np.cross(legs.s, S_dot) / legs.L[:, None]
    missing = (np.sum(legs.s * U_1, axis=1) + legs.L * _square(across))[:, None] * legs.s
    m_u = state.hexapod.legs.upper.mass[:, None]
    return _of_forces(legs, -m_u * missing - _force_of(legs, m_u * np.cross(legs.r_u, missing)))


def _e4(state: State, legs: Legs, _: EquationsOfMotion) -> Terms:
    """Eq. 22: friction C_u W of the universal joint, for C_u (W - omega_b)."""
    moment = state.hexapod.legs.damping.universal[:, None] * state.base.angular_velocity
    return _of_forces(legs, _force_of(legs, moment))


def _e5(_: State, __: Legs, e: EquationsOfMotion) -> Terms:
    """Eqs 32, 33: in the moments Q_b multiplies the platform's accelerations, for the base's."""
    moments = np.zeros((6, 6))
    moments[3:] = -e.J_b[3:]
    return Terms(moments, moments, np.zeros(6))


def _e6(state: State, _: Legs, e: EquationsOfMotion) -> Terms:
    """Eq. 2: F = +K (L - L_0), for F = -K (L - L_0): every leg force the other way."""
    return Terms(np.zeros((6, 6)), np.zeros((6, 6)), 2 * e.H @ state.leg_force)


MISPRINTS: dict[str, Misprint] = {"E1": _e1, "E2": _e2, "E3": _e3, "E4": _e4, "E5": _e5, "E6": _e6}


def _of_legs(legs: Legs, Q_p: Array, Q_b: Array) -> Terms:
    """Differences of Q_p and Q_b, (6, 3, 3) kg, carried into J_p and J_b as in Eq. 34."""
    at_p, at_b = _carried(legs.q_p), _carried(legs.q_b)
    left = at_p.swapaxes(1, 2)
    return Terms((left @ Q_p @ at_p).sum(axis=0), (left @ Q_b @ at_b).sum(axis=0), np.zeros(6))


def _of_forces(legs: Legs, force: Array) -> Terms:
    """Differences of the forces at the spherical joints, (6, 3) N, carried into eta as in Eq. 34."""
    eta = np.concatenate([force.sum(axis=0), np.cross(legs.q_p, force).sum(axis=0)])
    return Terms(np.zeros((6, 6)), np.zeros((6, 6)), eta)


def _force_of(legs: Legs, moment: Array) -> Array:
    """W^T m: the force at the spherical joint that balances a moment about the base joint, (6, 3)."""
    return np.einsum("lji,lj->li", legs.W, moment)


def _carried(q: Array) -> Array:
    """(6, 3, 6), [E, -q~]: the acceleration of a joint from that of its plate."""
    return np.concatenate([np.broadcast_to(np.eye(3), (6, 3, 3)), -_tilde(q)], axis=2)


def _square(v: Array) -> Array:
    return np.asarray(np.sum(v * v, axis=1))


def _tilde(v: Array) -> Array:
    """(6, 3, 3) matrices of the cross product with v, (6, 3)."""
    return np.cross(v[:, None, :], np.eye(3)).swapaxes(1, 2)
