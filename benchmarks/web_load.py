"""The server under load: `python -m benchmarks.web_load`.

20 pages whose sliders move ten times a second, four jobs that never end (clouds of five million poses and simulations
of a minute, begun again and again), and beside them one hostile client with 40 connections: it asks for the designs
that take longest to refuse, sends requests of a megabyte, leaves in the middle, and holds 100 half requests open.
"""

from __future__ import annotations

import contextlib
import json
import multiprocessing
import os
import socket
import statistics
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from functools import partial
from urllib.parse import urlsplit

from benchmarks.web import PAGES, SECONDS, many_pages, memory, percentile, served

CONNECTIONS, HALF = 40, 100


def post(url: str, path: str, body: bytes) -> None:
    """Ask, and read the answer to its end, whatever it is."""
    with contextlib.suppress(urllib.error.HTTPError, ConnectionError, TimeoutError):
        request = urllib.request.Request(f"{url}api/{path}", body, {"content-type": "application/json"})
        with urllib.request.urlopen(request, timeout=30) as answer:
            while answer.read(1 << 16):
                pass


def jobs(url: str, text: str) -> None:
    """Four jobs at a time, for ever."""
    home = [0.0, 0.0, 2.39, 0.0, 0.0, 0.0]
    box = {"low": [-0.1, -0.1, 2.3, -5, -5, -5], "high": [0.1, 0.1, 2.5, 5, 5, 5]}
    cloud = json.dumps({"design": text, "pose": home, "box": box, "points": 5_000_000}).encode()
    run = json.dumps({"design": text, "pose": home, "kind": "harmonic", "axis": "z", "duration": 60.0}).encode()
    _crowd([partial(post, url, kind, body) for kind, body in (("jobs/cloud", cloud), ("jobs/time", run)) * 2])


def hostile(url: str, text: str) -> None:
    """One client that means no good, for ever."""
    keys = json.dumps({"design": "\n".join(f"key{n} = 1" for n in range(240))}).encode()
    long = json.dumps({"design": "platform.mass = [" + "1," * 100_000 + "]"}).encode()
    wrong = json.dumps({"design": text, "changes": {f"legs.{n}": 1 for n in range(240)}}).encode()
    huge = b" " * (1 << 20)
    address = urlsplit(url)
    where = (address.hostname or "", address.port or 0)
    head = f"POST /api/state HTTP/1.1\r\nHost: {address.netloc}\r\nContent-Length: 9\r\n".encode()

    def leave() -> None:
        with socket.create_connection(where) as page:
            page.sendall(head.replace(b": 9", b": %d" % len(keys)) + b"\r\n" + keys)

    held = [socket.create_connection(where) for _ in range(HALF)]
    for one in held:
        one.sendall(head)
    bodies = [keys, long, wrong, huge]
    asks = [partial(post, url, "design", body) for body in bodies]
    _crowd([*asks, leave] * (CONNECTIONS // 5))


def _crowd(acts: list[Callable[[], None]]) -> None:
    """Each act in a thread of its own, again and again."""

    def again(act: Callable[[], None]) -> None:
        while True:
            with contextlib.suppress(OSError):
                act()

    for act in acts[1:]:
        threading.Thread(target=again, args=(act,), daemon=True).start()
    again(acts[0])


def main() -> None:
    spawn = multiprocessing.get_context("spawn")
    with served() as (url, pid):
        text = json.load(urllib.request.urlopen(f"{url}api/start"))["presets"]["motion-base"]
        many_pages(url)  # every process has started
        beside: list[multiprocessing.process.BaseProcess] = []
        for words, act in (("alone", None), ("beside four jobs", jobs), ("and a hostile client", hostile)):
            if act:
                beside.append(spawn.Process(target=act, args=(url, text), daemon=True))
                beside[-1].start()
                time.sleep(3)
            answers = many_pages(url)
            middle, slow = statistics.median(answers), percentile(answers, 0.95)
            print(
                f"{PAGES} pages {words}: {len(answers) / SECONDS:.0f} answers/s, median {middle:.0f} ms, "
                f"p95 {slow:.0f} ms, worst {max(answers):.0f} ms; {memory(pid):.0f} MB; "
                f"load average {os.getloadavg()[0]:.1f}",
                flush=True,
            )
        for process in beside:
            process.terminate()


if __name__ == "__main__":
    main()
