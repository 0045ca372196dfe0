"""Sets of poses to sweep: a box sampled at random or evenly, a grid, a path, or poses as given.

Every set knows its poses by their number: `rows(start, stop)` gives the same numbers whichever way the set is cut, so
that pieces of it can be made anywhere and in any order.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import whole
from flexapod.conventions import AXES, Array, unit_of
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.pose import Pose
from flexapod.workspace.box import BITS, Box, Workspace
from flexapod.workspace.sobol import PIECE, Sobol


class PoseSet:
    """Poses by number, for sweeps: made by `random_poses`, `low_discrepancy`, `pose_grid` or `pose_path`.

    Attributes
    ----------
    shape : tuple of int
        Shape of the results of a sweep.
    dims : tuple of str
        Names of their axes.
    box : Box or None
        The box that the poses fill, if they fill one.

    Examples
    --------
    >>> fx.random_poses(fx.Box(z=(0.7, 0.9)), 1000).rows(10, 12).round(3)
    array([[0.   , 0.   , 0.896, 0.   , 0.   , 0.   ],
           [0.   , 0.   , 0.751, 0.   , 0.   , 0.   ]])
    """

    shape: tuple[int, ...]
    dims: tuple[str, ...] = ("pose",)
    box: Box | None = None

    @property
    def count(self) -> int:
        """Number of poses."""
        return prod(self.shape)

    def rows(self, start: int, stop: int) -> Array:
        """Return some of the poses.

        Parameters
        ----------
        start, stop : int
            Number of the first pose, and of the one after the last.

        Returns
        -------
        ndarray, shape (stop - start, 6) or (stop - start, 12)
            x, y, z (m), roll, pitch, yaw (rad); or position (m) and rotation matrix by rows.
        """
        raise NotImplementedError

    def describe(self) -> dict[str, Any]:
        """Return how the set is made, as plain data."""
        raise NotImplementedError

    def identity(self) -> dict[str, Any]:
        """Return `describe`, and for poses as given a digest of their numbers: what tells this set from others."""
        return self.describe()


class _BoxPoses(PoseSet):
    """Poses of a box, made from a seed."""

    kind: str
    box: Box

    def __init__(self, box: Box | Workspace, samples: int, seed: int) -> None:
        self.box, self.shape, self.seed = _box(box), (whole(samples, "samples"),), whole(seed, "seed", 0)

    def describe(self) -> dict[str, Any]:
        return {"kind": self.kind, "count": self.count, "seed": self.seed, "box": self.box.ranges()}


class RandomPoses(_BoxPoses):
    """Poses spread evenly by chance over a box. See `random_poses`."""

    kind = "random"

    def rows(self, start: int, stop: int) -> Array:
        bits = np.random.PCG64DXSM(self.seed)
        bits.advance(6 * int(start))  # every pose takes six draws, whether its coordinates vary or not
        generator = np.random.Generator(bits)
        out = np.empty((stop - start, 6))
        width, low = self.box.high - self.box.low, self.box.low
        for first in range(0, len(out), PIECE):
            piece = out[first : first + PIECE]
            generator.random(out=piece)
            piece *= width
            piece += low
        return out


class SobolPoses(_BoxPoses):
    """Poses of a scrambled Sobol sequence in a box. See `low_discrepancy`."""

    kind = "sobol"

    def __init__(self, box: Box | Workspace, samples: int, seed: int) -> None:
        super().__init__(box, samples, seed)
        if samples > 2**BITS:
            raise ArgumentError(
                f"samples is {samples}; the Sobol sequence here has {2**BITS} poses. Take random poses for more."
            )

    def rows(self, start: int, stop: int) -> Array:
        width, low = (self.box.high - self.box.low) * 2.0**-BITS, self.box.low
        out = np.empty((stop - start, 6))
        for part, integers in Sobol(6, self.seed, BITS).pieces(start, stop):
            piece = out[part]
            np.multiply(integers, width, out=piece)
            piece += low
        return out


class GridPoses(PoseSet):
    """All combinations of coordinate values. See `pose_grid`."""

    box: Box

    def __init__(self, axes: Mapping[str, Array]) -> None:
        self.axes = axes
        self.dims = tuple(name for name in AXES if axes[name].size > 1) or ("pose",)
        self.shape = tuple(axes[name].size for name in self.dims) if self.dims != ("pose",) else (1,)
        self.box = Box(*((axes[name].min(), axes[name].max()) for name in AXES))

    def rows(self, start: int, stop: int) -> Array:
        sizes = tuple(self.axes[name].size for name in AXES)
        run = sizes[5]
        first, last = start // run, -(-stop // run)  # whole runs of the last coordinate that cover what is asked for
        out = np.empty((last - first, run, 6))
        places = np.unravel_index(np.arange(first, last), sizes[:5])
        for k, place in enumerate(places):
            out[:, :, k] = self.axes[AXES[k]][place][:, None]
        out[:, :, 5] = self.axes["yaw"]
        return out.reshape(-1, 6)[start - first * run : stop - first * run]

    def describe(self) -> dict[str, Any]:
        return {"kind": "grid", "axes": {name: self.axes[name].tolist() for name in AXES}}


class GivenPoses(PoseSet):
    """Poses as they are, rows of 6 or 12 numbers."""

    def __init__(self, rows: Array, kind: str = "given", shape: tuple[int, ...] | None = None) -> None:
        self._rows, self.kind = rows, kind
        self.shape = (len(rows),) if shape is None or len(shape) < 2 else shape
        self.dims = ("pose",) if len(self.shape) == 1 else tuple(f"pose_{k}" for k in range(len(self.shape)))

    def rows(self, start: int, stop: int) -> Array:
        return self._rows[start:stop]

    def describe(self) -> dict[str, Any]:
        return {"kind": self.kind, "count": self.count}

    def identity(self) -> dict[str, Any]:
        from hashlib import sha256

        content = sha256(np.ascontiguousarray(self._rows, dtype="<f8").data).hexdigest()[:16]
        return {**self.describe(), "digest": content}


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
    (1000, [[-0.02, 0.0, 0.8, 0.0, 0.0, 0.0]])
    """
    return RandomPoses(box, samples, seed)


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
    >>> round(float(poses.rows(0, 1024)[:, 0].mean()), 5)
    0.0
    """
    return SobolPoses(box, samples, seed)


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
    array([[158.18, 157.97],
           [156.38, 156.24]])
    """
    axes: dict[str, Array] = {}
    for name, value in zip(AXES, (x, y, z, roll, pitch, yaw), strict=True):
        try:
            axis = np.atleast_1d(np.asarray(value, dtype=np.float64))
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
    array([158.18, 157.37, 156.33, 155.1 , 153.69])
    """
    from scipy.spatial.transform import Rotation, Slerp

    poses = waypoints if isinstance(waypoints, Pose) else Pose.from_rpy(*np.moveaxis(_six(waypoints), -1, 0))
    if len(poses.shape) != 1 or poses.shape[0] < 2:
        raise PoseError(f"the waypoints have batch axes {poses.shape}; a path needs at least two poses in a row")
    knots = np.arange(float(poses.shape[0]))
    at = np.linspace(0.0, knots[-1], whole(samples, "samples"))
    position = np.stack([np.interp(at, knots, p) for p in poses.position.T], axis=-1)
    rotation = Slerp(knots, Rotation.from_matrix(poses.matrix))(at).as_matrix()
    return GivenPoses(np.concatenate([position, rotation.reshape(-1, 9)], axis=1), "path")


def described(description: Mapping[str, Any]) -> PoseSet | None:
    """The set that `PoseSet.describe` described; None for poses that were given one by one."""
    kind = description["kind"]
    if kind == "grid":
        return pose_grid(**description["axes"])
    if kind in ("random", "sobol"):
        make = RandomPoses if kind == "random" else SobolPoses
        return make(Box(**description["box"]), description["count"], description["seed"])
    return None


def given_poses(poses: Pose | ArrayLike) -> PoseSet:
    """Poses given one by one: rows (..., 6) of x, y, z (m), roll, pitch, yaw (rad) are used without a copy.

    Raises PoseError for a wrong shape, and for no pose at all; NaN is left to the sweep.
    """
    if isinstance(poses, Pose):
        flat = poses.matrix.reshape(-1, 9)
        found = GivenPoses(np.concatenate([poses.position.reshape(-1, 3), flat], axis=1), shape=poses.shape)
    else:
        array = _six(poses)
        found = GivenPoses(array.reshape(-1, 6), shape=array.shape[:-1])
    if found.count == 0:
        raise PoseError(f"the set of poses is empty (shape {found.shape}); at least one pose is needed")
    return found


def _six(value: Any) -> Array:
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise PoseError(
            f"poses is {type(value).__name__}; give rows of x, y, z (m), roll, pitch, yaw (rad), or a Pose"
        ) from None
    if np.ndim(value) == 0 or array.shape[-1] != 6:
        raise PoseError(
            f"poses has shape {np.shape(value)}; its last axis must hold x, y, z (m), roll, pitch, yaw (rad)"
        )
    return array


def _box(value: Any) -> Box:
    if isinstance(value, Workspace) and not value.from_home:
        value = value.box(np.zeros(6))
    if isinstance(value, Box):
        return value
    raise ArgumentError(
        f"box is {shown(value)}; it must be a flexapod Box, such as Box(x=(-0.1, 0.1), z=0.8), or a Workspace fixed in "
        "the base."
    )
