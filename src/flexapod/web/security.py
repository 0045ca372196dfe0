"""Checks of every request (host, origin, size), and the security headers of every answer."""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from flexapod.web.answers import Refusal

LOCAL_HOSTS = ("127.0.0.1", "localhost", "::1")
MAX_BODY = 8 * 1024 * 1024  #: bytes; enough for a recorded base motion of about 60 000 rows

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
    """Middleware that refuses unknown Host headers (DNS rebinding), pages of other sites, and long bodies."""

    def __init__(self, app: ASGIApp, hosts: Iterable[str] = (), max_body: int = MAX_BODY) -> None:
        self.app = app
        self.hosts = {host.lower() for host in (*LOCAL_HOSTS, *hosts)}
        self.max_body = max_body

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            if scope["type"] == "lifespan":
                await self.app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        send = _with_headers(send)
        refused = self._refusal(scope["method"], headers)
        if refused is not None:
            status, reason = refused
            refusal: Refusal = {"error": reason, "fields": []}
            await JSONResponse(refusal, status)(scope, receive, send)
            return
        await self.app(scope, receive, send)

    def _refusal(self, method: str, headers: Headers) -> tuple[int, str] | None:
        """Status and reason if the request is refused."""
        host = headers.get("host", "")
        if not self._known(f"//{host}"):
            return 421, f"this server does not answer for the host {host[:100]!r}; open it as http://127.0.0.1"
        if method not in ("GET", "HEAD"):
            origin = headers.get("origin")
            if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
                return 403, "requests from pages of other sites are refused"
            if origin is not None and (not self._known(origin) or urlsplit(origin).netloc != host):
                return 403, "requests from pages of other sites are refused"
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > self.max_body:
            return 413, f"the request is longer than {self.max_body} bytes; use a smaller file"
        return None

    def _known(self, url: str) -> bool:
        """Whether the host of a URL is one of ours."""
        try:
            return (urlsplit(url).hostname or "") in self.hosts
        except ValueError:  # such as an unclosed bracket
            return False


def _with_headers(send: Send) -> Send:
    """The same `send`, with the security headers added to each answer."""

    async def wrapped(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers[name] = value
            headers.setdefault("cache-control", "no-cache")
        await send(message)

    return wrapped
