"""Who is let in, and what a request may take: hosts, tokens, sizes, times and memory."""

import contextlib
import json
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

import pytest
from click.testing import CliRunner
from tests.web.asked import ASKED, TEXT

from flexapod.cli import group

pytest.importorskip("starlette")
from starlette.testclient import TestClient
from tests.helpers.waiting import until
from tests.web.serving import Served, running

from flexapod.web import limits
from flexapod.web.app import application
from flexapod.web.security import HEADERS

TOKEN = "a-token-of-tests"


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    with TestClient(application(), base_url="http://127.0.0.1:8765") as client:
        yield client


@pytest.fixture(scope="module")
def others() -> Iterator[TestClient]:
    """Of a server that other computers can reach, as one of them."""
    app = application(hosts=["bench"], token=TOKEN)
    with TestClient(app, base_url="http://192.168.1.5:8765", follow_redirects=False) as client:
        yield client


@pytest.fixture
def served() -> Iterator[Served]:
    with running() as found:
        yield found


@pytest.mark.parametrize(
    "host",
    [
        "evil.com@127.0.0.1", "127.0.0.1/x", "127.0.0.1?x", "127.0.0.1#@evil.com", "127.0.0.1:8765:1", "127.0.0.1:", "::1",
        "127.0.0.1, evil.com", "localhost.", "[::1", "[::1]x", "127.0.0.1:123456", "127.0.0.1 ", "192.168.1.5", "0.0.0.0",
    ],
)  # fmt: skip
def test_a_host_is_compared_whole(host: str, client: TestClient) -> None:
    assert client.get("/api/start", headers={"host": host}).status_code == 421


@pytest.mark.parametrize("origin", ["http://127.0.0.1:8765/", "http://u@127.0.0.1:8765", "ftp://127.0.0.1:8765", ""])
def test_an_origin_is_compared_whole(origin: str, client: TestClient) -> None:
    assert client.post("/api/state", json=ASKED, headers={"origin": origin}).status_code == 403


def test_a_token_opens_the_page_and_its_cookie_all_that_follows(others: TestClient) -> None:
    others.cookies.clear()
    for path in ("/", "/api/start", "/icon.svg", "/?token=", "/?token=wrong", f"/?token={TOKEN}x"):
        assert others.get(path).status_code == 401
    assert others.post(f"/api/state?token={TOKEN}", json=ASKED).status_code == 401, "only a page is opened by it"
    opened = others.get(f"/?token={TOKEN}")
    assert opened.status_code == 303
    assert opened.headers["location"] == "/", "it does not stay in the address"
    assert {"HttpOnly", "SameSite=Lax"} <= set(re.split("; ", opened.headers["set-cookie"]))
    assert TOKEN not in opened.headers["set-cookie"]
    for path in ("/", "/api/start", "/icon.svg"):
        assert others.get(path).status_code == 200
    assert others.post("/api/state", json=ASKED).status_code == 200
    assert others.post("/api/state", json=ASKED, headers={"origin": "http://evil.example"}).status_code == 403


def test_a_token_leads_to_no_other_site(others: TestClient) -> None:
    others.cookies.clear()
    for path in ("//evil.example", "/%2Fevil.example", "/%5Cevil.example"):
        assert others.get(f"http://192.168.1.5:8765{path}?token={TOKEN}").status_code == 401


def test_a_script_sends_the_token_as_a_header(others: TestClient) -> None:
    others.cookies.clear()
    for words, status in ((f"Bearer {TOKEN}", 200), ("Bearer x", 401), (TOKEN, 401), ("Bearer None", 401)):
        assert others.post("/api/state", json=ASKED, headers={"authorization": words}).status_code == status
    assert others.get("/", headers={"cookie": "flexapod=1; \xe4; flexapod-=".encode("latin-1")}).status_code == 401


@pytest.mark.parametrize(("host", "status"), [("bench:1", 401), ("10.0.0.1", 401), ("[fe80::1]:80", 401), ("evil.example", 421)])  # fmt: skip
def test_names_can_be_rebound_and_numbers_cannot(host: str, status: int, others: TestClient) -> None:
    others.cookies.clear()
    assert others.get("/", headers={"host": host}).status_code == status


def test_an_empty_host_is_refused() -> None:
    for host in ("", " "):
        found = CliRunner().invoke(group, ["serve", "--host", host, "--port", "0"])
        assert found.exit_code == 2
        assert "every address" in found.output


@pytest.mark.parametrize(
    ("host", "guarded"), [("0.0.0.0", True), ("::", True), ("0", True), ("127.0.0.1", False), ("localhost", False)]
)
def test_where_others_can_reach_it_the_address_has_a_token(
    host: str, guarded: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    import uvicorn

    if host == "::" and not socket.has_ipv6:
        pytest.skip("no IPv6 here")
    served = []

    def run(self: uvicorn.Server, sockets: list[socket.socket]) -> None:
        served.append(self.config.app)
        sockets[0].close()

    monkeypatch.setattr(uvicorn.Server, "run", run)
    found = CliRunner().invoke(group, ["serve", "--host", host, "--port", "0", "--json"])
    if host == "::" and "cannot listen" in found.output:
        pytest.skip("no IPv6 here")
    assert found.exit_code == 0, found.output
    url = json.loads(found.stdout)["url"]
    assert ("?token=" in url) == ("Note: other computers can reach it" in found.stderr) == guarded
    with TestClient(served[0], base_url=url.split("?")[0]) as client:
        assert client.get(url).status_code == 200
        client.cookies.clear()
        assert client.get("/").status_code == (401 if guarded else 200)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (json.dumps(ASKED | {"pose": [10**400, 0, 0, 0, 0, 0]}), "integer of 401 digits"),
        (json.dumps(ASKED | {"loss_factor": 10**400}), "integer of 401 digits"),
        (json.dumps(ASKED | {"changes": {"platform.mass": -(10**400)}}), "integer of 402 digits"),
        (json.dumps(ASKED | {"changes": {"platform.mass_center": [0, 0, 1e99]}}), "too far apart"),
        (json.dumps(ASKED | {"changes": {"platform.mass": json.loads("[" * 13 + "]" * 13)}}), "12 deep"),
        ("[" * 100_000, "not JSON"),
        ('{"design": "' + "x" * 40_000, "not JSON"),
        (b"\xff\xfe{", "not JSON"),
    ],
)  # fmt: skip
def test_numbers_and_texts_beyond_all_measure_are_refused_in_words(
    body: str | bytes, words: str, client: TestClient
) -> None:
    for question in ("state", "response"):
        answer = client.post(f"/api/{question}", content=body)
        assert (answer.status_code, words in answer.json()["error"]) == (400, True), answer.text
        assert HEADERS.items() <= dict(answer.headers).items()


def test_a_fault_of_ours_has_the_headers_too(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def broken(start: Any) -> Any:
        raise ZeroDivisionError("of ours")

    monkeypatch.setattr("flexapod.web.app._start", broken)
    with TestClient(application(), base_url="http://127.0.0.1:8765") as client:
        answer = client.get("/api/start")
    assert (answer.status_code, answer.json()["error"]) == (500, "internal error; see the server")
    assert HEADERS.items() <= dict(answer.headers).items()
    assert "ZeroDivisionError: of ours" in capfd.readouterr().err


def test_errors_of_a_design_are_cut_at_twenty(client: TestClient) -> None:
    for asked in ({"design": "\n".join(f"k{n} = 1" for n in range(200))},
                  {"design": TEXT, "changes": {f"k{n}": 1 for n in range(200)}}):  # fmt: skip
        fields = client.post("/api/design", json=asked).json()["fields"]
        assert len(fields) == 21
        assert fields[-1]["message"] == "There are 180 errors more."


def test_long_questions_and_longer_jobs_are_refused(client: TestClient) -> None:
    for path, most in (("/api/state", limits.QUESTION_BYTES), ("/api/jobs/time", limits.JOB_BYTES)):
        answer = client.post(path, content=iter([b" " * (most // 2)] * 3))
        assert answer.status_code == 413
        assert str(most) in answer.json()["error"]


def test_what_takes_too_long_is_stopped(monkeypatch: pytest.MonkeyPatch, client: TestClient) -> None:
    monkeypatch.setattr(limits, "ANSWER_SECONDS", 0.0)
    monkeypatch.setattr(limits, "JOB_SECONDS", -1.0)
    answer = client.post("/api/state", json=ASKED)
    assert (answer.status_code, "was stopped after" in answer.json()["error"]) == (503, True)
    assert b"stopped after" in client.post("/api/jobs/time", json=ASKED).content
    monkeypatch.undo()
    assert client.post("/api/state", json=ASKED).status_code == 200


@pytest.mark.parametrize(("limit", "value"), [("WAITING", 0), ("BODIES_BYTES", 10)])
def test_too_many_who_wait_are_told(limit: str, value: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, limit, value)
    with TestClient(application(), base_url="http://127.0.0.1:8765") as client:
        assert client.post("/api/state", json=ASKED).status_code == 503
        job = client.post("/api/jobs/time", json=ASKED)
    assert b"too many jobs wait" in job.content if limit == "WAITING" else job.status_code == 503


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux enforces such a limit")
def test_memory_has_an_end() -> None:
    script = (
        "from flexapod.web import worker, process\n"
        "process.limit_memory(100 * 2**20)\n"
        "import numpy as np\n"
        "def greedy(asked): return {'a': np.ones(10**9 // 8)}\n"
        "worker.QUESTIONS['state'] = greedy\n"
        "head, content = worker._answer('state', b'{}')\n"
        "assert np.ones(10**6).size == 10**6\n"
        "print(head['status'], content)\n"
    )
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    assert found.startswith("422")
    assert "MiB of memory" in found


def test_half_requests_are_closed(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "HEAD_SECONDS", 0.3)
    monkeypatch.setattr(limits, "BODY_SECONDS", 0.3)
    head = f"POST /api/state HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n"
    whole = f"GET /icon.svg HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n"
    for begun, answer in (("", b""), (head, b""), (head + "Content-Length: 9\r\n\r\n{", b" 408 ")):
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as page:
            page.sendall(begun.encode())
            assert answer in page.recv(4096)
    monkeypatch.setattr(limits, "HEAD_SECONDS", 1.0)  # in which the first request comes, on a slow machine too
    for early in (head, ""):  # on a connection that was used before, begun with the answer or after it
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as page:
            page.sendall((whole + early).encode())
            assert b"200 OK" in page.recv(65536)
            if not early:
                assert until(lambda: all(one.idle() for one in served.server.server_state.connections))
                page.sendall(head.encode())
            while page.recv(65536):
                pass


def test_of_too_many_connections_the_oldest_idle_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "CONNECTIONS", 5)
    monkeypatch.setattr(limits, "HEAD_SECONDS", 100.0)
    with running() as served, contextlib.ExitStack() as stack:
        held = [stack.enter_context(socket.create_connection(("127.0.0.1", served.port), timeout=20)) for _ in range(8)]
        assert served.ask("state", ASKED)[0] == 200
        assert until(lambda: len(served.server.server_state.connections) <= 5)
        assert held[0].recv(1) == b""
        held[-1].sendall(b"GET /icon.svg HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert b"200 OK" in held[-1].recv(4096)


def test_a_client_that_leaves_is_no_fault(served: Served, capfd: pytest.CaptureFixture[str]) -> None:
    body = json.dumps(ASKED).encode()
    head = f"POST /api/state HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\nContent-Length: {len(body)}\r\n\r\n".encode()
    for part in (head, head + body[:100], head + body, head[:40]):
        with socket.create_connection(("127.0.0.1", served.port)) as page:
            page.sendall(part)
    assert served.ask("state", ASKED)[0] == 200
    assert until(lambda: not served.server.server_state.tasks)
    time.sleep(0.2)
    assert capfd.readouterr().err == ""


def test_what_is_no_http_is_refused_with_the_headers(served: Served) -> None:
    for sent in (b"\x16\x03\x01\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n", b"GET /\xff HTTP/1.1\r\nHost: x\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", served.port), timeout=20) as page:
            page.sendall(sent)
            answer = page.recv(65536)
            assert b" 400 " in answer
            assert b"content-security-policy" in answer
