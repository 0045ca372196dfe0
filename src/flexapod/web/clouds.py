"""Many poses for the page: the cloud of a pose box, a slice through it, and its worst pose, as float32 points."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import numpy as np

import flexapod as fx
from flexapod.pose import Pose
from flexapod.web import asking
from flexapod.web.encode import float32

CHUNK = 20_000  #: poses between two messages of progress
MOST_POINTS = 5_000_000  #: what a page's memory takes with ease: 8 numbers of 4 bytes each

Message = tuple[dict[str, Any], bytes]


def cloud(spec: dict[str, Any]) -> Iterator[Message]:
    """Poses drawn in a box, with index and cond(H): rows x y z roll pitch yaw (m, degrees), omega_1, cond(H)."""
    question, (low, high) = asking.question(spec), box_of(spec)
    count = int(asking.number(spec, "points", 100_000, 1, MOST_POINTS))
    random = np.random.default_rng(int(asking.number(spec, "seed", 0, 0, 2**31)))
    began = time.perf_counter()
    for start in range(0, count, CHUNK):
        six = random.uniform(low, high, (min(CHUNK, count - start), 6)).astype("f4").astype(float)
        rows = np.concatenate([six, _quantities(question, six)], axis=1)
        yield _progress("points", start + len(rows), count, began), float32(rows)


def slice_map(spec: dict[str, Any]) -> Iterator[Message]:
    """Index, cond(H) and whether limits hold over a grid of two coordinates, the other four as the pose has them."""
    question, (low, high) = asking.question(spec), box_of(spec)
    across = asking.COORDINATES.index(asking.choice(spec, "across", asking.COORDINATES))
    up = asking.COORDINATES.index(asking.choice(spec, "up", asking.COORDINATES))
    if across == up:
        raise asking.AskingError("the two coordinates of a slice must differ; choose another one")
    side = int(asking.number(spec, "side", 120, 2, 1000))
    xs, ys = np.linspace(low[across], high[across], side), np.linspace(low[up], high[up], side)
    began = time.perf_counter()
    lines = max(1, CHUNK // side)
    for first in range(0, side, lines):
        part = ys[first : first + lines]
        six = np.tile(question.six, (len(part) * side, 1))
        six[:, across], six[:, up] = np.tile(xs, len(part)), np.repeat(part, side)
        values = np.concatenate([_quantities(question, six), _within(question, six)], axis=1)
        yield _progress("rows", first + len(part), side, began), float32(values)


def worst(spec: dict[str, Any]) -> Iterator[Message]:
    """The pose of the lowest index in the box, refined from the sweep's worst ones."""
    raise NotImplementedError


def box_of(spec: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Low and high of the six coordinates, m and degrees."""
    box = spec.get("box")
    if not isinstance(box, dict):
        raise asking.AskingError("box must have low and high, six numbers each")
    low, high = (np.array(asking.numbers(box.get(side), f"box.{side}", 6)) for side in ("low", "high"))
    for i in np.flatnonzero(low > high):
        raise asking.AskingError(
            f"the box of {asking.COORDINATES[i]} runs from {low[i]:g} to {high[i]:g}; the first must not be the larger"
        )
    return low, high


def _poses(six: np.ndarray) -> Pose:
    return Pose.from_rpy(*six[:, :3].T, *np.radians(six[:, 3:]).T)


def _quantities(question: asking.Question, six: np.ndarray) -> np.ndarray:
    """Index (rad/s) and cond(H) of many poses, (n, 2)."""
    poses = _poses(six)
    index = fx.stability_index(question.hexapod, poses, question.joint)
    return np.stack([index, fx.condition_number(question.hexapod, poses)], axis=1)


def _within(question: asking.Question, six: np.ndarray) -> np.ndarray:
    return fx.check_limits(question.hexapod, _poses(six)).ok[:, None]


def _progress(kind: str, done: int, total: int, began: float) -> dict[str, Any]:
    return {"type": kind, "done": done, "total": total, "seconds": time.perf_counter() - began}
