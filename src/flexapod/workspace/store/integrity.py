"""Whether a stored sweep is what was written: sums of its description, sizes and sums of the files of its blocks.

The files of a block end in a CRC-32C sum, as the codec of that name of the Zarr format has it, so that other programs
check it as well. What describes the store is in JSON files, of which the store's own attributes hold a digest each, and
one of themselves.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from hashlib import sha256
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flexapod.conventions import AXES
from flexapod.errors import OutputError
from flexapod.optional import needed
from flexapod.workspace.quantities import QUANTITIES
from flexapod.workspace.store.blocks import Blocks

SUM_BYTES = 4
ROOT = "zarr.json"
_TOLD = 5  # damaged files that are named


def digest(content: bytes) -> str:
    """Sixteen digits that tell contents apart."""
    return sha256(content).hexdigest()[:16]


def sealed(attrs: Mapping[str, Any]) -> dict[str, Any]:
    """The attributes of a store with their own digest."""
    rest = {key: value for key, value in attrs.items() if key != "sum"}
    return {**rest, "sum": digest(json.dumps(rest, sort_keys=True).encode())}


def description_files(path: Path) -> dict[str, str]:
    """The files of a store that has no blocks yet, but for its own attributes: name in the store -> digest."""
    files = sorted(file for file in path.rglob("*") if file.is_file() and file != path / ROOT)
    return {file.relative_to(path).as_posix(): digest(file.read_bytes()) for file in files}


def damaged_description(path: Path, files: Mapping[str, str]) -> list[str]:
    """Those of the description's files that are missing or changed."""
    return [name for name, known in files.items() if _digest_of(path / name) != known]


def _digest_of(file: Path) -> str | None:
    try:
        return digest(file.read_bytes())
    except OSError:
        return None


class Layout(NamedTuple):
    """Where the numbers of a store lie: arrays by name, cut into blocks of which each has one file in every array."""

    path: Path
    arrays: tuple[str, ...]
    blocks: Blocks

    def files(self, number: int) -> Iterator[Path]:
        """The files of a block."""
        region = self.blocks[number].region
        indices = [str(part.start // step) for part, step in zip(region, self.blocks.chunk, strict=True)]
        for name in self.arrays:
            yield Path(self.path, name, "c", *indices, *(["0"] if _trailing(name) else []))

    def sizes(self) -> list[int]:
        """Of the files of any block, in the order of the arrays: a block at an edge is filled up to a whole one."""
        numbers = prod(self.blocks.chunk)
        return [numbers * (6 if _trailing(name) else 1) * dtype_of(name).itemsize + SUM_BYTES for name in self.arrays]

    def damaged(self, numbers: Iterable[int], thorough: bool) -> dict[int, list[str]]:
        """Blocks that are not whole: their files that are missing, cut, or (thorough) disagree with their sum."""
        sizes = self.sizes()
        found: dict[int, list[str]] = {}
        for number in numbers:
            wrong = [
                file for file, size in zip(self.files(number), sizes, strict=True) if not _whole(file, size, thorough)
            ]
            if wrong:
                found[number] = [file.relative_to(self.path).as_posix() for file in wrong]
        return found


def array_names(quantities: Iterable[str], keeps_poses: bool) -> tuple[str, ...]:
    """The arrays of a store that are cut into blocks."""
    return (*quantities, "status", *(AXES if keeps_poses else ()))


def dtype_of(name: str) -> np.dtype[Any]:
    """Of an array of a store."""
    return np.dtype({"status": "uint8"}.get(name) or (QUANTITIES[name].dtype if name in QUANTITIES else "float64"))


def _trailing(name: str) -> str:
    return QUANTITIES[name].trailing if name in QUANTITIES else ""


def _whole(file: Path, size: int, thorough: bool) -> bool:
    try:
        if not file.is_file() or file.stat().st_size != size:
            return False
        return not thorough or sum_agrees(file.read_bytes())
    except OSError:
        return False


def sum_agrees(content: bytes) -> bool:
    """Whether the bytes of a file end in the sum of those before them."""
    crc = needed("google_crc32c", "sweep", "a .zarr store needs zarr")
    body = memoryview(content)[:-SUM_BYTES]
    return bool(crc.value(bytes(body)).to_bytes(SUM_BYTES, "little") == content[-SUM_BYTES:])


def damage(path: Path, files: list[str]) -> OutputError:
    """What is told of damaged files of a store."""
    names = ", ".join(files[:_TOLD]) + (f" and {len(files) - _TOLD} more" if len(files) > _TOLD else "")
    return OutputError(
        f"{path} is damaged: {names} {'is' if len(files) == 1 else 'are'} missing or not what was written. Go on with "
        "the command that made it and --resume (SweepStore.resume): what is damaged is computed anew."
    )
