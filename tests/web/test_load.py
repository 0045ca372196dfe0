"""Pages, jobs and a hostile client at once: whose turn it is, and what memory it takes. Counted, not timed."""

import http.client
import json
import threading
from collections import Counter
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from typing import Any

import psutil
import pytest

pytest.importorskip("starlette")

from tests.helpers.waiting import until
from tests.web.asked import ASKED, LONG, TEXT
from tests.web.serving import Served, running

from flexapod.web import forks, limits
from flexapod.web.clients import Client
from flexapod.web.turns import Turns

PAGES, MOVES, CONNECTIONS = 20, 2, 24
#: Of a process that answers questions, beside what it shares; measured: 13 MB of a fork, 115 MB of one started anew.
OWN = (48 if forks.FORKS else 128) * limits.MIB


class Page:
    """A page as a browser holds it: one connection, and the cookie of its first answer."""

    def __init__(self, port: int) -> None:
        self.server = http.client.HTTPConnection("127.0.0.1", port, timeout=120)
        self.server.request("GET", "/api/start")
        answer = self.server.getresponse()
        self.head = {"cookie": answer.headers["set-cookie"].split(";")[0]}
        answer.read()

    def begin(self, kind: str, asked: dict[str, Any]) -> http.client.HTTPResponse:
        self.server.request("POST", f"/api/{kind}", json.dumps(asked).encode(), self.head)
        return self.server.getresponse()

    def ask(self, kind: str, asked: dict[str, Any]) -> int:
        """The status of the answer."""
        answer = self.begin(kind, asked)
        answer.read()
        return answer.status


class Log:
    """How many turns strangers, who have no cookie, got while each page waited for one of its own."""

    def __init__(self) -> None:
        self.strangers: Counter[Turns] = Counter()
        self.passed: list[int] = []

    def record(self, monkeypatch: pytest.MonkeyPatch) -> None:
        turn = Turns.turn

        @asynccontextmanager
        async def logged(turns: Turns, client: Client) -> AsyncIterator[None]:
            before = self.strangers[turns]
            async with turn(turns, client):
                if client.name:
                    self.passed.append(self.strangers[turns] - before)
                else:
                    self.strangers[turns] += 1
                yield

        monkeypatch.setattr(Turns, "turn", logged)


@contextmanager
def hostile(served: Served) -> Iterator[None]:
    """One client without a cookie: questions that are quick, and designs that take long to refuse, without rest."""
    end = threading.Event()
    bodies = [
        ASKED,
        {"design": "\n".join(f"key{n} = 1" for n in range(240))},
        {"design": TEXT, "changes": {f"legs.{n}": 1 for n in range(240)}},
        {"design": "platform.mass = [" + "1," * 20_000 + "]"},
    ]

    def again(asked: dict[str, Any]) -> None:
        while not end.is_set():
            with suppress(OSError):
                served.ask("state", asked, 5.0)

    crowd = [threading.Thread(target=again, args=(bodies[n % len(bodies)],)) for n in range(CONNECTIONS)]
    for thread in crowd:
        thread.start()
    try:
        yield
    finally:
        end.set()
        for thread in crowd:
            thread.join(timeout=120)


def together(acts: list[Callable[[], None]]) -> None:
    threads = [threading.Thread(target=act) for act in acts]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=300)
        assert not thread.is_alive()


def own_memory(process: psutil.Process) -> int:
    """Bytes that it shares with no other."""
    return int(process.memory_full_info().uss)


def test_pages_have_their_turns_beside_jobs_and_a_hostile_client(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between a page's question and its turn the hostile client has one, and not one for each of its connections."""
    monkeypatch.setattr(limits, "IDLE_SECONDS", 1000)  # on a slow machine too
    log, statuses = Log(), Counter[int]()
    log.record(monkeypatch)
    with running() as served:
        pages, workers = ([Page(served.port) for _ in range(count)] for count in (PAGES, 4))
        together([lambda page=page: page.ask("state", ASKED) for page in pages])  # type: ignore[misc]
        jobs = [page.begin("jobs/time", LONG) for page in workers]
        log.passed.clear()

        def use(page: Page, number: int) -> None:
            for move in range(MOVES):
                pose = [0.001 * number, 0.001 * move, 0.086, 0.0, 0.0, 0.0]
                statuses[page.ask("state", ASKED | {"pose": pose})] += 1

        with hostile(served):
            assert until(lambda: sum(log.strangers.values()) > 5, 120), "it is at work"
            together([lambda page=page, n=n: use(page, n) for n, page in enumerate(pages)])  # type: ignore[misc]
        asked = served.app.state.questions
        kept = [asked.quick.pool, asked.careful.pool]
        assert until(lambda: bool(kept[0].idle), 60)  # no more than one may have been ended, if its client had left
        owned = [own_memory(psutil.Process(process.process.pid)) for pool in kept for process in pool.idle]
        assert len(served.app.state.jobs.running()) == 4
        assert statuses == {200: PAGES * MOVES}
        assert PAGES * MOVES <= len(log.passed) <= PAGES * MOVES + len(jobs)  # whose turns may come later
        assert max(log.passed) <= 2
        assert max(owned) < OWN
        for job in jobs:
            job.close()
        for page in (*pages, *workers):
            page.server.close()
        assert until(lambda: not served.app.state.jobs.running())
