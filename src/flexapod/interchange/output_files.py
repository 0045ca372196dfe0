"""Files that are written: the path checked before anything is computed, and errors that say what to do."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from flexapod.errors import ArgumentError, OutputError, shown


def output_path(path: str | PathLike[str]) -> Path:
    """The path of a file to be written; raises ArgumentError for anything else, such as a hexapod."""
    if not isinstance(path, str | PathLike):
        raise ArgumentError(
            f"path is {shown(path)}; it must be the path of the file to write, which comes before the hexapod."
        )
    return Path(path)


def write(file: Path, content: str | bytes) -> Path:
    """Write a text or binary file; raises OutputError where that cannot be."""
    try:
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as error:
        raise OutputError(f"{file} cannot be written: {error.strerror}. Choose another place.") from error
    return file
