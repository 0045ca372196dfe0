"""A contest: several tools do one task, have their results compared with Flexapod's, and take turns at the clock."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from statistics import median
from typing import Any, NamedTuple

from benchmarks._machine import missing, version

OURS = "Flexapod"


class Disagreement(Exception):
    """A tool does not compute what Flexapod does: its time means nothing."""


@dataclass
class Plan:
    """How much to do, and what was left out for want of a package. quick: only to see that everything works."""

    quick: bool
    absent: set[str] = field(default_factory=set)

    def has(self, *packages: str) -> bool:
        """Are these distributions installed? Those that are not are noted."""
        lacking = {package for package in packages if missing(package)}
        self.absent |= lacking
        return not lacking

    def size(self, full: float, quick: float) -> int:
        """A number of things to do."""
        return int(quick if self.quick else full)


class Contender(NamedTuple):
    """One tool at one task; the first of a contest is Flexapod, to which the others are compared.

    tool: its name, or "A + B". package: the distribution it comes from, for its version. how: what is measured.
    run: seconds for one unit of the task. error: difference of its result from Flexapod's, as the contest measures it;
    none where there is no result to compare. limit: the largest error that counts as agreement.
    """

    tool: str
    package: str
    how: str
    run: Callable[[], float]
    error: float | None = None
    limit: float = 0.0


class Contest(NamedTuple):
    """One task. unit: what one time is the time of ("a pose"). compared: what `error` of the contenders is. most_turns:
    where one takes long."""

    task: str
    unit: str
    compared: str
    contenders: list[Contender]
    most_turns: int = 100


@dataclass(frozen=True)
class Record:
    """What came of one contender: times of the turns, and their ratios to Flexapod's time of the same turn."""

    task: str
    unit: str
    tool: str
    version: str
    how: str
    compared: str
    error: float | None
    seconds: list[float]
    ratios: list[float]

    @property
    def time(self) -> float:
        return median(self.seconds)

    @property
    def ratio(self) -> float:
        return median(self.ratios)


def take_turns(contest: Contest, turns: int, done: Callable[[], object] = lambda: None) -> list[Record]:
    """Check the contenders, then time them one after the other, `turns` times. Raises Disagreement."""
    for c in contest.contenders:
        if c.error is not None and not c.error <= c.limit:
            raise Disagreement(
                f"{contest.task}: {c.tool} ({c.how}) is off by {c.error:.2g} in {contest.compared}; "
                f"at most {c.limit:g} counts as the same result"
            )
    gc.collect()
    seconds: list[list[float]] = []
    for _ in range(min(turns, contest.most_turns)):
        seconds.append([c.run() for c in contest.contenders])
        done()
    return [
        Record(
            contest.task,
            contest.unit,
            c.tool,
            version(c.package),
            c.how,
            contest.compared,
            c.error,
            [turn[i] for turn in seconds],
            [turn[i] / turn[0] for turn in seconds],
        )
        for i, c in enumerate(contest.contenders)
    ]


def cpu_seconds(call: Callable[[], Any], units: float = 1.0, repeats: int = 1) -> Callable[[], float]:
    """A `run` of a contender: processor time of this process for one unit, where a call does `units` of them.

    Processor time, so that what else the machine does is not counted; on one core it is the time that passes.
    """

    def run() -> float:
        began = time.process_time()
        for _ in range(repeats):
            call()
        return (time.process_time() - began) / (repeats * units)

    return run
