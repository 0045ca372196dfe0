"""Numbers of the core that follow from others of the design, where a search changes these (see layout.py)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.design.hexapod import Hexapod
from flexapod.design.layout import PLACES, WORDED
from flexapod.design.packing import series_compliance
from flexapod.design.stiffness_laws import TableLaw
from flexapod.rotations import rpy_matrix

_REST = "legs.joint_rest"


class Derived:
    """What follows from the numbers of a design that are `changed`: springs in series, the pose of rest, a table's end.

    Complex numbers keep their derivatives.
    """

    def __init__(self, hexapod: Hexapod, changed: NDArray[np.bool_]) -> None:
        legs = hexapod.legs
        self._springs = legs.series_stiffness.shape[1] if changed[WORDED["legs.series_stiffness"]].any() else 0
        home = [key for key in ("home.position", "home.orientation") if changed[PLACES[key]].any()]
        self._home = bool(home) and legs.joint_rest is None
        self._turned = bool(changed[WORDED[f"{_REST}.orientation"]].any())
        self._tables = [
            (place, len(legs.stiffness_law.lengths))
            for key in ("lengths", "stiffnesses")
            if isinstance(legs.stiffness_law, TableLaw) and changed[place := PLACES[f"legs.stiffness_law.{key}"]].any()
        ]

    def __bool__(self) -> bool:
        return bool(self._springs or self._home or self._turned or self._tables)

    def make(self, numbers: Any) -> None:
        """Write what follows into `FULL` numbers, which may be complex."""
        if self._springs:
            given = numbers[WORDED["legs.series_stiffness"][:, : self._springs]]
            numbers[PLACES["legs.series_compliance"]] = series_compliance(given)
        if self._home:
            numbers[PLACES[f"{_REST}.position"]] = numbers[PLACES["home.position"]]
            numbers[PLACES[f"{_REST}.matrix"]] = rpy_matrix(numbers[PLACES["home.orientation"]])
        if self._turned:
            numbers[PLACES[f"{_REST}.matrix"]] = rpy_matrix(numbers[WORDED[f"{_REST}.orientation"]])
        for place, count in self._tables:
            numbers[place[count:]] = numbers[place[count - 1]]
