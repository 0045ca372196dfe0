"""Damped modes beside the undamped ones: paired by what moves, not by their order."""

from __future__ import annotations

from itertools import permutations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.checks import instance
from flexapod.conventions import Array
from flexapod.mechanics.linearisation import DampedModes
from flexapod.mechanics.modes import NaturalModes, mode_clusters
from flexapod.showing import in_notebooks

_ORDERS = np.array(list(permutations(range(6))))
LEAST_OVERLAP = 0.5  # of the kinetic energy: what a damped mode must share with an undamped one to stand beside it


@in_notebooks
class ModePairs(NamedTuple):
    """Which damped mode moves as each undamped mode does.

    Attributes
    ----------
    damped : ndarray of int
        For each undamped mode the number of its damped mode, from 0, (6,); -1 where none is like it.
    overlap : ndarray
        Share of that damped mode's kinetic energy in the shape of the undamped mode, or of all those that are nearly
        repeated with it, (6,); NaN where none is like it.
    """

    damped: NDArray[np.int64]
    overlap: Array

    @property
    def alone(self) -> list[int]:
        """Damped modes that are like no undamped one, numbered from 0."""
        return [j for j in range(6) if j not in self.damped]

    def beside(self, values: NDArray[Any]) -> NDArray[Any]:
        """Numbers of the damped modes, (6,), in the order of the undamped ones; NaN where there is none."""
        return np.where(self.damped >= 0, values[self.damped], np.nan)


def pair_modes(modes: NaturalModes, damped: DampedModes) -> ModePairs:
    """Pair damped modes with the undamped ones by their shapes.

    Parameters
    ----------
    modes : NaturalModes
        The undamped modes at one pose.
    damped : DampedModes
        The modes of `flexapod.linearise` there.

    Returns
    -------
    ModePairs
        For each undamped mode its damped one, where there is one like it, and how much alike they are.

    See Also
    --------
    flexapod.natural_modes : The undamped modes.
    flexapod.linearise : The damped modes: `linearise(...).modes()`.

    Notes
    -----
    The modal assurance criterion weighted with the mass matrix. The undamped shapes are orthonormal in it, so that the
    values of one damped mode sum to 1: they are shares of its kinetic energy. Those of nearly repeated modes are added
    up, for any mixture of such modes is as good a mode. The pairs are the assignment with the largest sum; one whose
    share is below a half is none.

    Examples
    --------
    >>> heavy = fx.load("cubic-isolator").replace({"platform.mass": 200})
    >>> tilted = fx.Pose.from_rpy(0.004, 0, 0.035, 0, 2, 0, degrees=True)
    >>> pairs = fx.mechanics.pair_modes(fx.natural_modes(heavy, tilted), fx.linearise(heavy, tilted).modes())
    >>> pairs.damped.tolist()
    [2, 0, 1, 4, 3, 5]
    """
    instance(modes, NaturalModes, "modes", "as natural_modes gives them")
    instance(damped, DampedModes, "damped", "as linearise(...).modes() gives them")
    share = np.abs(np.linalg.solve(modes.shape, damped.shape)) ** 2
    share = share / share.sum(axis=0)
    together = share.copy()
    for cluster in mode_clusters(modes.omega):
        together[cluster] = share[cluster].sum(axis=0)
    worth = together + 1e-3 * share  # among nearly repeated modes the one that is most like it
    chosen = _ORDERS[np.argmax(worth[range(6), _ORDERS].sum(axis=1))]
    overlap = together[range(6), chosen]
    alike = overlap >= LEAST_OVERLAP
    return ModePairs(np.where(alike, chosen, -1), np.where(alike, overlap, np.nan))
