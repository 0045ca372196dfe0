"""The small motions of a closed mechanism, from what a rigid-body program says of its open tree and its closures.

The velocities that the closures allow are N x', with x' those of six chosen joints; mass and friction are projected on
them, and the stiffness is the derivative of the projected force along motions that keep the loops closed, which holds
the turning of every force as the mechanism moves. Nothing of a program's solver, step or softness enters.
"""

from typing import NamedTuple, Protocol

import numpy as np
from tests.helpers.support import difference


class Tree(NamedTuple):
    """An open tree at rest in one position: n velocities, m closures."""

    mass: np.ndarray  # (n, n)
    force: np.ndarray  # (n,) springs and weight
    damping: np.ndarray  # (n, n)
    closure: np.ndarray  # (m, n) Jacobian of `gap`
    gap: np.ndarray  # (m,) how far the loops are open
    platform: np.ndarray  # (6, n) velocity of the platform's reference point and its angular velocity, inertial axes


class Mechanism(Protocol):
    start: np.ndarray  # the position that is examined
    chosen: np.ndarray  # six of the n velocities
    steps: np.ndarray  # (6,) of the differences, in their units

    def tree(self, q) -> Tree: ...
    def moved(self, q, dv) -> np.ndarray: ...


class Tangent(NamedTuple):
    """M x'' + C x' + K x = 0 in the platform's displacements, inertial axes, and the force left at rest."""

    M: np.ndarray
    C: np.ndarray
    K: np.ndarray
    residual: np.ndarray

    @property
    def omega(self) -> np.ndarray:
        return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(self.M, self.K)).real))


def tangent(mechanism: Mechanism) -> Tangent:
    """The tangent about the start, in the coordinates of `flexapod.linearise`."""
    tree = mechanism.tree(mechanism.start)
    N = _allowed(mechanism, tree)
    K = np.column_stack(
        [-difference(lambda t, i=i: _force(mechanism, t * N[:, i]), mechanism.steps[i]) for i in range(6)]
    )
    T = np.linalg.inv(tree.platform @ N)
    M, C = (T.T @ N.T @ matrix @ N @ T for matrix in (tree.mass, tree.damping))
    return Tangent(M, C, T.T @ K @ T, T.T @ N.T @ tree.force)


def _allowed(mechanism: Mechanism, tree: Tree) -> np.ndarray:
    """N (n, 6): all velocities for unit ones of the chosen joints."""
    n = tree.mass.shape[0]
    others = np.setdiff1d(np.arange(n), mechanism.chosen)
    N = np.zeros((n, 6))
    N[mechanism.chosen] = np.eye(6)
    N[others] = -np.linalg.solve(tree.closure[:, others], tree.closure[:, mechanism.chosen])
    return N


def _force(mechanism: Mechanism, dv: np.ndarray) -> np.ndarray:
    """Projected force after all joints have moved by dv and those that were not chosen have closed the loops."""
    others = np.setdiff1d(np.arange(len(dv)), mechanism.chosen)
    q = mechanism.moved(mechanism.start, dv)
    for _ in range(6):
        tree = mechanism.tree(q)
        step = np.zeros(len(dv))
        step[others] = -np.linalg.solve(tree.closure[:, others], tree.gap)
        q = mechanism.moved(q, step)
        if np.abs(step).max() < 1e-9:  # m or rad, of which Newton's method leaves no more than the square
            break
    tree = mechanism.tree(q)
    return _allowed(mechanism, tree).T @ tree.force
