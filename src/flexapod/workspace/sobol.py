"""Scrambled Sobol sequences of which any part is found by its numbers: the points that scipy.stats.qmc makes.

Loading scipy.stats takes longer than most of the work that wants some hundred points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array
from flexapod.errors import ArgumentError

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


@lru_cache(maxsize=4)
def _scrambled(sequence: Sobol) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Point 0 and the direction numbers, (dimensions, bits), after a random linear scrambling and shift.

    J. Matousek, On the L2-discrepancy for anchored boxes, Journal of Complexity 14 (1998).
    """
    d, bits = sequence.dimensions, sequence.bits
    random = np.random.default_rng(sequence.seed).spawn(1)[0]  # as scipy.stats.qmc does
    shift = random.integers(2, size=(d, bits), dtype=np.uint32) @ (np.uint32(1) << np.arange(bits, dtype=np.uint32))
    lower = np.tril(random.integers(2, size=(d, bits, bits), dtype=np.uint32), -1) + np.eye(bits, dtype=np.uint32)
    places = np.arange(bits - 1, -1, -1, dtype=np.uint32)[:, None]
    digits = _directions(d, bits)[:, None, :] >> places & np.uint32(1)  # (d, place from the highest, bits)
    mixed = (lower.astype(float) @ digits.astype(float)).astype(np.uint32) & np.uint32(1)
    return shift.astype(np.uint32), np.bitwise_or.reduce(mixed << places, axis=1)


def _directions(dimensions: int, bits: int) -> NDArray[np.uint32]:
    """Direction numbers of the first dimensions, (dimensions, bits)."""
    with resources.files("flexapod.workspace").joinpath("sobol_directions.txt").open(encoding="ascii") as file:
        rows = islice((line for line in file if not line.startswith("#")), dimensions - 1)
        numbers = [[1] * bits, *(_recurrence(*map(int, line.split()), bits=bits) for line in rows)]
    if len(numbers) < dimensions:
        raise ArgumentError(f"{dimensions} numbers vary; a Sobol sequence has at most {len(numbers)} dimensions here")
    return np.array(numbers, np.uint32) << np.arange(bits - 1, -1, -1, dtype=np.uint32)


def _recurrence(polynomial: int, *initial: int, bits: int) -> list[int]:
    """The odd numbers m_1 to m_bits of a primitive polynomial over two elements, written as its bits."""
    degree, m = len(initial), list(initial[:bits])
    while len(m) < bits:
        following = m[-degree]
        for k in range(1, degree + 1):
            if polynomial >> (degree - k) & 1:
                following ^= m[-k] << k
        m.append(following)
    return m


@lru_cache(maxsize=4)
def _table(sequence: Sobol) -> NDArray[np.uint32]:
    """The first PIECE points: each half is the one before it, changed by one direction number and in reverse."""
    origin, directions = _scrambled(sequence)
    points = origin[None]
    for j in range(PIECE.bit_length() - 1):
        points = np.concatenate([points, points[::-1] ^ directions[:, j]])
    return points


@lru_cache(maxsize=128)
def _difference_of_power(sequence: Sobol, exponent: int) -> NDArray[np.uint32]:
    directions = _scrambled(sequence)[1]
    return directions[:, exponent] ^ directions[:, exponent - 1] if exponent else directions[:, 0]
