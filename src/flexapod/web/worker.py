"""What a process of the server does: one question or job after another. A job is a generator of messages."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from flexapod.errors import FlexapodError
from flexapod.web import description, designs, limits, requests, response, simulation, state, workspace
from flexapod.web.answers import Message, Refusal
from flexapod.web.design_errors import InvalidDesign
from flexapod.web.encode import as_json


def _state(asked: dict[str, Any]) -> Mapping[str, Any]:
    question = requests.question(asked)
    return state.snapshot(question.hexapod, question.six, question.joint)


KINDS: dict[str, Callable[[dict[str, Any]], Iterator[Message]]] = {
    "cloud": workspace.cloud,
    "slice": workspace.slice_map,
    "worst": workspace.worst,
    "time": simulation.simulation,
}
QUESTIONS: dict[str, Callable[[dict[str, Any]], Mapping[str, Any]]] = {
    "design": lambda asked: description.described(requests.source(asked)),
    "state": _state,
    "response": response.response,
    "shake": response.shake,
}


def serve(pipe: Connection) -> None:
    """Answer what comes from the pipe until it closes. What fails sends its error, and the process goes on.

    Numbers of a request that are too large to compute with show in the answer, not on the server's terminal.
    """
    with np.errstate(all="ignore"), suppress(EOFError, BrokenPipeError, ConnectionResetError):
        while True:
            kind, body = pipe.recv()
            for message in _messages(kind, body) if kind in KINDS else (_answer(kind, body),):
                pipe.send(message)


def _messages(kind: str, body: bytes) -> Iterator[tuple[Any, bytes]]:
    """The messages of one job, and how it ended."""
    try:
        yield from KINDS[kind](requests.parsed(body))
        yield {"type": "done"}, b""
    except Exception as error:
        yield {"type": "failed", "error": _refused(error)[1]}, b""


def _answer(kind: str, body: bytes) -> tuple[Any, bytes]:
    """The answer to a question as JSON text, with its status and how long it took, s."""
    began, status = time.perf_counter(), 200
    try:
        content = as_json(QUESTIONS[kind](requests.parsed(body)))
    except Exception as error:
        status, words = _refused(error)
        refusal: Refusal = {"error": words, "fields": error.errors if isinstance(error, InvalidDesign) else []}
        content = as_json(refusal)
    return {"status": status, "seconds": time.perf_counter() - began}, content


def _refused(error: Exception) -> tuple[int, str]:
    """The status of an error and its words. A defect of the program is traced on the server's terminal."""
    if isinstance(error, FlexapodError):
        return (error.status if isinstance(error, requests.RequestError) else 422), str(error)
    if isinstance(error, MemoryError):
        for cache in (designs.built, designs.original, requests.pose_of):
            cache.cache_clear()
        return 422, f"this takes more than {limits.MEMORY // limits.MIB} MiB of memory (MemoryError); ask for less"
    if isinstance(error, OverflowError | FloatingPointError | np.linalg.LinAlgError):
        return 400, f"numbers of this request are too large, too small or too far apart to compute with ({error})"
    traceback.print_exception(error)
    return 500, f"internal error ({type(error).__name__}); see the server"
