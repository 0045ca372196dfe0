"""Clusters: workers killed at random moments, and addresses and times that lead nowhere.

FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import os
import shutil
import signal

import pytest
from tests.attack.bounded import AMONG_TESTS, limited, rounds, tried
from tests.helpers.stores import BOX, I, content, stored

import flexapod as fx

pytest.importorskip("distributed")
pytest.importorskip("zarr")

# dask.distributed closes its event loops when they are thrown away, and its threads may see sockets close under them
pytestmark = pytest.mark.filterwarnings(
    "ignore::pytest.PytestUnraisableExceptionWarning",
    "ignore::pytest.PytestUnhandledThreadExceptionWarning",
    "ignore::ResourceWarning",
)

ADDRESSES = [
    "tcp://127.0.0.1:1", "tcp://127.0.0.1:99999", "tcp://127.0.0.1:-1", "tcp://[::1]:1", "tcp://", "tcp", "", " ", ":", "x" * 3000, "a\0b",
    "tls://127.0.0.1:1", "ws://127.0.0.1:1", "inproc://1", "udp://127.0.0.1:1", "nowhere.invalid:1", "127.0.0.1", "LOCAL", "local ",
    "\u03c9", "tcp://127.0.0.1:\u00b2", "/", "..", "%s", 0, 1.5, None, True, b"local", [], {}, object(), fx, I,
]  # fmt: skip
SECONDS = [0, 0.0, 1e-9, 0.05, -1, -0.0, float("nan"), "x", "1", None, 1j, [], (), {}, b"1", object(), True]


def test_an_address_that_leads_nowhere_is_an_error_of_flexapod():
    for draw in rounds(0.2, "addresses", most=8):
        given = draw.choice(ADDRESSES), draw.choice([0.05, draw.choice(SECONDS)])
        try:
            with limited(), fx.workspace.cluster(given[0], timeout=given[1]):
                pytest.fail(f"{given} led somewhere")
        except (fx.FlexapodError, TypeError) as error:
            own = isinstance(error, fx.FlexapodError)
            tried("clusters that are not there", "an error of Flexapod" if own else "TypeError")


@pytest.mark.skipif(os.name != "posix", reason="kills with POSIX signals")
@pytest.mark.skipif(AMONG_TESTS, reason="tests/workspace/test_sweep_cluster.py kills one")
def test_workers_killed_at_any_moment_cost_nothing_but_time(tmp_path):
    poses = fx.random_poses(BOX, 200_000, seed=5)
    stored(tmp_path / "threads.zarr", poses, chunk=4000)
    truth = content(tmp_path / "threads.zarr")
    for draw in rounds(0.8, "workers"):
        with fx.workspace.cluster("local") as crew:  # a worker killed while it starts does not come again
            living = list(crew.client.run(os.getpid).values())
            moments = sorted(draw.random() for _ in range(min(len(living), draw.choice((0, 1, 1, 2)))))
            kills = len(moments)

            def kill(share, moments=moments, living=living):
                while moments and share >= moments[0]:
                    moments.pop(0)
                    os.kill(living.pop(), signal.SIGKILL)

            store = fx.workspace.SweepStore.create(
                tmp_path / "cluster.zarr", I, poses, quantities=("omega_1", "cond_H"), chunk=4000
            )
            store.run(crew, progress=kill)
            assert content(tmp_path / "cluster.zarr") == truth
            shutil.rmtree(tmp_path / "cluster.zarr")
            tried("stored sweeps on a cluster whose workers are killed", f"same bytes after {kills} kills")
