"""Makers of pose sets: at random or evenly in a box, on a grid, along a path."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, whole
from flexapod.conventions import AXES, Array, unit_of
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.pose import Pose
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.pose_sets import GivenPoses, GridPoses, PoseSet, RandomPoses, SobolPoses, six_columns


def random_poses(box: Box | Workspace, samples: int, *, seed: int = 0) -> PoseSet:
    """Return poses spread evenly by chance over a box, each coordinate independent of the others.

    Parameters
    ----------
    box : Box or Workspace
        Ranges of the six coordinates in the base frame, m and rad. A Workspace must be fixed in the base.
    samples : int
        Number of poses.
    seed : int, optional
        Seed of the random numbers.

    Returns
    -------
    PoseSet
        The poses, by number; they are made where they are needed.

    Raises
    ------
    ArgumentError
        If the box, the number of samples or the seed is invalid.

    Notes
    -----
    Pose i is made of draws 6 i to 6 i + 5 of NumPy's PCG64DXSM generator with this seed, so it does not depend on the
    number of samples, nor on the pieces in which they are drawn.

    Examples
    --------
    >>> poses = fx.random_poses(fx.Box(x=(-0.1, 0.1), z=0.8), 1000, seed=1)
    >>> poses.count, poses.rows(0, 1).round(3).tolist()
    (1000, [[-0.046, 0.0, 0.8, 0.0, 0.0, 0.0]])
    """
    return RandomPoses(_box(box), samples, seed)


def low_discrepancy(box: Box | Workspace, samples: int, *, seed: int = 0) -> PoseSet:
    """Return poses of a box that fill it more evenly than chance, from a scrambled Sobol sequence.

    Parameters
    ----------
    box : Box or Workspace
        Ranges of the six coordinates in the base frame, m and rad. A Workspace must be fixed in the base.
    samples : int
        Number of poses, best a power of two.
    seed : int, optional
        Seed of the scrambling.

    Returns
    -------
    PoseSet
        The poses, by number; they are made where they are needed.

    Raises
    ------
    ArgumentError
        If the box, the number of samples or the seed is invalid, or the sequence has fewer poses.

    Notes
    -----
    The six-dimensional sequence of Sobol (1967) with the scrambling of scipy.stats.qmc. For other sequences give
    `fx.sweep` the array ``box.scale(sampler.random(n))``.

    Examples
    --------
    >>> poses = fx.workspace.low_discrepancy(fx.Box(x=(-0.1, 0.1), z=0.8), 1024)
    >>> abs(float(poses.rows(0, 1024)[:, 0].mean())) < 1e-4
    True
    """
    return SobolPoses(_box(box), samples, seed)


def pose_grid(
    x: ArrayLike = 0.0,
    y: ArrayLike = 0.0,
    z: ArrayLike = 0.0,
    roll: ArrayLike = 0.0,
    pitch: ArrayLike = 0.0,
    yaw: ArrayLike = 0.0,
) -> PoseSet:
    """Return all combinations of values of the six coordinates.

    Parameters
    ----------
    x, y, z : float or array_like, optional
        Values of a coordinate of the reference point in the base frame, m.
    roll, pitch, yaw : float or array_like, optional
        Values of a rotation about the fixed axes x, y, z, rad.

    Returns
    -------
    PoseSet
        The poses; coordinates with several values name the dimensions of a sweep's result.

    Raises
    ------
    ArgumentError
        If a value is not a finite number or a list of them.

    Notes
    -----
    The poses are in the order of the axes x to yaw, the last one fastest.

    Examples
    --------
    >>> fx.sweep(fx.load("motion-base"), fx.pose_grid(z=[2.3, 2.4], yaw=[0.0, 0.2])).omega_1.round(2).values
    array([[28.88, 29.53],
           [27.99, 28.56]])
    """
    axes: dict[str, Array] = {}
    for name, value in zip(AXES, (x, y, z, roll, pitch, yaw), strict=True):
        try:
            axis = np.atleast_1d(floats(value))
        except (TypeError, ValueError):
            raise ArgumentError(
                f"{name} is {shown(value)}; it must be a number or a list of numbers, in {unit_of(name)}"
            ) from None
        if axis.ndim > 1 or not axis.size:
            raise ArgumentError(f"{name} has shape {axis.shape}; it must be a number or a list of at least one number")
        if not np.isfinite(axis).all():
            raise ArgumentError(f"{name} holds NaN or infinity; values of a grid must be finite")
        axes[name] = axis
    return GridPoses(axes)


def pose_path(waypoints: Pose | ArrayLike, samples: int) -> PoseSet:
    """Return poses along straight lines between waypoints, equally many between each two.

    Parameters
    ----------
    waypoints : Pose or array_like, shape (k, 6)
        At least two poses: x, y, z (m), roll, pitch, yaw (rad).
    samples : int
        Number of poses.

    Returns
    -------
    PoseSet
        The poses in their order.

    Raises
    ------
    PoseError
        If fewer than two waypoints are given.
    ArgumentError
        If the number of samples is invalid.

    Notes
    -----
    Positions follow straight lines; orientations turn at a steady rate about a fixed axis from one to the next
    (spherical linear interpolation). A motion with times is `fx.Trajectory`.

    Examples
    --------
    >>> path = fx.workspace.pose_path([[0, 0, 2.3, 0, 0, 0], [0, 0, 2.5, 0, 0, 0.2]], 5)
    >>> fx.sweep(fx.load("motion-base"), path).omega_1.round(2).values
    array([28.88, 28.4 , 28.13, 28.07, 28.2 ])
    """
    from scipy.spatial.transform import Rotation, Slerp

    poses = waypoints if isinstance(waypoints, Pose) else Pose.from_rpy(*np.moveaxis(six_columns(waypoints), -1, 0))
    if len(poses.shape) != 1 or poses.shape[0] < 2:
        raise PoseError(f"the waypoints have batch axes {poses.shape}; a path needs at least two poses in a row")
    knots = np.arange(float(poses.shape[0]))
    at = np.linspace(0.0, knots[-1], whole(samples, "samples"))
    position = np.stack([np.interp(at, knots, p) for p in poses.position.T], axis=-1)
    rotation = Slerp(knots, Rotation.from_matrix(poses.matrix))(at).as_matrix()
    return GivenPoses(Pose(position, rotation).packed, "path")


def _box(value: Any) -> Box:
    if isinstance(value, Workspace) and not value.from_home:
        value = value.box(np.zeros(6))
    if isinstance(value, Box):
        return value
    raise ArgumentError(
        f"box is {shown(value)}; it must be a flexapod Box, such as Box(x=(-0.1, 0.1), z=0.8), or a Workspace fixed in "
        "the base."
    )
