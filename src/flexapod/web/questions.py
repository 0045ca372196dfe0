"""Questions that are answered at once, in processes of their own.

Two kinds of process share the work, so that nobody's moving sliders wait for a text that takes long to read:
- quick ones answer about designs whose text was accepted before, with few changes: a few milliseconds each;
- careful ones, of lower priority, take texts that are new or long, and many changes.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from hashlib import blake2b
from typing import NamedTuple

import anyio

from flexapod.web import limits, requests
from flexapod.web.clients import Client
from flexapod.web.encode import as_json
from flexapod.web.jobs import DIED
from flexapod.web.process import Pool, Process
from flexapod.web.turns import Share, Turns

REMEMBERED = 1000  #: texts that were accepted


class Answer(NamedTuple):
    """The status, the JSON text and how long it took to compute, s."""

    status: int
    content: bytes
    seconds: float = 0.0


def refusal(status: int, words: str) -> Answer:
    """An answer that says why there is none."""
    return Answer(status, as_json({"error": words, "fields": []}))


class _Lane:
    """Processes for one kind of question, and those who wait for them."""

    def __init__(self, turns: Turns, kept: int, niceness: int) -> None:
        self.pool = Pool(kept, niceness, limits.QUESTION_MEMORY)
        self._turns, self._there = turns, Share(limits.WAITING)

    async def ask(self, client: Client, kind: str, body: bytes) -> Answer:
        """The answer to a question of a client, when it is its turn."""
        with self._there.held(client) as allowed:
            if not allowed:
                return refusal(503, "too many questions wait for their answers; ask again later")
            async with self._turns.turn(client):
                return await self._asked(kind, body)

    async def _asked(self, kind: str, body: bytes) -> Answer:
        try:
            process = await self.pool.take()
        except (EOFError, OSError):
            return refusal(503, DIED.format("question"))
        answer = None
        try:
            await process.send(kind, body)
            answer = await _answer(process, limits.ANSWER_SECONDS)
        except (EOFError, OSError):
            return refusal(503, DIED.format("question"))
        except anyio.get_cancelled_exc_class():  # its client has left
            with anyio.CancelScope(shield=True):
                answer = await _after_all(process)
            raise
        finally:
            self.pool.give_back(process, answer is not None)
        return answer or refusal(503, f"computing this was stopped after {limits.ANSWER_SECONDS:g} s")


async def _answer(process: Process, seconds: float) -> Answer | None:
    """The answer of a process, if it comes in time."""
    end = anyio.current_time() + seconds
    while anyio.current_time() < end:
        message = await process.receive(0.1)
        if message is not None:
            return Answer(message[0]["status"], message[1], message[0]["seconds"])
    return None


async def _after_all(process: Process) -> Answer | None:
    """An answer that nobody waits for, if it comes soon: then the process lives on."""
    try:
        return await _answer(process, limits.GRACE_SECONDS)
    except (EOFError, OSError):
        return None


class Questions:
    """Questions of all pages. accepted: texts that are known to be designs."""

    def __init__(self, accepted: Iterable[str] = ()) -> None:
        self.quick = _Lane(Turns(limits.QUICK, alone=True), limits.QUICK, 0)
        self.careful = _Lane(Turns(limits.CAREFUL), 1, 10)
        self._accepted: OrderedDict[bytes, None] = OrderedDict((_digest(text), None) for text in accepted)

    async def ask(self, client: Client, kind: str, body: bytes) -> Answer:
        """The answer to a question. Raises RequestError if the body makes no sense."""
        if len(body) > limits.SMALL_BYTES:
            return await self.careful.ask(client, kind, body)
        asked = requests.parsed(body)
        text, changes = asked.get("design"), asked.get("changes", {})
        if not isinstance(text, str) or not isinstance(changes, dict):
            return await self.quick.ask(client, kind, body)  # which refuses it
        digest = _digest(text)
        quick = digest in self._accepted and len(changes) <= limits.FEW_CHANGES
        answer = await (self.quick if quick else self.careful).ask(client, kind, body)
        if answer.status == 200:
            self._accepted[digest] = None
            self._accepted.move_to_end(digest)
            if len(self._accepted) > REMEMBERED:
                self._accepted.popitem(last=False)
        return answer


def _digest(text: str) -> bytes:
    return blake2b(text.encode("utf-8", "surrogatepass"), digest_size=16).digest()
