"""What a search raises: the lowest natural frequency at a pose, its least over a workspace, its mean over a path; or,
for comparison, how well conditioned the force transformation is."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexapod.conventions import Array
from flexapod.errors import ArgumentError
from flexapod.optimisation.constraint_quantities import Conditioning
from flexapod.optimisation.derivatives import Slopes, index_slopes
from flexapod.pose import Pose
from flexapod.workspace.region import PoseList, Region, RegionLike, as_region

Numbers = NDArray[np.int64]
_HELD = 16  # lowest poses of a sweep that the finish holds up


class Objective(Protocol):
    """A number to raise, made of a quantity of the sweep at some places. unit, label: as figures show it."""

    quantity: str
    unit: str
    label: str

    @property
    def over(self) -> Region: ...

    def index(self, found: Array) -> float:
        """From the quantity at every pose swept; 0 where a pose has none."""
        ...

    def held(self, found: Array) -> Numbers:
        """Numbers of the poses that decide it."""
        ...

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        """Logarithms of what must be raised together, (k,) and (k, n)."""
        ...

    def describe(self) -> dict[str, Any]: ...


class _Index:
    quantity = "omega_1"
    unit = "rad/s"
    label = "index"


class LeastIndex(_Index):
    """The least stability index (rad/s) over a workspace, a box, or poses; at one pose, the index there. None: at home.

    Raises: PoseError for what names no poses.
    Source: conclusion 1.
    """

    def __init__(self, over: RegionLike = None) -> None:
        self.over = as_region(over)

    def index(self, found: Array) -> float:
        """The objective from the quantity at every pose swept, (n,); 0 where a pose has none."""
        return float(found.min()) if np.isfinite(found).all() else 0.0

    def held(self, found: Array) -> Numbers:
        """Numbers of the poses that decide it, of (n,) values."""
        return np.argsort(found)[:_HELD]

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        """Logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        return index_slopes(at, sharpness)

    def describe(self) -> dict[str, Any]:
        """In plain numbers and words: what makes this objective and no other."""
        return {"least index over": self.over.describe()}

    def __repr__(self) -> str:
        return f"least index over {self.over!r}"


class MeanIndex(_Index):
    """The weighted mean of the stability index (rad/s) over the poses of a path.

    weights: one a pose, >= 0; default equal.

    Raises: ArgumentError for a box, or weights that do not fit; PoseError for what names no poses.
    Source: conclusion 1.
    """

    def __init__(self, poses: Pose | ArrayLike, weights: ArrayLike | None = None) -> None:
        over = as_region(poses)
        if not isinstance(over, PoseList):
            raise ArgumentError("a mean is taken over poses one by one, not over a box. Give a batch of poses.")
        self.over = over
        count = len(over.rows(np.zeros(6), 0))
        given = np.ones(count) if weights is None else np.asarray(weights, dtype=np.float64)
        if given.shape != (count,) or not np.isfinite(given).all() or (given < 0).any() or not given.any():
            raise ArgumentError(
                f"weights has shape {given.shape} for {count} poses; one number >= 0 is needed for each, not all 0."
            )
        self.weights: Array = given / given.sum()

    def index(self, found: Array) -> float:
        """The objective from the quantity at every pose swept, (n,); 0 where a pose has none."""
        return float(self.weights @ found) if np.isfinite(found).all() else 0.0

    def held(self, found: Array) -> Numbers:
        """Numbers of the poses that decide it, of (n,) values."""
        return np.arange(len(found))

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        """Logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        logarithm, slope = index_slopes(at, sharpness)
        part = self.weights * np.exp(logarithm)
        return np.log(part.sum(keepdims=True)), (part @ slope)[None] / part.sum()

    def describe(self) -> dict[str, Any]:
        """In plain numbers and words: what makes this objective and no other."""
        return {"mean index over": self.over.describe(), "weights": self.weights.tolist()}

    def __repr__(self) -> str:
        return f"mean index over {self.over!r}"


class Dexterity:
    """1/cond(H), H in metres, at its least over a workspace, a box, or poses: what "best conditioned" designs maximise.

    It knows nothing of mass and stiffness, and its optimum is not that of the stability index.

    Raises: PoseError for what names no poses.
    Source: own; Section 3 sets cond(H) beside the index.
    """

    quantity = "cond_H"
    unit = ""
    label = "1/cond(H)"

    def __init__(self, over: RegionLike = None) -> None:
        self.over = as_region(over)

    def index(self, found: Array) -> float:
        """The objective from the quantity at every pose swept, (n,); 0 where a pose has none."""
        return float(1 / found.max()) if np.isfinite(found).all() else 0.0

    def held(self, found: Array) -> Numbers:
        """Numbers of the poses that decide it, of (n,) values."""
        return np.argsort(-found)[:_HELD]

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        """Logarithms of what must be raised together, (k,), and their derivatives by the variables, (k, n)."""
        value, slope, _ = Conditioning().slopes(at)
        return -np.log(value), -slope / value[:, None]

    def describe(self) -> dict[str, Any]:
        """In plain numbers and words: what makes this objective and no other."""
        return {"least 1/cond(H) over": self.over.describe()}

    def __repr__(self) -> str:
        return f"least 1/cond(H) over {self.over!r}"
