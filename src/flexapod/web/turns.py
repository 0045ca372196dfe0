"""How clients share what there is: places at work, places in which to wait, bytes.

A client may have as much as it leaves free for the others: of four places two, then the next client one, and the last
is left for a third. One client can therefore never take all, and alone it gets half (the dynamic thresholds of
Choudhury and Hahne, "Dynamic queue length thresholds for shared-memory packet switches", 1998).
"""

from __future__ import annotations

import contextlib
from collections import Counter, OrderedDict
from collections.abc import AsyncIterator, Iterator
from typing import NamedTuple

import anyio

from flexapod.web.clients import REMEMBERED, Client


class Share:
    """An amount that clients share."""

    def __init__(self, most: int) -> None:
        self.free = most
        self._held: Counter[str | Client] = Counter()

    def allows(self, client: str | Client, amount: int = 1) -> bool:
        """Whether the client may have so much more, and leaves as much as it has then but for this amount."""
        return self._held[client] + amount <= self.free

    def take(self, client: str | Client, amount: int = 1) -> bool:
        """Take an amount if it is allowed; whether it was."""
        allowed = self.allows(client, amount)
        if allowed:
            self.hold(client, amount)
        return allowed

    def hold(self, client: str | Client, amount: int = 1) -> None:
        """Take an amount."""
        self.free -= amount
        self._held[client] += amount

    @contextlib.contextmanager
    def held(self, client: str | Client, amount: int = 1) -> Iterator[bool]:
        """An amount as long as the block runs, if it is allowed; whether it was."""
        taken = self.take(client, amount)
        try:
            yield taken
        finally:
            if taken:
                self.give_back(client, amount)

    def give_back(self, client: str | Client, amount: int = 1) -> None:
        self.free += amount
        self._held[client] -= amount
        if not self._held[client]:
            del self._held[client]


class _Waiting(NamedTuple):
    client: Client
    turn: anyio.Event


class Turns:
    """Places at work, given in turn: first to the address that had none for longest, there to the client that had none.

    alone: whether one client may have all places while nobody else waits, which is right where work is short.
    """

    def __init__(self, places: int, alone: bool = False) -> None:
        self._share, self._alone = Share(places), alone
        self._waiting: list[_Waiting] = []  # in the order in which they came
        self._latest: OrderedDict[str | Client, int] = OrderedDict()  # the number of the latest turn
        self._given = 0

    @contextlib.asynccontextmanager
    async def turn(self, client: Client) -> AsyncIterator[None]:
        """A place, as long as the block runs."""
        waiting = _Waiting(client, anyio.Event())
        self._waiting.append(waiting)
        self._give()
        try:
            await waiting.turn.wait()
            yield
        finally:
            if waiting.turn.is_set():
                self._share.give_back(client)
            else:
                self._waiting.remove(waiting)
            self._give()

    def waits(self, client: Client) -> bool:
        """Whether a client that came now would have to wait."""
        return not self._may(client)

    def _may(self, client: Client) -> bool:
        return self._share.free > 0 if self._alone else self._share.allows(client)

    def _give(self) -> None:
        """Give free places to those whose turn it is."""
        while ready := [one for one in self._waiting if self._may(one.client)]:
            chosen = min(ready, key=lambda one: [self._latest.get(key, 0) for key in (one.client.address, one.client)])
            self._waiting.remove(chosen)
            self._share.hold(chosen.client)
            self._note(chosen.client)
            chosen.turn.set()

    def _note(self, client: Client) -> None:
        """Take down that a client had its turn."""
        self._given += 1
        for key in (client.address, client):
            self._latest[key] = self._given
            self._latest.move_to_end(key)
        while len(self._latest) > 2 * REMEMBERED:
            self._latest.popitem(last=False)
