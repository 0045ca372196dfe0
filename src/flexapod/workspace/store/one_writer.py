"""One run at a time writes a store, and takes away what a killed run has left half written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from flexapod.errors import OutputError


def remove_partial(path: str) -> None:
    """Take away what a killed run left half written."""
    for file in Path(path).rglob("*.partial"):
        file.unlink(missing_ok=True)


@contextmanager
def one_writer(path: str) -> Iterator[None]:
    """One run at a time. A lock dies with the process that holds it."""
    try:
        import fcntl
    except ImportError:  # not on Windows
        yield
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise OutputError(
                f"another run is writing {path} just now. Wait for it, or write to another store."
            ) from None
        yield
    finally:
        os.close(handle)
