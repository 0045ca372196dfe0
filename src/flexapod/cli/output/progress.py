"""Progress on standard error: of a run over many poses, and of the trials of a search."""

from __future__ import annotations

from types import TracebackType
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

if TYPE_CHECKING:
    from flexapod.workspace.store.store import Progress as State


class PoseProgress:
    """Called with the `state` of a `flexapod.workspace.SweepStore`."""

    def __init__(self) -> None:
        columns = (
            TextColumn("{task.fields[poses]}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[rate]}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[bad]}"),
        )
        self._progress = Progress(*columns, console=Console(stderr=True))
        self._task: TaskID | None = None

    def __enter__(self) -> PoseProgress:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def __call__(self, state: State) -> None:
        if self._task is None:
            self._task = self._progress.add_task(
                "", total=state.total, completed=state.before, poses="", rate="", bad=""
            )
        elapsed = self._progress.tasks[0].elapsed or 0.0
        rate = f"{_short((state.done - state.before) / elapsed)} poses/s" if elapsed > 0 else ""
        bad = sum(count for code, count in state.statuses.items() if code)
        self._progress.update(
            self._task,
            completed=state.done,
            poses=f"{_short(state.done)} of {_short(state.total)} poses",
            rate=rate,
            bad=f"{bad} not ok" if bad else "",
        )


def _short(number: float) -> str:
    for size, letter in ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")):
        if number >= size:
            return f"{number / size:.3g} {letter}"
    return f"{number:.3g}"


class TrialProgress:
    """Called with trials finished, trials wanted, and the best index so far."""

    def __init__(self) -> None:
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[best]}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        self._progress = Progress(*columns, console=Console(stderr=True))
        self._task: Any = None

    def __enter__(self) -> TrialProgress:
        self._progress.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._progress.stop()

    def __call__(self, done: int, wanted: int, best: float) -> None:
        if self._task is None:
            self._task = self._progress.add_task("trials", total=wanted, best="")
        words = f"best {best:.5g} rad/s" if best == best else "none feasible yet" if done else ""
        finishing = done >= wanted
        self._progress.update(
            self._task,
            completed=done,
            best=words,
            description="finishing by gradients, verifying" if finishing else "trials",
        )
