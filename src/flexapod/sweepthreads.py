"""Blocks of a stored sweep computed by threads of this process, one block a thread."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

from flexapod.quantities import thread_count
from flexapod.sweepjob import Finished, Job, compute_block

_POLL = 0.2  # s between looks at whether to stop


class Threads:
    """See `flexapod.sweepjob.Workers`. Default: all cores that this process may use."""

    def __init__(self, count: int | None = None) -> None:
        self.count = thread_count(count)

    def compute(self, job: Job, numbers: Iterable[int], stop: Callable[[], bool]) -> Iterator[Finished]:
        todo = list(numbers)
        if not todo:
            return
        job = job._replace(threads=max(1, self.count // len(todo)))
        waiting = iter(todo)
        running: set[Future[Finished]] = set()
        with ThreadPoolExecutor(self.count) as pool:
            try:
                while True:
                    while len(running) < 2 * self.count and not stop():
                        number = next(waiting, None)
                        if number is None:
                            break
                        running.add(pool.submit(compute_block, job, number))
                    if not running:
                        return
                    if stop():
                        running = {future for future in running if not future.cancel()}
                    done, running = wait(running, _POLL, FIRST_COMPLETED)
                    for future in done:
                        yield future.result()
            finally:
                pool.shutdown(cancel_futures=True)
