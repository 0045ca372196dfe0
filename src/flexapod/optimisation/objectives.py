"""Objectives of a design search: the lowest natural frequency, or how well conditioned the force transformation is."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod.checks import numbers
from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.optimisation.constraint_quantities import Conditioning
from flexapod.optimisation.derivatives import DesignDerivatives, index_derivatives
from flexapod.workspace.region import PoseList, Region, RegionLike, as_region

_WORST = 16  # poses of a sweep that decide an objective, and that the local search holds


class Objective(Protocol):
    """A number to raise, from one quantity of a sweep over a region: an extension point.

    `LeastIndex`, `MeanIndex` and `Dexterity` are objectives. To add one, write a class with the attributes and methods
    below; `flexapod.optimise` then takes it.

    Attributes
    ----------
    quantity : str
        Name of a quantity of `flexapod.sweep`.
    unit, label : str
        Unit and name in figures.
    region : Region
        Where the quantity is taken.
    """

    quantity: str
    unit: str
    label: str

    @property
    def region(self) -> Region:
        """Where the quantity is taken."""
        ...

    def index(self, found: Array) -> float:
        """Return the objective from the quantity (n,) at every pose of a sweep; 0 if a pose has none."""
        ...

    def worst_poses(self, found: Array) -> NDArray[np.int64]:
        """Return the numbers of the poses that decide the objective."""
        ...

    def derivatives(self, at: DesignDerivatives, sharpness: float) -> tuple[Array, Array]:
        """Return logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        ...

    def describe(self) -> dict[str, Any]:
        """Return the objective in plain numbers and words: equal for equal objectives."""
        ...


class LeastIndex:
    """The smallest stability index over a region; at one pose, the index there.

    Parameters
    ----------
    region : Pose, array_like of shape (n, 6), Box, Workspace, PoseSet or Trajectory, optional
        Where the index counts; numbers are x, y, z in m, roll, pitch, yaw in rad. The home pose by default.

    Raises
    ------
    PoseError
        If the region is invalid.

    Notes
    -----
    The stability index is the lowest natural frequency, rad/s (the paper's conclusion 1).
    All poses count, also those beyond the limits of a design: a search would gain by putting its worst poses out of
    reach. `DesignLimits` is the constraint that keeps all of them within the limits.

    Examples
    --------
    >>> fx.LeastIndex(fx.Workspace.about_home(0.005, 0.1))
    least index over all poses within 0.005 m and 5.72958 degrees of home
    """

    quantity = "omega_1"
    unit = "rad/s"
    label = "index"

    def __init__(self, region: RegionLike = None) -> None:
        self.region = as_region(region)

    def index(self, found: Array) -> float:
        """Return the objective from the quantity (n,) at every pose of a sweep; 0 if a pose has none."""
        return float(found.min()) if np.isfinite(found).all() else 0.0

    def worst_poses(self, found: Array) -> NDArray[np.int64]:
        """Return the numbers of the poses that decide the objective."""
        return np.argsort(found)[:_WORST]

    def derivatives(self, at: DesignDerivatives, sharpness: float) -> tuple[Array, Array]:
        """Return logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        return index_derivatives(at, sharpness)

    def describe(self) -> dict[str, Any]:
        """Return the objective in plain numbers and words."""
        return {"least index over": self.region.describe()}

    def __repr__(self) -> str:
        return f"least index over {self.region!r}"


class MeanIndex:
    """The weighted mean of the stability index over poses, such as those of a path.

    Parameters
    ----------
    region : Pose, array_like of shape (n, 6), PoseSet or Trajectory
        The poses; numbers are x, y, z in m, roll, pitch, yaw in rad.
    weights : array_like, shape (n,), optional
        A weight >= 0 for each pose. Equal by default.

    Raises
    ------
    ArgumentError
        If the region is a box or a workspace, or the weights do not fit.
    PoseError
        If the region is invalid.

    Notes
    -----
    The stability index is the lowest natural frequency, rad/s (the paper's conclusion 1).
    All poses count, also those beyond the limits of a design: a search would gain by putting its worst poses out of
    reach. `DesignLimits` is the constraint that keeps all of them within the limits.

    Examples
    --------
    >>> fx.optimisation.MeanIndex([[0, 0, 0.8, 0, 0, 0], [0, 0, 0.9, 0, 0, 0]], weights=[1, 2])
    mean index over 2 poses
    """

    quantity = "omega_1"
    unit = "rad/s"
    label = "index"

    def __init__(self, region: RegionLike, weights: ArrayLike | None = None) -> None:
        poses = as_region(region)
        if not isinstance(poses, PoseList):
            raise ArgumentError("a mean is taken over poses one by one, not over a box. Give a batch of poses.")
        self.region = poses
        count = len(poses.rows(np.zeros(6), 0))
        given = np.ones(count) if weights is None else numbers(weights, "weights")
        if given.shape != (count,) or (given < 0).any() or not given.any():
            raise ArgumentError(
                f"weights has shape {given.shape} for {count} poses; one number >= 0 is needed for each, not all 0."
            )
        self.weights: Array = given / given.sum()

    def index(self, found: Array) -> float:
        """Return the objective from the quantity (n,) at every pose of a sweep; 0 if a pose has none."""
        return float(self.weights @ found) if np.isfinite(found).all() else 0.0

    def worst_poses(self, found: Array) -> NDArray[np.int64]:
        """Return the numbers of the poses that decide the objective: all."""
        return np.arange(len(found))

    def derivatives(self, at: DesignDerivatives, sharpness: float) -> tuple[Array, Array]:
        """Return logarithms of what must be raised together, (1,), and their derivatives by the variables, (1, n)."""
        logarithm, slope = index_derivatives(at, sharpness)
        part = self.weights * np.exp(logarithm)
        return np.log(part.sum(keepdims=True)), (part @ slope)[None] / part.sum()

    def describe(self) -> dict[str, Any]:
        """Return the objective in plain numbers and words."""
        return {"mean index over": self.region.describe(), "weights": self.weights.tolist()}

    def __repr__(self) -> str:
        return f"mean index over {self.region!r}"


class Dexterity:
    """The smallest 1/cond(H) over a region, with H in m: what "best conditioned" designs maximise.

    Parameters
    ----------
    region : Pose, array_like of shape (n, 6), Box, Workspace, PoseSet or Trajectory, optional
        Where it counts; numbers are x, y, z in m, roll, pitch, yaw in rad. The home pose by default.

    Raises
    ------
    PoseError
        If the region is invalid.

    Notes
    -----
    The condition number of the force transformation H (Section 3) does not depend on mass and stiffness, and its
    optimum is not that of the stability index.

    Examples
    --------
    >>> fx.optimisation.Dexterity()
    least 1/cond(H) over home
    """

    quantity = "cond_H"
    unit = ""
    label = "1/cond(H)"

    def __init__(self, region: RegionLike = None) -> None:
        self.region = as_region(region)

    def index(self, found: Array) -> float:
        """Return the objective from the quantity (n,) at every pose of a sweep; 0 if a pose has none."""
        return float(1 / found.max()) if np.isfinite(found).all() else 0.0

    def worst_poses(self, found: Array) -> NDArray[np.int64]:
        """Return the numbers of the poses that decide the objective."""
        return np.argsort(-found)[:_WORST]

    def derivatives(self, at: DesignDerivatives, sharpness: float) -> tuple[Array, Array]:
        """Return logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        value, slope, _ = Conditioning().derivatives(at)
        return -np.log(value), -slope / value[:, None]

    def describe(self) -> dict[str, Any]:
        """Return the objective in plain numbers and words."""
        return {"least 1/cond(H) over": self.region.describe()}

    def __repr__(self) -> str:
        return f"least 1/cond(H) over {self.region!r}"
