"""The server attacked: bodies, heads, designs and floods drawn at random, and clients that leave.

Every answer has a documented status and the security headers, nothing is traced, memory stays within bounds, and other
clients are served meanwhile. FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import http.client
import json
import random
import socket
import threading
from collections import Counter

import psutil
import pytest
from tests.attack.bounded import rounds
from tests.web.asked import ASKED, BOX, TEXT
from tests.web.serving import running, until

from flexapod.web import limits
from flexapod.web.security import HEADERS

STATUSES = {200, 204, 303, 304, 400, 403, 404, 405, 408, 413, 421, 422, 503}
ROUTES = (
    "state",
    "design",
    "response",
    "shake",
    "jobs/slice",
    "jobs/cloud",
    "jobs/time",
    "jobs/worst",
    "jobs/x",
    "start",
    "x",
)
METHODS = ("POST", "POST", "POST", "POST", "GET", "HEAD", "DELETE", "PUT", "OPTIONS", "TRACE", "X")
VALUES = (
    None, True, 0, -1, 1, 1e99, -1e99, 5e-324, 10**400, 1e308, "", "x", "\ud800", "\0", [], {}, [[]], [1] * 6, [1e99] * 6, [0] * 7,
    [None] * 6, {"low": [0] * 6, "high": [1] * 6}, {"platform.mass": 1e99}, {"platform.mass": -1}, {"legs.stiffness[9]": 1},
    {"platform.mass_center": [0, 0, 1e99]}, {"k" * 999: 1}, {f"k{n}": 1 for n in range(300)}, "x" * 3000, "universal", "spin_free", "z",
)  # fmt: skip
KEYS = (
    *ASKED,
    "changes",
    "joint",
    "box",
    "quantity",
    "loss_factor",
    "omega",
    "axis",
    "points",
    "side",
    "across",
    "up",
    "duration",
    "csv",
    "kind",
)
SPEC = {
    **ASKED,
    "box": BOX,
    "points": 100,
    "side": 4,
    "across": "x",
    "up": "z",
    "duration": 0.001,
    "axis": "z",
    "omega": 50.0,
}


def nested(draw):
    return draw.choice(["[", '{"a":']) * draw.choice([10, 900, 100_000])


def design(draw):
    """Texts that once took seconds or gigabytes, and a design with bytes changed."""
    n = draw.choice([10, 300, 3000, 20_000])
    text = list(TEXT)
    for _ in range(draw.choice([1, 5, 50])):
        text[draw.randrange(len(text))] = draw.choice('[]{}.="\n0a#-e\0\u03c9')
    return draw.choice(
        [
            ".".join("a" * n) + "=1", "\n".join(f"k{k}=1" for k in range(n)), "\n".join(f"[a{k}]" for k in range(n)),
            "a=" + "[" * n + "]" * n, "platform.mass=[" + "1," * n + "]", "'" + "k" * n + "'=1", "a=" + "9" * n,
            "a={" + ",".join(f"x{k}=1" for k in range(n)) + "}", "#" * n, "\n" * n + TEXT, "".join(text),
        ]
    )  # fmt: skip


def body(draw):
    kind = draw.randrange(6)
    if kind == 0:
        return draw.randbytes(draw.choice([0, 1, 50, 5000, 100_000]))
    if kind == 1:
        return nested(draw).encode()
    if kind == 2:
        return b" " * draw.choice([limits.SMALL_BYTES, limits.QUESTION_BYTES + 1])
    spec = SPEC | ({"design": design(draw)} if kind == 3 else {})
    spec |= {draw.choice(KEYS): draw.choice(VALUES) for _ in range(draw.choice([0, 1, 1, 2]))}
    return json.dumps(spec).encode()


def heads(draw, port):
    """The heads of a request; most of them right."""
    found = {"Host": f"127.0.0.1:{port}", "Content-Type": "application/json"}
    wrong = {
        "Host": draw.choice(
            ["evil.example", f"127.0.0.1:{port}/x", "x@127.0.0.1", "", "[", "\xff", "127.0.0.1:99999999"]
        ),
        "Origin": draw.choice(["null", "", "http://evil.example", f"http://127.0.0.1:{port}/", "\xff"]),
        "Sec-Fetch-Site": draw.choice(["cross-site", "", "none", "x"]),
        "Cookie": "a=" + "b" * draw.choice([1, 3000]),
        "Authorization": "Bearer x",
        "Range": draw.choice(["bytes=0-", "bytes=-1", "bytes=9999999-", "x", "bytes=" + "0-1," * 500]),
        "If-Modified-Since": "x",
        "Accept-Encoding": "gzip",
        "Expect": "100-continue",
        "Upgrade": "websocket",
        "Connection": "Upgrade",
    }
    for name in draw.sample(sorted(wrong), draw.choice([0, 0, 0, 0, 1, 2])):
        found[name] = wrong[name]
    return found


def request(draw, port):
    """Bytes of a request, as a client sends them."""
    method, content = draw.choice(METHODS), body(draw)
    path = draw.choice(
        [f"/api/{draw.choice(ROUTES)}"] * 8 + ["/", "/icon.svg", "/../app.py", "/%2e%2e/", "//x", "/\xff", "/%00"]
    )
    length = draw.choice([len(content)] * 12 + [0, len(content) + 5, -1, "x", 10**9, "9" * 5000])
    lines = [f"{method} {path} HTTP/1.1", *(f"{name}: {value}" for name, value in heads(draw, port).items())]
    if draw.random() < 0.1:
        lines.append("Transfer-Encoding: chunked")
        content = b"%x\r\n" % len(content) + content + b"\r\n0\r\n\r\n" if content else b"0\r\n\r\n"
    else:
        lines.append(f"Content-Length: {length}")
    sent = "\r\n".join([*lines, "", ""]).encode("latin-1") + content
    if draw.random() < 0.1:
        sent = bytearray(sent)
        for _ in range(3):
            sent[draw.randrange(min(len(sent), 400))] = draw.randrange(256)
    return bytes(sent), method


def answered(sent, method, port, leave):
    """The status of what the server answers and its headers; None where it closes without a word, or we leave."""
    with socket.create_connection(("127.0.0.1", port), timeout=60) as client:
        try:
            client.sendall(sent[: len(sent) // 2] if leave == "half-way" else sent)
            if leave:
                return None
            answer = http.client.HTTPResponse(client, method=method)
            answer.begin()
            found = answer.status, {name.lower(): value for name, value in answer.getheaders()}
            answer.read()
        except (http.client.RemoteDisconnected, http.client.IncompleteRead, ConnectionError):
            return None
    return found


def memory():
    """Bytes of the processes that compute."""
    return sum(child.memory_info().rss for child in psutil.Process().children() if child.is_running())


@pytest.fixture
def served(monkeypatch):
    monkeypatch.setattr(limits, "HEAD_SECONDS", 3.0)  # half requests are many here
    monkeypatch.setattr(limits, "BODY_SECONDS", 1.0)
    with running() as found:
        yield found


def test_the_server_attacked(served, capfd):
    assert served.ask("state", ASKED)[0] == 200
    seen, faults, end = Counter(), [], threading.Event()

    def others():
        """Another client, who is served all the time."""
        while not end.is_set():
            status, found = served.ask("state", ASKED)
            if status != 200 or "omega" not in found:
                faults.append(("another client", status))
            seen["answers to others"] += 1
            end.wait(0.05)

    def attacker(draw):
        for _ in range(3):
            sent, method = request(draw, served.port)
            found = answered(sent, method, served.port, draw.choice([None] * 6 + ["half-way", "at once"]))
            seen["no answer" if found is None else found[0]] += 1
            if found and not (found[0] in STATUSES and HEADERS.items() <= found[1].items()):
                faults.append((sent[:300], found))

    beside = threading.Thread(target=others)
    beside.start()
    try:
        for draw in rounds(0.7, "server"):
            crowd = [threading.Thread(target=attacker, args=(random.Random(draw.random()),)) for _ in range(8)]
            for thread in crowd:
                thread.start()
            for thread in crowd:
                thread.join(timeout=120)
                assert not thread.is_alive(), "no answer in two minutes"
            assert not faults, faults[0]
            assert memory() < (limits.QUICK + limits.CAREFUL + limits.MOST_JOBS) * limits.MEMORY
    finally:
        end.set()
        beside.join()
    assert not faults
    assert seen["answers to others"] > 0
    assert until(lambda: not served.app.state.jobs.running())
    assert served.ask("state", ASKED)[0] == 200
    told = capfd.readouterr()
    assert told.err == ""
    print(dict(seen))
