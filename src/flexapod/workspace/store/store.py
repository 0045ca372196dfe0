"""A sweep on disk: poses by the billion streamed to a Zarr store, block by block, to be taken up again where it ended.

A block counts when its chunks are on the disk and the store's metadata, replaced as a whole after that, name it. So
nothing that ends a run, a power cut included, leaves half a block that passes for a whole one; and since a block's
numbers depend on nothing but its number, a run in pieces writes the bytes of a run in one go.
"""

from __future__ import annotations

import json
import os
import shutil
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from uuid import uuid4

import numpy as np

from flexapod import _core
from flexapod.conventions import AXES, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import OutputError
from flexapod.mechanics.inputs import as_joint
from flexapod.workspace.pose_sets import GivenPoses, GridPoses, PoseSet
from flexapod.workspace.quantities import DEFAULT, PENDING, QUANTITIES, attributes, chosen, provenance
from flexapod.workspace.region import RegionLike, poses_of
from flexapod.workspace.store.block_job import Job, Workers, sync, zarr_package
from flexapod.workspace.store.blocks import Blocks, blocks
from flexapod.workspace.store.threads import Threads

if TYPE_CHECKING:
    import xarray as xr

BLOCK_BYTES = 2**26
MARK_EVERY = 1.0  # s: at most so much work is done again after a power cut
_FORMAT = "flexapod sweep 1"


class Progress(NamedTuple):
    """How far a run is: poses on the disk, in all and before it began, and poses by status in this run."""

    done: int
    total: int
    before: int
    statuses: dict[int, int]


class SweepStore:
    """A sweep in a directory `path`, whole or in part. Made by `create` or `resume`; `run` computes what is missing.

    Source: own.
    """

    def __init__(self, job: Job, done: set[int]) -> None:
        self.job, self.done = job, done

    @classmethod
    def create(
        cls,
        path: str | Path,
        hexapod: Hexapod,
        region: RegionLike = None,
        *,
        quantities: str | Iterable[str] = DEFAULT,
        samples: int = 2**20,
        seed: int = 0,
        joint: JointModel = "universal",
        chunk: int | None = None,
        keep_poses: bool = True,
    ) -> SweepStore:
        """An empty store.

        chunk: poses in a block; default such that a block takes up to 64 MiB. keep_poses=False leaves out the pose
        coordinates of random and low-discrepancy sets, which `pose_of` can make again.

        Raises: OutputError where there is something already, or where nothing can be written; PoseError as `sweep`.
        """
        points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities)
        as_joint(joint)
        if chunk is not None and chunk < 1:
            raise OutputError(f"chunk is {chunk}; it must be at least 1 pose.")
        keep = _streams_poses(points) and (keep_poses or isinstance(points, GivenPoses))
        cut = blocks(points.shape, chunk or _poses_per_block(wanted, keep))
        job = Job(str(Path(path).absolute()), hexapod, points, wanted, joint, cut, keep, _core.simd(), uuid4().hex)
        _make_store(job)
        return cls(job, set())

    @classmethod
    def resume(
        cls,
        path: str | Path,
        hexapod: Hexapod,
        region: RegionLike = None,
        *,
        quantities: str | Iterable[str] = DEFAULT,
        samples: int = 2**20,
        seed: int = 0,
        joint: JointModel = "universal",
        chunk: int | None = None,
    ) -> SweepStore:
        """A store that was begun, to be gone on with.

        Raises: OutputError where the design, the poses, the quantities, the joint model or the processor's instructions
        are not those it was begun with, and names both.
        """
        points, wanted = poses_of(hexapod, region, samples, seed), chosen(quantities)
        attrs = read_attributes(path)
        kept = bool(attrs["keeps_poses"])
        cut = Blocks(points.shape, tuple(map(int, attrs["chunk"].split())))
        job = Job(str(Path(path).absolute()), hexapod, points, wanted, joint, cut, kept, _core.simd(), uuid4().hex)
        _refuse_other(path, attrs, _attributes(job), chunk)
        return cls(job, _numbers(attrs.get("done", "")) if "done" in attrs else set(range(cut.count)))

    @property
    def complete(self) -> bool:
        """Whether every pose has been computed."""
        return len(self.done) == self.job.blocks.count

    def run(
        self,
        workers: Workers | int | None = None,
        progress: Callable[[Progress], None] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Progress:
        """Compute what is missing, until all is done or `stop()` is true.

        workers: how many threads of this process, default one a core; or those of a `flexapod.workspace.cluster`.

        Raises: OutputError when the disk is full, or another run is writing; ClusterError when a cluster gives up.
        """
        cut = self.job.blocks
        todo = [number for number in range(cut.count) if number not in self.done]
        before = sum(cut[n].stop - cut[n].start for n in self.done)
        total = prod(cut.shape)
        poses, seen, marked = before, Counter[int](), time.monotonic()
        crew = Threads(workers) if workers is None or isinstance(workers, int) else workers
        with _locked(self.job.path):
            _sweep_up(self.job.path)
            try:
                for block in crew.compute(self.job, todo, stop or (lambda: False)):
                    self.done.add(block.number)
                    poses += block.poses
                    seen.update(block.statuses)
                    if time.monotonic() - marked > MARK_EVERY:
                        self._mark()
                        marked = time.monotonic()
                    if progress is not None:
                        progress(Progress(poses, total, before, dict(seen)))
                if self.complete:
                    _sweep_up(self.job.path)  # what a killed worker left
                self._mark()
            except OSError as error:
                with suppress(OSError):
                    self._mark()
                if isinstance(error, OutputError):
                    raise
                raise OutputError(
                    f"{self.job.path} cannot be written: {error.strerror or error}. {poses} of {total} poses are in "
                    "it and stay readable. Make room, then go on with --resume."
                ) from error
            except BaseException:
                self._mark()
                raise
        return Progress(poses, total, before, dict(seen))

    def _mark(self) -> None:
        """Write down which blocks are done; when all are, that the store is complete."""
        attrs = _attributes(self.job) | ({} if self.complete else {"done": _ranges(self.done)})
        _replace_attributes(Path(self.job.path), attrs)


def _streams_poses(points: PoseSet) -> bool:
    return not isinstance(points, GridPoses)  # a grid's coordinates are its axes


def _poses_per_block(quantities: tuple[str, ...], keep_poses: bool) -> int:
    bytes_each = 1 + 48 * keep_poses
    for name in quantities:
        bytes_each += np.dtype(QUANTITIES[name].dtype).itemsize * (6 if QUANTITIES[name].trailing else 1)
    return 1 << (BLOCK_BYTES // bytes_each).bit_length() - 1


def _attributes(job: Job) -> dict[str, Any]:
    assert job.points is not None
    box = job.points.box
    volume = {} if box is None else {"box_volume": box.volume, "box_volume_unit": box.volume_unit}
    return {
        **provenance(job.hexapod, job.joint),
        "format": _FORMAT,
        "design_toml": job.hexapod.to_toml(),
        "poses": json.dumps(job.points.identity()),
        **volume,
        "quantities": " ".join(job.quantities),
        "chunk": " ".join(map(str, job.blocks.chunk)),
        "keeps_poses": int(job.keep_poses),
        "coordinates": " ".join(AXES),
    }


def _make_store(job: Job) -> None:
    """The whole tree of metadata under another name, then moved into place: there is a store or there is none."""
    path = Path(job.path)
    if path.exists():
        raise OutputError(f"{path} exists already. Go on with it (--resume), choose another name, or remove it.")
    if not path.parent.is_dir():
        raise OutputError(f"{path.parent} is no directory, so {path.name} cannot be written in it. Make it first.")
    making = path.with_name(f".{path.name}.{job.token}")
    try:
        _write_metadata(making, job)
        os.replace(making, path)
    except OSError as error:
        raise OutputError(f"{path} cannot be written: {error.strerror or error}. Choose another place.") from error
    finally:
        shutil.rmtree(making, ignore_errors=True)


def _write_metadata(path: Path, job: Job) -> None:
    assert job.points is not None
    points, cut = job.points, job.blocks
    path.mkdir()
    group = zarr_package().create_group(path, zarr_format=3, attributes={**_attributes(job), "done": ""})
    coordinate = {name: "float64" for name in AXES if job.keep_poses}
    columns = {name: QUANTITIES[name].dtype for name in job.quantities} | {"status": "uint8"} | coordinate
    for name, dtype in columns.items():
        trailing = QUANTITIES[name].trailing if name in QUANTITIES else ""
        group.create_array(
            name,
            shape=cut.shape + ((6,) if trailing else ()),
            chunks=cut.chunk + ((6,) if trailing else ()),
            dtype=dtype,
            fill_value={"float64": np.nan, "uint8": PENDING, "bool": False}[dtype],
            compressors="auto" if name == "status" else None,  # numbers of this kind hardly shrink
            dimension_names=points.dims + ((trailing,) if trailing else ()),
            attributes=_plain(attributes(name)),
        )
        if trailing and trailing not in group:
            group.create_array(trailing, data=np.arange(1, 7), dimension_names=(trailing,))
    if isinstance(points, GridPoses):
        for name in AXES:
            axis = points.axes[name]
            along = name in points.dims
            group.create_array(
                name,
                data=axis if along else axis[0].reshape(()),
                dimension_names=(name,) if along else (),
                attributes=_plain(attributes(name)),
            )


def _plain(attrs: dict[str, Any]) -> dict[str, Any]:
    return {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in attrs.items()}


def _replace_attributes(path: Path, attrs: dict[str, Any]) -> None:
    file, new = path / "zarr.json", path / "zarr.json.partial"
    document = json.loads(file.read_bytes())
    document["attributes"] = attrs
    with new.open("w", encoding="utf-8") as stream:
        json.dump(document, stream, indent=2)
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(new, file)
    sync(path)


def read_attributes(path: str | Path) -> dict[str, Any]:
    """Attributes of a sweep store. Raises OutputError where there is none."""
    file = Path(path, "zarr.json")
    try:
        attrs = json.loads(file.read_bytes())["attributes"]
        found = attrs["format"]
    except FileNotFoundError:
        raise OutputError(f"there is no sweep at {path} to read or to resume (no {file.name} in it).") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise OutputError(f"{path} is no sweep of Flexapod ({type(error).__name__}: {error}).") from error
    if found != _FORMAT:
        raise OutputError(f"{path} has format {found!r}; this version reads {_FORMAT!r}.")
    return dict(attrs)


_COMPARED = {
    "design_digest": "design",
    "poses": "poses",
    "joint": "joint model",
    "quantities": "choice of quantities",
    "source": "version",
    "instruction_set": "instruction set (FLEXAPOD_SIMD)",
}


def _refuse_other(path: str | Path, old: dict[str, Any], new: dict[str, Any], chunk: int | None) -> None:
    for key, word in _COMPARED.items():
        if old[key] != new[key]:
            was, now = (
                f"{attrs['design']!r} ({attrs[key]})" if key == "design_digest" else str(attrs[key])
                for attrs in (old, new)
            )
            raise OutputError(
                f"{path} was begun with another {word}: it has {was}, and now it is {now}. "
                "Resume with what it was begun with, or write to another store."
            )
    stored = prod(map(int, old["chunk"].split()))
    if chunk is not None and chunk != stored:
        raise OutputError(f"{path} was begun with blocks of {stored} poses, not {chunk}. Leave --chunk out to resume.")


def _ranges(numbers: set[int]) -> str:
    """Such as "0-4,6"."""
    text: list[str] = []
    ordered = sorted(numbers)
    first = 0
    for k, number in enumerate(ordered):
        if k + 1 == len(ordered) or ordered[k + 1] != number + 1:
            text.append(f"{ordered[first]}-{number}" if k > first else str(number))
            first = k + 1
    return ",".join(text)


def _numbers(ranges: str) -> set[int]:
    found: set[int] = set()
    for part in filter(None, ranges.split(",")):
        first, _, last = part.partition("-")
        found.update(range(int(first), int(last or first) + 1))
    return found


def _sweep_up(path: str) -> None:
    """Take away what a killed run left half written."""
    for file in Path(path).rglob("*.partial"):
        file.unlink(missing_ok=True)


@contextmanager
def _locked(path: str) -> Iterator[None]:
    """One run at a time. A lock dies with the process that holds it."""
    try:
        import fcntl
    except ImportError:  # not on Windows
        yield
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise OutputError(
                f"another run is writing {path} just now. Wait for it, or write to another store."
            ) from None
        yield
    finally:
        os.close(handle)


def open_sweep(path: str | Path) -> xr.Dataset:
    """The stored sweep at `path`, whole or in part, as a Dataset in SI units; numbers are read when they are used.

    Poses not computed yet are NaN and have the status `pending`.

    Raises: OutputError where there is no such store.
    Source: own.
    """
    import xarray as xr

    read_attributes(path)
    zarr_package()
    found = xr.open_zarr(path, consolidated=False, chunks=None)
    return found[[name for name in (*QUANTITIES, "status") if name in found]]
