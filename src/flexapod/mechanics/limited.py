"""A quantity that a design limits."""

from __future__ import annotations

from typing import NamedTuple

from flexapod.conventions import Array


class LimitedQuantity(NamedTuple):
    """A limited quantity: its name and unit, its values and its bounds."""

    name: str
    unit: str
    value: Array
    least: Array | float
    most: Array | float
