"""A store as Zarr reads it, guarded: no number that is not known to be the one that was written."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING

import numpy as np
from zarr.storage import LocalStore, WrapperStore

from flexapod.workspace.store.integrity import ROOT, Layout, damage, sum_agrees

if TYPE_CHECKING:
    from zarr.abc.store import ByteRequest
    from zarr.core.buffer import Buffer, BufferPrototype

_BLOCK = re.compile(r"(\w+)/c/([\d/]+)")


class Guarded(WrapperStore[LocalStore]):
    """The files of blocks that are done, each with its sum; those of others are not there yet, whatever a run left.

    Raises OutputError where a file is missing or is not what was written.
    """

    def __init__(self, store: LocalStore, layout: Layout, done: frozenset[int]) -> None:
        super().__init__(store)
        self.layout, self.done = layout, done

    def _with_store(self, store: LocalStore) -> Guarded:
        return type(self)(store, self.layout, self.done)

    async def get(self, key: str, prototype: BufferPrototype, byte_range: ByteRequest | None = None) -> Buffer | None:
        number = self._number(key)
        if number is not None and number not in self.done:
            return None
        try:
            found = await self._store.get(key, prototype, byte_range)
        except OSError:
            found = None
        if number is not None and (found is None or not sum_agrees(found.to_bytes())):
            raise damage(self.layout.path, [key])
        return found

    async def list_dir(self, prefix: str) -> AsyncIterator[str]:
        """What is in a directory; of the store itself its arrays, whatever else lies there."""
        async for name in self._store.list_dir(prefix):
            if prefix.strip("/") or (self.layout.path / name / ROOT).is_file():
                yield name

    def _number(self, key: str) -> int | None:
        """The block to which a file belongs."""
        match = _BLOCK.fullmatch(key)
        if match is None or match[1] not in self.layout.arrays:
            return None
        blocks = self.layout.blocks
        indices = tuple(map(int, match[2].split("/")))[: len(blocks.shape)]
        return int(np.ravel_multi_index(indices, blocks.parts))
