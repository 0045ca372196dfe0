"""Processes that compute for the server, with limits of memory, and pools of them."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import threading
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple

import anyio
from anyio.to_thread import run_sync

from flexapod.web import forks, limits, worker


def _serve(pipe: Connection, errors: Any, niceness: int, memory: int) -> None:
    """What a process does: it lets others go first, limits its memory, and answers until its pipe closes."""
    if errors is not None:
        os.dup2(errors.detach(), 2)
    if hasattr(os, "nice"):
        os.nice(niceness)
    limit_memory(memory)
    if not forks.FORKS:  # slow: before the first response needs it
        threading.Thread(target=import_module, args=(forks.PRELOADED,), daemon=True).start()
    with contextlib.suppress(BrokenPipeError):  # the server has ended meanwhile
        pipe.send(({"type": "ready"}, b""))
        worker.serve(pipe)


def limit_memory(more: int) -> None:
    """Limit the data of this process to what it has and so many bytes more. Only Linux enforces such a limit."""
    if sys.platform != "linux":
        return
    import resource

    found = re.search(r"VmData:\s*(\d+) kB", Path("/proc/self/status").read_text(encoding="ascii"))
    most = (int(found[1]) * limits.KIB if found else 0) + more
    _, hard = resource.getrlimit(resource.RLIMIT_DATA)
    with contextlib.suppress(ValueError):  # the system's own limit is lower
        resource.setrlimit(resource.RLIMIT_DATA, (most, hard))


class Process(NamedTuple):
    """A process that answers one question or runs one job after another."""

    process: BaseProcess
    pipe: Connection

    @classmethod
    def start(cls, niceness: int, memory: int) -> Process:
        ours, theirs = forks.CONTEXT.Pipe()
        given = (theirs, forks.errors(), niceness, memory)
        process = forks.CONTEXT.Process(target=_serve, args=given, name="flexapod-job", daemon=True)
        with forks.interrupts_blocked():
            process.start()
        theirs.close()
        return cls(process, ours)

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()
        self.process.close()

    async def send(self, kind: str, body: bytes) -> None:
        """Raises OSError if the process has died."""
        if len(body) > limits.SMALL_BYTES:  # more than a pipe takes at once
            await run_sync(self.pipe.send, (kind, body))
        else:
            self.pipe.send((kind, body))

    async def receive(self, seconds: float) -> tuple[Any, bytes] | None:
        """The next message, if it comes in time. Raises EOFError or OSError if the process has died."""
        if sys.platform == "win32":
            return self.pipe.recv() if await run_sync(self.pipe.poll, seconds) else None
        with anyio.move_on_after(seconds):
            await anyio.wait_readable(self.pipe.fileno())
            return self.pipe.recv()
        return None


class Pool:
    """Some idle processes are kept, since starting one takes longer than most questions and jobs."""

    def __init__(self, kept: int, niceness: int, memory: int) -> None:
        self.kept, self.niceness, self.memory = kept, niceness, memory
        self.idle: list[Process] = []
        self._starting = anyio.Lock()

    async def _start(self) -> Process:
        process = await run_sync(Process.start, self.niceness, self.memory)
        end = anyio.current_time() + limits.START_SECONDS
        while await process.receive(0.1) is None:
            if anyio.current_time() > end:
                process.stop()
                raise OSError("a process did not start")
        return process

    async def warm(self) -> None:
        """Start the processes that are kept."""
        while len(self.idle) < self.kept:
            async with self._starting:
                self.idle.append(await self._start())

    async def take(self) -> Process:
        """An idle process that is alive, or a new one; it waits for one that starts."""
        async with self._starting:
            while self.idle:
                process = self.idle.pop()
                if process.process.is_alive():
                    return process
                process.stop()
            return await self._start()

    def give_back(self, process: Process, well: bool) -> None:
        """Keep a process that did its work well; end any other."""
        if well and len(self.idle) < self.kept:
            self.idle.append(process)
        else:
            process.stop()

    def close(self) -> None:
        """End the idle processes."""
        while self.idle:
            self.idle.pop().stop()
