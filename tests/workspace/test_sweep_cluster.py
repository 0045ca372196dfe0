"""Sweeps on a Dask cluster: the bytes of a sweep by threads, also when a worker is killed."""

import os
import signal
import socket
import threading
import time

import numpy as np
import pytest
from tests.helpers.stores import BOX, POSES, I, content, stored

import flexapod as fx
from flexapod.workspace.store.dask_cluster import Cluster

# dask.distributed closes its event loops when they are thrown away, and its threads may see sockets close under them
pytestmark = pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning",
    "ignore::pytest.PytestUnhandledThreadExceptionWarning",
    "ignore::ResourceWarning",
)


@pytest.fixture(scope="module")
def workers():
    """A cluster on this machine, of one worker process a core."""
    with fx.workspace.cluster("local") as crew:
        yield crew.client.scheduler.address


def test_a_cluster_writes_the_same_bytes(tmp_path, workers):
    stored(tmp_path / "threads.zarr", chunk=700)
    with fx.workspace.cluster(workers) as crew:
        store = fx.workspace.SweepStore.create(tmp_path / "cluster.zarr", I, POSES, chunk=700)
        store.run(crew)
    assert store.complete
    assert content(tmp_path / "cluster.zarr") == content(tmp_path / "threads.zarr")


def test_given_poses_travel_block_by_block(tmp_path, workers):
    rows = POSES.rows(0, 3000).copy()
    rows[100, 0] = np.nan
    with fx.workspace.cluster(workers) as crew:
        state = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, rows, chunk=500).run(crew)
    assert state.statuses == {0: 2999, 3: 1}
    assert np.array_equal(
        fx.open_sweep(tmp_path / "map.zarr").omega_1.values, fx.sweep(I, rows).omega_1.values, equal_nan=True
    )


def test_a_killed_worker_costs_nothing_but_time(tmp_path, workers):
    poses = fx.random_poses(BOX, 120_000, seed=5)
    killed = threading.Event()

    def kill(share):
        if not killed.is_set() and share >= 0.1:
            os.kill(victim, signal.SIGKILL)
            killed.set()

    with fx.workspace.cluster(workers) as crew:
        victim = next(iter(crew.client.run(os.getpid).values()))
        store = fx.workspace.SweepStore.create(tmp_path / "cluster.zarr", I, poses, chunk=4_000)
        store.run(crew, progress=kill)
    assert killed.is_set()
    assert store.complete
    stored(tmp_path / "threads.zarr", poses, chunk=4_000)
    assert content(tmp_path / "cluster.zarr") == content(tmp_path / "threads.zarr")


def test_a_cluster_stops_when_asked_and_is_gone_on_with_by_threads(tmp_path, workers):
    path = tmp_path / "map.zarr"
    stop = threading.Event()
    with fx.workspace.cluster(workers) as crew:
        store = fx.workspace.SweepStore.create(path, I, POSES, chunk=500)
        store.run(crew, progress=lambda share: stop.set(), stop=stop.is_set)
    assert 0 < len(store.done) < store.job.blocks.count
    fx.workspace.SweepStore.resume(path, I, POSES).run()
    stored(tmp_path / "whole.zarr", chunk=500)
    assert content(path) == content(tmp_path / "whole.zarr")


def test_a_lost_scheduler_is_told_and_what_is_done_is_kept(tmp_path):
    from distributed import Client, LocalCluster

    path = tmp_path / "map.zarr"
    own = LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address="localhost:0")
    with Client(own) as client:
        store = fx.workspace.SweepStore.create(path, I, POSES, chunk=500)
        with pytest.raises(fx.errors.ClusterError, match="connection to the scheduler was lost"):
            store.run(Cluster(client), progress=lambda share: own.close())
    assert 0 < len(fx.workspace.SweepStore.resume(path, I, POSES).done) < 20


def test_a_worker_with_other_instructions_is_refused(tmp_path, workers):
    """Its last digits may differ, and the bytes of a store would depend on who computed what."""
    store = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, POSES)
    store.job = store.job._replace(instruction_set="abacus")
    with (
        fx.workspace.cluster(workers) as crew,
        pytest.raises(fx.errors.OutputError, match=r"with abacus instructions.*FLEXAPOD_SIMD"),
    ):
        store.run(crew)


def test_a_worker_that_does_not_see_the_store_is_told(tmp_path, workers):
    store = fx.workspace.SweepStore.create(tmp_path / "map.zarr", I, POSES)
    job = store.job._replace(path=str(tmp_path / "elsewhere.zarr"))
    with (
        fx.workspace.cluster(workers) as crew,
        pytest.raises(fx.errors.OutputError, match="on a disk that all workers share"),
    ):
        next(crew.compute(job, [0], lambda: False))


def test_no_scheduler_is_told_soon():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    start = time.monotonic()
    with (
        pytest.raises(fx.errors.ClusterError, match=f"no Dask scheduler answers at {address}"),
        fx.workspace.cluster(address, timeout=1),
    ):
        pass
    assert time.monotonic() - start < 25  # Dask itself waits for 30 s


@pytest.mark.parametrize("address", ["nonsense", "tcp://", "tcp://127.0.0.1:99999", "http://127.0.0.1:1"])
def test_nonsense_for_an_address_is_told(address):
    with (
        pytest.raises(fx.errors.ClusterError, match="no Dask scheduler answers"),
        fx.workspace.cluster(address, timeout=1),
    ):
        pass


def test_a_scheduler_without_workers_is_told():
    from distributed import LocalCluster

    with (
        LocalCluster(n_workers=0, dashboard_address="localhost:0") as empty,
        pytest.raises(fx.errors.ClusterError, match="has no workers"),
        fx.workspace.cluster(empty.scheduler_address, timeout=0.5),
    ):
        pass
