"""What a search raises: the lowest natural frequency at a pose, its least over a workspace, its mean over a path."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from flexapod.errors import ArgumentError
from flexapod.optimal.places import Places, PoseList, places
from flexapod.optimal.slopes import Slopes, index_slopes
from flexapod.pose import Array, Pose
from flexapod.posesets import Box

_HELD = 16  # lowest poses of a sweep that the finish holds up


class Objective(Protocol):
    """An index made of the lowest frequencies at some places, rad/s."""

    over: Places

    def index(self, omega_1: Array) -> float:
        """From the lowest frequency at every pose swept."""
        ...

    def held(self, omega_1: Array) -> Array:
        """Numbers of the poses that decide it."""
        ...

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        """Logarithms of what must be raised together, (k,) and (k, n)."""
        ...

    def describe(self) -> dict[str, Any]: ...


class LeastIndex:
    """The least stability index over a workspace, a box, or poses; at one pose, the index there. None: at home."""

    def __init__(self, over: Places | Box | Pose | ArrayLike | None = None) -> None:
        self.over = places(over)

    def index(self, omega_1: Array) -> float:
        return float(omega_1.min()) if np.isfinite(omega_1).all() else 0.0

    def held(self, omega_1: Array) -> Array:
        return np.argsort(omega_1)[:_HELD]

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        return index_slopes(at, sharpness)

    def describe(self) -> dict[str, Any]:
        return {"least index over": self.over.describe()}

    def __repr__(self) -> str:
        return f"least index over {self.over!r}"


class MeanIndex:
    """The weighted mean of the stability index over the poses of a path. weights: one a pose, >= 0; default equal."""

    def __init__(self, poses: Pose | ArrayLike, weights: ArrayLike | None = None) -> None:
        over = places(poses)
        if not isinstance(over, PoseList):
            raise ArgumentError("a mean is taken over poses one by one, not over a box. Give a batch of poses.")
        self.over = over
        count = len(over.rows(np.zeros(6), 0))
        given = np.ones(count) if weights is None else np.asarray(weights, dtype=np.float64)
        if given.shape != (count,) or not np.isfinite(given).all() or (given < 0).any() or not given.any():
            raise ArgumentError(
                f"weights has shape {given.shape} for {count} poses; it must hold one number >= 0 for each pose, not all 0."
            )
        self.weights: Array = given / given.sum()

    def index(self, omega_1: Array) -> float:
        return float(self.weights @ omega_1) if np.isfinite(omega_1).all() else 0.0

    def held(self, omega_1: Array) -> Array:
        return np.arange(len(omega_1))

    def slopes(self, at: Slopes, sharpness: float) -> tuple[Array, Array]:
        logarithm, slope = index_slopes(at, sharpness)
        part = self.weights * np.exp(logarithm)
        return np.log(part.sum(keepdims=True)), (part @ slope)[None] / part.sum()

    def describe(self) -> dict[str, Any]:
        return {"mean index over": self.over.describe(), "weights": self.weights.tolist()}

    def __repr__(self) -> str:
        return f"mean index over {self.over!r}"
