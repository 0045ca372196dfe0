"""Requests of a page: JSON bodies read as designs, poses, boxes and numbers."""

from __future__ import annotations

import json
import math
from functools import lru_cache
from typing import Any, NamedTuple

import anyio
import numpy as np
from starlette.requests import Request

from flexapod.conventions import AXES, JOINT_MODELS, Array
from flexapod.design.hexapod import Hexapod
from flexapod.errors import FlexapodError
from flexapod.pose import Pose
from flexapod.web import designs, limits
from flexapod.web.clients import Allowance, Client
from flexapod.web.geometry import pose_at
from flexapod.web.turns import Share


class RequestError(FlexapodError, ValueError):
    """A wrong request; the page shows the message."""

    def __init__(self, message: str, status: int = 422) -> None:
        super().__init__(message)
        self.status = status


class Question(NamedTuple):
    """What most requests are about: a design (text and changes), its pose and the joint model."""

    design: designs.Source
    six: tuple[float, ...]  #: x, y, z in m, roll, pitch, yaw in degrees
    joint: Any

    @property
    def hexapod(self) -> Hexapod:
        return designs.built(self.design)

    @property
    def pose(self) -> Pose:
        return pose_of(self.six)


class Bodies:
    """Bodies of requests as they arrive: each of limited length, all together of limited size, and in time."""

    def __init__(self) -> None:
        self._share = Share(limits.BODIES_BYTES)
        self._pace = Allowance(limits.LONG_BYTES, limits.LONG_BYTES_A_SECOND)

    async def read(self, request: Request, client: Client, most: int) -> bytes:
        """The body of a request. Its length is checked as it arrives, since the header may not state it."""
        parts: list[bytes] = []
        size = 0
        try:
            with anyio.fail_after(limits.BODY_SECONDS):
                async for part in request.stream():
                    if size + len(part) > most:
                        raise RequestError(f"the request is longer than {most} bytes; use a smaller file", 413)
                    if not self._share.take(client, len(part)):
                        raise RequestError("too many long requests arrive at the same time; try again later", 503)
                    size += len(part)
                    parts.append(part)
                    if size > limits.SMALL_BYTES:
                        await anyio.sleep(self._pace.owed(client, len(part)))
        except TimeoutError:
            raise RequestError(f"the request took longer than {limits.BODY_SECONDS:g} s to arrive", 408) from None
        finally:
            self._share.give_back(client, size)
        return b"".join(parts)


def parsed(body: bytes) -> dict[str, Any]:
    """The JSON object of a request."""
    try:
        value = json.loads(body, parse_int=_integer)
    except (ValueError, RecursionError) as error:
        if isinstance(error, RequestError):
            raise
        raise RequestError("the request is not JSON", 400) from None
    if not isinstance(value, dict):
        raise RequestError("the request must be a JSON object", 400)
    _check_depth(value)
    return value


def _integer(text: str) -> int:
    if len(text) > limits.DIGITS:
        raise RequestError(f"the request has an integer of {len(text)} digits; at most {limits.DIGITS} can be", 400)
    return int(text)


def _check_depth(value: Any) -> None:
    """Raises RequestError for lists and objects that lie too deep within each other."""
    level = [value]
    for _ in range(limits.DEPTH):
        nested = (one.values() if isinstance(one, dict) else one for one in level)
        level = [item for items in nested for item in items if isinstance(item, dict | list)]
        if not level:
            return
    raise RequestError(f"the request has lists or objects more than {limits.DEPTH} deep", 400)


def question(asked: dict[str, Any]) -> Question:
    """The design, pose and joint model of a request."""
    six = numbers(asked.get("pose", [0.0] * 6), "pose", 6)
    return Question(source(asked), six, choice(asked, "joint", JOINT_MODELS))


def source(asked: dict[str, Any]) -> designs.Source:
    """The design of a request as hashable text: its TOML and the changes made to it."""
    text, changes = asked.get("design"), asked.get("changes", {})
    if not isinstance(text, str) or not isinstance(changes, dict):
        raise RequestError("design must be the text of a design file, and changes an object of key: value")
    return designs.Source(text, json.dumps(changes, sort_keys=True))


def numbers(value: Any, name: str, count: int | None = None) -> tuple[float, ...]:
    """A list of finite numbers."""
    good = isinstance(value, list) and all(_finite(item) for item in value) and count in (None, len(value))
    if not good:
        raise RequestError(f"{name} must be {'a list of' if count is None else count} finite numbers")
    return tuple(float(item) for item in value)


def number(asked: dict[str, Any], name: str, default: float, least: float, most: float) -> float:
    """One number within bounds."""
    value = asked.get(name, default)
    if not _finite(value) or not least <= value <= most:
        raise RequestError(f"{name} is {value!r}; it must be a number from {least:g} to {most:g}")
    return float(value)


def choice(asked: dict[str, Any], name: str, allowed: tuple[str, ...]) -> str:
    """One of the allowed words; the first of them if the request has none."""
    value = asked.get(name, allowed[0])
    if value not in allowed:
        raise RequestError(f"{name} is {value!r}; it must be one of {', '.join(allowed)}")
    return str(value)


def yes_or_no(asked: dict[str, Any], name: str, default: bool) -> bool:
    """True or false."""
    value = asked.get(name, default)
    if not isinstance(value, bool):
        raise RequestError(f"{name} is {value!r}; it must be true or false")
    return value


def _finite(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


@lru_cache(maxsize=64)
def pose_of(six: tuple[float, ...]) -> Pose:
    """The pose of coordinates in m and degrees."""
    return pose_at(six)


def box(asked: dict[str, Any]) -> tuple[Array, Array]:
    """Low and high of the six coordinates of a pose box, m and degrees."""
    given = asked.get("box")
    if not isinstance(given, dict):
        raise RequestError("box must have low and high, six numbers each")
    low, high = (np.array(numbers(given.get(side), f"box.{side}", 6)) for side in ("low", "high"))
    for i in np.flatnonzero(low > high):
        raise RequestError(f"the box of {AXES[i]} runs from {low[i]:g} to {high[i]:g}; low must not exceed high")
    return low, high
