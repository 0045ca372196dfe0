"""The server of the application: connections that send no whole request in time, or are too many, are closed."""

from __future__ import annotations

import asyncio
import contextlib
from typing import Any

import h11
import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from flexapod.web import limits
from flexapod.web.security import HEADERS


class Connection(H11Protocol):
    """A connection whose requests must have their heads in time."""

    _timer: asyncio.TimerHandle | None = None
    _began = 0.0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._began = self.loop.time()
        self._wait()
        there = [c for c in self.connections if isinstance(c, Connection) and not c.transport.is_closing()]
        if len(there) > limits.CONNECTIONS:
            idle = (connection for connection in there if connection._is_idle())
            min(idle, key=lambda connection: connection._began, default=self).transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop_waiting()
        super().connection_lost(exc)

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

    def _is_idle(self) -> bool:
        return self.cycle is None or self.cycle.response_complete

    def _wait(self) -> None:
        self._timer = self.loop.call_later(limits.HEAD_SECONDS, self._too_slow)

    def _stop_waiting(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _too_slow(self) -> None:
        self._timer = None
        if self._is_idle():
            self.transport.close()


def server(app: ASGIApp, **options: Any) -> uvicorn.Server:
    """A server of the application. options: of uvicorn.Config, as port."""
    config = uvicorn.Config(
        app, http=Connection, ws="none", log_level="error", timeout_graceful_shutdown=1, server_header=False, **options
    )
    return uvicorn.Server(config)
