"""Progress of long calls: a bar where somebody looks on, by itself, once a second has passed.

It is shown in terminals and in notebooks, by the outermost call only, in the first thread of the first process, and
never in files, pipes and other processes.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from html import escape
from typing import Any, Literal, ParamSpec, Protocol, TypeAlias, TypeVar

from flexapod.errors import ArgumentError, shown

#: What a call does with the share that is done: shown by itself (None), not at all, or told to a function.
ProgressLike: TypeAlias = Callable[[float], object] | Literal[False] | None

AFTER = 1.0  # s from the beginning of a call to its bar
_EVERY = 0.1  # s between two pictures of it
_inside: ContextVar[bool] = ContextVar("inside", default=False)

P = ParamSpec("P")
R = TypeVar("R")


def with_progress(what: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a function whose argument `progress` is None unless given: its bar is called `what`.

    The function itself is given something to call, or None.
    """

    def decorated(function: Callable[P, R]) -> Callable[P, R]:
        @wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            given = kwargs.get("progress")
            if not (given is None or given is False or callable(given)):
                words = "a function that is called with the share done, False for none, or None"
                raise ArgumentError(f"progress is {shown(given)}; it must be {words}.")
            if callable(given) or given is False or _inside.get():
                kwargs["progress"] = given or None
                with silent():
                    return function(*args, **kwargs)
            with silent(), _bar(what) as report:
                kwargs["progress"] = report
                return function(*args, **kwargs)

        return call

    return decorated


@contextmanager
def silent() -> Iterator[None]:
    """No call in here shows progress by itself."""
    token = _inside.set(True)
    try:
        yield
    finally:
        _inside.reset(token)


class _Picture(Protocol):
    def show(self, share: float) -> None: ...

    def close(self) -> None: ...


@contextmanager
def _bar(what: str) -> Iterator[Callable[[float], object] | None]:
    """What is called with the share done, and shows it after a while; None where nobody looks on."""
    make = _kind()
    if make is None:
        yield None
        return
    began = last = time.monotonic()
    picture: _Picture | None = None

    def report(share: float) -> None:
        nonlocal picture, last
        now = time.monotonic()
        if now - began < AFTER or (picture is not None and now - last < _EVERY and share < 1):
            return
        last = now
        picture = make(what, began) if picture is None else picture
        picture.show(min(max(float(share), 0.0), 1.0))

    try:
        yield report
    finally:
        if picture is not None:
            picture.close()


def in_terminal() -> bool:
    """Whether somebody may look on: standard error is a terminal."""
    return sys.stderr is not None and sys.stderr.isatty()


def _kind() -> Callable[[str, float], _Picture] | None:
    """How progress is shown here, if at all."""
    if threading.current_thread() is not threading.main_thread() or _is_worker():
        return None
    if _in_notebook():
        return _InNotebook
    return _InTerminal if in_terminal() else None


def _is_worker() -> bool:
    """Whether this is a process that another one of Python started to share its work."""
    process = sys.modules.get("multiprocessing.process")  # loaded in every such process
    return process is not None and process.parent_process() is not None


def _in_notebook() -> bool:
    """Whether there is a kernel that shows what a cell displays; a terminal's IPython is a terminal."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell is not None and getattr(shell, "kernel", None) is not None


class _InTerminal:
    """A line on standard error, which is gone at the end."""

    def __init__(self, what: str, began: float) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

        columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
        self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task(what, total=1.0)
        self._progress.start()

    def show(self, share: float) -> None:
        self._progress.update(self._task, completed=share)

    def close(self) -> None:
        self._progress.stop()


class _InNotebook:
    """A bar of the browser's own below the cell, which is gone at the end."""

    def __init__(self, what: str, began: float) -> None:
        from IPython.display import HTML, display

        self._what, self._began, self._html = what, began, HTML
        self._place: Any = display(HTML(""), display_id=True)

    def show(self, share: float) -> None:
        passed = time.monotonic() - self._began
        left = f", {passed * (1 - share) / share:.0f} s left" if share > 0 else ""
        bar = f'<progress value="{share:.4f}" max="1"></progress>'
        self._place.update(self._html(f"{escape(self._what)} {bar} {100 * share:.0f} %{left}"))

    def close(self) -> None:
        self._place.update(self._html(""))
