"""Bounds that are proved at every pose of some boxes, or all along a path: the compiled prover, called in turns.

Between turns a proof can be stopped, stored and shared out, because a turn gives back the parts that are left.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from flexapod import _core
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.strays import Stray, rows_of
from flexapod.mechanics.inputs import as_joint
from flexapod.pose import Pose
from flexapod.workspace.quantities import kernel_limits

TURN = 2.0  # s: how long a stop waits at the most
RUNGS = (
    0.5,
    0.2,
    0.05,
)  # gaps that are proved first where the time is limited: each takes several times the one before
FINE = 0.7  # the ratio of such gaps where a design's numbers stray
CUT = 0.5  # where boxes are cut


@dataclass(frozen=True)
class Boxes:
    """Boxes (n, 6, 2): least and largest x, y, z (m), roll, pitch, yaw (rad)."""

    parts: Array

    def prove(self, *given: Any, parts: Array, level: float, options: Any, progress: Any) -> Any:
        design, joint, kind = given
        return _core.certify(design, joint, parts, kind, level, options, progress)

    def volume(self, parts: Array) -> float:
        """Of some parts, in what is only for comparing them: coordinates that nowhere vary do not count."""
        whole = np.ptp(self.parts, axis=2).max(axis=0)
        width = parts[:, whole > 0, 1] - parts[:, whole > 0, 0]
        return float((width / whole[whole > 0]).prod(axis=1).sum())

    def split(self, parts: Array, count: int) -> Array:
        """At least so many parts that cover the same: the largest are halved where they are widest."""
        whole = np.ptp(self.parts, axis=(0, 2))
        scale = np.where(whole > 0, whole, 1.0)
        while 0 < len(parts) < count:
            width = (parts[:, :, 1] - parts[:, :, 0]) / scale
            if not width.max() > 0:
                break
            axis = width.argmax(axis=1)
            rows = np.arange(len(parts))
            middle = parts[rows, axis].mean(axis=1)
            lower, upper = parts.copy(), parts.copy()
            lower[rows, axis, 1] = upper[rows, axis, 0] = middle
            parts = np.concatenate([lower, upper[width.max(axis=1) > 0]])
        return parts


@dataclass(frozen=True)
class PathPieces:
    """A path in pieces (n, 6, k + 1): coefficients of position (m) and rotation vector (rad), lowest power first.

    The rotation vector turns `middle` (3, 3) about the base's axes. parts (m, 3): a piece's number, and the least and
    largest value of its parameter, s from its beginning.
    """

    pieces: Array
    middle: Array
    parts: Array

    def prove(self, *given: Any, parts: Array, level: float, options: Any, progress: Any) -> Any:
        design, joint, kind = given
        return _core.certify_path(design, joint, self.pieces, self.middle, parts, kind, level, options, progress)

    def volume(self, parts: Array) -> float:
        """Of some parts, s."""
        return float((parts[:, 2] - parts[:, 1]).sum())

    def split(self, parts: Array, count: int) -> Array:
        """A path is never shared out: it takes milliseconds."""
        return parts


Place: TypeAlias = Boxes | PathPieces


class Turn(NamedTuple):
    """What a turn of the prover found. proved, outside: shares of the parts that it was given."""

    status: str
    level: float
    value: float
    at: Array
    broken: int
    leg: int
    left: Array
    proved: float
    outside: float
    boxes: int
    seconds: float
    gave_up: bool


@dataclass(frozen=True)
class Prover:
    """What is to be proved of a design, and where. kind: a name of `_core.CertificateKind`.

    limits: whether the design's limits are what is proved, or what poses must be within to count. only_law: of these,
    the range of a stiffness law alone. strays: what may lie anywhere in a range. payload: where something strays, mass
    (kg) and place (m) of a load beside the design's, (4,), or nothing.
    """

    hexapod: Hexapod
    joint: JointModel
    kind: str
    place: Place
    limits: bool = False
    only_law: bool = False
    strays: tuple[Stray, ...] = ()
    payload: tuple[float, ...] = ()
    cut: float = CUT
    threads: int = 1

    def turn(
        self, parts: Array, level: float, gap: float, seconds: float, progress: Callable[[float], object] | None
    ) -> Turn:
        """One turn over some parts, for so many seconds."""
        options = _core.CertificateOptions(
            gap=gap,
            limits=kernel_limits(self.hexapod, self.only_law) if self.limits else None,
            seconds=seconds,
            max_boxes=np.inf,
            threads=self.threads,
            cut=self.cut,
            strays=rows_of(self.strays),
            payload=np.array(self.payload or np.zeros(4)),
            home=np.zeros(0) if self.hexapod.home is None else self.hexapod.home.packed,
        )
        found = self.place.prove(
            self.hexapod.packed,
            as_joint(self.joint),
            _core.CertificateKind[self.kind],
            parts=np.ascontiguousarray(parts),
            level=level,
            options=options,
            progress=progress,
        )
        return Turn(
            status=found.status.name,
            level=found.level,
            value=found.value,
            at=found.at,
            broken=found.broken,
            leg=found.leg,
            left=found.remaining,
            proved=found.proved,
            outside=found.outside,
            boxes=int(found.boxes),
            seconds=found.seconds,
            gave_up=found.seconds < seconds,
        )


def together(prover: Prover, found: list[Turn | None], shares: list[Array]) -> Turn:
    """One turn from those of shares of its parts; None stands for a share whose turn was lost."""
    whole = sum(map(prover.place.volume, shares))
    volumes = [prover.place.volume(share) / whole if whole > 0 else 1 / len(shares) for share in shares]
    done = [(turn, volume) for turn, volume in zip(found, volumes, strict=True) if turn is not None]
    left = [share if turn is None else turn.left for turn, share in zip(found, shares, strict=True)]
    turns = [turn for turn, _ in done]
    if not turns:
        nothing = np.full(12, np.nan)
        return Turn("undecided", np.nan, np.nan, nothing, -1, -1, np.concatenate(left), 0, 0, 0, 0, False)
    worst = turns[0]
    for turn in turns[1:]:
        if worst.status != "refuted" and (turn.status == "refuted" or worse(prover.kind, turn.value, worst.value)):
            worst = turn
    levels = [turn.level for turn in turns if np.isfinite(turn.level)]
    level = (max if prover.kind == "condition" else min)(levels, default=np.nan)
    every = len(turns) == len(found) and all(turn.status == "proved" for turn in turns)
    return Turn(
        status="refuted" if worst.status == "refuted" else "proved" if every else "undecided",
        level=level,
        value=worst.value,
        at=worst.at,
        broken=worst.broken,
        leg=worst.leg,
        left=np.concatenate(left),
        proved=sum(turn.proved * volume for turn, volume in done),
        outside=sum(turn.outside * volume for turn, volume in done),
        boxes=sum(turn.boxes for turn in turns),
        seconds=max(turn.seconds for turn in turns),
        gave_up=len(turns) == len(found) and all(turn.gave_up for turn in turns),
    )


@dataclass(frozen=True, eq=False)
class Standing:
    """How far a proof is.

    level: what is proved everywhere but in the parts `left`. floor: what is proved everywhere; NaN for nothing. value,
    at: the most adverse value that a pose was found to have, and the pose (12,), position and matrix; NaN where none is
    known. strayed: of the strays, from -1 to 1, in the design that has that value; none: all are 0. decided, outside:
    shares of the whole.
    """

    status: str
    level: float
    value: float
    left: Array
    floor: float = np.nan
    at: Array = field(default_factory=lambda: np.full(12, np.nan))
    strayed: tuple[float, ...] = ()
    broken: int = -1
    leg: int = -1
    decided: float = 0.0
    outside: float = 0.0
    boxes: int = 0
    seconds: float = 0.0


@dataclass(frozen=True)
class Watch:
    """What stands beside a proof: who is told, when it ends, and who takes its turns.

    progress: called with the share that is decided. keep: called with the standing after each turn. stop: whether to
    end. until: when to, on the clock of `time.monotonic`. most: after how many boxes. take: see `Prover.turn`, for
    several computers.
    """

    progress: Callable[[float], object] | None = None
    keep: Callable[[Standing], object] | None = None
    stop: Callable[[], bool] = lambda: False
    until: float = np.inf
    most: float = np.inf
    take: Callable[..., Turn] | None = None

    @property
    def over(self) -> bool:
        """Whether a proof is to end."""
        return self.stop() or time.monotonic() >= self.until


def run(prover: Prover, standing: Standing, gap: float, watch: Watch) -> Standing:
    """Go on with a proof until it is decided, the prover gives up, or the watch ends it.

    gap: 0 where the standing's level is to be proved; above 0 the level is (1 - gap) times the least value, for cond(H)
    (1 + gap) times the greatest.
    """
    while len(standing.left) and standing.boxes < watch.most and not watch.over:
        standing, gave_up = _after_turn(prover, standing, gap, watch)
        if watch.keep is not None:
            watch.keep(standing)
        if standing.status == "refuted" or gave_up:
            break
    if len(standing.left) or standing.status == "refuted":
        return standing
    return replace(standing, status="proved", floor=standing.level, decided=1.0)


def _after_turn(prover: Prover, standing: Standing, gap: float, watch: Watch) -> tuple[Standing, bool]:
    rest = 1.0 - standing.decided

    def told(share: float) -> None:
        if watch.progress is not None:
            watch.progress(min(1.0, standing.decided + rest * share))

    seconds = float(min(TURN, watch.until - time.monotonic()))
    level = standing.value if gap > 0 else standing.level
    take = watch.take or (lambda prover, *given: prover.turn(*given))
    turn = take(prover, standing.left, level, gap, max(seconds, 1e-3), told)
    value, at, strayed = standing.value, standing.at, standing.strayed
    if worse(prover.kind, turn.value, value) or turn.status == "refuted":
        value, at, strayed = turn.value, turn.at, ()
    told(min(1.0, turn.proved + turn.outside))
    return replace(
        standing,
        status=turn.status,
        level=turn.level if gap > 0 and np.isfinite(turn.level) else standing.level,
        value=value,
        at=at,
        strayed=strayed,
        broken=turn.broken,
        leg=turn.leg,
        left=turn.left,
        decided=min(1.0, standing.decided + rest * (turn.proved + turn.outside)),
        outside=standing.outside + rest * turn.outside,
        boxes=standing.boxes + turn.boxes,
        seconds=standing.seconds + turn.seconds,
    ), turn.gave_up


def worse(kind: str, value: float, than: float) -> bool:
    """Whether a value is more adverse than another, or the other is not known."""
    if np.isnan(value):
        return False
    return bool(np.isnan(than) or (value > than if kind == "condition" else value < than))


def closest(prover: Prover, standing: Standing, gap: float, watch: Watch) -> Standing:
    """The closest bound of all parts that the time allows: its `floor`.

    Where the time is limited, or what strays may leave no narrow gap, wide ones are proved first, each over all parts.
    """
    rungs = RUNGS if not prover.strays else tuple(FINE ** np.arange(1, 40))
    rungs = tuple(rung for rung in rungs if rung > (2 if not prover.strays else 1) * gap)
    rungs = tuple(rung for rung in rungs if not _reached(prover.kind, standing, rung))
    for rung in (*(rungs if np.isfinite(watch.until) or prover.strays else ()), gap):
        anew = replace(standing, status="undecided", left=prover.place.parts, decided=0.0, outside=0.0)
        standing = run(prover, anew, rung, watch)
        if standing.status != "proved":
            break
    return standing


def _reached(kind: str, standing: Standing, gap: float) -> bool:
    """Whether what is proved is as close as a gap already."""
    aim = standing.value * (1 + gap if kind == "condition" else 1 - gap)
    return not np.isnan(standing.floor) and not worse(kind, standing.floor, aim)


def six_of(at: Array, boxes: Array) -> Array:
    """x, y, z, roll, pitch, yaw of a pose (12,), position and matrix, as the boxes (n, 6, 2) have them."""
    six = np.concatenate([at[:3], Pose(at[:3], at[3:].reshape(3, 3)).rpy])
    flipped = six + np.array([0, 0, 0, np.pi, np.pi - 2 * six[4], np.pi])
    middle, half = boxes.mean(axis=2), np.ptp(boxes, axis=2) / 2
    every = []
    for angles in (six, flipped):
        turns = np.round((middle - angles) / (2 * np.pi)) * np.repeat([0.0, 1.0], 3)
        every.append(angles + 2 * np.pi * turns)
    poses = np.concatenate(every)
    beyond = np.maximum(np.abs(poses - np.tile(middle, (2, 1))) - np.tile(half, (2, 1)), 0.0).max(axis=1)
    nearest = int(beyond.argmin())
    inside = np.clip(poses[nearest], *boxes[nearest % len(boxes)].T)
    return np.asarray(inside if beyond[nearest] < 1e-9 else poses[nearest])
