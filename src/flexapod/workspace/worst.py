"""The worst pose of a box: the least dynamic stability index over all of it, not only over the poses of a sweep."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flexapod import _core
from flexapod.checks import thread_count, whole
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.mechanics.inputs import as_hexapod, as_joint, states
from flexapod.pose import Pose
from flexapod.workspace.box import Box
from flexapod.workspace.box_minimum import smooth_minimum
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.region import RegionLike, as_region, home_of
from flexapod.workspace.sampling import low_discrepancy

SINGULAR = 1e-9  # omega_1 / omega_6 below which the index is zero to rounding
AGREE = 1e-6  # relative difference of indices that count as the same minimum
_CANDIDATES = 2048
_APART = 0.15  # least distance of two starts, in units of the box's diagonal


class WorstPose(NamedTuple):
    """Where the stability index is least in a region, and how sure that is.

    Attributes
    ----------
    pose : ndarray, shape (6,)
        x, y, z (m), roll, pitch, yaw (rad): `fx.Pose.from_rpy(*pose)`.
    omega_1 : float
        The index there, rad/s; zero to rounding where the region holds a singular pose.
    gradient : ndarray, shape (6,)
        Derivatives of omega_1 by the six coordinates, rad/s per m and per rad. At the least index of a box they are
        zero, except for coordinates in `at_bounds`, where they point out of the box.
    at_bounds : tuple of str
        Coordinates that are at an end of their range.
    singular : bool
        Whether the pose is singular.
    starts, agreed : int
        Number of descents, and how many of them ended at this index; zero for a list of poses.
    minima : list of (float, ndarray)
        Index (rad/s) and pose of every distinct local minimum found, least first.
    sampled : float
        Least index of the poses that were sampled, rad/s.
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
    region: RegionLike = None,
    *,
    joint: JointModel = "universal",
    samples: int = 2**15,
    starts: int = 12,
    seed: int = 0,
    threads: int | None = None,
) -> WorstPose:
    """Find the pose of a region with the least stability index.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    region : Box, Workspace, Pose, PoseSet, Trajectory or array_like, optional
        A Box in the base frame or a Workspace, over all of which the index is minimised; or poses, one or many, of
        which the worst is taken: six numbers or rows (n, 6) of x, y, z (m), roll, pitch, yaw (rad), or a Trajectory,
        which is sampled. Default: the home pose.
    joint : {"universal", "spin_free"}, optional
        Joint model.
    samples : int, optional
        Number of poses of the Sobol sequence that the descents start from.
    starts : int, optional
        Number of descents in a box.
    seed : int, optional
        Seed of the sequence's scrambling.
    threads : int, optional
        Number of threads, default one for each core.

    Returns
    -------
    WorstPose
        The pose, its index, and what was found on the way.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If a number is invalid, or no coordinate of a Box varies.
    PoseError
        If no pose of the region can be computed.

    See Also
    --------
    sweep : The index at many poses.
    stability_index : The index at a pose.

    Notes
    -----
    In a box, a Sobol sweep gives low poses apart from one another; from each, L-BFGS-B (Byrd, Lu, Nocedal and Zhu,
    1995) descends on omega_1^2 with exact derivatives. The lowest of several frequencies that meet is never least where
    they meet (it has a ridge there), so that the descent passes repeated frequencies; squared, it is smooth at a
    singular pose.

    Examples
    --------
    >>> worst = fx.worst_pose(fx.load("motion-base"), fx.Workspace.about_home(0.2, 0.1), samples=1024)
    >>> round(worst.omega_1, 2), worst.agreed == worst.starts
    (26.18, False)
    """
    where = as_region(region)
    index = SquaredFrequency(as_hexapod(hexapod), joint, mode=1)
    home = home_of(hexapod, where)
    box = where.box(home)
    threads = thread_count(threads)
    if box is None:
        rows = where.rows(home, samples)
        return _worst_of(index, rows, evaluate(hexapod, rows, ("omega_1",), joint, threads)["omega_1"])
    rows = low_discrepancy(box, samples, seed=seed).rows(0, samples)
    omega = evaluate(hexapod, rows, ("omega_1",), joint, threads)["omega_1"]
    begin = _apart(rows, omega, box, whole(starts, "starts"))
    ends = [smooth_minimum(index, rows[i], box.low, box.high) for i in begin]
    found = sorted(((index.root(end), end) for end in ends), key=lambda one: one[0])
    minima = _distinct(found, box)
    least, pose = minima[0]
    edge = (pose <= box.low) | (pose >= box.high)
    return WorstPose(
        pose=pose,
        omega_1=least,
        gradient=index.gradient(pose),
        at_bounds=tuple(name for name, at in zip(AXES, edge, strict=True) if at and name in box.free),
        singular=least <= SINGULAR * index.scale,
        starts=len(found),
        agreed=sum(_same(value, least, index.scale) for value, _ in found),
        minima=minima,
        sampled=float(np.nanmin(omega)),
    )


def _worst_of(index: SquaredFrequency, rows: Array, omega: Array) -> WorstPose:
    """The worst of some poses."""
    if not np.isfinite(omega).any():
        raise PoseError(f"none of the {len(rows)} poses can be computed. Look at the status of a sweep of them.")
    pose = rows[int(np.nanargmin(omega))]
    least, gradient = index.root(pose), index.gradient(pose)
    singular = least <= SINGULAR * index.scale
    return WorstPose(pose, least, gradient, (), singular, 0, 0, [(least, pose)], float(np.nanmin(omega)))


class SquaredFrequency:
    """The square of one of the six natural frequencies at x, y, z, roll, pitch, yaw, (6,), with exact derivatives."""

    def __init__(self, hexapod: Hexapod, joint: JointModel, mode: int) -> None:
        self.hexapod, self.joint, self.mode = hexapod, as_joint(joint), mode - 1
        self.scale = 1.0  # largest omega_6 met, rad/s

    def __call__(self, six: Array) -> tuple[float, Array]:
        """omega^2 and its derivatives by the coordinates. A pose that no leg can take raises PoseError."""
        s = states(self.hexapod, Pose.from_rpy(*six))
        omega = _core.natural_modes(self.hexapod.packed, self.joint, s.platform, s.base)[0][0]
        by_twist = _core.frequency_derivatives(self.hexapod.packed, self.joint, s.platform, s.base)[1]
        self.scale = max(self.scale, float(omega[-1]))
        return float(omega[self.mode] ** 2), by_twist[0, self.mode] @ twist_of_coordinates(six)

    def root(self, six: Array) -> float:
        """The frequency itself, rad/s."""
        return float(np.sqrt(max(self(six)[0], 0.0)))

    def gradient(self, six: Array) -> Array:
        """Of the frequency by the six coordinates; NaN where it is zero."""
        square, slope = self(six)
        return slope / (2 * np.sqrt(square)) if square > 0 else np.full(6, np.nan)


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
