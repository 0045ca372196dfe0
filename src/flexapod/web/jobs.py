"""Long jobs, each in its own process. Results are streamed to the page that started the job.

A job is stopped when its page closes or cancels it.
"""

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

from flexapod.web import worker
from flexapod.web.encode import frame

KEPT = 2  #: idle processes kept: a page starts a cloud and a slice at the same time
_SPAWN = multiprocessing.get_context("spawn")  # a fork of a server with threads may hang


@contextlib.contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block Ctrl-C for processes started in the block, from their start on: the server ends them itself."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    resource_tracker.ensure_running()  # or the start does it, which unblocks the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class Process(NamedTuple):
    """A process that runs one job after another."""

    process: BaseProcess
    pipe: Connection

    @classmethod
    def start(cls) -> Process:
        ours, theirs = _SPAWN.Pipe()
        process = _SPAWN.Process(target=worker.serve, args=(theirs,), name="flexapod-job", daemon=True)
        with _interrupts_blocked():
            process.start()
        theirs.close()
        return cls(process, ours)

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()
        self.process.close()


class Jobs:
    """Jobs of all pages. Some idle processes are kept, since starting one takes longer than most jobs."""

    def __init__(self, at_once: int | None = None) -> None:
        self._limit = anyio.CapacityLimiter(at_once or max(4, os.cpu_count() or 1))
        self._idle: list[Process] = []
        self._cancelled: dict[str, bool] = {}  # running jobs, and whether each was told to stop

    async def warm(self) -> None:
        """Start processes for the first jobs."""
        while len(self._idle) < KEPT:
            self._idle.append(await anyio.to_thread.run_sync(Process.start))

    def close(self) -> None:
        """End the idle processes."""
        while self._idle:
            self._idle.pop().stop()

    async def _free_process(self) -> Process:
        """An idle process that is alive, or a new one."""
        while self._idle:
            process = self._idle.pop()
            if process.process.is_alive():
                return process
            process.stop()
        return await anyio.to_thread.run_sync(Process.start)

    def running(self) -> list[str]:
        """Names of the jobs that run or wait."""
        return list(self._cancelled)

    def cancel(self, name: str) -> bool:
        """Stop a job; False if no job of this name runs. Only the page that started a job knows its name."""
        known = name in self._cancelled
        if known:
            self._cancelled[name] = True
        return known

    async def run(self, kind: str, spec: dict[str, Any]) -> AsyncIterator[bytes]:
        """Frames of one job: its name, its messages, and how it ended (done, failed or cancelled)."""
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
        """Frames of a job that has its turn. The process is kept only if the job came to its end."""
        process = await self._free_process()
        finished = False
        try:
            process.pipe.send((kind, spec))
            while not finished:
                if self._cancelled[name]:
                    yield frame({"type": "cancelled"})
                    return
                if not await anyio.to_thread.run_sync(process.pipe.poll, 0.1):
                    continue
                try:
                    message, data = await anyio.to_thread.run_sync(process.pipe.recv)
                except EOFError:
                    yield frame(
                        {"type": "failed", "error": "the process of this job died; it may have run out of memory"}
                    )
                    return
                finished = message["type"] in ("done", "failed")
                yield frame(message, data)
        finally:
            if finished and len(self._idle) < KEPT:
                self._idle.append(process)
            else:
                process.stop()
