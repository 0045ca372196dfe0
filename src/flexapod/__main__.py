"""`python -m flexapod` is the command `flexapod`."""

import sys

from flexapod.cli import main

if __name__ == "__main__":
    sys.exit(main())
