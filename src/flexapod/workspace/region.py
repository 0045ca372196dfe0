"""Where in the workspace a machine is looked at: every function with an argument `region` converts it here.

A region is a Pose (one or many), six numbers or rows (n, 6) of x, y, z (m), roll, pitch, yaw (rad), a Box or Workspace,
a PoseSet, a Trajectory, or None for the home pose. All are in the base frame, except a Workspace that is measured from
the home pose.
"""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias, TypeGuard, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from flexapod.checks import floats
from flexapod.conventions import Array
from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import HOME, numbers
from flexapod.errors import PoseError, shown
from flexapod.mechanics.inputs import as_hexapod, pose_or_home
from flexapod.pose import Pose
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.pose_sets import PoseSet, SobolPoses, given_poses, six_numbers

PATH_SAMPLES = 400  # poses along a trajectory


class Region(Protocol):
    """Poses at which a design is judged: x, y, z (m), roll, pitch, yaw (rad).

    from_home: they are added to the six numbers of the design's home pose, and move with it.
    """

    from_home: bool

    def rows(self, home: Array, samples: int, seed: int = 0) -> Array:
        """Poses (n, 6): about `samples` of a box, or all of a list."""
        ...

    def box(self, home: Array) -> Box | None:
        """The box in which the poses lie; None for a list."""
        ...

    def describe(self) -> dict[str, Any]: ...


@runtime_checkable
class Curve(Protocol):
    """A path on which poses can be taken, such as `fx.Trajectory`."""

    def poses(self, samples: int) -> Pose:
        """At least `samples` poses in their order."""
        ...


#: Whatever a function takes as `region`.
RegionLike: TypeAlias = "Region | Box | PoseSet | Pose | Curve | ArrayLike | None"


class PoseList:
    """Poses one by one, rows (n, 6)."""

    def __init__(self, rows: Array, from_home: bool = False) -> None:
        self._rows, self.from_home = rows, from_home

    def box(self, home: Array) -> None:
        return None

    def rows(self, home: Array, samples: int = 0, seed: int = 0) -> Array:
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


def as_region(value: RegionLike, name: str = "region") -> Region:
    """A region for any design, from what `RegionLike` lists; None is the home pose. Raises PoseError otherwise."""
    if value is None:
        return AT_HOME
    if isinstance(value, Workspace | PoseList):
        return value
    if isinstance(value, Box):
        return Workspace(value) if value.free else PoseList(value.low[None])
    if isinstance(value, PoseSet):
        return _listed(six_numbers(value.rows(0, value.count)), name)
    if _is_curve(value):
        value = value.poses(PATH_SAMPLES)
    if isinstance(value, Pose):
        return _listed(np.concatenate([value.position, value.rpy], axis=-1).reshape(-1, 6), name)
    try:
        rows = floats(value)
    except (TypeError, ValueError):
        rows = np.zeros(())
    if rows.ndim not in (1, 2) or rows.shape[-1] != 6 or not rows.size or not np.isfinite(rows).all():
        raise PoseError(
            f"{name} is {shown(value)}; give a Workspace, a Box, a PoseSet, a Pose, a Trajectory, or rows x, y, z (m), "
            "roll, pitch, yaw (rad)."
        )
    return PoseList(rows.reshape(-1, 6))


def _listed(rows: Array, name: str) -> PoseList:
    if not len(rows):
        raise PoseError(f"{name} holds no pose; at least one is needed.")
    return PoseList(rows)


def _is_curve(value: Any) -> TypeGuard[Curve]:
    """Whether poses can be taken along a value; a Dataset has an attribute of this name that is no function."""
    return isinstance(value, Curve) and callable(value.poses)


def poses_of(hexapod: Hexapod, region: RegionLike, samples: int, seed: int = 0) -> PoseSet:
    """The poses of a region for one design: those that it lists, or else `samples` of a box (Sobol) or a trajectory.

    Raises PoseError for a wrong shape, for no pose at all, or where a home pose is needed and not given; NaN is left
    to the sweep.
    """
    as_hexapod(hexapod)
    if isinstance(region, PoseSet):
        return region
    if isinstance(region, Box):
        return SobolPoses(region, samples, seed)
    if isinstance(region, Workspace):
        return SobolPoses(region.box(home_of(hexapod, region)), samples, seed)
    if region is None or isinstance(region, PoseList):
        listed = as_region(region)
        return given_poses(listed.rows(home_of(hexapod, listed), samples))
    given: Any = region.poses(samples) if _is_curve(region) else region
    return given_poses(given)


def home_of(hexapod: Hexapod, region: Region) -> Array:
    """The home pose that a region is measured from, (6,) m and rad; zeros if it is fixed in the base.

    Raises PoseError if the design names no home pose and the region needs it.
    """
    if not region.from_home:
        return np.zeros(6)
    pose_or_home(hexapod, None, "region")
    return numbers(hexapod)[HOME]
