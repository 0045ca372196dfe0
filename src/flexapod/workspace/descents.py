"""Descents to the least stability index over a box, or over the part of it that is within the design's limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.errors import PoseError
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.box_minimum import apart, constrained_minimum, smooth_minimum
from flexapod.workspace.coordinates import AtCoordinates
from flexapod.workspace.limit_margins import LimitMargins
from flexapod.workspace.quantities import evaluate
from flexapod.workspace.sampling import low_discrepancy

_ENOUGH = 1024  # poses within the limits from which searches begin
_MOST = 2**19  # poses that are looked at for so many
_SOUGHT, _SOUGHT_FROM = 512, 12  # poses from whose nearest one within the limits is sought, where no sample is
_MARGIN = 1e-6  # by which that one is to be within them


class SquaredFrequency:
    """The square of one of the six natural frequencies at x, y, z, roll, pitch, yaw, (6,), with exact derivatives.

    highest: it is sought where it is highest, so that its negative is what a search lowers.
    """

    def __init__(self, hexapod: Hexapod, joint: JointModel, mode: int, *, highest: bool = False) -> None:
        self.hexapod, self.joint_name, self.mode = hexapod, joint, mode - 1
        self._at = AtCoordinates(hexapod, joint)
        self.sign = -1.0 if highest else 1.0
        self.scale = 1.0  # largest omega_6 met, rad/s

    def __call__(self, six: Array) -> tuple[float, Array]:
        """omega^2 and its derivatives by the coordinates; zero at a pose that no leg can take, which it falls to."""
        if not (np.isfinite(six).all() and self._at.taken(six)):
            return 0.0, np.zeros(6)
        omega, slope = (found[0] for found in self._at(six).frequencies())
        self.scale = max(self.scale, float(omega[-1]))
        return self.sign * float(omega[self.mode] ** 2), self.sign * slope[self.mode, self.mode]

    def swept(self, rows: Array, threads: int) -> Array:
        """The frequency at many poses, rad/s, with the sign of what a search lowers."""
        if self.mode == 0:
            omega = evaluate(self.hexapod, rows, ("omega_1",), self.joint_name, threads)["omega_1"]
        else:
            omega = evaluate(self.hexapod, rows, ("omega",), self.joint_name, threads)["omega"][:, self.mode]
        return self.sign * omega

    def root(self, six: Array) -> float:
        """The frequency itself, rad/s."""
        return float(np.sqrt(max(self.sign * self(six)[0], 0.0)))

    def gradient(self, six: Array) -> Array:
        """Of the frequency by the six coordinates; NaN where it is zero."""
        square, slope = self(six)
        return slope / (2 * np.sqrt(square)) if square > 0 else np.full(6, np.nan)


class Sample(NamedTuple):
    """Poses of a box that a search may start from, rows (n, 6), and their index (rad/s); the last are corners of it.

    share: the part of an even sample of the box that is within the limits.
    """

    rows: Array
    omega: Array
    corners: int
    share: float

    @property
    def least(self) -> float:
        """The least index of the even sample; of the corners where it has none."""
        even = self.omega[: len(self.omega) - self.corners]
        return float(np.nanmin(even if np.isfinite(even).any() else self.omega))


@dataclass(frozen=True)
class BoxSearch:
    """A search of a box for an extreme frequency; where limits are given, of the part that is within them."""

    index: SquaredFrequency
    box: Box
    limits: LimitMargins | None
    samples: int
    seed: int
    threads: int

    def sample(self) -> Sample:
        """A Sobol sequence and the corners of the box; where there are limits, those within them.

        Raises PoseError where no pose can be computed, or none within the limits is found.
        """
        rows = Workspace(self.box).rows(np.zeros(6), self.samples, self.seed)
        even, corners, share = rows[-self.samples :], rows[1 : -self.samples], 1.0
        if self.limits is not None:
            even, share = self._within(even)
            corners = corners[self._inside(corners)]
            if not len(even) + len(corners):
                even = self._sought(self.limits)[None]
        rows = np.concatenate([even, corners])
        omega = self.index.swept(rows, self.threads)
        if not np.isfinite(omega).any():
            raise PoseError(f"no pose of {self.box!r} could be computed. Look at the status of a sweep of it.")
        return Sample(rows, omega, len(corners), share)

    def descend(self, start: Array) -> Array:
        """Where a descent from a pose ends."""
        if self.limits is None:
            return smooth_minimum(self.index, start, self.box.low, self.box.high)
        return constrained_minimum(self.index, self.limits, start, self.box.low, self.box.high)

    def _inside(self, rows: Array) -> np.ndarray:
        index = self.index
        kernel, forces = (None, True) if self.limits is None else (self.limits.kernel, not self.limits.only_law)
        found = evaluate(index.hexapod, rows, ("within_limits",), index.joint_name, self.threads, kernel, forces=forces)
        return found["within_limits"]

    def _within(self, even: Array) -> tuple[Array, float]:
        """Those of an even sample that are within the limits, and of more where they are few; which part that is."""
        found, drawn = [even[self._inside(even)]], len(even)
        sequence = low_discrepancy(self.box, max(_MOST, drawn), seed=self.seed)
        while (count := sum(map(len, found))) < _ENOUGH and drawn < _MOST:
            more = sequence.rows(drawn, min(4 * drawn, _MOST))
            found.append(more[self._inside(more)])
            drawn += len(more)
        return np.concatenate(found), count / drawn

    def _sought(self, limits: LimitMargins) -> Array:
        """A pose within the limits, by descents on the squares of what they are exceeded by."""
        low, high = self.box.low, self.box.high

        def excess(six: Array) -> tuple[float, Array]:
            margin, slope = limits(six)
            short = np.minimum(margin - _MARGIN, 0.0)
            return float(short @ short), 2 * short @ slope

        rows = Workspace(self.box).rows(np.zeros(6), min(self.samples, _SOUGHT), self.seed)
        nearest = sorted(rows, key=lambda six: excess(six)[0])[:_SOUGHT_FROM]
        ends = sorted((smooth_minimum(excess, six, low, high) for six in nearest), key=lambda six: excess(six)[0])
        margin = limits(ends[0])[0]
        if margin.min() >= 0:
            return ends[0]
        raise PoseError(
            f"no pose of {self.box!r} is within the limits of {self.index.hexapod.name!r}: none of {_MOST} poses, and "
            f"descents from the nearest of them end beyond the {limits.names[int(np.argmin(margin))]}. Choose another "
            "box, or take poses beyond the limits as well (all_poses, on the command line --all-poses)."
        )


def starts_of(poses: Sample, box: Box, count: int) -> Array:
    """Poses to descend from: `count` low ones that lie apart, and every corner that no corner next to it undercuts."""
    corner = np.arange(len(poses.rows) - poses.corners, len(poses.rows))
    at, omega = poses.rows[corner], np.nan_to_num(poses.omega[corner], nan=np.inf)
    beside = (at[:, None] != at[None]).sum(axis=-1) == 1
    lowest = np.isfinite(omega) & (np.where(beside, omega, np.inf).min(axis=1, initial=np.inf) >= omega)
    chosen = [*corner[lowest], *_apart(poses, box, count)]
    return poses.rows[list(dict.fromkeys(map(int, chosen)))]


def _apart(poses: Sample, box: Box, count: int) -> list[int]:
    """The lowest poses that lie apart."""
    usable = np.flatnonzero(np.isfinite(poses.omega))
    lowest = usable[np.argsort(poses.omega[usable], kind="stable")]
    free = box.high > box.low
    chosen = apart((poses.rows[lowest] - box.low)[:, free] / (box.high - box.low)[free], count)
    return lowest[chosen].tolist()
