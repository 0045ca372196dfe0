"""An array of poses cut into blocks: each a box of the array and, as arrays are in C order, a run of pose numbers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import prod
from typing import NamedTuple


class Block(NamedTuple):
    """Poses start to stop - 1, which lie at `region` of an array with the blocks' shape."""

    number: int
    start: int
    stop: int
    region: tuple[slice, ...]


@dataclass(frozen=True)
class Blocks:
    """Blocks of an array of `shape`; `chunk` has ones, then at most one part of an axis, then whole axes."""

    shape: tuple[int, ...]
    chunk: tuple[int, ...]

    @property
    def count(self) -> int:
        return prod(self.parts)

    @property
    def parts(self) -> tuple[int, ...]:
        """How many blocks there are along each axis."""
        return tuple(-(-n // c) for n, c in zip(self.shape, self.chunk, strict=True))

    def __getitem__(self, number: int) -> Block:
        region: list[slice] = []
        rest = number
        for size, step, parts in zip(self.shape[::-1], self.chunk[::-1], self.parts[::-1], strict=True):
            rest, part = divmod(rest, parts)
            region.append(slice(part * step, min((part + 1) * step, size)))
        region.reverse()
        start = 0
        for size, part_of in zip(self.shape, region, strict=True):
            start = start * size + part_of.start
        return Block(number, start, start + prod(s.stop - s.start for s in region), tuple(region))

    def __iter__(self) -> Iterator[Block]:
        return (self[number] for number in range(self.count))


def blocks(shape: tuple[int, ...], most: int) -> Blocks:
    """Blocks of at most `most` poses each, as large as may be."""
    chunk = [1] * len(shape)
    size = 1
    for axis in reversed(range(len(shape))):
        chunk[axis] = min(shape[axis], max(1, most // size))
        size *= chunk[axis]
        if chunk[axis] < shape[axis]:
            break
    return Blocks(tuple(int(n) for n in shape), tuple(int(n) for n in chunk))
