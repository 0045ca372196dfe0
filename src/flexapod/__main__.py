"""The command `flexapod`, which is `python -m flexapod` too."""

import sys

from flexapod.cli import main

#: Packages that xarray and pandas load to ask every array whether it is one of theirs, which takes longer than most
#: commands, and what the arguments of a command that needs them hold: only a cluster has arrays of Dask.
_SPARED = {"dask": "--scheduler", "pint": "--scheduler", "pyarrow": ".parquet"}


def run() -> int:
    """What the shell starts: the command line. Returns its exit code."""
    for name, needed_by in _SPARED.items():
        if not any(needed_by in text.lower() for text in sys.argv[1:]):
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # so Python marks what is not to be had
    return main()


if __name__ == "__main__":
    sys.exit(run())
