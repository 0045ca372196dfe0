"""Weak scaling of a sweep over Dask workers: each worker has the same number of poses to do.

    python benchmarks/dask_scaling.py --points 10000000 --workers 1 2 4

Workers are processes of one thread on this machine; more of them than cores shows what the cores limit, not Dask.
"kernel" computes the blocks of a store and keeps nothing, "store" has them on the disk; "threads" is the same work
by as many threads of one process, without Dask, and "disk" only writes the bytes of the blocks, from as many
threads. The runs are interleaved, and medians are told.
"""

from __future__ import annotations

import argparse
import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import flexapod as fx
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.store.block_job import Job, poses_per_block, sync
from flexapod.workspace.store.blocks import blocks
from flexapod.workspace.store.dask_cluster import Cluster

BYTES = 65  # of a pose: omega_1, cond(H), six coordinates, status


def kernel(job: Job, number: int) -> int:
    """Compute a block as a worker does, and keep nothing of it."""
    block = job.blocks[number]
    assert job.points is not None
    found = evaluate(job.hexapod, job.points.rows(block.start, block.stop), job.quantities, job.joint, 1)
    return len(found["status"])


def written(directory: Path, number: int, content: bytes) -> None:
    """Put the bytes of a block on the disk."""
    file = directory / str(number)
    file.write_bytes(content)
    sync(file)


@contextmanager
def workers_of(count: int) -> Iterator[Any]:
    """A client of so many workers, which have imported what they need."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address="localhost:0") as cluster,
        Client(cluster) as client,
    ):
        client.wait_for_workers(count)
        client.run(fx.load, "mukherjee-i")
        yield client


def seconds_of(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def run(kind: str, points: int, workers: int, directory: Path) -> float:
    """Seconds for one sweep, without the start of the workers."""
    hexapod = fx.load("mukherjee-i")
    home = fx.home_pose(hexapod)
    assert home is not None
    poses = fx.random_poses(fx.Box.about(home, 0.1, 0.35), points)
    store = fx.workspace.SweepStore.create(directory / "map.zarr", hexapod, poses)
    quantities = ("omega_1", "cond_H")
    cut = blocks((points,), poses_per_block(quantities, keep_poses=True))
    job = Job("", hexapod, poses, quantities, "universal", cut, True, "", "")
    numbers = range(cut.count)
    if kind == "kernel, Dask":
        with workers_of(workers) as client:
            return seconds_of(lambda: client.gather(client.map(kernel, [job] * cut.count, numbers, pure=False)))
    if kind == "store, Dask":
        with workers_of(workers) as client:
            return seconds_of(lambda: store.run(Cluster(client)))
    if kind == "store, threads":
        return seconds_of(lambda: store.run(workers))
    with ThreadPoolExecutor(workers) as pool:
        if kind == "kernel, threads":
            return seconds_of(lambda: list(pool.map(kernel, [job] * cut.count, numbers)))
        content = [os.urandom(BYTES * (cut[n].stop - cut[n].start)) for n in numbers]
        return seconds_of(lambda: list(pool.map(written, [directory] * cut.count, numbers, content)))


KINDS = ("kernel, Dask", "kernel, threads", "store, Dask", "store, threads", "disk")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=10_000_000, help="poses for each worker")
    parser.add_argument("--workers", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--directory", type=Path, default=None)
    given = parser.parse_args()
    seconds: dict[tuple[str, int], list[float]] = {}
    for _ in range(given.repeats):
        for count in given.workers:
            for kind in KINDS:
                with tempfile.TemporaryDirectory(dir=given.directory) as place:
                    seconds.setdefault((kind, count), []).append(run(kind, given.points * count, count, Path(place)))
    for kind in KINDS:
        first = statistics.median(seconds[kind, given.workers[0]])
        for count in given.workers:
            middle = statistics.median(seconds[kind, count])
            print(
                f"{kind:>15}, {count} workers: {given.points * count:>12,} poses in {middle:7.2f} s, "
                f"{given.points * count / middle:12,.0f} poses/s, efficiency {first / middle:.0%}"
            )


if __name__ == "__main__":
    main()
