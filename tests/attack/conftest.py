"""The table at the end of `make attack`."""

import os

from tests.attack.bounded import SECONDS, TRIED


def pytest_terminal_summary(terminalreporter):
    if not TRIED or "FLEXAPOD_ATTACK_SECONDS" not in os.environ:
        return
    terminalreporter.section(f"attacks of {SECONDS:g} s each")
    wide = max(map(len, TRIED))
    for attack, outcomes in sorted(TRIED.items()):
        ends = "; ".join(f"{outcome}: {count}" for outcome, count in sorted(outcomes.items()))
        terminalreporter.write_line(f"{attack:{wide}}  {outcomes.total():7}  {ends}")
