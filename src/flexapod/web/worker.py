"""The process of jobs: it runs one job after another, each a generator of messages."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from typing import Any

from flexapod.errors import FlexapodError
from flexapod.web import simulation, workspace
from flexapod.web.answers import Message

KINDS: dict[str, Callable[[dict[str, Any]], Iterator[Message]]] = {
    "cloud": workspace.cloud,
    "slice": workspace.slice_map,
    "worst": workspace.worst,
    "time": simulation.simulation,
}


def serve(pipe: Connection) -> None:
    """Run jobs from the pipe until it closes. A job that fails sends its error, and the process goes on."""
    while True:
        try:
            kind, spec = pipe.recv()
            for message in _messages(kind, spec):
                pipe.send(message)
        except (EOFError, BrokenPipeError, ConnectionResetError):
            return


def _messages(kind: str, spec: dict[str, Any]) -> Iterator[Message]:
    """The messages of one job, and how it ended."""
    try:
        yield from KINDS[kind](spec)
        yield {"type": "done"}, b""
    except FlexapodError as error:
        yield {"type": "failed", "error": str(error)}, b""
    except Exception as error:  # a defect of the program: traced on the server's terminal
        traceback.print_exc()
        yield {"type": "failed", "error": f"internal error ({type(error).__name__}); see the server"}, b""
