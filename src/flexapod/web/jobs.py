"""Long jobs, each in a process of its own: streamed to the one page that asked, stopped when it goes or says so."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import secrets
import signal
from collections.abc import AsyncIterator, Iterator
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, NamedTuple

import anyio
import anyio.to_thread

from flexapod.web import worker as work
from flexapod.web.encode import frame

KEPT = 2  #: idle processes: a page asks for a cloud and a slice at once
_SPAWN = multiprocessing.get_context("spawn")  # a fork of a server with threads may hang


@contextlib.contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Processes started within do not get a terminal's Ctrl-C, from their first moment: the server ends them itself."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # done later by the start itself, this would lift the mask again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Worker(NamedTuple):
    """A process that waits for one job after another."""

    process: BaseProcess
    pipe: Connection

    @classmethod
    def start(cls) -> Worker:
        ours, theirs = _SPAWN.Pipe()
        process = _SPAWN.Process(target=work.serve, args=(theirs,), name="flexapod-job", daemon=True)
        with _deaf_to_interrupts():
            process.start()
        theirs.close()
        return cls(process, ours)

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()
        self.process.close()


class Jobs:
    """Runs jobs for many pages. Idle processes are kept ready, since starting one takes longer than most jobs."""

    def __init__(self, at_once: int | None = None) -> None:
        self._limit = anyio.CapacityLimiter(at_once or max(4, os.cpu_count() or 1))
        self._idle: list[Worker] = []
        self._cancelled: dict[str, bool] = {}  # running jobs, and whether each was told to stop

    async def warm(self) -> None:
        """Have processes ready for the first jobs."""
        while len(self._idle) < KEPT:
            self._idle.append(await anyio.to_thread.run_sync(Worker.start))

    def close(self) -> None:
        while self._idle:
            self._idle.pop().stop()

    async def _worker(self) -> Worker:
        """An idle process, or a new one; those that have died meanwhile are given up."""
        while self._idle:
            worker = self._idle.pop()
            if worker.process.is_alive():
                return worker
            worker.stop()
        return await anyio.to_thread.run_sync(Worker.start)

    def running(self) -> list[str]:
        """Names of the jobs that run or wait."""
        return list(self._cancelled)

    def cancel(self, name: str) -> bool:
        """Stop a job; False where no job of this name runs. Names are known only to the page that started the job."""
        known = name in self._cancelled
        if known:
            self._cancelled[name] = True
        return known

    async def run(self, kind: str, spec: dict[str, Any]) -> AsyncIterator[bytes]:
        """Frames of one job: its name, then what it yields, then how it ended (done, failed or cancelled)."""
        name = secrets.token_urlsafe(16)
        self._cancelled[name] = False
        try:
            yield frame({"type": "job", "id": name, "waiting": self._limit.available_tokens < 1})
            async with self._limit:
                async for message in self._frames(name, kind, spec):
                    yield message
        finally:
            del self._cancelled[name]

    async def _frames(self, name: str, kind: str, spec: dict[str, Any]) -> AsyncIterator[bytes]:
        worker = await self._worker()
        finished = False
        try:
            worker.pipe.send((kind, spec))
            while not finished:
                if self._cancelled[name]:
                    yield frame({"type": "cancelled"})
                    return
                if not await anyio.to_thread.run_sync(worker.pipe.poll, 0.1):
                    continue
                try:
                    message, data = await anyio.to_thread.run_sync(worker.pipe.recv)
                except EOFError:
                    yield frame(
                        {"type": "failed", "error": "the process of this job died; it may have run out of memory"}
                    )
                    return
                finished = message["type"] in ("done", "failed")
                yield frame(message, data)
        finally:
            if finished and len(self._idle) < KEPT:
                self._idle.append(worker)
            else:
                worker.stop()
