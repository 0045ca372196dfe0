"""Long jobs, each in its own process. Results are streamed to the page that started the job.

A job is stopped when its page closes or cancels it, or when it takes too long.
"""

from __future__ import annotations

import contextlib
import os
import secrets
from collections.abc import AsyncIterator

import anyio

from flexapod.web import limits
from flexapod.web.answers import JobMessage
from flexapod.web.clients import Client
from flexapod.web.encode import frame
from flexapod.web.process import Pool
from flexapod.web.turns import Share, Turns

KEPT = 2  #: idle processes kept: a page starts a cloud and a slice at the same time
NICENESS = 15  #: questions, which follow sliders, go before jobs
DIED = "the process of this {} died; it may have run out of memory"


class Jobs:
    """Jobs of all pages."""

    def __init__(self, at_once: int | None = None) -> None:
        self._turns = Turns(at_once or min(max(4, os.cpu_count() or 1), limits.MOST_JOBS))
        self.pool = Pool(KEPT, NICENESS, limits.MEMORY)
        self._cancelled: dict[str, bool] = {}  # running jobs, and whether each was told to stop
        self._there, self._bytes = Share(limits.WAITING), Share(limits.BODIES_BYTES)

    def running(self) -> list[str]:
        """Names of the jobs that run or wait."""
        return list(self._cancelled)

    def cancel(self, name: str) -> bool:
        """Stop a job; False if no job of this name runs. Only the page that started a job knows its name."""
        known = name in self._cancelled
        if known:
            self._cancelled[name] = True
        return known

    async def run(self, client: Client, kind: str, body: bytes) -> AsyncIterator[bytes]:
        """Frames of one job: its name, its messages, and how it ended (done, failed or cancelled)."""
        with contextlib.ExitStack() as held:
            if not (
                held.enter_context(self._there.held(client)) and held.enter_context(self._bytes.held(client, len(body)))
            ):
                yield _failed("too many jobs wait for their turn; try again later")
                return
            name = secrets.token_urlsafe(16)
            self._cancelled[name] = False
            held.callback(self._cancelled.pop, name)
            yield frame({"type": "job", "id": name, "waiting": self._turns.waits(client)})
            async with self._turns.turn(client):
                async for message in self._frames(name, kind, body):
                    yield message

    async def _frames(self, name: str, kind: str, body: bytes) -> AsyncIterator[bytes]:
        """Frames of a job that has its turn. The process is kept only if the job came to its end."""
        try:
            process = await self.pool.take()
        except (EOFError, OSError):
            yield _failed(DIED.format("job"))
            return
        finished = False
        latest = anyio.current_time() + limits.JOB_SECONDS
        try:
            await process.send(kind, body)
            while not finished:
                if self._cancelled[name]:
                    yield frame({"type": "cancelled"})
                    return
                if anyio.current_time() > latest:
                    yield _failed(f"stopped after {limits.JOB_SECONDS / 60:g} minutes; the library has no such limit")
                    return
                message = await process.receive(0.1)
                if message is not None:
                    finished = message[0]["type"] in ("done", "failed")
                    yield frame(*message)
        except (EOFError, OSError):
            yield _failed(DIED.format("job"))
        finally:
            self.pool.give_back(process, finished)


def _failed(words: str) -> bytes:
    message: JobMessage = {"type": "failed", "error": words}
    return frame(message)
