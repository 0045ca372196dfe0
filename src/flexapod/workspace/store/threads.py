"""Blocks of a stored sweep computed by threads of this process, one block a thread."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Any

from flexapod.checks import thread_count
from flexapod.workspace.store.block_job import Finished, Job, flush_block, write_block

_POLL = 0.2  # s between looks at whether to stop


class Threads:
    """See `flexapod.workspace.store.block_job.Workers`. Default: all cores that this process may use."""

    def __init__(self, count: int | None = None) -> None:
        self.count = thread_count(count)

    def compute(self, job: Job, numbers: Iterable[int], stop: Callable[[], bool]) -> Iterator[Finished]:
        todo = list(numbers)
        if not todo:
            return
        job = job._replace(threads=max(1, self.count // len(todo)))
        waiting = iter(todo)
        computing: set[Future[Finished]] = set()
        flushing: dict[Future[None], Finished] = {}  # written; the disk takes them while others are computed
        with ThreadPoolExecutor(self.count) as pool, ThreadPoolExecutor(1) as flusher:
            try:
                while True:
                    while len(computing) + len(flushing) < 2 * self.count and not stop():
                        number = next(waiting, None)
                        if number is None:
                            break
                        computing.add(pool.submit(write_block, job, number))
                    if not computing and not flushing:
                        return
                    if stop():
                        computing = {future for future in computing if not future.cancel()}
                    begun: list[Future[Any]] = [*computing, *flushing]
                    wait(begun, _POLL, FIRST_COMPLETED)
                    for future in [future for future in computing if future.done()]:
                        computing.remove(future)
                        block = future.result()
                        flushing[flusher.submit(flush_block, job, block.number)] = block
                    for flushed in [flushed for flushed in flushing if flushed.done()]:
                        flushed.result()
                        yield flushing.pop(flushed)
            finally:
                pool.shutdown(cancel_futures=True)
