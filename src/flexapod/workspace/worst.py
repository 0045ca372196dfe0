"""The worst pose of a box: the least dynamic stability index over all of it, not only over the poses of a sweep."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.checks import thread_count
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.mechanics.inputs import is_universal, states
from flexapod.pose import Pose
from flexapod.workspace.pose_sets import Box, low_discrepancy
from flexapod.workspace.quantities import evaluate

SINGULAR = 1e-9  # omega_1 / omega_6 below which the index is zero to rounding
AGREE = 1e-6  # relative difference of indices that count as the same minimum
_CANDIDATES = 2048
_APART = 0.15  # least distance of two starts, in units of the box's diagonal


class WorstPose(NamedTuple):
    """Where the index is least in a box, and how sure that is.

    pose: x, y, z m, roll, pitch, yaw rad (`flexapod.Pose.from_rpy(*pose)`). omega_1: rad/s, there; zero where the box
    holds a singular pose (singular). gradient: of omega_1 by the six coordinates, rad/s per m and per rad; at the least
    it is zero but for coordinates in `at_bounds`, where it points out of the box. starts, agreed: how many searches
    were made and how many ended at this index. minima: index and pose of every distinct local minimum found, least
    first. sampled: least index of the sweep that gave the starts.

    Source: own.
    """

    pose: Array
    omega_1: float
    gradient: Array
    at_bounds: tuple[str, ...]
    singular: bool
    starts: int
    agreed: int
    minima: list[tuple[float, Array]]
    sampled: float


def worst_pose(
    hexapod: Hexapod,
    box: Box,
    joint: JointModel = "universal",
    points: int = 2**15,
    starts: int = 12,
    seed: int = 0,
    threads: int | None = None,
) -> WorstPose:
    """The pose of a box with the least stability index (rad/s).

    A Sobol sweep of `points` poses gives `starts` low poses apart from one another; from each, L-BFGS-B descends on
    omega_1^2 with exact derivatives. The lowest of several frequencies that meet is never least where they meet (it has
    a ridge there), so that the descent passes repeated frequencies; squared, it is smooth at a singular pose.

    Raises: PoseError for a box without extent, or in which no pose can be computed.
    Source: own, with L-BFGS-B (R. H. Byrd, P. Lu, J. Nocedal and C. Zhu, 1995).
    """
    universal = is_universal(joint)
    free = box.high > box.low
    if not free.any():
        raise PoseError(f"{box!r} is one pose; a range of at least one coordinate is needed. Use stability_index.")
    if starts < 1 or points < 1:
        raise PoseError(f"points is {points} and starts is {starts}; both must be at least 1")
    rows = low_discrepancy(box, points, seed).rows(0, points)
    omega = evaluate(hexapod, rows, ("omega_1",), joint, thread_count(threads))["omega_1"]
    chosen = _apart(rows, omega, box, starts)
    search = _Search(hexapod, universal, box, free)
    found = sorted((search.descend(rows[i]) for i in chosen), key=lambda end: end[0])
    minima = _distinct(found, box)
    least, pose = minima[0]
    agreed = sum(_same(value, least, search.scale) for value, _ in found)
    gradient = search.gradient(pose)
    edge = (pose <= box.low) | (pose >= box.high)
    return WorstPose(
        pose=pose,
        omega_1=least,
        gradient=gradient,
        at_bounds=tuple(name for name, at in zip(AXES, edge & free, strict=True) if at),
        singular=least <= SINGULAR * search.scale,
        starts=len(found),
        agreed=agreed,
        minima=minima,
        sampled=float(np.nanmin(omega)),
    )


class _Search:
    """Descent on omega_1^2 over the free coordinates of a box, each from 0 to 1."""

    def __init__(self, hexapod: Hexapod, universal: bool, box: Box, free: np.ndarray) -> None:
        self.hexapod, self.universal, self.box, self.free = hexapod, universal, box, free
        self.width = box.high - box.low
        self.scale = 1.0  # largest omega_6 met, rad/s

    def descend(self, start: Array) -> tuple[float, Array]:
        """omega_1 and pose where the descent ends."""
        from scipy.optimize import minimize

        u = ((start - self.box.low) / np.where(self.free, self.width, 1.0))[self.free]
        unit = max(self._square(start)[0], np.finfo(float).tiny)

        def function(u: Array) -> tuple[float, Array]:
            value, slope = self._square(self._pose(u))
            return value / unit, (slope * self.width)[self.free] / unit

        bounds = [(0.0, 1.0)] * len(u)
        for _ in range(3):  # anew where a ridge between two modes has spoilt the curvature it has learnt
            end = minimize(
                function,
                u,
                jac=True,
                method="L-BFGS-B",
                bounds=bounds,
                options={"ftol": 0, "gtol": 1e-10, "maxiter": 500},
            )
            still = np.abs(end.x - u).max() < 1e-9
            u = end.x
            if still:
                break
        pose = self._pose(u)
        return float(np.sqrt(max(self._square(pose)[0], 0.0))), pose

    def gradient(self, pose: Array) -> Array:
        """Of omega_1 by the six coordinates; NaN where omega_1 is zero."""
        square, slope = self._square(pose)
        return slope / (2 * np.sqrt(square)) if square > 0 else np.full(6, np.nan)

    def _pose(self, u: Array) -> Array:
        pose = self.box.low.copy()
        pose[self.free] = np.clip(self.box.low + self._spread(u) * self.width, self.box.low, self.box.high)[self.free]
        at_end = self._spread(u) >= 1.0
        pose[at_end] = self.box.high[at_end]
        return pose

    def _spread(self, u: Array) -> Array:
        whole = np.zeros(6)
        whole[self.free] = u
        return whole

    def _square(self, six: Array) -> tuple[float, Array]:
        """omega_1^2 and its derivatives by the coordinates. A pose that no leg can take raises PoseError."""
        s = states(self.hexapod, Pose.from_rpy(*six))
        omega = _core.natural_modes(self.hexapod.packed, self.universal, s.platform, s.base)[0][0]
        by_twist = _core.frequency_derivatives(self.hexapod.packed, self.universal, s.platform, s.base)[1][0, 0]
        self.scale = max(self.scale, float(omega[-1]))
        return float(omega[0] ** 2), by_twist @ twist_of_coordinates(six)


def twist_of_coordinates(six: Array) -> Array:
    """(6, 6): translation and rotation vector (inertial axes) for each change of x, y, z, roll, pitch, yaw."""
    pitch, yaw = six[4], six[5]
    cp, sp, cy, sy = np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    jacobian = np.eye(6)
    jacobian[3:, 3:] = [[cy * cp, -sy, 0.0], [sy * cp, cy, 0.0], [-sp, 0.0, 1.0]]
    return jacobian


def _apart(rows: Array, omega: Array, box: Box, starts: int) -> list[int]:
    """The lowest poses that are apart from those before them; nearer ones where there are too few."""
    usable = np.flatnonzero(np.isfinite(omega))
    if not usable.size:
        raise PoseError(f"no pose of {box!r} could be computed. Look at the status of a sweep of it.")
    lowest = usable[np.argsort(omega[usable], kind="stable")][:_CANDIDATES]
    free = box.high > box.low
    unit = (rows[lowest] - box.low)[:, free] / (box.high - box.low)[free]
    apart = _APART * np.sqrt(free.sum())
    chosen: list[int] = []
    left = np.ones(len(lowest), dtype=bool)
    while len(chosen) < min(starts, len(lowest)):
        if not left.any():
            apart /= 2
            left[:] = True
            left[chosen] = False
            for k in chosen:
                left &= np.linalg.norm(unit - unit[k], axis=1) > apart
            continue
        k = int(np.argmax(left))
        chosen.append(k)
        left &= np.linalg.norm(unit - unit[k], axis=1) > apart
        left[k] = False
    return [int(lowest[k]) for k in chosen]


def _same(value: float, least: float, scale: float) -> bool:
    return value - least <= AGREE * least + SINGULAR * scale


def _distinct(found: list[tuple[float, Array]], box: Box) -> list[tuple[float, Array]]:
    """Minima that differ in place by more than 1e-3 of the box."""
    width = np.where(box.high > box.low, box.high - box.low, 1.0)
    kept: list[tuple[float, Array]] = []
    for value, pose in found:
        if all(np.abs((pose - other) / width).max() > 1e-3 for _, other in kept):
            kept.append((value, pose))
    return kept
