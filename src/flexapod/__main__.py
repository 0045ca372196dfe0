"""The command `flexapod`, which is `python -m flexapod` too."""

import gc
import sys

from flexapod.cli import main

#: Packages that xarray and pandas load to ask every array whether it is one of theirs, which takes longer than most
#: commands, and what the arguments of a command that needs them hold: only a cluster has arrays of Dask.
_SPARED = {"dask": "--scheduler", "pint": "--scheduler", "pyarrow": ".parquet"}
#: Objects made between two searches for garbage: what is loaded stays, so to look through it at every 700 is in vain.
_BETWEEN_SEARCHES = 100_000


def run() -> int:
    """What the shell starts: the command line. Returns its exit code."""
    gc.set_threshold(_BETWEEN_SEARCHES)
    for name, needed_by in _SPARED.items():
        if not any(needed_by in text.lower() for text in sys.argv[1:]):
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # so Python marks what is not to be had
    try:
        return main()
    finally:
        gc.freeze()  # the process ends: what it holds goes with it, and need not be searched for garbage before


if __name__ == "__main__":
    sys.exit(run())
