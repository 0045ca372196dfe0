"""A server in this process, on a free port."""

import json
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from flexapod.web import serving
from flexapod.web.app import application


class Served(NamedTuple):
    """A running server, its application and its port."""

    app: Any
    server: Any
    port: int

    def ask(self, kind: str, asked: dict[str, Any]) -> tuple[int, Any]:
        """Status and answer of a question."""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}/api/{kind}", json.dumps(asked).encode())
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, json.load(answer)
        except urllib.error.HTTPError as error:
            return error.code, json.load(error)


@contextmanager
def running() -> Iterator[Served]:
    app = application()
    server = serving.server(app, port=0)
    thread = threading.Thread(target=server.run)
    thread.start()
    while not server.started:
        time.sleep(0.02)
    yield Served(app, server, server.servers[0].sockets[0].getsockname()[1])
    server.should_exit = True
    thread.join(timeout=20)


def until(met: Any, seconds: float = 10.0) -> bool:
    """Whether a condition is met within some seconds."""
    end = time.monotonic() + seconds
    while not met():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True
