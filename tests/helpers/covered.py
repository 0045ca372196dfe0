"""How much of the Python code the tests ran, by lines and branches together and by branches alone: `make coverage`.

Fails where either is below `fail_under` of pyproject.toml. The combined number is coverage's own; it flatters, since
most lines are easy to reach and branches are not.
"""

import json
import sys
import tempfile
from pathlib import Path

from coverage import Coverage


def main() -> int:
    """Print both and return the exit code."""
    measured = Coverage()
    measured.combine()
    measured.save()
    whole = measured.report()
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory) / "coverage.json"
        measured.json_report(outfile=str(file))
        totals = json.loads(file.read_text())["totals"]
    branches = 100 * totals["covered_branches"] / totals["num_branches"]
    least = measured.get_option("report:fail_under")
    print(f"branches: {totals['covered_branches']} of {totals['num_branches']}, {branches:.2f} %")
    print(f"lines and branches: {whole:.2f} %; at least {least} % is asked of both")
    return 0 if min(branches, whole) >= least else 2


if __name__ == "__main__":
    sys.exit(main())
