"""The command `flexapod`, which is `python -m flexapod` too."""

import gc
import sys

from flexapod.cli import main
from flexapod.optional import ASKED_OF_ARRAYS, spare

#: What the arguments of a command hold that needs one of these packages: only a cluster has arrays of Dask.
_NEEDED_BY = {"pyarrow": ".parquet"}
#: Objects made between two searches for garbage: what is loaded stays, so to look through it at every 700 is in vain.
_BETWEEN_SEARCHES = 100_000


def run() -> int:
    """What the shell starts: the command line. Returns its exit code."""
    gc.set_threshold(_BETWEEN_SEARCHES)
    line = " ".join(sys.argv[1:]).lower()
    spare(name for name in ASKED_OF_ARRAYS if _NEEDED_BY.get(name, "--scheduler") not in line)
    try:
        return main()
    finally:
        gc.freeze()  # the process ends: what it holds goes with it, and need not be searched for garbage before


if __name__ == "__main__":
    sys.exit(run())
