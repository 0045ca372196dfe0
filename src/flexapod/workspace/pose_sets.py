"""Sets of poses to sweep: a box sampled at random or evenly, a grid, a path, or poses as given.

Every set knows its poses by their number: `rows(start, stop)` gives the same numbers whichever way the set is cut, so
that pieces of it can be made anywhere and in any order.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from math import prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import AXES, Array
from flexapod.errors import PoseError
from flexapod.pose import Pose

UNITS = ("m", "m", "m", "rad", "rad", "rad")
_PIECE = 4096  # rows made at a time, so that they stay in cache
_SOBOL_BITS = 32  # the most with which scipy.stats.qmc.Sobol can be wound forward


class Box:
    """Ranges of the six pose coordinates: a pair (least, largest), or one number for a coordinate that is held.

    x, y, z in m; roll, pitch, yaw in rad about the fixed axes x, y, z.

    Raises: PoseError where least > largest, or numbers are not finite.
    Source: own.
    """

    def __init__(
        self,
        x: ArrayLike = 0.0,
        y: ArrayLike = 0.0,
        z: ArrayLike = 0.0,
        roll: ArrayLike = 0.0,
        pitch: ArrayLike = 0.0,
        yaw: ArrayLike = 0.0,
    ) -> None:
        given = dict(zip(AXES, (x, y, z, roll, pitch, yaw), strict=True))
        bounds = np.array([_range(name, value) for name, value in given.items()])
        self.low: Array = bounds[:, 0].copy()
        self.high: Array = bounds[:, 1].copy()

    @classmethod
    def about(cls, pose: Pose, position: float, angle: float) -> Box:
        """All six coordinates of one pose, plus and minus `position` (m) and `angle` (rad).

        Raises: PoseError for a batch of poses.
        """
        if pose.shape:
            raise PoseError(f"a box lies about one pose; this one has batch axes {pose.shape}. Index it first.")
        six = np.concatenate([pose.position, pose.rpy])
        half = np.repeat([position, angle], 3)
        return cls(*zip(six - half, six + half, strict=True))

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the coordinates that vary."""
        return tuple(name for name, vary in zip(AXES, self.high > self.low, strict=True) if vary)

    @property
    def volume(self) -> float:
        """Product of the ranges that vary, in m and rad (see `volume_unit`)."""
        width = self.high - self.low
        return float(np.prod(width[width > 0]))

    @property
    def volume_unit(self) -> str:
        """Such as "m3 rad3"."""
        free = [unit for name, unit in zip(AXES, UNITS, strict=True) if name in self.free]
        counts = [(unit, free.count(unit)) for unit in ("m", "rad")]
        return " ".join(f"{unit}{count if count > 1 else ''}" for unit, count in counts if count)

    def scale(self, points: ArrayLike) -> Array:
        """Points of the unit cube, (..., 6), to poses: for any sampler, such as those of scipy.stats.qmc."""
        return np.asarray(points, dtype=np.float64) * (self.high - self.low) + self.low

    def ranges(self) -> dict[str, list[float]]:
        """Least and largest value of each coordinate."""
        return {name: [float(a), float(b)] for name, a, b in zip(AXES, self.low, self.high, strict=True)}

    def __repr__(self) -> str:
        ranges = (f"{name}={a:.6g}" + (f"..{b:.6g}" if b > a else "") for name, (a, b) in self.ranges().items())
        return f"Box({', '.join(ranges)})"


def _range(name: str, value: ArrayLike) -> tuple[float, float]:
    unit = UNITS[AXES.index(name)]
    try:
        pair = np.broadcast_to(np.asarray(value, dtype=np.float64), 2)
    except (TypeError, ValueError):
        raise PoseError(
            f"{name} is {value!r}; it must be a number, or a pair of least and largest, in {unit}"
        ) from None
    low, high = map(float, pair)
    if not (np.isfinite(low) and np.isfinite(high)):
        raise PoseError(f"{name} is from {low} to {high} {unit}; both must be finite")
    if low > high:
        raise PoseError(f"{name} is from {low:.6g} to {high:.6g} {unit}; the least comes first. Swap the two.")
    return low, high


class PoseSet:
    """Poses by number: x, y, z m, roll, pitch, yaw rad, or positions and rotation matrices.

    `shape` and `dims` are the axes of results; `box` is what they fill, where they fill one.

    Source: own.
    """

    shape: tuple[int, ...]
    dims: tuple[str, ...] = ("pose",)
    box: Box | None = None

    @property
    def count(self) -> int:
        """How many poses."""
        return prod(self.shape)

    def rows(self, start: int, stop: int) -> Array:
        """Poses start to stop - 1: (stop - start, 6) x, y, z m and roll, pitch, yaw rad, or (stop - start, 12)."""
        raise NotImplementedError

    def describe(self) -> dict[str, Any]:
        """How the set is made, in plain numbers and words."""
        raise NotImplementedError

    def identity(self) -> dict[str, Any]:
        """`describe`, and for poses as given a digest of their numbers: what makes this set and no other."""
        return self.describe()


class RandomPoses(PoseSet):
    """Poses spread evenly by chance over a box. See `random_poses`."""

    def __init__(self, box: Box, count: int, seed: int) -> None:
        self.box, self.shape, self.seed = box, (_count(count),), _seed(seed)

    def rows(self, start: int, stop: int) -> Array:
        bits = np.random.PCG64DXSM(self.seed)
        bits.advance(6 * int(start))  # every pose takes six draws, whether its coordinates vary or not
        generator = np.random.Generator(bits)
        out = np.empty((stop - start, 6))
        assert self.box is not None
        width, low = self.box.high - self.box.low, self.box.low
        for first in range(0, len(out), _PIECE):
            piece = out[first : first + _PIECE]
            generator.random(out=piece)
            piece *= width
            piece += low
        return out

    def describe(self) -> dict[str, Any]:
        assert self.box is not None
        return {"kind": "random", "count": self.count, "seed": self.seed, "box": self.box.ranges()}


class SobolPoses(PoseSet):
    """Poses of a scrambled Sobol sequence in a box. See `low_discrepancy`."""

    def __init__(self, box: Box, count: int, seed: int) -> None:
        self.box, self.shape, self.seed = box, (_count(count),), _seed(seed)
        if count > 2**_SOBOL_BITS:
            raise PoseError(
                f"{count} low-discrepancy poses were asked for; the Sobol sequence here has {2**_SOBOL_BITS}. "
                "Take random poses for more."
            )

    def rows(self, start: int, stop: int) -> Array:
        assert self.box is not None
        width, low = (self.box.high - self.box.low) * 2.0**-_SOBOL_BITS, self.box.low
        basis = _sobol_basis(self.seed, max(self.count - 1, 1).bit_length())
        table = _sobol_table(self.seed)
        out = np.empty((stop - start, 6))
        position = start
        while position < stop:
            block, offset = divmod(position, _PIECE)
            step = min(_PIECE - offset, stop - position)
            piece = out[position - start : position - start + step]
            np.multiply(table[offset : offset + step] ^ _combined(basis, block * _PIECE), width, out=piece)
            piece += low
            position += step
        return out

    def describe(self) -> dict[str, Any]:
        assert self.box is not None
        return {"kind": "sobol", "count": self.count, "seed": self.seed, "box": self.box.ranges()}


def _sobol(seed: int) -> Any:
    from scipy.stats import qmc

    return qmc.Sobol(6, scramble=True, bits=_SOBOL_BITS, rng=seed)


def _integers(points: Array) -> np.ndarray:
    return (points * 2.0**_SOBOL_BITS).astype(np.uint32)


@lru_cache(maxsize=4)
def _sobol_table(seed: int) -> np.ndarray:
    return _integers(_sobol(seed).random(_PIECE))


@lru_cache(maxsize=4)
def _sobol_basis(seed: int, bits: int) -> np.ndarray:
    """Point 2^j xor point 0, for every j. Point i xor point 0 is linear over xor in the binary digits of i, since its
    Gray code is: so any point is a few of these, and a sequence need not be walked from its start."""
    first = _integers(_sobol(seed).random(1))[0]
    rows = []
    for j in range(bits):
        sequence = _sobol(seed)
        sequence.fast_forward(1 << j)
        rows.append(_integers(sequence.random(1))[0] ^ first)
    return np.array(rows)


def _combined(basis: np.ndarray, number: int) -> np.ndarray:
    digits = [j for j in range(len(basis)) if number >> j & 1]
    return np.bitwise_xor.reduce(basis[digits], axis=0) if digits else np.zeros(6, np.uint32)


class GridPoses(PoseSet):
    """All combinations of coordinate values. See `pose_grid`."""

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


def random_poses(box: Box, count: int, seed: int = 0) -> PoseSet:
    """`count` poses (m, rad) spread evenly by chance over a box, each coordinate on its own.

    Pose i is made of draws 6 i to 6 i + 5 of NumPy's PCG64DXSM generator with this seed, so it does not depend on how
    many are drawn, or in which pieces.

    Raises: PoseError for what is no Box, no count or no seed.
    Source: own, with NumPy's PCG64DXSM.
    """
    return RandomPoses(_box(box), count, seed)


def low_discrepancy(box: Box, count: int, seed: int = 0) -> PoseSet:
    """`count` poses of the scrambled six-dimensional Sobol sequence of scipy.stats.qmc: more even than chance.

    Rows are x, y, z in m and roll, pitch, yaw in rad. Best with a power of two. For other sequences give `fx.sweep` the
    array `box.scale(sampler.random(n))`.

    Raises: PoseError for what is no Box, no count or no seed, or more poses than the sequence has.
    Source: I. M. Sobol (1967), scrambled as scipy.stats.qmc does.
    """
    return SobolPoses(_box(box), count, seed)


def pose_grid(
    x: ArrayLike = 0.0,
    y: ArrayLike = 0.0,
    z: ArrayLike = 0.0,
    roll: ArrayLike = 0.0,
    pitch: ArrayLike = 0.0,
    yaw: ArrayLike = 0.0,
) -> PoseSet:
    """All combinations of the given values of x, y, z (m), roll, pitch, yaw (rad): each a number or a list.

    Axes with several values name the dimensions of the result.

    Raises: PoseError for values that are no finite numbers or lists of them.
    Source: own.
    """
    axes: dict[str, Array] = {}
    for name, value, unit in zip(AXES, (x, y, z, roll, pitch, yaw), UNITS, strict=True):
        try:
            axis = np.atleast_1d(np.asarray(value, dtype=np.float64))
        except (TypeError, ValueError):
            raise PoseError(f"{name} is {value!r}; it must be a number or a list of numbers, in {unit}") from None
        if axis.ndim > 1 or not axis.size:
            raise PoseError(f"{name} has shape {axis.shape}; it must be a number or a list of at least one number")
        if not np.isfinite(axis).all():
            raise PoseError(f"{name} holds NaN or infinity; values of a grid must be finite")
        axes[name] = axis
    return GridPoses(axes)


def pose_path(waypoints: Pose | ArrayLike, count: int) -> PoseSet:
    """`count` poses along a path through waypoints (a batch of poses, or rows (k, 6)), equally many between each two.

    Rows are x, y, z in m and roll, pitch, yaw in rad. Positions follow straight lines; orientations turn at a steady
    rate about a fixed axis from one to the next.

    Raises: PoseError for fewer than two waypoints.
    Source: own.
    """
    from scipy.spatial.transform import Rotation, Slerp

    poses = waypoints if isinstance(waypoints, Pose) else Pose.from_rpy(*np.moveaxis(_six(waypoints), -1, 0))
    if len(poses.shape) != 1 or poses.shape[0] < 2:
        raise PoseError(f"the waypoints have batch axes {poses.shape}; a path needs at least two poses in a row")
    knots = np.arange(float(poses.shape[0]))
    at = np.linspace(0.0, knots[-1], _count(count))
    position = np.stack([np.interp(at, knots, p) for p in poses.position.T], axis=-1)
    rotation = Slerp(knots, Rotation.from_matrix(poses.matrix))(at).as_matrix()
    return GivenPoses(np.concatenate([position, rotation.reshape(-1, 9)], axis=1), "path")


def described(description: Mapping[str, Any]) -> PoseSet | None:
    """The set that `PoseSet.describe` described; None for poses that were given one by one."""
    kind = description["kind"]
    if kind == "grid":
        return pose_grid(**description["axes"])
    if kind in ("random", "sobol"):
        make = random_poses if kind == "random" else low_discrepancy
        return make(Box(**description["box"]), description["count"], description["seed"])
    return None


def pose_set(poses: PoseSet | Pose | ArrayLike) -> PoseSet:
    """Whatever names poses, as a set: rows (..., 6) of x, y, z (m), roll, pitch, yaw (rad) are used without a copy.

    Raises PoseError for a wrong shape, and for no pose at all; NaN is left to the sweep.
    """
    if isinstance(poses, PoseSet):
        found = poses
    elif isinstance(poses, Pose):
        flat = poses.matrix.reshape(-1, 9)
        rows = np.concatenate([poses.position.reshape(-1, 3), flat], axis=1)
        found = GivenPoses(rows, shape=poses.shape)
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
    if not isinstance(value, Box):
        raise PoseError(f"box is {type(value).__name__}; it must be a flexapod Box, such as Box(x=(-0.1, 0.1), z=0.8)")
    return value


def _count(value: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
        raise PoseError(f"the number of poses is {value!r}; it must be a whole number, at least 1")
    return int(value)


def _seed(value: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 0:
        raise PoseError(f"seed is {value!r}; it must be a whole number, at least 0")
    return int(value)
