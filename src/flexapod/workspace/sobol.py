"""Scrambled Sobol sequences of which any part is found by its numbers, as scipy.stats.qmc makes them from the start."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array

PIECE = 4096  # points made at a time, so that they stay in cache


@dataclass(frozen=True)
class Sobol:
    """The scrambled Sobol sequence of `scipy.stats.qmc.Sobol(dimensions, rng=seed, bits=bits)`.

    Point i xor point 0 is linear over xor in the binary digits of i, since its Gray code is. So any point is a
    combination of the points 2^j, and a sequence need not be walked from its start.
    """

    dimensions: int
    seed: int
    bits: int = 30

    def points(self, start: int, stop: int) -> Array:
        """Points start to stop - 1, (stop - start, dimensions), each coordinate from 0 to 1."""
        out = np.empty((stop - start, self.dimensions))
        for part, integers in self.pieces(start, stop):
            np.multiply(integers, 2.0**-self.bits, out=out[part])
        return out

    def pieces(self, start: int, stop: int) -> Iterator[tuple[slice, NDArray[np.uint32]]]:
        """The same in pieces, as integers of `bits` bits, with the place of each piece in the whole."""
        table = _table(self)
        position = start
        while position < stop:
            block, offset = divmod(position, PIECE)
            step = min(PIECE - offset, stop - position)
            integers = table[offset : offset + step] ^ self._difference(block * PIECE)
            yield slice(position - start, position - start + step), integers
            position += step

    def _difference(self, number: int) -> NDArray[np.uint32]:
        """Point `number` xor point 0."""
        digits = [_difference_of_power(self, j) for j in range(number.bit_length()) if number >> j & 1]
        return np.bitwise_xor.reduce(digits, axis=0) if digits else np.zeros(self.dimensions, np.uint32)

    def begin(self) -> Any:
        """SciPy's generator at the start of the sequence."""
        from scipy.stats import qmc

        return qmc.Sobol(self.dimensions, scramble=True, bits=self.bits, rng=self.seed)

    def integers(self, points: Array) -> NDArray[np.uint32]:
        """Points as integers of `bits` bits."""
        return (points * 2.0**self.bits).astype(np.uint32)


@lru_cache(maxsize=4)
def _table(sequence: Sobol) -> NDArray[np.uint32]:
    return sequence.integers(sequence.begin().random(PIECE))


@lru_cache(maxsize=128)
def _difference_of_power(sequence: Sobol, exponent: int) -> NDArray[np.uint32]:
    generator = sequence.begin()
    generator.fast_forward(1 << exponent)
    return sequence.integers(generator.random(1))[0] ^ _table(sequence)[0]
