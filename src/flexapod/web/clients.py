"""Who asks: requests are told apart by address and, within an address, by browser.

Behind one address there may be many people, and on this computer all pages have the same one. So each browser gets a
signed cookie with its first answer; nobody can make one up, and an address gets few at a time. Requests without one
are one client together, that of their address.
"""

from __future__ import annotations

import hmac
import ipaddress
import secrets
from collections import OrderedDict
from time import monotonic
from typing import NamedTuple

from starlette.requests import HTTPConnection

from flexapod.web import limits

REMEMBERED = 1000  #: clients of which is known what they took lately; one that is forgotten begins anew


class Client(NamedTuple):
    """An address, and the name in the cookie; "" without one."""

    address: str
    name: str = ""


class Allowance:
    """So much at once for each client, and so much a second after that."""

    def __init__(self, at_once: float, a_second: float) -> None:
        self._at_once, self._a_second = at_once, a_second
        self._left: OrderedDict[str | Client, tuple[float, float]] = OrderedDict()  # and when it was, s

    def take(self, client: str | Client) -> bool:
        """Whether the client may have one more now; then it is taken."""
        allowed = self._now(client) >= 1
        if allowed:
            self.owed(client, 1)
        return allowed

    def owed(self, client: str | Client, amount: float) -> float:
        """Take an amount, and return how long the client has to wait until it is allowed, s."""
        left = self._now(client) - amount
        self._left[client] = left, monotonic()
        self._left.move_to_end(client)
        if len(self._left) > REMEMBERED:
            self._left.popitem(last=False)
        return max(0.0, -left / self._a_second)

    def _now(self, client: str | Client) -> float:
        """What is left to the client now."""
        left, then = self._left.get(client, (self._at_once, 0.0))
        return min(self._at_once, left + (monotonic() - then) * self._a_second)


class Clients:
    """Gives browsers their cookies and knows them again."""

    def __init__(self) -> None:
        self._secret = secrets.token_bytes(32)
        self._cookie = f"flexapod-client-{secrets.token_hex(4)}"  # servers at other ports have their own
        self._new = Allowance(limits.NEW_CLIENTS, limits.NEW_CLIENTS_A_SECOND)

    def who(self, connection: HTTPConnection) -> Client:
        """The client of a request."""
        name, _, signed = connection.cookies.get(self._cookie, "").partition(".")
        known = hmac.compare_digest(signed.encode("utf-8", "replace"), self._signature(name).encode())
        host = connection.client.host if connection.client else ""
        return Client(network(host), name if known else "")

    def cookie(self, client: Client) -> dict[str, str]:
        """The head that makes a browser known, if it is not and its address had not too many of late."""
        if client.name or not self._new.take(client.address):
            return {}
        name = secrets.token_urlsafe(12)
        return {"set-cookie": f"{self._cookie}={name}.{self._signature(name)}; Path=/; HttpOnly; SameSite=Strict"}

    def _signature(self, name: str) -> str:
        return hmac.digest(self._secret, name.encode("utf-8", "replace"), "sha256").hex()


def network(host: str) -> str:
    """An address; of IPv6 the network, in which one computer may have as many addresses as it likes."""
    try:
        address = ipaddress.ip_address(host.partition("%")[0])
    except ValueError:
        return host
    if isinstance(address, ipaddress.IPv4Address):
        return host
    if address.ipv4_mapped:
        return str(address.ipv4_mapped)
    return str(ipaddress.ip_network((address, limits.IPV6_NETWORK), strict=False))
