"""Progress of a study that works in stages, on standard error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from flexapod.progress import in_terminal


class Report(Protocol):
    """Called with the stage's name and the share of it that is done."""

    def __call__(self, stage: str, share: float) -> None: ...


@contextmanager
def stages(quiet: bool, first: str = "") -> Iterator[Report]:
    """A bar for every stage that reports; none when quiet, or where standard error is no terminal.

    first: the stage that is shown before it reports.
    """
    if quiet or not in_terminal():
        yield lambda stage, share: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        tasks: dict[str, TaskID] = {}

        def report(stage: str, share: float) -> None:
            if stage not in tasks:
                tasks[stage] = progress.add_task(stage, total=1.0)
            progress.update(tasks[stage], completed=min(share, 1.0))

        if first:
            report(first, 0.0)
        yield report
