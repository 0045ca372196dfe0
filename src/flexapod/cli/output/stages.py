"""Progress of a study that works in stages, on standard error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta
from typing import Protocol

from flexapod.progress import in_terminal


class Report(Protocol):
    """Called with the stage's name and the share of it that is done."""

    def __call__(self, stage: str, share: float) -> None: ...


@contextmanager
def stages(quiet: bool, first: str = "") -> Iterator[Report]:
    """A bar for every stage that reports, with the time that is left where it can be told.

    There is none when quiet, or where standard error is no terminal.

    first: the stage that is shown before it reports; without one, a command may show something else before.
    """
    if quiet or not in_terminal():
        yield lambda stage, share: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.fields[left]}"))
    progress = Progress(*columns, console=Console(stderr=True), transient=True)
    tasks: dict[str, TaskID] = {}

    def report(stage: str, share: float) -> None:
        progress.start()
        if stage not in tasks:
            for earlier in tasks.values():
                progress.update(earlier, completed=1.0, left="")
            tasks[stage] = progress.add_task(stage, total=1.0, left="")
        number = tasks[stage]
        progress.update(number, completed=min(share, 1.0))
        seconds = progress.tasks[number].time_remaining
        progress.update(number, left=f"{timedelta(seconds=math.ceil(seconds))} left" if seconds else "")

    try:
        if first:
            report(first, 0.0)
        yield report
    finally:
        if tasks:
            progress.stop()
