"""A certificate: what was proved of a design over a region, between which numbers, and what is left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from flexapod.conventions import TWO_PI, Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.strays import Stray, strayed
from flexapod.showing import in_notebooks
from flexapod.workspace.box import Box
from flexapod.workspace.proof import Boxes, Place

Claim = Literal["index", "regular", "condition", "limits"]
Status = Literal["proved", "refuted", "undecided"]
CLAIMS: tuple[Claim, ...] = get_args(Claim)
_TINY = 1e-6  # share of a region's width below which a box is at the end of what can be told
STATUSES: tuple[Status, ...] = get_args(Status)


@in_notebooks
@dataclass(frozen=True, eq=False, repr=False)
class Certificate:
    """What is proved of a design at every pose of a region, as `certify` and its like give it.

    Parameters
    ----------
    claim : {"index", "regular", "condition", "limits"}
        What it is about: the stability index, that no pose is singular, cond(H), or the design's limits.
    status : {"proved", "refuted", "undecided"}
        "refuted" with `pose`, one that breaks the claim; "undecided" where the time was up, with the parts that are
        `left`.
    hexapod : Hexapod
        The design that was computed: of an uncertain one, its worst.
    joint : {"universal", "spin_free"}
        Joint model.
    place : Boxes or PathPieces
        The region in numbers: boxes (n, 6, 2) of least and largest x, y, z (m), roll, pitch, yaw (rad), or a path.
    wanted : float or None
        What was to be proved: the index, rad/s, or cond(H); None where the closest bound was.
    gap : float
        How close the bound was to come to what a pose has, as a share of that.
    within_limits : bool
        Whether only poses within the design's limits count.
    assumed : tuple of str
        What is uncertain about the design, in words.
    nominal : str
        Digest of the design as it is, where something is uncertain; else that of `hexapod`.
    strays : tuple of Stray
        Places of the design that may lie anywhere in a range, each by a variable from -1 to 1; `hexapod` is in the
        middle.
    payload : tuple of float
        Mass (kg) and place (m) of a load on the platform beside that of `hexapod`, (4,); none where nothing strays.
    strayed : tuple of float
        The values of these variables in the design that is the most adverse known at `pose`; none where all are 0.
    lower, upper : float
        Between which the extreme of the region lies: the least index, rad/s (`lower` is proved at all poses, `upper` is
        that of `pose`), or the greatest cond(H) (`upper` is proved, `lower` is that of `pose`). NaN where not known.
    pose : ndarray, shape (6,), or None
        The most adverse pose known: x, y, z (m), roll, pitch, yaw (rad). Of a refuted claim, one that breaks it.
    broken : str
        The limit that `pose` breaks, in words, where limits are refuted; the stiffness law whose range it leaves, where
        it has no index.
    level : float
        What is proved everywhere but in the parts that are `left`, rad/s or cond(H).
    left : ndarray, shape (m, 6, 2) or (m, 3)
        The parts that are not decided: boxes, or pieces of a path with the ends of their parameter, s.
    share_left, share_outside : float
        Shares of the volume (of a path, of its time) that are not decided, and that are beyond the limits.
    boxes : int
        Number of boxes, or pieces of a path, that were looked at.
    seconds : float
        How long the proof took, s.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.certify(machine, fx.Box.about(fx.home_pose(machine), 0.05, 0.05), at_least=25.0)
    >>> found.status, found.lower
    ('proved', 25.0)
    """

    claim: Claim
    status: Status
    hexapod: Hexapod
    joint: JointModel
    place: Place
    wanted: float | None
    gap: float
    within_limits: bool
    assumed: tuple[str, ...]
    nominal: str
    strays: tuple[Stray, ...]
    payload: tuple[float, ...]
    strayed: tuple[float, ...]
    lower: float
    upper: float
    pose: Array | None
    broken: str
    level: float
    left: Array
    share_left: float
    share_outside: float
    boxes: int
    seconds: float

    @property
    def proved(self) -> bool:
        """Whether the claim holds at every pose of the region."""
        return self.status == "proved"

    @property
    def adverse(self) -> Hexapod:
        """The design, of all that the certificate is about, that has the most adverse value known, at `pose`."""
        return strayed(self.hexapod, self.strays, self.strayed, self.payload)

    @property
    def on_path(self) -> bool:
        """Whether the region is a path."""
        return not isinstance(self.place, Boxes)

    @property
    def reached(self) -> float:
        """How close the bounds are, as a share of the larger; NaN where one is not known."""
        return 1.0 - self.lower / self.upper if self.upper > 0 else float("nan")

    @property
    def region(self) -> list[Box]:
        """The boxes of the region; none for a path."""
        return [Box(*part) for part in self.place.parts] if isinstance(self.place, Boxes) else []

    @property
    def stuck(self) -> Array | None:
        """The middle (6,) of a box that was cut down to rounding and is not decided: at the bound, or singular."""
        if self.on_path or not len(self.left):
            return None
        whole = np.ptp(self.place.parts, axis=(0, 2))
        small = (np.ptp(self.left, axis=2) <= _TINY * whole).all(axis=1)
        return np.asarray(self.left[int(small.argmax())].mean(axis=1)) if small.any() else None

    @property
    def words(self) -> str:
        """The claim and what became of it, as a sentence."""
        return f"{self._claimed()}: {self.status}{self._why()}."

    def _where(self) -> str:
        if not isinstance(self.place, Boxes):
            where = "the path"
        else:
            kind = "box" if np.ptp(self.place.parts, axis=2).any() else "pose"
            count = len(self.place.parts)
            where = f"the {kind}" if count == 1 else f"the {count} {'boxes' if kind == 'box' else 'poses'}"
        return f"{where} within the limits" if self.within_limits else where

    def _claimed(self) -> str:
        where, bound = self._where(), self.wanted
        everywhere = f"at {where}" if where.startswith("the pose") else f"at every pose of {where}"
        if self.claim == "regular":
            return f"{where.capitalize()} is not singular" if where == "the pose" else f"No pose of {where} is singular"
        if self.claim == "limits":
            return f"The limits are kept {everywhere}"
        if self.claim == "index":
            bound = self.lower if bound is None else bound
            if not bound > 0:
                return f"The index has a bound above zero {everywhere}"
            return f"The index is at least {bound:.6g} rad/s ({bound / TWO_PI:.5g} Hz) {everywhere}"
        bound = self.upper if bound is None else bound
        return f"cond(H) is at most {bound:.6g} {everywhere}"

    def _why(self) -> str:
        if self.status == "undecided":
            return f", {self.share_left:.2%} of it is left"
        if self.status == "proved" or self.pose is None:
            return ""
        if self.claim == "limits":
            return f", a pose breaks the limit of the {self.broken}"
        if self.broken:
            return f", a pose is outside the range of the {self.broken}"
        if self.claim == "condition":
            return f", a pose has {self.lower:.6g}"
        return ", a pose is singular" if np.isnan(self.upper) else f", a pose has {self.upper:.6g} rad/s"

    def __repr__(self) -> str:
        return f"<Certificate of {self.hexapod.name}: {self.words}>"
