"""The command `flexapod`, which is `python -m flexapod` too."""

import sys

from flexapod.cli import main

#: Packages that xarray loads to ask every array whether it is one of theirs, which takes longer than most commands.
_SPARED = ("dask", "pint")


def run() -> int:
    """What the shell starts: the command line. Returns its exit code."""
    if not any(text.startswith("--scheduler") for text in sys.argv[1:]):  # only a cluster has such arrays
        for name in _SPARED:
            sys.modules.setdefault(name, None)  # type: ignore[arg-type]  # so Python marks what is not to be had
    return main()


if __name__ == "__main__":
    sys.exit(run())
