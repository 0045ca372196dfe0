"""One block of a stored sweep: what it needs, and how it is computed and put on the disk, by whomever."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from flexapod import _core
from flexapod.conventions import AXES, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import OutputError
from flexapod.optional import needed
from flexapod.workspace.pose_sets import PoseSet, six_numbers
from flexapod.workspace.quantities import QUANTITIES, evaluate
from flexapod.workspace.store.blocks import Blocks
from flexapod.workspace.store.integrity import Layout, array_names

if TYPE_CHECKING:
    import zarr


BLOCK_BYTES = 2**26


class Job(NamedTuple):
    """All that a block needs wherever it is computed. `token` names the run, so that nothing is kept between runs."""

    path: str
    hexapod: Hexapod
    points: PoseSet | None
    quantities: tuple[str, ...]
    joint: JointModel
    blocks: Blocks
    keep_poses: bool
    instruction_set: str
    token: str
    threads: int = 1

    @property
    def layout(self) -> Layout:
        return Layout(Path(self.path), array_names(self.quantities, self.keep_poses), self.blocks)


class Finished(NamedTuple):
    """A block that is on the disk, and how many of its poses have which status."""

    number: int
    poses: int
    statuses: dict[int, int]


class Workers(Protocol):
    """Whatever computes blocks: threads of this process, or a cluster."""

    def compute(self, job: Job, numbers: Iterable[int], stop: Callable[[], bool]) -> Iterator[Finished]:
        """Blocks as they are finished; when `stop` says so, those that are begun are finished and no other begun."""
        ...


def write_block(job: Job, number: int, rows: Array | None = None) -> Finished:
    """Compute a block and write it; the operating system may still hold it in memory."""
    block = job.blocks[number]
    if _core.simd() != job.instruction_set:
        raise OutputError(
            f"this store is computed with {job.instruction_set} instructions, a worker here uses {_core.simd()}; the "
            "last digits would differ. Set FLEXAPOD_SIMD to the same name everywhere."
        )
    if rows is None:
        assert job.points is not None
        rows = job.points.rows(block.start, block.stop)
    found = evaluate(job.hexapod, rows, job.quantities, job.joint, job.threads)
    if job.keep_poses:
        found |= dict(zip(AXES, six_numbers(rows).T, strict=True))
    arrays = open_arrays(job.path, job.token)
    for name, values in found.items():
        shape = tuple(part.stop - part.start for part in block.region)
        arrays[name][block.region] = values.reshape(shape + values.shape[1:])
    counts = np.bincount(found["status"], minlength=1)
    return Finished(number, block.stop - block.start, {code: int(n) for code, n in enumerate(counts) if n})


def zarr_package() -> Any:
    """The module zarr. Raises MissingExtraError where it is not installed."""
    return needed("zarr", "sweep", "a .zarr store needs zarr")


@lru_cache(maxsize=8)
def open_arrays(path: str, token: str) -> dict[str, zarr.Array]:
    """The arrays of a store, opened once in a process and run."""
    zarr = zarr_package()
    try:
        with zarr.config.set({"array.write_empty_chunks": True}):  # or each chunk is compared with the fill value first
            return dict(zarr.open_group(path, mode="r+").arrays())
    except FileNotFoundError:
        import socket

        raise OutputError(
            f"{path} is not there as {socket.gethostname()} sees it. Put the store on a disk that all workers share."
        ) from None


def flush_block(job: Job, number: int) -> None:
    """Have a block's chunks on the disk itself, so that what is marked as done outlives a power cut."""
    for file in job.layout.files(number):
        sync(file)
        sync(file.parent)


def sync(path: Path) -> None:
    """Have a file or directory on the disk itself."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except PermissionError:  # directories cannot be opened on Windows
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def poses_per_block(quantities: tuple[str, ...], keep_poses: bool) -> int:
    """As many poses as have `BLOCK_BYTES`, a power of two."""
    bytes_each = 1 + 48 * keep_poses
    for name in quantities:
        bytes_each += np.dtype(QUANTITIES[name].dtype).itemsize * (6 if QUANTITIES[name].trailing else 1)
    return 1 << (BLOCK_BYTES // bytes_each).bit_length() - 1
