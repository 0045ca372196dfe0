"""Jobs over many poses: a cloud of random poses in a box, a slice through the box, and its worst pose."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from flexapod.checks import thread_count
from flexapod.conventions import AXES, Array
from flexapod.web import requests
from flexapod.web.answers import Message, Progress
from flexapod.web.encode import float32
from flexapod.web.geometry import in_degrees, in_radians
from flexapod.workspace.box import Box
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.sampling import random_poses

CHUNK = 50_000  #: poses between two messages: about 0.01 s
MOST_POINTS = 5_000_000  #: of a cloud, for the browser's memory: 36 bytes each


def cloud(spec: dict[str, Any]) -> Iterator[Message]:
    """Random poses in a box: rows of x, y, z, roll, pitch, yaw (m, degrees), index, cond(H), whether limits hold.

    A pose is rounded to float32 before the computation, so that its numbers belong to the pose that the page gets.
    """
    question, count = requests.question(spec), int(requests.number(spec, "points", 100_000, 1, MOST_POINTS))
    poses = random_poses(_box(spec), count, seed=int(requests.number(spec, "seed", 0, 0, 2**31)))
    began = time.perf_counter()
    for start in range(0, count, CHUNK):
        stop = min(start + CHUNK, count)
        six = poses.rows(start, stop)
        six[:, 3:] = np.degrees(six[:, 3:])
        six = six.astype("f4").astype(float)
        found = _quantities(question, six, ("omega_1", "cond_H", "within_limits"))
        yield _progress("points", stop, count, began), float32(np.concatenate([six, found], axis=1))


def slice_map(spec: dict[str, Any]) -> Iterator[Message]:
    """Stability index, cond(H) and whether limits hold, over a grid of two coordinates through the pose."""
    question, (low, high) = requests.question(spec), requests.box(spec)
    across = AXES.index(requests.choice(spec, "across", AXES))
    up = AXES.index(requests.choice(spec, "up", AXES))
    if across == up:
        raise requests.RequestError("the two coordinates of a slice must differ; choose another one")
    side = int(requests.number(spec, "side", 120, 2, 1000))
    xs, ys = np.linspace(low[across], high[across], side), np.linspace(low[up], high[up], side)
    began = time.perf_counter()
    lines = max(1, CHUNK // side)
    for first in range(0, side, lines):
        part = ys[first : first + lines]
        six = np.tile(question.six, (len(part) * side, 1))
        six[:, across], six[:, up] = np.tile(xs, len(part)), np.repeat(part, side)
        values = _quantities(question, six, ("omega_1", "cond_H", "within_limits"))
        yield _progress("rows", first + len(part), side, began), float32(values)


def worst(spec: dict[str, Any]) -> Iterator[Message]:
    """The pose of the lowest stability index in the box: of those within the limits, or by `all_poses` of all."""
    from flexapod.workspace.worst import worst_pose

    question = requests.question(spec)
    everywhere = requests.yes_or_no(spec, "all_poses", False)
    found = worst_pose(question.hexapod, _box(spec), joint=question.joint, all_poses=everywhere)
    what = "singular poses lie in the box; here the index is" if found.singular else "least index"
    edge = f"; on the box's edge in {', '.join(found.at_bounds)}" if found.at_bounds else ""
    limits = f"; at limits: {', '.join(found.at_limits)}" if found.at_limits else ""
    share = found.share_within_limits
    part = f"; {share:.3g} of the box is within the limits" if share < 1 else ""
    words = f"{what} {found.omega_1:.5g} rad/s, found by {found.agreed} of {found.starts} searches{edge}{limits}{part}"
    yield (
        {
            "type": "found",
            "pose": in_degrees(found.pose),
            "index": found.omega_1,
            "within": None if np.isnan(share) else share,
            "words": words[0].upper() + words[1:],
        },
        b"",
    )


def _box(spec: dict[str, Any]) -> Box:
    """The pose box of a request, in m and rad."""
    low, high = requests.box(spec)
    return Box(*zip(in_radians(low), in_radians(high), strict=True))


def _quantities(question: requests.Question, six: Array, names: tuple[str, ...]) -> Array:
    """Quantities of many poses (m, degrees), one column each, with half of the threads: other pages need some."""
    found = evaluate(question.hexapod, in_radians(six), names, question.joint, max(1, thread_count(None) // 2))
    return np.stack([np.asarray(found[name], dtype=float) for name in names], axis=1)


def _progress(kind: Literal["points", "rows"], done: int, total: int, began: float) -> Progress:
    return {"type": kind, "done": done, "total": total, "seconds": time.perf_counter() - began}
