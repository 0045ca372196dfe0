"""The server attacked: bad contents in right requests, heads and floods drawn at random, and clients that leave.

Every answer has a documented status and the security headers, nothing is traced, memory stays within bounds, and other
clients are served meanwhile. FLEXAPOD_ATTACK_SECONDS: how long in all.
"""

import contextlib
import http.client
import json
import re
import socket
import threading
import time
from collections import Counter

import psutil
import pytest
from tests.attack.bounded import SECONDS, rounds, tried
from tests.helpers.waiting import until
from tests.web.asked import ASKED, BOX, TEXT
from tests.web.serving import running

from flexapod.web import forks, limits
from flexapod.web.security import HEADERS

#: Of a process beside what it shares: 8 MB of a fork at its start, at most 70 MB after that; else 93 and 115 MB.
OWN_MEMORY = (112 if forks.FORKS else 160) * limits.MIB
STATUSES = {200, 204, 206, 303, 304, 400, 403, 404, 405, 408, 413, 416, 421, 422, 429, 503}
#: What each handler reads beside the design, its changes, the pose and the joint model.
READ = {
    "state": (),
    "design": (),
    "response": ("quantity", "loss_factor"),
    "shake": ("axis", "omega", "loss_factor"),
    "jobs/slice": ("box", "across", "up", "side"),
    "jobs/cloud": ("box", "points", "seed"),
    "jobs/worst": ("box", "all_poses"),
    "jobs/time": ("kind", "axis", "amplitude", "frequency", "end", "peak", "pulse", "duration", "csv"),
}
ROUTES = (*READ, "jobs/x", "start", "x")
METHODS = ("POST", "GET", "HEAD", "DELETE", "PUT", "OPTIONS", "TRACE", "X")
VALUES = (
    None, True, 0, -1, 1, 1e99, -1e99, 5e-324, 10**400, 1e308, "", "x", "\ud800", "\0", [], {}, [[]], [1] * 6, [1e99] * 6, [0] * 7,
    [None] * 6, {"low": [0] * 6, "high": [1] * 6}, {"platform.mass": 1e99}, {"platform.mass": -1}, {"legs.stiffness[9]": 1},
    {"platform.mass_center": [0, 0, 1e99]}, {"k" * 999: 1}, {f"k{n}": 1 for n in range(300)}, "x" * 3000, "universal", "spin_free", "z",
)  # fmt: skip
KEYS = (*ASKED, "changes", "joint", *sorted({key for keys in READ.values() for key in keys}))
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
    "loss_factor": 0.01,
    "quantity": "relative",
    "kind": "harmonic",
    "amplitude": 1e-6,
    "frequency": 50.0,
    "end": 90.0,
    "peak": 1.0,
    "pulse": 0.01,
    "csv": "time,z_mm\n0,0\n0.001,0.1\n",
    "seed": 1,
    "all_poses": False,
}
#: Numbers as a page sends them, and as nobody should.
NUMBERS = (0, -1, 1, 1e-300, 1e-9, 0.5, 7, 1e3, 1e9, 1e99, 1e308, -1e308, True, None, "1", [1.0], 2**63)
PLACES = (
    "platform.mass", "platform.inertia", "platform.mass_center", "platform.joints", "base.joints", "base.universal_axes[2]", "gravity",
    "legs.stiffness", "legs.stiffness[3]", "legs.damping", "legs.upper.mass", "legs.lower.inertia", "home.position", "home.rpy_deg",
    "limits.leg_length", "limits.universal_angle", "base.radius", "platform.radius", "name", "legs", "legs.stiffness[6]", "platfrom.mass",
)  # fmt: skip


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


def spoilt(draw, value):
    """A value of a request with one of its numbers, or all of it, replaced."""
    if isinstance(value, list) and value and draw.random() < 0.8:
        at = draw.randrange(len(value))
        return [*value[:at], spoilt(draw, value[at]), *value[at + 1 :]]
    if isinstance(value, dict) and value and draw.random() < 0.8:
        key = draw.choice(sorted(value))
        return value | {key: spoilt(draw, value[key])}
    return draw.choice(VALUES if draw.random() < 0.3 else NUMBERS)


def changes(draw):
    """Changes to a design, most of them at places that it has."""
    value = lambda: draw.choice([draw.choice(NUMBERS), [draw.choice(NUMBERS) for _ in range(draw.choice([2, 3, 6]))]])  # noqa: E731
    return {draw.choice(PLACES): value() for _ in range(draw.choice([1, 1, 2, 5, 40]))}


def lines(draw):
    """A design whose text has one line too many, too few, or with another number in it."""
    text = TEXT.splitlines()
    at = draw.randrange(len(text))
    one = text[at]
    numbered = re.sub(
        r"[0-9.]+(e-?[0-9]+)?", lambda _: draw.choice(["0", "-1", "1e300", "nan", "inf", "1e-300", "7"]), one, count=1
    )
    text[at : at + 1] = draw.choice([[], [one, one], [numbered], [numbered], [one.replace("=", " = -")]])
    return "\n".join(text)


def contents(draw, route):
    """A request that is right but for some of its contents, at places that its handler reads."""
    spec = dict(SPEC) | {"pose": ASKED["pose"]}
    for _ in range(draw.choice([1, 1, 1, 2, 3])):
        kind = draw.randrange(4)
        if kind == 0:
            spec["changes"] = changes(draw)
        elif kind == 1:
            spec["design"] = lines(draw) if draw.random() < 0.8 else design(draw)
        else:
            key = draw.choice(("pose", "joint", *READ[route] * 3))
            spec[key] = spoilt(draw, spec.get(key, "universal"))
    return json.dumps(spec).encode()


def inside(draw, port):
    """Bytes of a request whose head is right, and its route: one of five begins a job, of which each may take seconds."""
    jobs = draw.random() < 0.2
    route = draw.choice([name for name in READ if name.startswith("jobs/") == jobs])
    content = contents(draw, route)
    head = f"POST /api/{route} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {len(content)}\r\n\r\n"
    return head.encode() + content, route


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
    """Status, heads and body of what the server answers; None where it closes without a word, or we leave."""
    with socket.create_connection(("127.0.0.1", port), timeout=300) as client:
        try:
            client.sendall(sent[: len(sent) // 2] if leave == "half-way" else sent)
            if leave:
                return None
            answer = http.client.HTTPResponse(client, method=method)
            answer.begin()
            heads = {name.lower(): value for name, value in answer.getheaders()}
            return answer.status, heads, answer.read()
        except (http.client.RemoteDisconnected, http.client.IncompleteRead, ConnectionError):
            return None


def outcome(route, found):
    """How a request ended, in words for the table; those with a route are right as HTTP."""
    if found is None:
        return "no answer"
    status, _, content = found
    if route is None:
        return f"HTTP {status}"
    if status == 503:
        return "no turn"
    failed = status != 200 or b'"type":"failed"' in content[-2000:]
    return "refused by its handler" if failed else "answered by its handler"


def computing(parent):
    """The processes that compute: forks of a process for that, which itself has all they share, or its own children."""
    children = parent.children()
    if not forks.FORKS:
        return children
    return [
        one
        for child in children
        if "multiprocessing.forkserver" in " ".join(child.cmdline())
        for one in child.children()
    ]


def most_own(parent):
    """Bytes that the largest of the processes that compute shares with no other."""
    found = [0]
    with contextlib.suppress(psutil.NoSuchProcess):  # a child of this process has just ended
        for one in computing(parent):
            with contextlib.suppress(psutil.NoSuchProcess):
                found.append(one.memory_full_info().uss)
    return max(found)


@pytest.fixture
def served(monkeypatch):
    monkeypatch.setattr(limits, "HEAD_SECONDS", 3.0)  # half requests are many here
    monkeypatch.setattr(limits, "BODY_SECONDS", 1.0)
    monkeypatch.setattr(limits, "JOB_SECONDS", 2.0)
    with running() as found:
        yield found


def test_the_server_attacked(served, capfd):
    assert served.ask("state", ASKED)[0] == 200
    seen, others_seen, faults, end = Counter(), Counter(), [], threading.Event()

    def others():
        """Another client, who is served all the time."""
        while not end.is_set():
            status, found = served.ask("state", ASKED, 300.0)
            if status != 200 or "omega" not in found:
                faults.append(("another client", status))
            others_seen["answers"] += 1
            end.wait(0.05)

    def attacker(number):
        for draw in (draw for draw in rounds(0.7, f"server {number}") for _ in range(5)):
            if faults:
                return
            route, method = None, "POST"
            if draw.random() < 0.8:
                leave, (sent, route) = None, inside(draw, served.port)
            else:
                leave = draw.choice([None] * 6 + ["half-way", "at once"])
                sent, method = request(draw, served.port)
            found = answered(sent, method, served.port, leave)
            seen[outcome(route, found)] += 1
            if found and not (found[0] in STATUSES and HEADERS.items() <= found[1].items()):
                faults.append((sent, found))
            if route and (found is None or found[0] not in (200, 400, 422, 503) or b"internal error" in found[2]):
                faults.append((sent, found))

    beside = threading.Thread(target=others)
    crowd = [threading.Thread(target=attacker, args=(number,), daemon=True) for number in range(8)]
    last = time.monotonic() + 0.7 * SECONDS + 900  # for an answer
    for thread in (beside, *crowd):
        thread.start()
    try:
        while any(thread.is_alive() for thread in crowd):
            assert time.monotonic() < last, "no answer in a quarter of an hour"
            assert not faults, faults[0]
            assert most_own(psutil.Process()) < OWN_MEMORY
            time.sleep(0.2)
    finally:
        end.set()
        beside.join()
    assert not faults
    assert others_seen["answers"] > 0
    handled = seen["refused by its handler"] + seen["answered by its handler"]
    assert handled > 0.6 * seen.total(), seen
    assert until(lambda: not served.app.state.jobs.running())
    assert served.ask("state", ASKED)[0] == 200
    assert capfd.readouterr().err == ""
    for words, count in seen.items():
        tried("requests to the server", words, count)
    tried("requests of another client meanwhile", "answered", others_seen["answers"])
