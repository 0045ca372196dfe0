"""How clients share places, bytes and connections, and who counts as a client."""

import asyncio
import contextlib
import socket
from typing import Any

import pytest

pytest.importorskip("starlette")

from starlette.requests import HTTPConnection
from tests.helpers.waiting import until
from tests.web.serving import Served, apart, running

from flexapod.web import clients as web_clients
from flexapod.web import limits
from flexapod.web.clients import Allowance, Client, Clients, network
from flexapod.web.turns import Share, Turns

GREEDY, BROWSER, OTHER = Client("10.0.0.1"), Client("10.0.0.1", "browser"), Client("10.0.0.2")


async def order(turns: Turns, *waiting: Client) -> list[Client]:
    """The order in which clients that all wait have their turns. The first comes first and works until all wait."""
    found: list[Client] = []
    there = asyncio.Event()

    async def work(client: Client) -> None:
        async with turns.turn(client):
            found.append(client)
            await there.wait()

    tasks = []
    for client in waiting:
        tasks.append(asyncio.create_task(work(client)))
        await asyncio.sleep(0)
    there.set()
    await asyncio.gather(*tasks)
    return found


def test_who_waited_longest_for_a_turn_goes_first() -> None:
    """Not who asked most: of 50 questions of one client, one goes before each of the others."""
    found = apart(order(Turns(1), *[GREEDY] * 50, OTHER, OTHER, BROWSER))
    assert found[:4] == [GREEDY, OTHER, BROWSER, OTHER]
    assert found[4:] == [GREEDY] * 49


def test_an_address_has_its_turn_however_many_clients_it_has() -> None:
    many = [Client("10.0.0.1", f"browser {n}") for n in range(30)]
    found = apart(order(Turns(1), *many, OTHER, OTHER))
    assert [found.index(OTHER), len(found) - 1 - found[::-1].index(OTHER)] == [1, 3]


def test_a_client_cannot_have_all_places() -> None:
    async def working() -> list[int]:
        turns, counts = Turns(4), []
        async with contextlib.AsyncExitStack() as stack:
            for client in (GREEDY, BROWSER, OTHER):
                places = 0
                while not turns.waits(client):
                    await stack.enter_async_context(turns.turn(client))
                    places += 1
                counts.append(places)
            assert turns.waits(GREEDY)
        assert not turns.waits(GREEDY), "all were given back"
        return counts

    assert apart(working()) == [2, 1, 1]


def test_short_work_may_have_all_places_while_nobody_waits() -> None:
    assert apart(order(Turns(2, alone=True), GREEDY, GREEDY, GREEDY, OTHER)) == [GREEDY, GREEDY, OTHER, GREEDY]


def test_who_leaves_while_waiting_takes_no_place() -> None:
    async def leaving() -> None:
        turns = Turns(1)
        async with turns.turn(GREEDY):
            others = [asyncio.create_task(order(turns, client)) for client in (OTHER, BROWSER)]
            await asyncio.sleep(0.01)
            for one in others:
                one.cancel()
            found = await asyncio.gather(*others, return_exceptions=True)
            assert all(isinstance(one, asyncio.CancelledError) for one in found)
        assert not turns.waits(OTHER)

    apart(leaving())


def test_a_share_leaves_as_much_to_the_others() -> None:
    share = Share(100)
    assert share.take(GREEDY, 50)
    assert not share.take(GREEDY)
    assert share.take(OTHER, 25)
    assert not share.take(OTHER, 1)
    share.give_back(GREEDY, 50)
    assert share.take(OTHER, 25)
    with share.held(BROWSER, 51) as allowed:
        assert not allowed
    assert share.free == 50


def test_what_was_taken_comes_back_with_time(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(web_clients, "monotonic", lambda: now[0])
    allowance = Allowance(10, 2)
    assert [allowance.take("a") for _ in range(12)] == [True] * 10 + [False] * 2
    assert allowance.take("b"), "each has its own"
    assert allowance.owed("a", 5) == 2.5
    now[0] = 3.0
    assert allowance.take("a")
    now[0] = 1000.0
    assert [allowance.take("a") for _ in range(12)].count(True) == 10


def test_what_is_known_of_clients_is_bounded() -> None:
    allowance, turns = Allowance(1, 1), Turns(1)
    for n in range(2 * web_clients.REMEMBERED):
        allowance.take(str(n))
    assert len(allowance._left) == web_clients.REMEMBERED
    many = [Client(str(n)) for n in range(2 * web_clients.REMEMBERED)]
    apart(order(turns, *many[:1]))
    for client in many:
        turns._note(client)
    assert len(turns._latest) == 2 * web_clients.REMEMBERED
    assert not turns._share._held


@pytest.mark.parametrize(
    ("host", "found"),
    [
        ("127.0.0.1", "127.0.0.1"), ("::ffff:10.0.0.7", "10.0.0.7"), ("2001:db8:1:2:3::4", "2001:db8:1:2::/64"),
        ("fe80::1%eth0", "fe80::/64"), ("testclient", "testclient"), ("", ""),
    ],
)  # fmt: skip
def test_a_network_of_ipv6_is_one_address(host: str, found: str) -> None:
    assert network(host) == found


def asking(cookie: str = "", host: str = "10.0.0.1") -> HTTPConnection:
    headers = [(b"cookie", cookie.encode("latin-1"))]
    return HTTPConnection({"type": "http", "headers": headers, "client": (host, 1)})


def test_a_browser_is_known_by_a_cookie_that_nobody_can_make_up() -> None:
    known, others = Clients(), Clients()
    stranger = known.who(asking())
    assert stranger == Client("10.0.0.1")
    cookie = known.cookie(stranger)["set-cookie"]
    assert {"HttpOnly", "SameSite=Strict"} <= set(cookie.split("; "))
    pair = cookie.split(";")[0]
    client = known.who(asking(pair))
    assert client.name
    assert known.cookie(client) == {}, "it has one"
    assert others.who(asking(pair)) == stranger, "another server does not know it"
    name, value = pair.split("=")
    for wrong in (f"{name}={value}0", f"{name}=x{value}", f"{name}=.", f"{name}=", name, f"{name}=\xe4.\xe4", "\0"):
        assert known.who(asking(wrong)) == stranger
    second = known.cookie(stranger)["set-cookie"].split(";")[0]
    assert known.who(asking(second)) not in (client, stranger)


def test_an_address_gets_few_cookies() -> None:
    known = Clients()
    given = [known.cookie(Client("10.0.0.1")) for _ in range(2 * limits.NEW_CLIENTS)]
    assert sum(map(bool, given)) == limits.NEW_CLIENTS
    assert known.cookie(Client("10.0.0.2"))


def greet(served: Served, own: str = "127.0.0.1", what: bytes = b"GET /icon.svg") -> bytes:
    with socket.create_connection(("127.0.0.1", served.port), 20, (own, 0)) as page:
        page.sendall(what + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
        return page.recv(12)


def test_who_connects_too_fast_is_refused_and_others_are_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "NEW_CONNECTIONS", 5)
    monkeypatch.setattr(limits, "NEW_CONNECTIONS_A_SECOND", 1e-3)
    with running() as served:
        assert [greet(served) for _ in range(5)] == [b"HTTP/1.1 200"] * 5
        with pytest.raises(ConnectionError):
            greet(served)
        assert greet(served, "127.0.0.2") == b"HTTP/1.1 200"


def test_an_address_cannot_have_all_connections(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that never asked are closed first, and never one of another address."""
    monkeypatch.setattr(limits, "CONNECTIONS", 8)
    monkeypatch.setattr(limits, "HEAD_SECONDS", 100.0)
    with running() as served, contextlib.ExitStack() as stack:

        def connect(own: str) -> socket.socket:
            return stack.enter_context(socket.create_connection(("127.0.0.1", served.port), 20, (own, 0)))

        def asks(page: socket.socket) -> bool:
            page.sendall(b"HEAD /icon.svg HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            return page.recv(4096).startswith(b"HTTP/1.1 200")

        first, other = connect("127.0.0.1"), connect("127.0.0.2")
        assert asks(first)
        assert asks(other)
        held = [connect("127.0.0.1") for _ in range(30)]
        assert until(lambda: len(served.server.server_state.connections) == 5)  # four, and the other's
        assert asks(first)
        assert asks(other)
        assert asks(held[-1])
        assert held[0].recv(1) == b""


def test_requests_that_come_too_fast_wait_and_then_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    waits: list[float] = []

    async def sleep(seconds: float) -> None:
        waits.append(seconds)

    monkeypatch.setattr(limits, "REQUESTS", 3)
    monkeypatch.setattr(limits, "REQUESTS_A_SECOND", 0.5)
    monkeypatch.setattr(limits, "OPENINGS", 0)
    monkeypatch.setattr(web_clients, "monotonic", lambda: 1.0)
    with running() as served:
        monkeypatch.setattr("flexapod.web.security.anyio.sleep", sleep)
        found = [greet(served) for _ in range(6)]
    assert found == [b"HTTP/1.1 200"] * 4 + [b"HTTP/1.1 429"] * 2
    assert waits == [0, 0, 0, 2]


def test_a_new_page_does_not_wait_behind_a_script_of_its_address(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "REQUESTS", 1)
    monkeypatch.setattr(limits, "REQUESTS_A_SECOND", 1e-3)
    monkeypatch.setattr(limits, "OPENINGS", 2)
    monkeypatch.setattr(limits, "OPENINGS_A_SECOND", 1e-3)
    with running() as served:
        script = [greet(served, what=b"DELETE /api/jobs/none") for _ in range(3)]
        assert script == [b"HTTP/1.1 404", b"HTTP/1.1 429", b"HTTP/1.1 429"]
        assert [greet(served) for _ in range(3)] == [b"HTTP/1.1 200"] * 2 + [b"HTTP/1.1 429"]


def test_long_bodies_come_at_a_pace(monkeypatch: pytest.MonkeyPatch) -> None:
    from starlette.requests import Request

    from flexapod.web.requests import Bodies

    waits: list[float] = []

    async def sleep(seconds: float) -> None:
        waits.append(seconds)

    async def read(bodies: Bodies, client: Client, parts: list[int]) -> int:
        sent = iter(parts)

        async def receive() -> dict[str, Any]:
            size = next(sent, None)
            return {"type": "http.request", "body": b" " * (size or 0), "more_body": size is not None}

        request = Request({"type": "http", "method": "POST", "headers": []}, receive)
        return len(await bodies.read(request, client, limits.JOB_BYTES))

    monkeypatch.setattr("flexapod.web.requests.anyio.sleep", sleep)
    monkeypatch.setattr(web_clients, "monotonic", lambda: 1.0)
    bodies = Bodies()
    for _ in range(600):
        assert apart(read(bodies, GREEDY, [limits.SMALL_BYTES])) == limits.SMALL_BYTES
    assert waits == [], "short ones do not wait"
    assert apart(read(bodies, GREEDY, [limits.LONG_BYTES // 4] * 2)) == limits.LONG_BYTES // 2
    assert apart(read(bodies, GREEDY, [limits.LONG_BYTES // 4] * 2)) == limits.LONG_BYTES // 2
    assert max(waits) == 0.0
    assert apart(read(bodies, GREEDY, [limits.LONG_BYTES_A_SECOND] * 2)) == 2 * limits.LONG_BYTES_A_SECOND
    assert waits[-1] == 2.0
    apart(read(bodies, OTHER, [limits.LONG_BYTES // 4] * 2))
    assert waits[-1] == 0.0
