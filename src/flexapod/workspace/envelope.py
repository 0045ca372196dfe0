"""The envelope of a machine: how far it moves from home, what stops it, and how fast it is."""

from __future__ import annotations

from itertools import combinations, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import number, numbers, one_of, positive, whole
from flexapod.conventions import AXES, JOINT_MODELS, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import ArgumentError, PoseError, told_apart
from flexapod.mechanics.inputs import ZERO, PointLike, as_point, single_pose
from flexapod.mechanics.joint_limits import check_limits
from flexapod.mechanics.limited import together
from flexapod.pose import Pose, PoseLike
from flexapod.showing import drawn, in_notebooks
from flexapod.workspace.axis_speeds import Fastest, fastest
from flexapod.workspace.box_minimum import pattern_minima
from flexapod.workspace.largest_box import Boxes, largest_shares
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.rays import trace
from flexapod.workspace.sobol import Sobol
from flexapod.workspace.travel_limits import Bounds, Displacements, TravelLimits

if TYPE_CHECKING:
    from matplotlib.figure import Figure, SubFigure

_ALONG = 33  # poses along an axis
_IN_BOX, _STARTS = 2048, 16  # poses of the box, and those from which its least index is sought


@in_notebooks
class AxisTravel(NamedTuple):
    """The motion along one axis, from home.

    Attributes
    ----------
    axis : str
        "x", "y", "z" (m), or "roll", "pitch", "yaw" (rad).
    least, most : float
        How far the motion goes to each side, m or rad; least is not above zero.
    stopped_at_least, stopped_at_most : tuple of str
        What stops it there, as "greatest length of leg 3"; empty where nothing does as far as it was followed.
    least_index : float
        The least natural frequency along the axis, rad/s.
    velocity, acceleration : Fastest
        How fast the machine moves along the axis.
    """

    axis: str
    least: float
    most: float
    stopped_at_least: tuple[str, ...]
    stopped_at_most: tuple[str, ...]
    least_index: float
    velocity: Fastest
    acceleration: Fastest


@in_notebooks
class PairTravel(NamedTuple):
    """Motions along two axes at once.

    Attributes
    ----------
    axes : (str, str)
        The two axes.
    boundary : ndarray
        Displacements at which straight motions from home end, m or rad, (n, 2), all the way round.
    stopped : list of tuple of str
        What stops each of them.
    share : float
        The part of the travels along both axes, each to both sides, that may be combined in any way.
    """

    axes: tuple[str, str]
    boundary: Array
    stopped: list[tuple[str, ...]]
    share: float


@in_notebooks
class BoxTravel(NamedTuple):
    """The largest box of given proportions about home, within which all displacements hold in combination.

    Attributes
    ----------
    half : ndarray
        Half its ranges of x, y, z (m), roll, pitch, yaw (rad), (6,).
    share : float
        What part of the box asked for it is.
    at : ndarray
        The displacement that keeps it from being larger, (6,), m and rad.
    stopped : tuple of str
        What stops it there.
    least_index : float
        The least natural frequency in the box, rad/s.
    """

    half: Array
    share: float
    at: Array
    stopped: tuple[str, ...]
    least_index: float


@in_notebooks
class Envelope(NamedTuple):
    """How far a machine moves from home.

    Attributes
    ----------
    home : Pose
        The pose that all is measured from.
    point : ndarray
        The point of the platform that is moved, and that turns are about, platform frame, m, (3,).
    point_name : str
        Its name in the design; "" where it was given by its place.
    axes : tuple of AxisTravel
        Motions along each axis.
    pairs : tuple of PairTravel
        Motions along each two axes.
    box : BoxTravel
        The largest box.
    """

    home: Pose
    point: Array
    point_name: str
    axes: tuple[AxisTravel, ...]
    pairs: tuple[PairTravel, ...]
    box: BoxTravel

    def plot(self, name: str = "", *, figure: Figure | SubFigure | None = None) -> Figure:
        """Draw the motions along every two axes: `plots.envelope.pairs`, with its options."""
        return drawn(self, name=name, figure=figure)


def envelope(
    hexapod: Hexapod,
    pose: PoseLike | None = None,
    *,
    point: PointLike = ZERO,
    proportions: ArrayLike | None = None,
    index: float | None = None,
    condition_number: float | None = None,
    characteristic_length: float | None = None,
    directions: int = 48,
    joint: JointModel = "universal",
) -> Envelope:
    """Find the largest motions from home along each axis, along two axes at once, and along all of them in a box.

    Parameters
    ----------
    hexapod : Hexapod
        The machine. The limits of its legs and joints, and of static leg forces, stop motions.
    pose : Pose or array_like, optional
        Pose of the platform in the base frame that motions begin at: a Pose, or x, y, z in m and roll, pitch, yaw in
        rad. Left out, the home pose.
    point : array_like or str
        Point of the platform, in its frame, m, (3,), or the name of a point of the design, that is moved along the axes
        of the base frame, and that the platform turns about.
    proportions : array_like, optional
        Half ranges of x, y, z (m), roll, pitch, yaw (rad), (6,), of the box whose largest multiple is sought; zero
        holds a coordinate. Left out, the lesser travel of each axis.
    index : float, optional
        Least natural frequency that motions may have, rad/s.
    condition_number : float, optional
        Largest condition number of H that they may have.
    characteristic_length : float, optional
        Length in m by which the moment rows of H are divided for this bound. Left out, 1 m.
    directions : int
        Number of motions in the plane of two axes, a multiple of 4.
    joint : {"universal", "spin_free"}
        Model of the base joints: exact universal joints, or the paper's legs that do not spin.

    Returns
    -------
    Envelope
        Travels along the axes and what stops them, boundaries of pairs of axes, and the largest box.

    Raises
    ------
    PoseError
        For a batch of poses, where no home pose is known, and where the pose itself is beyond a limit.
    ArgumentError
        For numbers that are out of range.
    DesignError
        If `hexapod` is not a Hexapod.

    See Also
    --------
    flexapod.check_limits : Whether a pose keeps the design's limits.
    flexapod.worst_pose : The least index of a box.

    Notes
    -----
    Displacements add to the position of `point`, and turn the platform about the fixed axes of the base frame (roll,
    then pitch, then yaw). A motion goes along a straight line of displacements as far as it can without a break: a pose
    beyond a limit is not passed, and neither is a singular pose. Leg lengths, joint angles, distances of legs and
    cond(H) cannot change faster than the joints of the platform move, which gives steps that cannot pass a limit
    (sphere tracing, Hart, 1996); ends are found by bisection. The index and static leg forces have no such bound and
    are looked at in steps of a hundredth of a leg's length. The box is made smaller until descents on the margin of
    each limit, from many of its poses, find none below zero. Where nothing stops a motion, it is followed for half a
    turn, or for four leg lengths.

    Velocity along an axis is steady, with leg rates, and leg power at the forces of rest; acceleration is from rest,
    with the legs' accelerations and forces. Both are infinite where the design limits nothing of this.

    Examples
    --------
    >>> found = fx.envelope(fx.load("motion-base"))
    >>> x = found.axes[0]
    >>> round(x.least, 3), round(x.most, 3), x.stopped_at_most
    (-0.952, 1.226, ('greatest length of leg 3', 'greatest length of leg 4'))
    """
    where = single_pose(hexapod, pose)
    centre = as_point(hexapod, point)
    bounds = _bounds(index, condition_number, characteristic_length)
    one_of(joint, "joint", JOINT_MODELS)
    if whole(directions, "directions", 4) % 4:
        raise ArgumentError(f"directions is {directions}; it must be a multiple of 4.")
    half = None if proportions is None else _proportions(proportions)
    moves = Displacements(where, centre)
    limits = TravelLimits(hexapod, moves, bounds, joint)
    _check_start(limits)
    axes = _axes(limits)
    travels = np.array([[axis.least, axis.most] for axis in axes])
    half = np.abs(travels).min(axis=1) if half is None else half
    pairs = tuple(_pairs(limits, travels, directions))
    return Envelope(where, centre, point if isinstance(point, str) else "", axes, pairs, _box(limits, half))


def _bounds(index: float | None, condition: float | None, length: float | None) -> Bounds:
    if index is not None:
        positive(index, "index", "rad/s")
    if condition is not None and not number(condition, "condition_number") > 1:
        raise ArgumentError(f"condition_number is {condition}; it must be > 1, as no H has a smaller one.")
    if length is not None:
        positive(length, "characteristic_length", "m")
        if condition is None:
            raise ArgumentError("characteristic_length is for condition_number, which is not given. Give both.")
    return Bounds(index, condition, length)


def _proportions(proportions: ArrayLike) -> Array:
    half = numbers(proportions, "proportions", (6,))
    if (half < 0).any() or not half.any():
        raise ArgumentError(f"proportions are {half.tolist()}; half ranges (m, rad) must be >= 0, and one > 0.")
    return half


def _check_start(limits: TravelLimits) -> None:
    """Raises PoseError where the pose that motions begin at is beyond a limit."""
    hexapod, where, bounds = limits.hexapod, limits.displacements.home, limits.bounds
    margins = limits.margins(np.zeros((1, 6)))[0]
    broken = [name for name, margin in zip(limits.names, margins, strict=True) if not margin >= 0]
    if not broken:
        return
    words = list(together(check_limits(hexapod, where, joint=limits.joint).exceeded)) or broken
    if bounds.least_index is not None and broken == ["bound of the index"]:
        found = bounds.least_index + margins[limits.names.index("bound of the index")]
        told, bound = told_apart(float(found), bounds.least_index, (5, 5))
        words = [f"its lowest natural frequency is {told} rad/s, below the bound of {bound} rad/s"]
    raise PoseError(
        f"motions cannot begin at {where!r}, which is beyond limits: {'; '.join(words)}. Begin at another pose, or "
        "widen the limits."
    )


def _axes(limits: TravelLimits) -> tuple[AxisTravel, ...]:
    unit = np.eye(6)
    ends = trace(limits, np.concatenate([-unit, unit]))
    found = []
    for i, name in enumerate(AXES):
        low, high = -ends.reach[i], ends.reach[6 + i]
        rows = np.concatenate([[0.0], np.linspace(low, high, _ALONG)])[:, None] * unit[i]
        along = evaluate(limits.hexapod, limits.displacements.poses(rows).packed, ("omega_1",), limits.joint, 1)
        velocity, acceleration = fastest(limits.hexapod, limits.displacements, i, rows, limits.joint)
        least = float(np.nanmin(along["omega_1"]))
        found.append(
            AxisTravel(
                name, float(low) + 0.0, float(high), ends.stops[i], ends.stops[6 + i], least, velocity, acceleration
            )
        )
    return tuple(found)


def _pairs(limits: TravelLimits, travels: Array, directions: int) -> list[PairTravel]:
    """Boundaries by rays that are even in travels: the first is to the greatest of the first axis."""
    angle = 2 * np.pi * np.arange(directions) / directions
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    circle[np.abs(circle) < 1e-12] = 0.0
    both = list(combinations(range(6), 2))
    rays = np.zeros((len(both), directions, 6))
    for k, pair in enumerate(both):
        low, high = travels[list(pair)].T
        rays[k][:, pair] = circle * np.where(circle > 0, high, -low)
    ends = trace(limits, rays.reshape(-1, 6))
    boundary = ends.reach.reshape(len(both), directions, 1) * rays
    free = np.array(both)
    shares = largest_shares(limits, Boxes(free, *np.moveaxis(travels[free], -1, 0)))
    found = []
    for k, (i, j) in enumerate(both):
        stops = ends.stops[k * directions : (k + 1) * directions]
        found.append(PairTravel((AXES[i], AXES[j]), boundary[k][:, [i, j]], stops, min(shares[k].share, 1.0)))
    return found


def _box(limits: TravelLimits, half: Array) -> BoxTravel:
    free = np.flatnonzero(half > 0)
    (found,) = largest_shares(limits, Boxes(free[None], -half[None, free], half[None, free]))
    box = found.share * half

    def index(cube: Array) -> Array:
        rows = np.zeros((len(cube), 6))
        rows[:, free] = (2 * cube - 1) * box[free]
        poses = limits.displacements.poses(rows).packed
        return np.nan_to_num(evaluate(limits.hexapod, poses, ("omega_1",), limits.joint, 1)["omega_1"])

    if not free.size:
        return BoxTravel(box, found.share, found.at, found.stops, float(index(np.zeros((1, 0)))[0]))
    corners = np.array(list(product((0.0, 1.0), repeat=len(free))))
    cube = np.concatenate([corners, Sobol(len(free), 0, 32).points(0, _IN_BOX)])
    lowest = cube[np.argsort(index(cube))[:_STARTS]]
    return BoxTravel(box, found.share, found.at, found.stops, float(pattern_minima(index, lowest)[0].min()))
