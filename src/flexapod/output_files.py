"""Files that Flexapod writes: tried before the work, and there as a whole or not at all.

A file is made beside its place under another name and gets its own when it is complete, so that a full disk or an
interrupt leaves what was there before.
"""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexapod.errors import ArgumentError, OutputError, shown

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_passing: set[Path] = set()  # files and directories that are there for a moment only
_QUIET, _PATIENCE = 0.5, 10.0  # s: how long nothing more comes, and how long that is waited for
#: Words are text in files, and the same figure is the same file.
_AS_TEXT = {"svg.fonttype": "none", "svg.hashsalt": "flexapod", "pdf.fonttype": 42, "ps.fonttype": 42}
#: Endings of figures that Matplotlib writes.
FIGURES = (".png", ".pdf", ".svg", ".eps", ".ps", ".jpg", ".jpeg", ".tif", ".tiff", ".webp")


def output_path(path: str | PathLike[str]) -> Path:
    """The path of a file to be written; raises ArgumentError for anything else, such as a hexapod."""
    if not isinstance(path, str | PathLike):
        raise ArgumentError(
            f"path is {shown(path)}; it must be the path of the file to write, which comes before the hexapod."
        )
    return Path(path)


@contextmanager
def passing(path: Path) -> Iterator[Path]:
    """A file or directory that is there while the block runs, and no longer, whatever ends it."""
    _passing.add(path)
    try:
        yield path
    finally:
        _remove(path)
    _passing.discard(path)


def remove_passing() -> None:
    """Take away what an interrupt left: it came before it was to be removed, or while another thread wrote in it.

    Such a thread makes its folder anew; it has ended when nothing has come for a while.
    """
    begun = quiet_since = time.monotonic()
    while _passing and time.monotonic() < min(quiet_since + _QUIET, begun + _PATIENCE):
        for path in [path for path in _passing if os.path.lexists(path)]:
            _remove(path)
            quiet_since = time.monotonic()
        time.sleep(0.01)
    _passing.clear()


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        import shutil  # not with the package, which is light

        shutil.rmtree(path, ignore_errors=True)
    else:
        with suppress(OSError, ValueError):
            path.unlink(missing_ok=True)


@contextmanager
def completed(path: str | PathLike[str]) -> Iterator[Path]:
    """Where to make a file, which gets its own name when the block ends well. Raises OutputError."""
    path = Path(path)
    try:
        place = _place(path)
        making = place if _is_device(place) else place.with_name(f".{os.getpid()}.{place.name[-60:]}")
    except (OSError, ValueError) as error:
        raise _failed(path, error) from error
    try:
        with passing(making) if making != place else nullcontext():
            yield making
            if making != place:
                if place.exists():
                    making.chmod(stat.S_IMODE(place.stat().st_mode))
                os.replace(making, place)
    except OutputError:
        raise
    except OSError as error:
        raise _failed(path, error) from error


def write_file(path: str | PathLike[str], content: str | bytes | memoryview) -> Path:
    """Write a file, text in UTF-8. Raises OutputError."""
    with completed(path) as making:
        making.write_bytes(content.encode() if isinstance(content, str) else content)
    return Path(path)


def write_figure(
    figure: Figure, path: str | PathLike[str], *, dpi: float = 160, metadata: Mapping[str, Any] | None = None
) -> None:
    """Write a figure in the format that the name ends with. Words stay text. Raises OutputError."""
    import matplotlib

    check_figure(Path(path))
    with completed(path) as making, matplotlib.rc_context(_AS_TEXT):  # type: ignore[arg-type]
        told: dict[str, Any] = {} if metadata is None else {"metadata": metadata}
        with drawn_once(figure):
            figure.savefig(making, dpi=dpi, **told)


@contextmanager
def drawn_once(figure: Figure, tight: bool = False) -> Iterator[None]:
    """While a figure is saved: of the drawing that Matplotlib makes to lay it out, only the layout is made.

    tight: it is cut to what is drawn, for which Matplotlib draws it first in any case.
    """
    engine = figure.get_layout_engine()
    spatial = any(hasattr(ax, "get_zlabel") for ax in figure.axes)
    if engine is None and (not tight or spatial):  # a drawing is what lays out axes of space
        yield
        return

    def lay_out(renderer: object) -> None:
        vars(figure).pop("draw")
        if engine is not None:
            engine.execute(figure)

    figure.draw = lay_out  # type: ignore[method-assign]
    try:
        yield
    finally:
        vars(figure).pop("draw", None)


def write_netcdf(dataset: xr.Dataset, path: str | PathLike[str], engine: str | None = None) -> None:
    """Write a dataset as NetCDF. Raises OutputError."""
    write_file(path, netcdf(dataset, engine))


def netcdf(dataset: xr.Dataset, engine: str | None = None) -> memoryview:
    """A dataset as NetCDF, made in memory: the HDF5 library ends the process where a disk is full."""
    return memoryview(dataset.to_netcdf(engine=engine))  # type: ignore[arg-type]


def check_figure(path: Path) -> None:
    """Raises OutputError for a name that ends in no format of figures."""
    if path.suffix.lower() not in FIGURES:
        raise OutputError(f"{path} ends in {path.suffix!r}, no format of figures. Choose .png, .pdf or .svg.")


def check_file(path: str | PathLike[str]) -> Path:
    """The path of a file, tried: raises OutputError, before anything is computed, where it cannot be written."""
    path = Path(path)
    if not path.parent.is_dir():
        raise OutputError(f"{path.parent} is no directory, so {path.name} cannot be written in it. Make it first.")
    try:
        place = _place(path)
        if not _is_device(place):
            _try_in(place.parent, place.name)
    except (OSError, ValueError) as error:
        raise _failed(path, error) from error
    return path


def check_directory(path: Path) -> Path:
    """The path of a directory for files, tried: raises OutputError, before anything is computed, where none can be."""
    try:
        there = next(place for place in (path, *path.absolute().parents) if place.exists())
        if not there.is_dir():
            raise NotADirectoryError(20, f"{there} is a file")
        _try_in(there, path.name)
    except (OSError, ValueError) as error:
        words = getattr(error, "strerror", None) or error
        raise OutputError(f"{path} cannot be made a directory: {words}. Choose another place.") from error
    return path


def make_directory(path: Path) -> Path:
    """The directory, made if it is not there. Raises OutputError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        words = getattr(error, "strerror", None) or error
        raise OutputError(f"{path} cannot be made a directory: {words}. Choose another place.") from error
    return path


def _place(path: Path) -> Path:
    """The file itself where the path is a link to it; raises OSError for one that must not be replaced."""
    place = Path(os.path.realpath(path))
    if place.is_dir():
        raise IsADirectoryError(21, "it is a directory")
    if place.exists() and not place.stat().st_mode & 0o222:
        raise PermissionError(13, "it may not be written to")
    return place


def _is_device(place: Path) -> bool:
    """Something that is no file and must stay, as /dev/null or a pipe."""
    return place.exists() and not place.is_file()


def _try_in(folder: Path, name: str) -> None:
    trial = folder / f".{os.getpid()}.{name}"[:255]
    if len(name.encode()) > 255:
        raise OSError(36, "File name too long")
    with passing(trial):
        trial.touch()


def _failed(path: Path, error: Exception) -> OutputError:
    words = getattr(error, "strerror", None) or error
    return OutputError(f"{path} cannot be written: {words}. Choose another place.")
