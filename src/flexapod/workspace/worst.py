"""The worst pose of a box: the least dynamic stability index over all of it, not only over the poses of a sweep."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from flexapod.checks import thread_count, whole
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.inputs import as_hexapod
from flexapod.progress import ProgressLike, with_progress
from flexapod.showing import in_notebooks
from flexapod.workspace.box import Box
from flexapod.workspace.descents import BoxSearch, SquaredFrequency, starts_of
from flexapod.workspace.limit_margins import LimitMargins, margins_to_keep, none_within, refuse_force_limits
from flexapod.workspace.proof import Boxes, Prover, Standing, Watch, run, six_of
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.region import RegionLike, as_region, home_of

SINGULAR = 1e-9  # omega_1 / omega_6 below which the index is zero to rounding
GAP = 0.01  # that a certified least index may be below what is found, as a share of that
AGREE = 1e-6  # relative difference of indices that count as the same minimum
_TOUCHES = 1e-6  # margin of a limit, and share of the box's width from its edge, at which the pose is


@in_notebooks
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
        zero, except for coordinates in `at_bounds`, where they point out of the box, and where limits hold the pose.
    at_bounds : tuple of str
        Coordinates that are at an end of their range.
    singular : bool
        Whether the pose is singular, or locks a universal joint: the index is zero.
    starts, agreed : int
        Number of descents, and how many of them ended at this index; zero for a list of poses.
    minima : list of (float, ndarray)
        Index (rad/s) and pose of every distinct local minimum found, least first.
    sampled : float
        Least index of the poses that were sampled, rad/s.
    at_limits : tuple of str
        Limits of the design that the pose is at, as "greatest length of leg 3".
    share_within_limits : float
        Part of the region's poses that is within the design's limits; NaN where all poses count.
    proved : float
        Index that no pose of the region falls below, rad/s; NaN where it was not asked for (`certified`).
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
    at_limits: tuple[str, ...] = ()
    share_within_limits: float = float("nan")
    proved: float = float("nan")


@with_progress("worst pose")
def worst_pose(
    hexapod: Hexapod,
    region: RegionLike = None,
    *,
    joint: JointModel = "universal",
    samples: int = 2**15,
    starts: int = 12,
    seed: int = 0,
    threads: int | None = None,
    all_poses: bool = False,
    certified: bool = False,
    progress: ProgressLike = None,
) -> WorstPose:
    """Search for the pose of a region with the least stability index.

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
        Number of descents from sampled poses of a box; corners of the box come to them.
    seed : int, optional
        Seed of the sequence's scrambling.
    threads : int, optional
        Number of threads, default one for each core.
    all_poses : bool, optional
        If True, poses beyond the design's limits count as well. If False (default), the worst of those within them is
        found; a design without limits allows all.
    certified : bool, optional
        If True, it is also proved that no pose of a box has an index more than 1 % lower, which takes from parts of a
        second to hours (`certify` can limit the time). If the proof meets a lower pose, the search goes on from there.
    progress : callable or False, optional
        Called with the share done, from 0 to 1: of the descents, or with `certified` of the box that is decided.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.

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
        If no pose of the region can be computed, or none within the limits is found.

    See Also
    --------
    sweep : The index at many poses.
    stability_index : The index at a pose.

    Notes
    -----
    In a box, a Sobol sweep gives low poses apart from one another; from each, and from every corner that no corner next
    to it undercuts, L-BFGS-B (Byrd, Lu, Nocedal and Zhu, 1995) descends on omega_1^2 with exact derivatives. The lowest
    of several frequencies that meet is never least where they meet (it has a ridge there), so that the descent passes
    repeated frequencies; squared, it is smooth at a singular pose. A search proves nothing: how far the index may be
    below what it finds is known with `certified` only.

    Where the design has limits, the descents begin at poses within them and keep to them by sequential quadratic
    programming (SLSQP, Kraft, 1988) with exact derivatives of leg lengths, joint angles and leg distances: the worst
    pose is mostly at several limits at once. Where few poses of the box are within the limits, more are sampled, and at
    last one is sought by descents on what exceeds them.

    Examples
    --------
    >>> worst = fx.worst_pose(fx.load("motion-base"), fx.Workspace.about_home(0.2, 0.1), samples=1024)
    >>> round(worst.omega_1, 2), worst.agreed == worst.starts
    (27.48, False)
    """
    where = as_region(region)
    index = SquaredFrequency(as_hexapod(hexapod), joint, mode=1)
    limits = margins_to_keep(hexapod, all_poses, joint)
    home = home_of(hexapod, where)
    box, threads = where.box(home), thread_count(threads)
    if certified and not all_poses:
        refuse_force_limits(hexapod)
    if box is None:
        if certified:
            raise ArgumentError(
                "certified is for a box, whose poses are not all looked at; of these poses each one is."
            )
        return _worst_of(index, limits, where.rows(home, samples), threads)
    count = whole(starts, "starts")
    search = BoxSearch(index, box, limits, whole(samples, "samples"), whole(seed, "seed", 0), threads)
    poses = search.sample()
    starts_at, ends = starts_of(poses, box, count), []
    for start in starts_at:
        ends.append(search.descend(start))
        if progress and not certified:
            progress(len(ends) / len(starts_at))
    found = sorted(((index.root(end), end) for end in ends), key=lambda one: one[0])
    proved = float("nan")
    if certified:
        proved, found = _proved(search, found, progress or None)
    minima = _distinct(found, box)
    least, pose = minima[0]
    touches = _TOUCHES * (box.high - box.low)
    edge = (pose <= box.low + touches) | (pose >= box.high - touches)
    return WorstPose(
        pose=pose,
        omega_1=least,
        gradient=index.gradient(pose),
        at_bounds=tuple(name for name, at in zip(AXES, edge, strict=True) if at and name in box.free),
        singular=least <= SINGULAR * index.scale,
        starts=len(found),
        agreed=sum(_same(value, least, index.scale) for value, _ in found),
        minima=minima,
        sampled=poses.least,
        at_limits=_at_limits(limits, pose),
        share_within_limits=_share(index, limits, poses.share),
        proved=proved,
    )


def _proved(
    search: BoxSearch, found: list[tuple[float, Array]], progress: Callable[[float], object] | None
) -> tuple[float, list[tuple[float, Array]]]:
    """What no pose of the box falls below, and the minima, with another one where the proof meets a lower pose."""
    index = search.index
    least, pose = found[0]
    if least <= SINGULAR * index.scale:
        return 0.0, found
    place = Boxes(np.stack([search.box.low, search.box.high], axis=-1)[None])
    limits = search.limits
    prover = Prover(
        hexapod=index.hexapod,
        joint=index.joint_name,
        kind="index",
        place=place,
        limits=limits is not None,
        only_law=limits is not None and limits.only_law,
        threads=search.threads,
    )
    standing = run(prover, Standing("undecided", np.nan, least, place.parts, at=pose), GAP, Watch(progress))
    if standing.value < least:
        end = search.descend(six_of(standing.at, place.parts))
        found = sorted([*found, (index.root(end), end)], key=lambda one: one[0])
    return 0.0 if np.isnan(standing.floor) else standing.floor, found


def _worst_of(index: SquaredFrequency, limits: LimitMargins | None, rows: Array, threads: int) -> WorstPose:
    """The worst of some poses."""
    wanted = ("omega_1", "within_limits") if limits is not None else ("omega_1",)
    kernel = limits.kernel if limits is not None else None
    found = evaluate(
        index.hexapod, rows, wanted, index.joint_name, threads, kernel, forces=limits is None or not limits.only_law
    )
    omega, share = found["omega_1"], 1.0
    if not np.isfinite(omega).any():
        raise PoseError(f"none of the {len(rows)} poses can be computed. Look at the status of a sweep of them.")
    if limits is not None:
        share = float(found["within_limits"].mean())
        omega = np.where(found["within_limits"], omega, np.nan)
        if not np.isfinite(omega).any():
            raise none_within(len(rows))
    pose = rows[int(np.nanargmin(omega))]
    least = index.root(pose)
    return WorstPose(
        pose=pose,
        omega_1=least,
        gradient=index.gradient(pose),
        at_bounds=(),
        singular=least <= SINGULAR * index.scale,
        starts=0,
        agreed=0,
        minima=[(least, pose)],
        sampled=float(np.nanmin(omega)),
        at_limits=_at_limits(limits, pose),
        share_within_limits=_share(index, limits, share),
    )


def _share(index: SquaredFrequency, limits: LimitMargins | None, found: float) -> float:
    """The part of the poses that is within the limits; NaN where this was not looked at."""
    return float("nan") if limits is None and index.hexapod.limits.given else found


def _at_limits(limits: LimitMargins | None, pose: Array) -> tuple[str, ...]:
    if limits is None:
        return ()
    margin = limits(pose)[0]
    return tuple(name for name, one in zip(limits.names, margin, strict=True) if one <= _TOUCHES)


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
