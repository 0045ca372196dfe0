"""Weak scaling of a stored sweep over Dask workers: each worker has the same number of poses to do.

    python benchmarks/dask_scaling.py --points 10000000 --workers 1 2 4

Workers are processes of one thread on this machine; more of them than cores shows what the cores limit, not Dask. The
runs are interleaved, and medians are told. "threads" is the same work by as many threads of one process, without Dask.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import flexapod as fx
from flexapod.workspace.store.dask_cluster import Cluster


def run(points: int, workers: int, directory: Path, by_dask: bool) -> float:
    """Seconds for one sweep, without the start of the workers."""
    from distributed import Client, LocalCluster

    hexapod = fx.load("mukherjee-i")
    home = fx.home_pose(hexapod)
    assert home is not None
    poses = fx.random_poses(fx.Box.about(home, 0.1, 0.35), points)
    with tempfile.TemporaryDirectory(dir=directory) as place:
        store = fx.workspace.SweepStore.create(Path(place) / "map.zarr", hexapod, poses)
        if not by_dask:
            start = time.perf_counter()
            store.run(workers)
            return time.perf_counter() - start
        with (
            LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="localhost:0") as cluster,
            Client(cluster) as client,
        ):
            client.wait_for_workers(workers)
            client.run(fx.load, "mukherjee-i")  # imports are done before the clock starts
            start = time.perf_counter()
            store.run(Cluster(client))
            return time.perf_counter() - start


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
            for kind in ("dask", "threads"):
                taken = run(given.points * count, count, given.directory, kind == "dask")
                seconds.setdefault((kind, count), []).append(taken)
    first = {kind: statistics.median(seconds[kind, given.workers[0]]) for kind in ("dask", "threads")}
    for (kind, count), times in seconds.items():
        middle = statistics.median(times)
        rate, efficiency = given.points * count / middle, first[kind] / middle
        print(
            f"{kind:>7}, {count} workers: {given.points * count:>12,} poses in {middle:7.2f} s, {rate:12,.0f} poses/s, "
            f"efficiency {efficiency:.0%}"
        )


if __name__ == "__main__":
    main()
