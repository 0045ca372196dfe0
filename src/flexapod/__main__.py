"""The command `flexapod`, which is `python -m flexapod` too."""

import sys
from collections.abc import Sequence

from flexapod.cli import main

_SPARED = ("dask", "pint")


def run() -> int:
    """What the shell starts: the command line. Returns its exit code."""
    _spare(sys.argv[1:])
    return main()


def _spare(arguments: Sequence[str]) -> None:
    """Spare this process packages whose arrays it has none of: xarray loads them to ask every array whether it is one.

    That takes longer than most commands. A store and a cluster need Dask.
    """
    if not any(text.lower().endswith(".zarr") or text.startswith("--scheduler") for text in arguments):
        for name in _SPARED:
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # so Python marks what is not to be had


if __name__ == "__main__":
    sys.exit(run())
