"""The home pose of a design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats
from flexapod.conventions import Array
from flexapod.design.schema import KEYS
from flexapod.design.value_checks import check_value
from flexapod.errors import DesignError, shown
from flexapod.pose import Pose, PoseLike, as_pose
from flexapod.rotations import rpy_matrix


def home_of(values: Mapping[str, Any], table: str = "home") -> Home | None:
    """The home pose of a design by its values, or another pose of the same kind, where they have one."""
    if f"{table}.position" not in values:
        return None
    return Home(values[f"{table}.position"], values.get(f"{table}.orientation", (0.0, 0.0, 0.0)), table)


class Home(Pose):
    """The home pose of a design, or its rest: one `Pose` that keeps roll, pitch and yaw as given, bit for bit.

    Unpacks as `position, rpy = home`.
    """

    __slots__ = ("_rpy",)

    def __init__(self, position: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0), table: str = "home") -> None:
        angles = check_value(f"{table}.orientation", rpy, KEYS["home.orientation"])
        super().__init__(check_value(f"{table}.position", position, KEYS["home.position"]), rpy_matrix(angles))
        angles.flags.writeable = False
        self._rpy = angles

    @classmethod
    def of(cls, value: PoseLike, table: str = "home") -> Home:
        """A home from any single pose; DesignError, which says the key `table`, where it is none."""
        if isinstance(value, Home):
            return value
        if not isinstance(value, Pose):
            try:
                six = floats(value)
            except (TypeError, ValueError):
                six = np.empty(0)
            if six.shape != (6,):
                raise DesignError(
                    f"{table} is {shown(value)}; it must be a Pose, or x, y, z in m and roll, pitch, yaw in rad."
                )
            return cls(six[:3], six[3:], table)
        pose = as_pose(value, table)
        if pose.shape:
            raise DesignError(f"{table} has batch axes {pose.shape}; a design has one such pose. Index it first.")
        return cls(pose.position, pose.rpy, table)

    @property
    def rpy(self) -> Array:
        """Roll, pitch, yaw in rad, (3,), as they were given."""
        return self._rpy

    def __iter__(self) -> Iterator[Array]:
        return iter((self.position, self.rpy))

    def __reduce__(self) -> tuple[Any, ...]:
        return Home, (self.position, self.rpy)
