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
from contextlib import AbstractContextManager, nullcontext, suppress
from math import prod
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

from flexapod import _core
from flexapod.checks import stop_asked, whole
from flexapod.conventions import JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import OutputError
from flexapod.mechanics.inputs import as_joint
from flexapod.progress import ProgressLike, with_progress
from flexapod.showing import in_notebooks
from flexapod.workspace.pose_sets import GivenPoses, GridPoses, PoseSet
from flexapod.workspace.quantities import chosen
from flexapod.workspace.region import RegionLike, poses_of
from flexapod.workspace.store.block_job import Job, Workers, poses_per_block
from flexapod.workspace.store.blocks import Blocks, blocks
from flexapod.workspace.store.integrity import ROOT, damage, damaged_description
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
from flexapod.workspace.store.one_writer import locked, remove_partial
from flexapod.workspace.store.parts import Part, forget_parts, marking
from flexapod.workspace.store.threads import Threads

MOST_BLOCKS = 2**22
MARK_EVERY = 1.0  # s: at most so much work is done again after a power cut
_MARK_PART_EVERY = 10.0  # the same of a part, as others mark the store too
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
    27.6
    """

    def __init__(
        self, job: Job, done: set[int], files: dict[str, str], damaged: tuple[str, ...] = (), part: Part | None = None
    ) -> None:
        self.job, self.done, self._files, self.damaged, self._part = job, done, files, damaged, part
        self._own = range(job.blocks.count) if part is None else part.blocks(job.blocks.count)
        self._total = self._poses(self._own)
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
        cut, keep = _cut(points, wanted, chunk, keep_poses)
        job = _job(path, hexapod, points, wanted, joint)._replace(blocks=cut, keep_poses=keep)
        if job.blocks.count > MOST_BLOCKS:
            raise OutputError(
                f"{points.count} poses in blocks of {prod(cut.chunk)} are {job.blocks.count} blocks, each with a file "
                f"for every quantity; a store may have {MOST_BLOCKS}. Leave chunk out, or make it larger."
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
        return cls._taken_up(_job(path, hexapod, points, wanted, joint), chunk, None)

    @classmethod
    def join(
        cls,
        path: str | Path,
        hexapod: Hexapod,
        region: RegionLike = None,
        *,
        part: int,
        of: int,
        quantities: str | Iterable[str] | None = None,
        samples: int = SAMPLES,
        seed: int = 0,
        joint: JointModel = "universal",
        chunk: int | None = None,
        keep_poses: bool = True,
    ) -> SweepStore:
        """Compute one part of a store, beside other runs that compute the others: make it, or take it up.

        Parameters
        ----------
        path : str or Path
            The store; the first of the runs makes it.
        hexapod : Hexapod
            The machine.
        region, quantities, samples, seed, joint, chunk, keep_poses : optional
            As for `create`, and the same in all runs.
        part, of : int
            Which part, from 1, of how many. A store has at least as many blocks as parts.

        Returns
        -------
        SweepStore
            The store; `run` computes what is missing of this part, and `state` tells of this part alone. Who finishes
            the last part completes the store, whose bytes are then those of one run.

        Raises
        ------
        OutputError
            As `create` and `resume`, and if this part is being computed by another run.
        ArgumentError, PoseError, DesignError
            As `create`; also for numbers of no part.
        """
        mine = Part.checked(part, of)
        points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities, hexapod)
        as_joint(joint)
        if not Path(path, ROOT).exists():
            mine.blocks(_cut(points, wanted, chunk, keep_poses)[0].count)
            given: dict[str, Any] = {"quantities": quantities, "samples": samples, "seed": seed, "joint": joint}
            try:
                cls.create(path, hexapod, region, **given, chunk=chunk, keep_poses=keep_poses)
            except OutputError:
                if not Path(path, ROOT).exists():  # another run did not make it meanwhile
                    raise
        return cls._taken_up(_job(path, hexapod, points, wanted, joint), chunk, mine)

    @classmethod
    def _taken_up(cls, job: Job, chunk: int | None, part: Part | None) -> SweepStore:
        """A store that is there, with what is whole of a part of it, or of all. job: but for its blocks."""
        attrs, layout, done = read_description(job.path)
        cut = Blocks(job.blocks.shape, layout.blocks.chunk)
        job = job._replace(blocks=cut, keep_poses=bool(attrs["keeps_poses"]))
        refuse_other(job.path, attrs, attributes_of(job), chunk)
        store = cls(job, set(done), attrs["files"], (), part)
        with store._writing():
            if part is not None and (files := damaged_description(layout.path, attrs["files"])):
                raise damage(layout.path, files)
            files = mend_description(job, attrs["files"])
            unsound = job.layout.damaged(store._own, thorough=True)
            for number in unsound:
                for file in job.layout.files(number):
                    remove(file)
        store.damaged = (*files, *(name for number in sorted(done & unsound.keys()) for name in unsound[number]))
        store.done |= set(store._own)  # whole, marked as done or not: a power cut comes between
        store.done -= unsound.keys()
        store.state = store._progress(store._poses_done(), Counter())
        return store

    @property
    def complete(self) -> bool:
        """Whether every pose has been computed."""
        return len(self.done) == self.job.blocks.count

    @with_progress("sweep")
    def run(
        self,
        workers: Workers | int | None = None,
        *,
        progress: ProgressLike = None,
        stop: Callable[[], bool] | None = None,
    ) -> Progress:
        """Compute what is missing, until all is done.

        Parameters
        ----------
        workers : int or Cluster, optional
            How many threads of this process, default one for each core; or a `flexapod.workspace.cluster`.
        progress : callable or False, optional
            Called with the share of the poses that is done, from 0 to 1, after each block; `state` then says more.
            By default a bar is shown in terminals and notebooks, once a second has passed; False: none.
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
        todo = [number for number in self._own if number not in self.done]
        before, seen = self._poses_done(), Counter[int]()
        self.state = self._progress(before, seen)
        crew = Threads(workers) if workers is None or isinstance(workers, int) else workers
        with self._writing():
            self._remove_partial()
            marked = time.monotonic()
            every = MARK_EVERY if self._part is None else _MARK_PART_EVERY
            try:
                for block in crew.compute(self.job, todo, stop_asked(stop)):
                    self.done.add(block.number)
                    seen.update(block.statuses)
                    self.state = self._progress(before, seen)
                    if time.monotonic() - marked > every:
                        self._mark()
                        marked = time.monotonic()
                    if progress:
                        progress(self.state.done / self.state.total)
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
        return self._poses(n for n in self._own if n in self.done)

    def _poses(self, numbers: Iterable[int]) -> int:
        cut = self.job.blocks
        return sum(cut[n].stop - cut[n].start for n in numbers)

    def _progress(self, before: int, seen: Counter[int]) -> Progress:
        return Progress(before + seen.total(), self._total, before, dict(seen))

    def _writing(self) -> AbstractContextManager[None]:
        """One run at a time: of the store, or of this part of it."""
        return locked(self.job.path) if self._part is None else self._part.writing(self.job.path)

    def _remove_partial(self) -> None:
        """Take away what a killed run left half written, of this run's blocks."""
        files = None if self._part is None else (file for n in self._own for file in self.job.layout.files(n))
        remove_partial(self.job.path, files)

    def _make_room(self) -> None:
        """Take away what is not whole, so that even a full disk takes down which blocks are done."""
        self._remove_partial()
        for number in self._own:
            if number not in self.done:
                for file in self.job.layout.files(number):
                    file.unlink(missing_ok=True)

    def _mark(self) -> None:
        """Write down which blocks are done; when all are, that the store is complete."""
        with nullcontext() if self._part is None else marking(self.job.path):
            if self._part is not None:  # what other runs have done meanwhile
                own = set(self._own)
                self.done = (self.done & own) | (read_description(self.job.path).done - own)
            if self.complete:
                remove_partial(self.job.path)  # what a killed worker left
                forget_parts(self.job.path)
            attrs = {**attributes_of(self.job), "files": self._files}
            replace_attributes(Path(self.job.path), attrs if self.complete else {**attrs, "done": ranges(self.done)})


def _job(path: str | Path, hexapod: Hexapod, points: PoseSet, wanted: tuple[str, ...], joint: JointModel) -> Job:
    """All of a job but its blocks, and whether the store keeps poses."""
    whole = Blocks(points.shape, points.shape)
    return Job(str(Path(path).absolute()), hexapod, points, wanted, joint, whole, False, _core.simd(), uuid4().hex)


def _cut(points: PoseSet, wanted: tuple[str, ...], chunk: int | None, keep_poses: bool) -> tuple[Blocks, bool]:
    """The blocks of a new store, and whether it keeps poses."""
    keep = _streams_poses(points) and (keep_poses or isinstance(points, GivenPoses))
    return blocks(points.shape, poses_per_block(wanted, keep) if chunk is None else whole(chunk, "chunk")), keep


def _streams_poses(points: PoseSet) -> bool:
    return not isinstance(points, GridPoses)  # a grid's coordinates are its axes
