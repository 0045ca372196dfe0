"""Where a machine is looked at: a workspace box, or poses one by one; fixed in the base or carried along with home."""

from __future__ import annotations

from itertools import product
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from flexapod.conventions import Array
from flexapod.errors import ArgumentError, PoseError
from flexapod.pose import Pose
from flexapod.workspace.pose_sets import Box, low_discrepancy

ZERO = np.zeros(6)


class Places(Protocol):
    """Rows of x, y, z m, roll, pitch, yaw rad at which a design is judged.

    from_home: they are added to the six numbers of the design's home pose, and move with it.
    """

    from_home: bool

    def rows(self, home: Array, count: int, seed: int = 0) -> Array:
        """Poses to sweep (n, 6): about `count` of a box, or all of a list."""
        ...

    def box(self, home: Array) -> Box | None:
        """The box in which the poses lie; None for a list."""
        ...

    def describe(self) -> dict[str, Any]: ...


class Workspace:
    """All poses of a box (m, rad), in the base frame, or (from_home) measured from the design's home pose.

    Raises: ArgumentError for what is no Box; PoseError for a box without extent.
    Source: own.
    """

    def __init__(self, box: Box, from_home: bool = False) -> None:
        if not isinstance(box, Box):
            raise ArgumentError(f"a workspace is a flexapod Box; this is {type(box).__name__}.")
        if not box.free:
            raise PoseError(f"{box!r} is one pose; a workspace needs a range of at least one coordinate.")
        self._box, self.from_home = box, from_home

    @classmethod
    def about_home(cls, position: float, angle: float) -> Workspace:
        """Every coordinate of the home pose, plus and minus `position` (m) and `angle` (rad)."""
        half = np.repeat([float(position), float(angle)], 3)
        return cls(Box(*zip(-half, half, strict=True)), from_home=True)

    def box(self, home: Array) -> Box:
        """Where the box is for a design with this home pose (x, y, z m, roll, pitch, yaw rad)."""
        origin = home if self.from_home else ZERO
        return Box(*zip(self._box.low + origin, self._box.high + origin, strict=True))

    def rows(self, home: Array, count: int, seed: int = 0) -> Array:
        """The corners and the middle of the box, where extremes often are, then a Sobol sequence: (n, 6) m and rad."""
        box = self.box(home)
        free = np.flatnonzero(box.high > box.low)
        middle = (box.low + box.high) / 2
        corners = np.tile(middle, (2 ** len(free), 1))
        corners[:, free] = list(product(*zip(box.low[free], box.high[free], strict=True)))
        return np.concatenate([middle[None], corners, low_discrepancy(box, count, seed).rows(0, count)])

    def describe(self) -> dict[str, Any]:
        """In plain numbers: what makes this workspace and no other."""
        return {"box": self._box.ranges(), "from_home": self.from_home}

    def __repr__(self) -> str:
        low, high = self._box.low, self._box.high
        if self.from_home and np.array_equal(-low, high) and np.ptp(high[:3]) == np.ptp(high[3:]) == 0:
            return f"all poses within {high[0]:.6g} m and {np.degrees(high[3]):.6g} degrees of home"
        return f"{'home + ' if self.from_home else ''}{self._box!r}"


class PoseList:
    """Poses one by one, rows (n, 6)."""

    def __init__(self, rows: Array, from_home: bool = False) -> None:
        self._rows, self.from_home = rows, from_home

    def box(self, home: Array) -> None:
        return None

    def rows(self, home: Array, count: int, seed: int = 0) -> Array:
        return self._rows + home if self.from_home else self._rows

    def describe(self) -> dict[str, Any]:
        return {"poses": self._rows.tolist(), "from_home": self.from_home}

    def __repr__(self) -> str:
        if self.from_home and not self._rows.any():
            return "home"
        if len(self._rows) == 1:
            return "one pose"
        return f"{len(self._rows)} poses{' from home' if self.from_home else ''}"


AT_HOME = PoseList(np.zeros((1, 6)), from_home=True)


def places(value: Places | Box | Pose | ArrayLike | None) -> Places:
    """Whatever names places: a Workspace, a Box, a Pose or a batch of them, rows (n, 6); None is the home pose."""
    if value is None:
        return AT_HOME
    if isinstance(value, Workspace | PoseList):
        return value
    if isinstance(value, Box):
        return Workspace(value)
    if isinstance(value, Pose):
        return PoseList(np.concatenate([value.position, value.rpy], axis=-1).reshape(-1, 6))
    try:
        rows = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        rows = np.zeros(())
    if rows.ndim not in (1, 2) or rows.shape[-1] != 6 or not rows.size or not np.isfinite(rows).all():
        raise PoseError(
            f"{value!r} names no poses; give a Workspace, a Box, a Pose, or rows x, y, z (m), roll, pitch, yaw (rad)."
        )
    return PoseList(rows.reshape(-1, 6))
