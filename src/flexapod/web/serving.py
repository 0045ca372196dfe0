"""The server of the application: connections that come too fast, are too many or too slow, are closed."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import struct
from collections import defaultdict
from functools import partial
from typing import Any

import h11
import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from flexapod.web import limits
from flexapod.web.clients import Allowance, network
from flexapod.web.security import HEADERS
from flexapod.web.turns import Share

AT_A_TIME = 64  #: connections that are accepted, or refused, before the server looks at others again


class Door(socket.socket):
    """A socket that listens, and refuses an address whose new connections come too fast, before they cost anything."""

    def __init__(self, *given: Any, **options: Any) -> None:
        super().__init__(*given, **options)
        self._allowance = Allowance(limits.NEW_CONNECTIONS, limits.NEW_CONNECTIONS_A_SECOND)

    def accept(self) -> tuple[socket.socket, Any]:
        """The next connection that is let in. Raises BlockingIOError if there is none just now."""
        for _ in range(AT_A_TIME):
            connection, address = super().accept()
            if self._allowance.take(network(address[0])):
                return connection, address
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # no farewell
            connection.close()
        raise BlockingIOError


class There:
    """The connections that are open."""

    def __init__(self) -> None:
        self._share = Share(limits.CONNECTIONS)
        self._of: defaultdict[str, dict[Connection, None]] = defaultdict(dict)  # by address, as they came

    def come(self, new: Connection) -> None:
        """Close another of the same address if it has too many: an idle one, at first one that never got an answer."""
        own = self._of[new.address]
        if not self._share.allows(new.address):
            idle = (one for one in own if one.idle())
            worst = min(idle, key=lambda one: one.answered > 0, default=new)  # of those alike, the one that came first
            self.leave(worst)
            worst.transport.abort()
        if not new.transport.is_closing():
            self._share.hold(new.address)
            own[new] = None

    def leave(self, gone: Connection) -> None:
        own = self._of[gone.address]
        if gone in own:
            del own[gone]
            self._share.give_back(gone.address)
        if not own:
            del self._of[gone.address]


class Connection(H11Protocol):
    """A connection whose requests must have their heads in time."""

    _timer: asyncio.TimerHandle | None = None
    address = ""
    answered = 0  #: requests so far

    def __init__(self, *given: Any, there: There, **options: Any) -> None:
        super().__init__(*given, **options)
        self._there = there

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self.address = network(self.client[0] if self.client else "")
        self._there.come(self)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        self._there.leave(self)
        self._stop_waiting()
        super().connection_lost(exc)

    def on_response_complete(self) -> None:
        self.answered += 1
        super().on_response_complete()
        if self.conn.their_state is h11.IDLE and self.conn.trailing_data[0] and self._timer is None:
            self._wait()  # a request that began to arrive during the answer

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        if self.conn.their_state is not h11.IDLE:
            self._stop_waiting()
        elif self._timer is None:  # begun, and not begun anew by each byte
            self._wait()

    def send_400_response(self, msg: str) -> None:
        """The answer to what is no HTTP, with the headers of all answers."""
        names = {"content-type": "text/plain; charset=utf-8", "connection": "close", **HEADERS}
        head = [(name.encode(), value.encode()) for name, value in names.items()]
        with contextlib.suppress(h11.LocalProtocolError):  # in the middle of another answer
            for event in (h11.Response(status_code=400, headers=head), h11.Data(data=msg.encode()), h11.EndOfMessage()):
                self.transport.write(self.conn.send(event) or b"")
        self.transport.close()

    def idle(self) -> bool:
        """Whether no request of this connection is being answered."""
        return self.cycle is None or self.cycle.response_complete

    def _wait(self) -> None:
        self._timer = self.loop.call_later(limits.HEAD_SECONDS, self._too_slow)

    def _stop_waiting(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _too_slow(self) -> None:
        self._timer = None
        if self.idle():
            self.transport.close()


def server(app: ASGIApp) -> uvicorn.Server:
    """A server of the application, to be run with sockets that are Doors."""
    config = uvicorn.Config(
        app,
        http=partial(Connection, there=There()),  # type: ignore[arg-type]  # it makes what is asked for
        ws="none",
        loop="asyncio:SelectorEventLoop",  # which asks the Door for each connection; others, as Windows' own, do not
        log_level="critical",
        backlog=AT_A_TIME,
        timeout_keep_alive=limits.IDLE_SECONDS,
        timeout_graceful_shutdown=1,
        server_header=False,
        proxy_headers=False,  # who has an address here, and not who says that it has
    )
    return uvicorn.Server(config)
