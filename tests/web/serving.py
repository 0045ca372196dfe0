"""A server in this process, on a free port."""

import asyncio
import json
import socket
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, NamedTuple

from flexapod.web import serving
from flexapod.web.app import application


class Served(NamedTuple):
    """A running server, its application and its port."""

    app: Any
    server: Any
    port: int

    def ask(self, kind: str, asked: dict[str, Any], timeout: float = 60.0) -> tuple[int, Any]:
        """Status and answer of a question."""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}/api/{kind}", json.dumps(asked).encode())
        try:
            with urllib.request.urlopen(request, timeout=timeout) as answer:
                return answer.status, json.load(answer)
        except urllib.error.HTTPError as error:
            return error.code, json.load(error)


@contextmanager
def running() -> Iterator[Served]:
    app = application()
    door = serving.Door(socket.AF_INET, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    door.bind(("127.0.0.1", 0))
    server = serving.server(app)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [door]})
    thread.start()
    while not server.started:
        time.sleep(0.02)
    try:
        yield Served(app, server, door.getsockname()[1])
    finally:
        server.should_exit = True
        thread.join(timeout=20)


def apart(task: Coroutine[Any, Any, Any]) -> Any:
    """What a coroutine returns, run in a thread of its own: the browser's tests leave a loop running in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, task).result()
