"""The server under load: `python -m benchmarks.web_load`.

20 pages whose sliders move ten times a second, four jobs that never end, each of a page of its own (clouds of five
million poses and simulations of a minute, begun again and again), and beside them one hostile client with 40
connections: it asks for the designs that take longest to refuse, sends requests of a megabyte, connects and leaves as
fast as it can, and holds 100 half requests open. It comes from the address of the pages, then from another one, where
a second one beside it has the cookie of a browser.
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
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from urllib.parse import urlsplit

from benchmarks.web import PAGES, SECONDS, Page, many_pages, memory, percentile, served

CONNECTIONS, HALF = 40, 100
HERE, ELSEWHERE = "127.0.0.1", "127.0.0.2"  # both lead to this computer


def jobs(url: str, own: str) -> None:
    """Four jobs at a time, for ever."""
    home = [0.0, 0.0, 2.39, 0.0, 0.0, 0.0]
    box = {"low": [-0.1, -0.1, 2.3, -5, -5, -5], "high": [0.1, 0.1, 2.5, 5, 5, 5]}
    pages = [Page(url, own) for _ in range(4)]
    text = pages[0].start["presets"]["motion-base"]
    cloud = json.dumps({"design": text, "pose": home, "box": box, "points": 5_000_000}).encode()
    run = json.dumps({"design": text, "pose": home, "kind": "harmonic", "axis": "z", "duration": 60.0}).encode()
    asked = (("jobs/cloud", cloud), ("jobs/time", run)) * 2
    _crowd([partial(page.ask, "POST", *one) for page, one in zip(pages, asked, strict=True)])


def hostile(url: str, own: str, known: bool = False) -> None:
    """One client that means no good, for ever. known: it shows the cookie of a browser."""
    first = Page(url, own)
    text = first.start["presets"]["motion-base"]
    keys = json.dumps({"design": "\n".join(f"key{n} = 1" for n in range(240))}).encode()
    long = json.dumps({"design": "platform.mass = [" + "1," * 100_000 + "]"}).encode()
    wrong = json.dumps({"design": text, "changes": {f"legs.{n}": 1 for n in range(240)}}).encode()
    huge = b" " * (1 << 20)
    address = urlsplit(url)
    where = (address.hostname or "", address.port or 0)
    cookie = f"Cookie: {first.cookie}\r\n" if known else ""
    head = f"POST /api/design HTTP/1.1\r\nHost: {address.netloc}\r\n{cookie}Content-Length: %d\r\n"

    def send(body: bytes, stay: bool) -> None:
        with socket.create_connection(where, 30, (own, 0)) as page:
            page.sendall((head % len(body)).encode() + b"Connection: close\r\n\r\n" + body)
            while stay and page.recv(1 << 16):
                pass

    held = [socket.create_connection(where, 30, (own, 0)) for _ in range(HALF)]
    for one in held:
        one.sendall((head % 9).encode())
    acts = [*(partial(send, body, True) for body in (keys, long, wrong, huge)), partial(send, keys, False)]
    _crowd(acts * (CONNECTIONS // len(acts)))


def _crowd(acts: list[Callable[[], object]]) -> None:
    """Each act in a thread of its own, again and again."""

    def again(act: Callable[[], object]) -> None:
        while True:
            with contextlib.suppress(OSError):
                act()

    for act in acts[1:]:
        threading.Thread(target=again, args=(act,), daemon=True).start()
    again(acts[0])


@contextmanager
def beside(*acts: Callable[[], None]) -> Iterator[None]:
    """Processes that run as long as the block."""
    spawn = multiprocessing.get_context("spawn")
    processes = [spawn.Process(target=act, daemon=True) for act in acts]
    for process in processes:
        process.start()
    time.sleep(3 if acts else 0)
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


@contextmanager
def watched(pid: int) -> Iterator[list[float]]:
    """The memory of a server during the block, MB, taken every half second."""
    found: list[float] = []
    end = threading.Event()

    def watch() -> None:
        while not end.wait(0.5):
            found.append(memory(pid))

    thread = threading.Thread(target=watch)
    thread.start()
    try:
        yield found
    finally:
        end.set()
        thread.join()


def newcomers(url: str) -> list[str]:
    """How long pages take to be opened now, from each address."""
    found = []
    for own in (HERE, ELSEWHERE, "127.0.0.3"):
        began = time.perf_counter()
        try:
            Page(url, own)
            found.append(f"{1e3 * (time.perf_counter() - began):.0f} ms")
        except OSError:
            found.append("refused")
    return found


def main() -> None:
    with served() as (url, pid):
        pages = [Page(url, HERE) for _ in range(PAGES)]
        many_pages(pages)  # every process has started
        working = partial(jobs, url, HERE)
        for words, acts in (
            ("alone", ()),
            ("beside four jobs", (working,)),
            ("and a hostile client", (working, partial(hostile, url, HERE))),
            ("and one elsewhere", (working, partial(hostile, url, ELSEWHERE))),
            ("and two elsewhere", (working, *(partial(hostile, url, ELSEWHERE, known) for known in (False, True)))),
        ):
            with beside(*acts), watched(pid) as taken:
                answers = many_pages(pages)
                opened = newcomers(url)
            middle, slow = statistics.median(answers), percentile(answers, 0.95)
            print(
                f"{PAGES} pages {words}: {len(answers) / SECONDS:.0f} answers/s, median {middle:.0f} ms, "
                f"p95 {slow:.0f} ms, worst {max(answers):.0f} ms; at most {max(taken):.0f} MB; new pages open in "
                f"{', '.join(opened)} (from three addresses); load average {os.getloadavg()[0]:.1f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
