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

from flexapod.checks import floats, whole
from flexapod.conventions import AXES, Array
from flexapod.errors import ArgumentError, PoseError
from flexapod.pose import Pose
from flexapod.rotations import rpy_of_matrices
from flexapod.workspace.box import BITS, Box
from flexapod.workspace.quantities import PoseNumbers
from flexapod.workspace.sobol import PIECE, Sobol

MOST = 2**40  # poses of a set: a year of a computer's work


def in_words(poses: int) -> str:
    """A number of poses of any size, as text."""
    return str(poses) if poses < 10**15 else f"some 10^{(poses.bit_length() - 1) * 30103 // 100000}"


def checked(poses: int) -> int:
    """A number of poses that a set can have. Raises ArgumentError."""
    if poses > MOST:
        raise ArgumentError(f"{in_words(poses)} poses are too many; a set may have 2^40, some 10^12. Take fewer.")
    return poses


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
    array([[0.   , 0.   , 0.822, 0.   , 0.   , 0.   ],
           [0.   , 0.   , 0.892, 0.   , 0.   , 0.   ]])
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

    def numbers(self) -> PoseNumbers:
        """Return all poses as a sweep in memory takes them: `rows`, or positions and rotations."""
        return self.rows(0, self.count)

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

    def __init__(self, box: Box, samples: int, seed: int) -> None:
        self.box, self.shape = box, (checked(whole(samples, "samples")),)
        self.seed = whole(seed, "seed", 0)

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

    def __init__(self, box: Box, samples: int, seed: int) -> None:
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
        checked(self.count)
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
        return {"kind": "grid", "axes": {name: _axis_described(self.axes[name]) for name in AXES}}


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


class ListedPoses(GivenPoses):
    """The poses of a `Pose`, of which rows are made when they are asked for."""

    def __init__(self, poses: Pose) -> None:
        self._poses = poses
        super().__init__(poses.position.reshape(-1, 3), shape=poses.shape)

    def numbers(self) -> PoseNumbers:
        return self._poses.numbers

    def rows(self, start: int, stop: int) -> Array:
        position, matrix = self._rows[start:stop], self._poses.matrix.reshape(-1, 9)[start:stop]
        return np.concatenate([position, matrix], axis=1)

    def identity(self) -> dict[str, Any]:
        return GivenPoses(self.rows(0, self.count)).identity()


def _axis_described(axis: Array) -> Any:
    """The values of an axis as plain data, even ones briefly."""
    if axis.size > 2 and np.array_equal(axis, np.linspace(axis[0], axis[-1], axis.size)):
        return {"first": float(axis[0]), "last": float(axis[-1]), "count": axis.size}
    return axis.tolist()


def _axis_of(axis: Any) -> Array:
    if isinstance(axis, Mapping):
        return np.linspace(axis["first"], axis["last"], axis["count"])
    return np.asarray(axis, dtype=float)


def described(description: Mapping[str, Any]) -> PoseSet | None:
    """The set that `PoseSet.describe` described; None for poses that were given one by one."""
    kind = description["kind"]
    if kind == "grid":
        return GridPoses({name: _axis_of(values) for name, values in description["axes"].items()})
    if kind in ("random", "sobol"):
        make = RandomPoses if kind == "random" else SobolPoses
        return make(Box(**description["box"]), description["count"], description["seed"])
    return None


def given_poses(poses: Pose | ArrayLike) -> PoseSet:
    """Poses given one by one: rows (..., 6) of x, y, z (m), roll, pitch, yaw (rad) are used without a copy.

    Raises PoseError for a wrong shape, and for no pose at all; NaN is left to the sweep.
    """
    if isinstance(poses, Pose):
        found: GivenPoses = ListedPoses(poses)
    else:
        array = six_columns(poses)
        found = GivenPoses(array.reshape(-1, 6), shape=array.shape[:-1])
    if found.count == 0:
        raise PoseError(f"the set of poses is empty (shape {found.shape}); at least one pose is needed")
    return found


def six_numbers(rows: Array) -> Array:
    """Rows of x, y, z, roll, pitch, yaw, from such rows, or from rows of twelve: a position and a matrix."""
    if rows.shape[1] == 6:
        return rows
    return np.concatenate([rows[:, :3], rpy_of_matrices(rows[:, 3:].reshape(-1, 3, 3))], axis=1)


def six_columns(value: Any) -> Array:
    """Rows (..., 6) of numbers, or PoseError."""
    try:
        array = np.ascontiguousarray(floats(value, copy=False))
    except (TypeError, ValueError):
        raise PoseError(
            f"poses is {type(value).__name__}; give rows of x, y, z (m), roll, pitch, yaw (rad), or a Pose"
        ) from None
    if np.ndim(value) == 0 or array.shape[-1] != 6:
        raise PoseError(
            f"poses has shape {np.shape(value)}; its last axis must hold x, y, z (m), roll, pitch, yaw (rad)"
        )
    return array
