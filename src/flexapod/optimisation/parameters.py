"""The smooth maps from the parameters of a search to numbers of a design.

They take complex numbers as well, so that derivatives are exact to rounding (complex step).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import TWO_PI, Array
from flexapod.design import layout
from flexapod.errors import ArgumentError

Kind = Literal["set", "add", "scale"]


@dataclass(frozen=True)
class Parameter:
    """A variable's name and bounds (SI), its unit in SI units and in words, and where the design has it."""

    name: str
    low: float
    high: float
    unit: float = 1.0
    log: bool = False
    start: float = np.nan
    unit_name: str = ""

    def check(self) -> None:
        if not (np.isfinite(self.low) and np.isfinite(self.high)):
            raise ArgumentError(f"{self.name} has the bounds {self.low} and {self.high}; both must be finite numbers.")
        if not self.low < self.high:
            low, high = self.low / self.unit, self.high / self.unit
            raise ArgumentError(
                f"{self.name} has the bounds {low:.6g} and {high:.6g}, which contradict each other; the lower bound "
                "must be < the upper one. To hold a number, leave it out of the variables."
            )
        if self.log and self.low <= 0:
            raise ArgumentError(f"{self.name} is searched in its logarithm; its lower bound must be > 0.")


@dataclass(frozen=True)
class AffineMap:
    """The map of a `Variable`: numbers that are affine in one parameter."""

    parameter: Parameter
    index: NDArray[np.int64]
    factor: Array
    base: Array
    kind: Kind

    @property
    def parameters(self) -> list[Parameter]:
        return [self.parameter]

    @property
    def touched(self) -> NDArray[np.int64]:
        return self.index

    def start(self) -> list[float]:
        if self.kind == "set":
            return [float((self.base / self.factor).mean())]
        return [0.0 if self.kind == "add" else 1.0]

    def put(self, x: Any, numbers: Any) -> None:
        if self.kind == "set":
            numbers[self.index] = self.factor * x[0]
        elif self.kind == "add":
            numbers[self.index] = self.base + self.factor * x[0]
        else:
            numbers[self.index] = self.base * (1 + self.factor * (x[0] - 1))


@dataclass(frozen=True)
class CircleMap:
    """The map of a `JointCircle`: radius, half angle, turn and height, each a parameter or a number.

    tangent: the legs whose axes follow the circle, (6,); which they are does not change within a search.
    """

    plate: str
    four: list[Parameter | float]
    third: Array
    side: Array
    tangent: NDArray[np.bool_]

    @property
    def parameters(self) -> list[Parameter]:
        return [p for p in self.four if isinstance(p, Parameter)]

    @property
    def touched(self) -> NDArray[np.int64]:
        joints = layout.PLACES[f"{self.plate}.joints"].ravel()
        axes = layout.PLACES["base.universal_axes"][self.tangent].ravel()
        return np.concatenate([joints, axes])

    def start(self) -> list[float]:
        return [p.start for p in self.parameters]

    def put(self, x: Any, numbers: Any) -> None:
        given = iter(x)
        radius, half, turn, height = (next(given) if isinstance(p, Parameter) else p for p in self.four)
        angle = turn + self.third * (TWO_PI / 3) + self.side * half
        place = layout.PLACES[f"{self.plate}.joints"]
        cosine, sine = np.cos(angle), np.sin(angle)
        numbers[place[:, 0]], numbers[place[:, 1]], numbers[place[:, 2]] = radius * cosine, radius * sine, height
        axes = layout.PLACES["base.universal_axes"][self.tangent].T
        numbers[axes[0]], numbers[axes[1]], numbers[axes[2]] = -sine[self.tangent], cosine[self.tangent], 0.0


Part = AffineMap | CircleMap
