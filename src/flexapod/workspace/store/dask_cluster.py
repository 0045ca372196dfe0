"""Blocks of a stored sweep computed by the workers of a Dask cluster."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from flexapod.checks import instance, positive
from flexapod.conventions import Array
from flexapod.errors import ClusterError
from flexapod.optional import needed
from flexapod.workspace.pose_sets import GivenPoses
from flexapod.workspace.proof import TURN, Prover, Turn, together
from flexapod.workspace.store.block_job import Finished, Job, flush_block, write_block

LOCAL = "local"
_POLL = 0.5  # s between looks at whether to stop
_SHARED_TURN = 10.0  # s of a turn of a proof: long beside what it takes to send parts
_SHARES = 8  # parts that each thread gets at the least, so that none is idle for long
Told: TypeAlias = "Callable[[float], object] | None"


class Cluster:
    """See `flexapod.workspace.store.block_job.Workers`. A block whose worker dies is computed anew by another."""

    def __init__(self, client: Any) -> None:
        self.client = client

    def compute(self, job: Job, numbers: Iterable[int], stop: Callable[[], bool]) -> Iterator[Finished]:
        from distributed import KilledWorker, wait
        from distributed.comm import CommClosedError

        waiting = iter(numbers)
        running: dict[Any, int] = {}
        try:
            while True:
                while len(running) < self._most() and not stop():
                    number = next(waiting, None)
                    if number is None:
                        break
                    running[self._submit(job, number)] = number
                if not running:
                    return
                try:
                    wait(list(running), timeout=_POLL, return_when="FIRST_COMPLETED")
                except TimeoutError:
                    continue
                for future in [future for future in running if future.done()]:
                    del running[future]
                    yield future.result()
        except KilledWorker as error:
            raise ClusterError(
                f"the cluster lost several workers over one block ({error}). What is done is kept; look at the logs of "
                "the workers, then go on with --resume."
            ) from error
        except (CancelledError, CommClosedError) as error:
            raise ClusterError(
                "the connection to the scheduler was lost. What is done is kept; go on with --resume."
            ) from error
        finally:
            if self.client.status == "running":
                self.client.cancel(list(running))

    def take_turn(self, prover: Prover, parts: Array, level: float, gap: float, seconds: float, progress: Told) -> Turn:
        """A turn of a proof, shared out: each thread of the workers has its parts for a while (see `_SHARED_TURN`).

        A share whose worker dies is left for the next turn.
        """
        from distributed.comm import CommClosedError

        each = max(1, sum(self.client.nthreads().values()))
        parts = prover.place.split(parts, _SHARES * each)
        shares = [parts[first::each] for first in range(min(each, len(parts)))]
        long = _SHARED_TURN if seconds >= TURN else seconds
        try:
            # Under a name of its own: one by its content may be what an earlier turn is still letting go.
            job = self.client.scatter(prover, broadcast=True, hash=False)
            given = [self.client.submit(_turn, job, share, level, gap, long, pure=False, retries=2) for share in shares]
            found = [_result(future) for future in given]
        except (CancelledError, CommClosedError) as error:
            raise ClusterError(
                "the connection to the scheduler was lost. What is stored of the proof is kept."
            ) from error
        return together(prover, found, shares)

    def _most(self) -> int:
        """Blocks to have under way: for each thread one that is computed, one that the disk takes, and the next."""
        from distributed.comm import CommClosedError

        if self.client.status != "running":
            raise CommClosedError
        return max(3, 3 * sum(self.client.nthreads().values()))

    def _submit(self, job: Job, number: int) -> Any:
        rows = None
        if isinstance(job.points, GivenPoses):  # each worker gets the poses of its block, not all
            block = job.blocks[number]
            rows = job.points.rows(block.start, block.stop)
            job = job._replace(points=None)
        return self.client.submit(_block, job, number, rows, key=f"sweep-{job.token}-{number}", retries=2)


def _block(job: Job, number: int, rows: Array | None) -> Finished:
    """A block computed and on the disk. While the disk takes it, the worker's thread is free for the next one."""
    from distributed import secede

    finished = write_block(job, number, rows)
    secede()
    flush_block(job, number)
    return finished


def _turn(prover: Prover, parts: Array, level: float, gap: float, seconds: float) -> Turn:
    return prover.turn(parts, level, gap, seconds, None)


def _result(future: Any) -> Turn | None:
    """What a worker found; None where it died over it."""
    from distributed import KilledWorker

    try:
        found: Turn = future.result()
    except KilledWorker:
        return None
    return found


def _knock(address: str, timeout: float) -> None:
    """Raises OSError or ValueError where no scheduler answers.

    A Client finds that out as well, but one that failed stays behind half made, and hangs the process when the garbage
    collector takes it while another is made.
    """
    import asyncio

    from distributed.comm import connect
    from distributed.security import Security

    async def try_to_connect() -> None:
        comm = await connect(address, timeout=timeout, **Security().get_connection_args("client"))
        await comm.close()

    with ThreadPoolExecutor(1) as pool:  # an event loop may be running in this thread, as in a notebook
        pool.submit(asyncio.run, asyncio.wait_for(try_to_connect(), timeout + 1)).result()


def _address_in(file: Path, timeout: float) -> str:
    """The address that a scheduler writes to a file when it is there."""
    end = time.monotonic() + timeout
    while True:
        try:
            return str(json.loads(file.read_bytes())["address"])
        except (OSError, ValueError, KeyError, TypeError) as error:  # not there yet, or not whole
            if time.monotonic() > end:
                raise ClusterError(
                    f"no Dask scheduler has written its address to {file} ({type(error).__name__}). Start one with "
                    f"`dask scheduler --scheduler-file {file}`, or wait longer."
                ) from error
        time.sleep(_POLL)


@contextmanager
def cluster(address: str, timeout: float = 10.0) -> Iterator[Cluster]:
    """Connect to a Dask cluster whose workers compute the blocks of a stored sweep; for a `with` statement.

    Parameters
    ----------
    address : str
        Address of the scheduler, such as ``tcp://host:8786``, or the path of the file that it writes its address to
        (``dask scheduler --scheduler-file FILE.json``); "local" starts a cluster on this machine.
    timeout : float, optional
        How long to wait for the scheduler, and then for a worker, s.

    Yields
    ------
    Cluster
        For `SweepStore.run`.

    Raises
    ------
    ClusterError
        If no scheduler answers within `timeout`, or it has no workers.
    ArgumentError
        If the address is no text, or the timeout no number above 0.

    See Also
    --------
    SweepStore : What the cluster computes.

    Notes
    -----
    The store must be on a disk that all workers share. A block whose worker dies is computed again by another.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> store = fx.workspace.SweepStore.create("map.zarr", machine, fx.pose_grid(z=[2.3, 2.4]))
    >>> with fx.workspace.cluster("local") as workers:  # doctest: +SKIP
    ...     store.run(workers)
    """
    instance(address, str, "address", "as tcp://host:8786 or local")
    timeout = positive(timeout, "timeout", "s")
    dask = needed("distributed", "sweep", "a cluster needs dask.distributed")
    if address == LOCAL:
        local = dask.LocalCluster(threads_per_worker=1, dashboard_address="localhost:0")
        with local, dask.Client(local) as client:
            yield Cluster(client)
        return
    address = _address_in(Path(address), timeout) if address.endswith(".json") else address
    try:
        _knock(address, timeout)
        client = dask.Client(address, timeout=timeout)
    except (OSError, ValueError, OverflowError, RuntimeError, TypeError) as error:  # the last for tls without its keys
        raise ClusterError(
            f"no Dask scheduler answers at {address} ({str(error) or 'timed out'}). Start one with "
            "`dask scheduler`, check the address (tcp://host:port), or use the address `local`."
        ) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=timeout)
        except TimeoutError:
            raise ClusterError(
                f"the scheduler at {address} has no workers. Start some with `dask worker {address}`."
            ) from None
        yield Cluster(client)
