"""A sweep on disk: poses by the billion streamed to a Zarr store, block by block, to be taken up again where it ended.

A block counts when its chunks are on the disk and the store's metadata, replaced as a whole after that, name it. So
nothing that ends a run, a power cut included, leaves half a block that passes for a whole one; and since a block's
numbers depend on nothing but its number, a run in pieces writes the bytes of a run in one go. Whatever damages a store
later is found by sums (`integrity.py`): it is told where it is read, and computed anew where the run is taken up.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple
from uuid import uuid4

import numpy as np

from flexapod import _core
from flexapod.checks import whole
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import OutputError
from flexapod.mechanics.inputs import as_joint
from flexapod.showing import in_notebooks
from flexapod.workspace.pose_sets import GivenPoses, GridPoses, PoseSet
from flexapod.workspace.quantities import QUANTITIES, chosen
from flexapod.workspace.region import RegionLike, poses_of
from flexapod.workspace.store.block_job import Job, Workers, zarr_package
from flexapod.workspace.store.blocks import Blocks, blocks
from flexapod.workspace.store.integrity import damage, damaged_description
from flexapod.workspace.store.metadata import (
    attributes_of,
    make_store,
    mend_description,
    ranges,
    read_description,
    refuse_other,
    remove,
    replace_attributes,
)
from flexapod.workspace.store.one_writer import one_writer, remove_partial
from flexapod.workspace.store.threads import Threads

if TYPE_CHECKING:
    import xarray as xr

BLOCK_BYTES = 2**26
MOST_BLOCKS = 2**22
MARK_EVERY = 1.0  # s: at most so much work is done again after a power cut
SAMPLES = 2**20  # poses of a box


class Progress(NamedTuple):
    """How far a run is: poses on the disk, in all and before it began, and poses by status in this run."""

    done: int
    total: int
    before: int
    statuses: dict[int, int]


@in_notebooks
class SweepStore:
    """A sweep in a directory of the disk, whole or in part, in the Zarr format.

    Made by `create`, or by `resume` where there is one already; `run` computes what is missing. A run that is stopped
    or killed loses nothing that is on the disk, and a sweep computed in several runs has the bytes of one computed at
    once.

    Attributes
    ----------
    state : Progress
        How far it is: poses that are done, in all, and done before this run, and poses of this run by status.
    damaged : tuple of str
        Files that `resume` found missing or not as they were written. Their blocks are no longer done.

    See Also
    --------
    open_sweep : The numbers of a store.
    cluster : Workers on several computers.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> region = fx.Workspace.about_home(0.2, 0.1)
    >>> store = fx.workspace.SweepStore.create("map.zarr", machine, region, samples=1000)
    >>> store.run().done, store.complete
    (1000, True)
    >>> round(fx.summarise(fx.open_sweep("map.zarr")).worst.omega_1, 1)
    26.4
    """

    def __init__(self, job: Job, done: set[int], files: dict[str, str], damaged: tuple[str, ...] = ()) -> None:
        self.job, self.done, self._files, self.damaged = job, done, files, damaged
        self.state = self._progress(self._poses_done(), Counter())

    @classmethod
    def create(
        cls,
        path: str | Path,
        hexapod: Hexapod,
        region: RegionLike = None,
        *,
        quantities: str | Iterable[str] | None = None,
        samples: int = SAMPLES,
        seed: int = 0,
        joint: JointModel = "universal",
        chunk: int | None = None,
        keep_poses: bool = True,
    ) -> SweepStore:
        """Make an empty store.

        Parameters
        ----------
        path : str or Path
            Where; there must be nothing yet.
        hexapod : Hexapod
            The machine.
        region, quantities, samples, seed, joint : optional
            As for `fx.sweep`.
        chunk : int, optional
            Poses in a block. Default: such that a block takes up to 64 MiB.
        keep_poses : bool, optional
            If False, the coordinates of poses that are made from a seed are not written.

        Returns
        -------
        SweepStore
            The store; nothing is computed yet.

        Raises
        ------
        OutputError
            If there is something at `path`, or nothing can be written there.
        ArgumentError, PoseError, DesignError
            As `fx.sweep`.
        """
        points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities, hexapod)
        as_joint(joint)
        keep = _streams_poses(points) and (keep_poses or isinstance(points, GivenPoses))
        most = _poses_per_block(wanted, keep) if chunk is None else whole(chunk, "chunk")
        job = _job(path, hexapod, points, wanted, joint, cut=blocks(points.shape, most), keep=keep)
        if job.blocks.count > MOST_BLOCKS:
            raise OutputError(
                f"{points.count} poses in blocks of {most} are {job.blocks.count} blocks, each with a file for every "
                f"quantity; a store may have {MOST_BLOCKS}. Leave chunk out, or make it larger."
            )
        make_store(job)
        return cls(job, set(), read_description(path).attrs["files"])

    @classmethod
    def resume(
        cls,
        path: str | Path,
        hexapod: Hexapod,
        region: RegionLike = None,
        *,
        quantities: str | Iterable[str] | None = None,
        samples: int = SAMPLES,
        seed: int = 0,
        joint: JointModel = "universal",
        chunk: int | None = None,
    ) -> SweepStore:
        """Take up a store that was begun.

        Parameters
        ----------
        path : str or Path
            The store.
        hexapod : Hexapod
            The machine.
        region, quantities, samples, seed, joint, chunk : optional
            Those that it was begun with; `chunk` may be left out.

        Returns
        -------
        SweepStore
            The store, with what is done. Every file is read and compared with its sum: blocks of which a file is
            missing or damaged are computed again by `run`.

        Raises
        ------
        OutputError
            If there is no store, or the design, the poses, the quantities, the joint model, the version or the
            processor's instructions are not those it was begun with; or if what it says of itself is damaged.
        """
        points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities, hexapod)
        as_joint(joint)
        attrs, layout, done = read_description(path)
        keep = bool(attrs["keeps_poses"])
        job = _job(path, hexapod, points, wanted, joint, cut=Blocks(points.shape, layout.blocks.chunk), keep=keep)
        refuse_other(path, attrs, attributes_of(job), chunk)
        with one_writer(job.path):
            files = mend_description(job, attrs["files"])
            unsound = job.layout.damaged(range(job.blocks.count), thorough=True)
            for number in unsound:
                for file in job.layout.files(number):
                    remove(file)
        whole = set(range(job.blocks.count)) - unsound.keys()  # marked as done or not: a power cut comes between
        wrong = (*files, *(name for number in sorted(done & unsound.keys()) for name in unsound[number]))
        return cls(job, whole, attrs["files"], wrong)

    @property
    def complete(self) -> bool:
        """Whether every pose has been computed."""
        return len(self.done) == self.job.blocks.count

    def run(
        self,
        workers: Workers | int | None = None,
        *,
        progress: Callable[[float], object] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Progress:
        """Compute what is missing, until all is done.

        Parameters
        ----------
        workers : int or Cluster, optional
            How many threads of this process, default one for each core; or a `flexapod.workspace.cluster`.
        progress : callable, optional
            Called with the share of the poses that is done, from 0 to 1, after each block; `state` then says more.
        stop : callable, optional
            Called often; when it returns True, the blocks that are begun are finished, and no other is begun.

        Returns
        -------
        Progress
            How far it is.

        Raises
        ------
        OutputError
            If the disk is full, or another run is writing.
        ClusterError
            If a cluster gives up.
        """
        todo = [number for number in range(self.job.blocks.count) if number not in self.done]
        before, seen = self._poses_done(), Counter[int]()
        self.state = self._progress(before, seen)
        crew = Threads(workers) if workers is None or isinstance(workers, int) else workers
        with one_writer(self.job.path):
            remove_partial(self.job.path)
            marked = time.monotonic()
            try:
                for block in crew.compute(self.job, todo, stop or (lambda: False)):
                    self.done.add(block.number)
                    seen.update(block.statuses)
                    self.state = self._progress(before, seen)
                    if time.monotonic() - marked > MARK_EVERY:
                        self._mark()
                        marked = time.monotonic()
                    if progress is not None:
                        progress(self.state.done / self.state.total)
                if self.complete:
                    remove_partial(self.job.path)  # what a killed worker left
                self._mark()
            except OSError as error:
                with suppress(OSError):
                    self._make_room()
                    self._mark()
                if isinstance(error, OutputError):
                    raise
                raise OutputError(
                    f"{self.job.path} cannot be written: {error.strerror or error}. {self.state.done} of "
                    f"{self.state.total} poses are in it and stay readable. Make room, then go on with --resume."
                ) from error
            except BaseException:
                self._mark()
                raise
        return self.state

    def _poses_done(self) -> int:
        cut = self.job.blocks
        return sum(cut[n].stop - cut[n].start for n in self.done)

    def _progress(self, before: int, seen: Counter[int]) -> Progress:
        return Progress(before + seen.total(), prod(self.job.blocks.shape), before, dict(seen))

    def _make_room(self) -> None:
        """Take away what is not whole, so that even a full disk takes down which blocks are done."""
        remove_partial(self.job.path)
        for number in range(self.job.blocks.count):
            if number not in self.done:
                for file in self.job.layout.files(number):
                    file.unlink(missing_ok=True)

    def _mark(self) -> None:
        """Write down which blocks are done; when all are, that the store is complete."""
        attrs = {**attributes_of(self.job), "files": self._files}
        replace_attributes(Path(self.job.path), attrs if self.complete else {**attrs, "done": ranges(self.done)})


def _job(
    path: str | Path,
    hexapod: Hexapod,
    points: PoseSet,
    wanted: tuple[str, ...],
    joint: JointModel,
    *,
    cut: Blocks,
    keep: bool,
) -> Job:
    return Job(str(Path(path).absolute()), hexapod, points, wanted, joint, cut, keep, _core.simd(), uuid4().hex)


def _streams_poses(points: PoseSet) -> bool:
    return not isinstance(points, GridPoses)  # a grid's coordinates are its axes


def _poses_per_block(quantities: tuple[str, ...], keep_poses: bool) -> int:
    bytes_each = 1 + 48 * keep_poses
    for name in quantities:
        bytes_each += np.dtype(QUANTITIES[name].dtype).itemsize * (6 if QUANTITIES[name].trailing else 1)
    return 1 << (BLOCK_BYTES // bytes_each).bit_length() - 1


def open_sweep(path: str | Path) -> xr.Dataset:
    """Open a stored sweep, whole or in part.

    Parameters
    ----------
    path : str or Path
        The store.

    Returns
    -------
    xarray.Dataset
        As `fx.sweep` gives, in SI units; numbers are read when they are used. Poses that are not computed yet are NaN
        and have the status ``pending``.

    Raises
    ------
    OutputError
        If there is no such store, or it is damaged. Sizes of files are looked at when it is opened, and every file is
        compared with its sum when it is read.

    See Also
    --------
    SweepStore : Makes a store.

    Notes
    -----
    The store is a Zarr group (version 3), which other programs can read.

    Examples
    --------
    >>> store = fx.workspace.SweepStore.create("map.zarr", fx.load("motion-base"), fx.pose_grid(z=[2.3, 2.4]))
    >>> _ = store.run()
    >>> fx.open_sweep("map.zarr").omega_1.round(2).values
    array([28.65, 27.99])
    """
    import xarray as xr

    zarr = zarr_package()
    from flexapod.workspace.store.guarded import Guarded

    attrs, layout, done = read_description(path)
    files = damaged_description(layout.path, attrs["files"])
    files += [file for names in layout.damaged(sorted(done), thorough=False).values() for file in names]
    if files:
        raise damage(layout.path, files)
    guarded = Guarded(zarr.storage.LocalStore(layout.path, read_only=True), layout, done)
    found = xr.open_zarr(guarded, consolidated=False, chunks=None)
    return found[[*(name for name in QUANTITIES if name in layout.arrays), "status"]]
