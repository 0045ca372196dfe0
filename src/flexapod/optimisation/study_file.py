"""The file of a study, in SQLite: made as a whole or not at all, and what goes wrong with it in sentences."""

from __future__ import annotations

import os
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

from flexapod.errors import OutputError
from flexapod.optional import needed
from flexapod.output_files import passing

_ROOM = 64 * 1024  # bytes: twice what SQLite adds to the file of its shared memory
_BEGINS = b"SQLite format 3"


def optuna_package() -> Any:
    """Optuna, which says nothing but errors. Raises MissingExtraError."""
    optuna = needed("optuna", "optimise", "the search needs Optuna; without it, leave the search out (trials=0)")
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    return optuna


@contextmanager
def told(file: Path | None) -> Iterator[None]:
    """What SQLite cannot do with the file of a study, as a full disk, in a sentence. Raises OutputError."""
    if file is None:  # a study in memory
        yield
        return
    optuna = optuna_package()
    from sqlalchemy.exc import SQLAlchemyError

    try:
        yield
    except (sqlite3.Error, SQLAlchemyError, optuna.exceptions.StorageInternalError) as error:
        cause: BaseException = error
        while not isinstance(cause, sqlite3.Error) and cause.__cause__ is not None:
            cause = cause.__cause__
        words = f"its disk is full ({cause})" if _is_full(file) else str(cause)
        raise OutputError(
            f"{file} cannot be used as a study file: {words}. Trials that are finished stay in it, and in "
            f"{file.name}-wal where that is left beside it: make room, or wait for who holds it, and give the same "
            "command again; or choose another place."
        ) from error


def _is_full(file: Path) -> bool:
    """Whether a disk has no room for what SQLite adds at a time; some of its errors do not say so."""
    try:
        return shutil.disk_usage(file.parent).free < _ROOM
    except OSError:
        return False


def open_storage(file: Path | None) -> Any:
    """Where Optuna keeps trials; None for memory. Raises OutputError."""
    if file is None:
        return None
    if not file.parent.is_dir():
        raise OutputError(f"{file.parent} is no directory, so {file.name} cannot be kept in it. Make it first.")
    try:
        if file.is_dir() or _begins(file) not in (b"", _BEGINS):
            raise OutputError(f"{file} is no study file (SQLite). Choose another name.")
        with told(file):
            if not _begins(file):
                _make(file)
            return _storage(file)
    except OutputError:
        raise
    except (OSError, ValueError) as error:  # the second for a name with a null character
        words = getattr(error, "strerror", None) or error
        raise OutputError(f"{file} cannot be written: {words}. Choose another place.") from error


def _begins(file: Path) -> bytes:
    """The first bytes of a file; none where there is no file."""
    try:
        with file.open("rb") as content:
            return content.read(len(_BEGINS))
    except FileNotFoundError:
        return b""


def _make(file: Path) -> None:
    """All tables under another name, then moved into place: whoever comes meanwhile finds a whole file or none."""
    with passing(file.with_name(f".{uuid4().hex}.{file.name[-60:]}")) as folder:
        folder.mkdir()
        making = folder / "study.db"
        _storage(making).engine.dispose()
        with closing(sqlite3.connect(making)) as connection:
            connection.execute("PRAGMA journal_mode=WAL")  # a reader does not hold a writer up
        try:
            os.link(making, file)
        except OSError:  # a file is there, or the disk has no hard links
            if not _begins(file):  # none, or an empty one; else another process was first
                os.replace(making, file)


def _storage(file: Path) -> Any:
    return optuna_package().storages.RDBStorage(_address(file), engine_kwargs={"connect_args": {"timeout": 60}})


def _address(file: Path) -> str:
    """A study file as an address, whatever characters its name has."""
    from sqlalchemy import URL

    return URL.create("sqlite", database=str(file.resolve())).render_as_string(hide_password=False)
