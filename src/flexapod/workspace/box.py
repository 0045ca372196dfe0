"""A box of poses: ranges of the six coordinates, fixed in the base or measured from a design's home pose."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats, not_negative, numbers
from flexapod.conventions import AXES, Array, unit_of
from flexapod.errors import ArgumentError, PoseError, shown
from flexapod.pose import Pose, as_pose
from flexapod.workspace.sobol import Sobol

BITS = 32  # of the coordinates of a Sobol point: the most that its integers hold


class Box:
    """Ranges of the six coordinates of a pose, in the base frame.

    Parameters
    ----------
    x, y, z : float or (least, largest), optional
        Range of a coordinate of the reference point, or one number where it is held, in m.
    roll, pitch, yaw : float or (least, largest), optional
        Range of a rotation about the fixed axes x, y, z, or one number where it is held, in rad.

    Attributes
    ----------
    low, high : ndarray, shape (6,)
        Least and largest values of x, y, z (m), roll, pitch, yaw (rad).

    Raises
    ------
    ArgumentError
        If the least value exceeds the largest, or a number is not finite.

    See Also
    --------
    Workspace : A box that may move with a design's home pose.
    random_poses, low_discrepancy : Poses of a box.

    Examples
    --------
    >>> box = fx.Box(x=(-0.1, 0.1), z=(0.7, 0.9), yaw=0.2)
    >>> box.free
    ('x', 'z')
    >>> round(box.volume, 6), box.volume_unit
    (0.04, 'm2')
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
    def about(cls, pose: Pose | ArrayLike, position: float, angle: float) -> Box:
        """Return the box in which each coordinate lies about that of a pose.

        Parameters
        ----------
        pose : Pose or array_like, shape (6,)
            Middle of the box.
        position, angle : float
            Half the range of x, y, z (m) and of roll, pitch, yaw (rad).

        Raises
        ------
        ArgumentError
            If half a range is negative or not finite.
        PoseError
            If a batch of poses is given.
        """
        middle = as_pose(pose)
        if middle.shape:
            raise PoseError(f"a box lies about one pose; this one has batch axes {middle.shape}. Index it first.")
        six = np.concatenate([middle.position, middle.rpy])
        half = _half_widths(position, angle)
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
        """Unit of the volume, such as "m3 rad3"."""
        free = [unit_of(name) for name in self.free]
        counts = [(unit, free.count(unit)) for unit in ("m", "rad")]
        return " ".join(f"{unit}{count if count > 1 else ''}" for unit, count in counts if count)

    def scale(self, points: ArrayLike) -> Array:
        """Map points of the unit cube to poses, for any sampler such as those of scipy.stats.qmc.

        Parameters
        ----------
        points : array_like, shape (..., 6)
            Points with coordinates from 0 to 1.

        Returns
        -------
        ndarray, shape (..., 6)
            x, y, z (m), roll, pitch, yaw (rad).

        Raises
        ------
        ArgumentError
            If the points are no finite numbers, or have other than six coordinates.
        """
        given = numbers(points, "points", None)
        if given.shape[-1:] != (6,):
            raise ArgumentError(f"points has shape {given.shape}; its last axis must hold six coordinates.")
        return given * (self.high - self.low) + self.low

    def ranges(self) -> dict[str, list[float]]:
        """Return the least and the largest value of each coordinate."""
        return {name: [float(a), float(b)] for name, a, b in zip(AXES, self.low, self.high, strict=True)}

    def __repr__(self) -> str:
        ranges = (f"{name}={a:.6g}" + (f"..{b:.6g}" if b > a else "") for name, (a, b) in self.ranges().items())
        return f"Box({', '.join(ranges)})"


def _half_widths(position: float, angle: float) -> Array:
    """(6,) half the ranges of a box about a pose, m and rad."""
    return np.repeat([not_negative(position, "position", "m"), not_negative(angle, "angle", "rad")], 3)


def _range(name: str, value: ArrayLike) -> tuple[float, float]:
    unit = unit_of(name)
    try:
        pair = np.broadcast_to(floats(value), 2)
    except (TypeError, ValueError):
        raise ArgumentError(
            f"{name} is {shown(value)}; it must be a number, or a pair of least and largest, in {unit}"
        ) from None
    low, high = map(float, pair)
    if not (np.isfinite(low) and np.isfinite(high)):
        raise ArgumentError(f"{name} is from {low} to {high} {unit}; both must be finite")
    if low > high:
        raise ArgumentError(f"{name} is from {low:.6g} to {high:.6g} {unit}; the least comes first. Swap the two.")
    return low, high


class Workspace:
    """All poses of a box, fixed in the base frame or measured from a design's home pose.

    Parameters
    ----------
    box : Box
        Ranges of the six coordinates, m and rad.
    from_home : bool, optional
        If True, the ranges are added to the six coordinates of the home pose, so that the workspace moves with it when
        a design changes. If False (default), the box is fixed in the base frame.

    Attributes
    ----------
    from_home : bool
        Whether the workspace moves with the home pose.

    Raises
    ------
    ArgumentError
        If `box` is not a Box, or no coordinate varies.

    Examples
    --------
    >>> fx.Workspace.about_home(0.05, 0.1)
    all poses within 0.05 m and 5.72958 degrees of home
    >>> round(fx.worst_pose(fx.load("motion-base"), fx.Workspace.about_home(0.05, 0.1), samples=1024).omega_1, 2)
    27.79
    """

    def __init__(self, box: Box, from_home: bool = False) -> None:
        if not isinstance(box, Box):
            raise ArgumentError(f"a workspace is a flexapod Box; this is {type(box).__name__}.")
        if not box.free:
            raise ArgumentError(f"{box!r} is one pose; a workspace needs a range of at least one coordinate.")
        self._box, self.from_home = box, from_home

    @classmethod
    def about_home(cls, position: float, angle: float) -> Workspace:
        """Return the workspace in which each coordinate lies about that of the home pose.

        Parameters
        ----------
        position, angle : float
            Half the range of x, y, z (m) and of roll, pitch, yaw (rad).

        Raises
        ------
        ArgumentError
            If half a range is negative or not finite, or both are 0.
        """
        half = _half_widths(position, angle)
        return cls(Box(*zip(-half, half, strict=True)), from_home=True)

    def box(self, home: Array) -> Box:
        """Return the box in the base frame, for a design with this home pose.

        Parameters
        ----------
        home : ndarray, shape (6,)
            x, y, z (m), roll, pitch, yaw (rad); without effect if the workspace is fixed in the base.
        """
        return Box(*zip(self._box.low + home, self._box.high + home, strict=True)) if self.from_home else self._box

    def rows(self, home: Array, samples: int, seed: int = 0) -> Array:
        """Return the middle and the corners of the box, where extremes often are, then points of a Sobol sequence.

        Parameters
        ----------
        home : ndarray, shape (6,)
            Home pose of the design.
        samples : int
            Number of points of the Sobol sequence.
        seed : int, optional
            Seed of the sequence's scrambling.

        Returns
        -------
        ndarray, shape (n, 6)
            x, y, z (m), roll, pitch, yaw (rad).
        """
        box = self.box(home)
        free = np.flatnonzero(box.high > box.low)
        middle = (box.low + box.high) / 2
        corners = np.tile(middle, (2 ** len(free), 1))
        corners[:, free] = list(product(*zip(box.low[free], box.high[free], strict=True)))
        return np.concatenate([middle[None], corners, box.scale(Sobol(6, seed, BITS).points(0, samples))])

    def describe(self) -> dict[str, Any]:
        """Return the ranges and `from_home` as plain data: what tells this workspace from others."""
        return {"box": self._box.ranges(), "from_home": self.from_home}

    def __repr__(self) -> str:
        low, high = self._box.low, self._box.high
        if self.from_home and np.array_equal(-low, high) and np.ptp(high[:3]) == np.ptp(high[3:]) == 0:
            return f"all poses within {high[0]:.6g} m and {np.degrees(high[3]):.6g} degrees of home"
        return f"{'home + ' if self.from_home else ''}{self._box!r}"
