"""Locks on a store, so that one run at a time writes it; and what a killed run has left half written."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from flexapod.errors import OutputError

_LOOK = 0.02  # s between looks at a lock


def remove_partial(path: str, files: Iterable[Path] | None = None) -> None:
    """Take away what a killed run left half written, of some files or of all."""
    found = Path(path).rglob("*.partial") if files is None else _partial_of(files)
    for file in found:
        file.unlink(missing_ok=True)


def _partial_of(files: Iterable[Path]) -> Iterator[Path]:
    wanted: dict[Path, set[str]] = {}
    for file in files:
        wanted.setdefault(file.parent, set()).add(file.stem)
    for folder, names in wanted.items():
        yield from (file for file in folder.glob("*.partial") if file.name.split(".")[0] in names)


@contextmanager
def locked(path: str, *, shared: bool = False, patience: float = 0.0) -> Iterator[None]:
    """A lock on a file or directory, which dies with the process that holds it.

    shared: beside others that share it. patience: how long to wait for it, s, before it raises OutputError.
    """
    try:
        import fcntl
    except ImportError:  # not on Windows
        yield
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        end = time.monotonic() + patience
        while True:
            try:
                fcntl.flock(handle, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
                break
            except BlockingIOError:
                if time.monotonic() >= end:
                    raise OutputError(
                        f"another run is writing {path} just now. Wait for it, or write to another store."
                    ) from None
            time.sleep(_LOOK)
        yield
    finally:
        os.close(handle)
