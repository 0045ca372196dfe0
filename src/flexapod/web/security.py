"""Checks of every request (host, token, origin, size), and the security headers of every answer."""

from __future__ import annotations

import hashlib
import ipaddress
import re
import secrets
import traceback
from collections.abc import Iterable
from urllib.parse import parse_qs

import anyio
from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect, HTTPConnection
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from flexapod.web import limits
from flexapod.web.answers import Refusal
from flexapod.web.clients import Allowance, Clients

LOCAL_HOSTS = ("127.0.0.1", "localhost", "[::1]")
_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[\w.-]+)(:\d{1,5})?", re.ASCII)

HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
        "require-trusted-types-for 'script'; trusted-types 'none'"
    ),
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}


class Guard:
    """Middleware that refuses unknown Host headers (DNS rebinding), pages of other sites, and long bodies.

    With a token, it answers only those who know it, from any address of this computer. A page shows it once, in its
    address, and gets a cookie for it; scripts send it as `Authorization: Bearer`.
    """

    def __init__(self, app: ASGIApp, hosts: Iterable[str] = (), token: str | None = None) -> None:
        self.app = app
        self.hosts = {_bracketed(host.lower()) for host in (*LOCAL_HOSTS, *hosts)}
        self.token = token
        digest = hashlib.sha256((token or "").encode()).hexdigest()
        self.cookie = f"flexapod-{digest[:8]}={digest[8:]}"  # the name: servers at other ports have their own

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            if scope["type"] == "lifespan":
                await self.app(scope, receive, send)
            return
        answer = _Sender(send)
        refused = self._refusal(scope, Headers(scope=scope))
        try:
            await (refused or self.app)(scope, receive, answer)
        except (ClientDisconnect, TimeoutError):  # of a client that takes no more of its answer
            return
        except Exception:
            traceback.print_exc()
            if not answer.begun:
                await _refused(500, "internal error; see the server")(scope, receive, answer)

    def _refusal(self, scope: Scope, headers: Headers) -> Response | None:
        """The answer to a request that is refused, or to one that shows the token."""
        host = headers.get("host", "").lower()
        if not self._known(host):
            return _refused(
                421, f"this server does not answer for the host {host[:100]!r}; open it as http://127.0.0.1"
            )
        if self.token is not None and not self._has_token(headers):
            if not self._shows_token(scope):
                return _refused(
                    401,
                    "open the address that `flexapod serve` printed, with its token",
                    {"www-authenticate": "Bearer"},
                )
            cookie = f"{self.cookie}; Path=/; HttpOnly; SameSite=Lax"
            return RedirectResponse(scope["path"], 303, {"set-cookie": cookie, "cache-control": "no-store"})
        if scope["method"] not in ("GET", "HEAD"):
            origin = headers.get("origin")
            other_site = headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none")
            if other_site or (origin is not None and origin.lower() not in (f"http://{host}", f"https://{host}")):
                return _refused(403, "requests from pages of other sites are refused")
        length = headers.get("content-length", "0")
        if not re.fullmatch("[0-9]{1,15}", length) or int(length) > limits.JOB_BYTES:
            return _refused(413, f"the request is longer than {limits.JOB_BYTES} bytes; use a smaller file")
        return None

    def _known(self, host: str) -> bool:
        """Whether a Host header, as a whole, is ours. With a token, numbers are too: only names can be rebound."""
        found = _HOST.fullmatch(host)
        return found is not None and (found[1] in self.hosts or (self.token is not None and _is_number(found[1])))

    def _has_token(self, headers: Headers) -> bool:
        given = [*headers.get("cookie", "").split(";"), headers.get("authorization", "")]
        return any(_same(one.strip(), right) for one in given for right in (self.cookie, f"Bearer {self.token}"))

    def _shows_token(self, scope: Scope) -> bool:
        """Whether the address of a page holds the token."""
        shown = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])
        plain = scope["path"].startswith("/") and not scope["path"].startswith(("//", "/\\"))  # no way to another site
        return scope["method"] in ("GET", "HEAD") and plain and _same(shown[0], self.token or "")


class Pace:
    """Middleware in which the requests of a client wait that come faster than they may.

    A page that is opened has no cookie yet, and is one client with whatever else has none at its address. So that it
    does not wait behind a script there, an address has some GET requests without a cookie beside.
    """

    def __init__(self, app: ASGIApp, clients: Clients) -> None:
        self.app, self.clients = app, clients
        self._allowance = Allowance(limits.REQUESTS, limits.REQUESTS_A_SECOND)
        self._openings = Allowance(limits.OPENINGS, limits.OPENINGS_A_SECOND)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        client = self.clients.who(HTTPConnection(scope)) if scope["type"] == "http" else None
        opens = client is not None and not client.name and scope["method"] == "GET"
        if client is not None and not (opens and self._openings.take(client.address)):
            wait = self._allowance.owed(client, 1)
            if wait > limits.LATE_SECONDS:
                self._allowance.owed(client, -1)
                await _refused(429, "too many requests; ask more slowly")(scope, receive, _Sender(send))
                return
            await anyio.sleep(wait)
        await self.app(scope, receive, send)


def _same(given: str, right: str) -> bool:
    return secrets.compare_digest(given.encode("utf-8", "replace"), right.encode())


def _bracketed(host: str) -> str:
    """A host as a Host header has it."""
    return f"[{host}]" if ":" in host and not host.startswith("[") else host


def _is_number(host: str) -> bool:
    """Whether a host is an IP address."""
    try:
        ipaddress.ip_address(host.strip("[]"))
    except ValueError:
        return False
    return True


def _refused(status: int, reason: str, headers: dict[str, str] | None = None) -> Response:
    refusal: Refusal = {"error": reason, "fields": []}
    return JSONResponse(refusal, status, headers)


class _Sender:
    """Sends the parts of an answer, the first with the security headers; raises TimeoutError if nobody takes them."""

    def __init__(self, send: Send) -> None:
        self._send = send
        self.begun = False

    async def __call__(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self.begun = True
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers[name] = value
            headers.setdefault("cache-control", "no-cache")
        with anyio.fail_after(limits.SEND_SECONDS):
            await self._send(message)
