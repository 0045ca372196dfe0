"""Ctrl-C and SIGTERM: the end of a command, or, where it can stop in good order, a wish to stop."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType
from typing import Any

import click

_ANSWER = "flexapod.answer"  # where a context keeps the exit code that says what a command found
_SIGNAL = "flexapod.signal"  # where a context keeps the number of the signal that cut its command short


class Terminated(BaseException):
    """SIGTERM came. Like KeyboardInterrupt, it is no Exception, so that nothing takes it for a failed attempt."""


class CutShort(Exception):
    """A signal ended a command in good order, before it had a result: what is kept, and how to go on."""

    def __init__(self, message: str, number: int | None) -> None:
        super().__init__(message)
        self.number = number or signal.SIGINT


class OutOfTime(Exception):
    """The time that a command was given is up, before it had a result: what is kept, and how to go on."""


@contextmanager
def terminable() -> Iterator[None]:
    """While entered, SIGTERM raises Terminated, as Ctrl-C raises KeyboardInterrupt: what was begun is undone."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def end(number: int, frame: FrameType | None) -> None:
        raise Terminated

    before, shown = signal.signal(signal.SIGTERM, end), sys.unraisablehook
    sys.unraisablehook = lambda lost: None if _comes_again(lost.exc_type) else shown(lost)
    try:
        yield
    finally:
        sys.unraisablehook = shown
        signal.signal(signal.SIGTERM, before)


def _comes_again(lost: type[BaseException]) -> bool:
    """Send a signal anew whose exception rose where Python lets none out, as in the callback of a weak reference."""
    number = {Terminated: signal.SIGTERM, KeyboardInterrupt: signal.SIGINT}.get(lost)
    if number is None:
        return False
    again = threading.Timer(0.02, os.kill, (os.getpid(), number))
    again.daemon = True
    again.start()
    return True


class Stopping:
    """While entered, the first signal only sets `signal`, and the exit code of the command; a second one interrupts."""

    def __init__(self) -> None:
        self.signal: int | None = None
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Stopping:
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def __call__(self) -> bool:
        return self.signal is not None

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.signal is not None:
            raise Terminated if number == signal.SIGTERM else KeyboardInterrupt
        self.signal = number
        context = click.get_current_context(silent=True)
        if context is not None:
            context.meta[_SIGNAL] = number


def exit_code(context: click.Context) -> int:
    """The exit code of a command that ended in good order: that of the signal that cut it short, or else 0."""
    return 128 + context.meta[_SIGNAL] if _SIGNAL in context.meta else 0


def answer(code: int) -> None:
    """Have the command end with an exit code that says what it found, unless a signal cut it short."""
    click.get_current_context().meta[_ANSWER] = code


def end_code(context: click.Context) -> int:
    """The exit code of a command that ended in good order: of the signal, or else of its answer."""
    return exit_code(context) or int(context.meta.get(_ANSWER, 0))
