"""Where processes come from that compute for the server: on Linux they are forks of one that is made for that.

It has loaded what all of them need, so that each starts in milliseconds and shares its memory. A fork of the server
itself, with its threads, may hang. On other systems, whose libraries do not bear it, each process starts anew.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import signal
import sys
from collections.abc import Iterator
from multiprocessing import reduction, resource_tracker
from typing import Any

FORKS = sys.platform == "linux"
CONTEXT = multiprocessing.get_context("forkserver") if FORKS else multiprocessing.get_context("spawn")
PRELOADED = "flexapod.web.preloaded"
if FORKS:
    CONTEXT.set_forkserver_preload([PRELOADED])


def begin() -> None:
    """Let what is to be forked load, while this process goes on."""
    if FORKS:
        from multiprocessing import forkserver

        with interrupts_blocked():
            forkserver.ensure_running()


@contextlib.contextmanager
def interrupts_blocked() -> Iterator[None]:
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


def errors() -> Any:
    """Where this process writes its errors, to be given to a new one: what is forked may write them elsewhere."""
    return reduction.DupFd(sys.__stderr__.fileno()) if FORKS and sys.__stderr__ is not None else None
