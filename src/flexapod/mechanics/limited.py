"""A quantity that a design limits."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.errors import told_apart


class LimitedQuantity(NamedTuple):
    """A limited quantity: its name and unit, its values and its bounds."""

    name: str
    unit: str
    value: Array
    least: Array | float
    most: Array | float

    @property
    def kept(self) -> NDArray[np.bool_]:
        """Whether each value is within its bounds; one that is not known is not."""
        return np.asarray((self.value >= self.least) & (self.value <= self.most))

    def in_words(self) -> list[str]:
        """What the values of one pose exceed, leg by leg."""
        if self.kept.all():
            return []
        value = np.atleast_1d(self.value)
        if np.isnan(value).any():  # as leg forces are at a singular pose
            return [f"no {self.name} holds the pose, so that its limit is not kept"]
        low, high = np.broadcast_to(self.least, value.shape), np.broadcast_to(self.most, value.shape)
        words = []
        for i, v in enumerate(value):
            leg = f"leg {i + 1}: " if value.size == 6 else ""
            if v < low[i] or v > high[i]:
                where, bound = ("below", low[i]) if v < low[i] else ("above", high[i])
                told, limit = told_apart(float(v), float(bound))
                words.append(f"{leg}{self.name} {told} {self.unit} is {where} {limit} {self.unit}")
        return words


def together(exceeded: Iterable[str]) -> dict[str, int]:
    """What is exceeded, a sentence for all legs of which the same is to be said, and how many those are."""
    legs: dict[str, list[str]] = {}
    for words in exceeded:
        leg, colon, told = words.partition(": ")
        legs.setdefault(told if colon else words, []).append(leg.removeprefix("leg ") if colon else "")
    return {
        (f"leg{'s' * (len(which) > 1)} {', '.join(which)}: " if which[0] else "") + told: len(which)
        for told, which in legs.items()
    }
