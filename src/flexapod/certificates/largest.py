"""The largest box of a shape for which a bound on the stability index holds, proved."""

from __future__ import annotations

import time
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flexapod.certificates import largest_file
from flexapod.certificates.certificate import Certificate
from flexapod.certificates.index import prove_index
from flexapod.certificates.known import Known, least_index, least_of_corners
from flexapod.certificates.largest_file import Progress
from flexapod.certificates.proving import Setup
from flexapod.certificates.question import Uncertainty, question
from flexapod.checks import number, positive, stop_asked, thread_count
from flexapod.conventions import Array, JointModel
from flexapod.design.hexapod import Hexapod
from flexapod.design.strays import data_of
from flexapod.errors import ArgumentError, PoseError
from flexapod.mechanics.inputs import as_hexapod, as_joint
from flexapod.output_files import check_file, output_path
from flexapod.progress import ProgressLike, with_progress
from flexapod.showing import in_notebooks
from flexapod.workspace.box import Box, Workspace
from flexapod.workspace.region import as_region, home_of

_GREATEST = 2.0**12  # of a scale that is tried
_LEAST = 2.0**-20  # of the first scale that is tried
_TURN = 2 * np.pi  # widest range of an angle that is tried, rad
_FINEST = 1e-9  # tolerance of the scale: what is finer takes more than anyone waits for, or is less than rounding
_GAP = 0.01  # what a certificate says where a bound is asked for
MOST_BOXES = 1e6  #: of the proof for one size, where no time is given


@in_notebooks
class CertifiedBox(NamedTuple):
    """The largest box of a shape for which a bound is proved, as `certified_box` gives it.

    Attributes
    ----------
    box : Box
        The box.
    scale : float
        Its widths as a share of those of the shape.
    certificate : Certificate
        The proof for it.
    refuted : float
        The least scale at which a pose below the bound was found: no larger box can be proved. Infinity if none was.
    pose : ndarray, shape (6,), or None
        That pose: x, y, z (m), roll, pitch, yaw (rad).
    given_up : float
        The least scale that was tried and given up, undecided. Infinity if none was.
    """

    box: Box
    scale: float
    certificate: Certificate
    refuted: float
    pose: Array | None
    given_up: float


@with_progress("largest certified box")
def certified_box(
    hexapod: Hexapod,
    box: Box | Workspace,
    at_least: float,
    *,
    tolerance: float = 0.01,
    joint: JointModel = "universal",
    within_limits: bool = False,
    uncertain: Uncertainty = (),
    time_limit: float | None = None,
    threads: int | None = None,
    path: str | PathLike[str] | None = None,
    resume: bool = False,
    progress: ProgressLike = None,
    stop: Callable[[], bool] | None = None,
) -> CertifiedBox:
    """Find the largest box of a shape for which a bound on the stability index is proved.

    Parameters
    ----------
    hexapod : Hexapod
        The machine.
    box : Box or Workspace
        Its widths are scaled together, about its middle.
    at_least : float
        The bound, rad/s.
    tolerance : float, optional
        How far the scale may be from the one at which a pose below the bound is known, as a share of that: at least
        1e-9, and less than 1.
    joint : {"universal", "spin_free"}, optional
        Joint model.
    within_limits, uncertain : optional
        As for `certify`.
    time_limit : float, optional
        How long to try, s; then the largest box that is proved is given. Left out, each size is tried by at most a
        million boxes, which is minutes of two processors.
    threads : int, optional
        Number of threads, default one for each core.
    path : str or path-like, optional
        File that keeps how far the search is; beside it, the certificate in hand is written every minute.
    resume : bool, optional
        Whether to go on with what is in the file.
    progress : callable or False, optional
        Called with the share of the volume of the box in hand that is decided, from 0 to 1.
        By default a bar is shown in terminals and notebooks, once a second has passed; False: none.
    stop : callable, optional
        Called often; when it returns True, the search ends with what it has.

    Returns
    -------
    CertifiedBox
        The box with its certificate, and the scale at which the bound is refuted.

    Raises
    ------
    DesignError
        If `hexapod` is not a Hexapod.
    ArgumentError
        If the middle of the box has less than the bound, nothing was proved in the time, or an argument is invalid.
    PoseError
        If no pose can be computed.
    OutputError
        If the file cannot be written, or cannot be gone on with.

    See Also
    --------
    certify : The proof for one box.

    Notes
    -----
    Bisection: what is proved of a box holds for every smaller one in it. The scale at which poses are below the bound
    is found first, by descents; then boxes below that size are proved, the largest first. One that is not decided in
    half of the time that is left, or without a limit of time by a million boxes, counts as too large (`given_up`): near
    a singular pose a proof may need more than anyone waits for. A search that is gone on with tries such sizes again.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> found = fx.certified_box(machine, fx.Workspace.about_home(0.05, 0.05), 28.0, tolerance=0.1)
    >>> found.certificate.status, found.scale < found.refuted
    ('proved', True)
    """
    as_hexapod(hexapod)
    as_joint(joint)
    tolerance = number(tolerance, "tolerance")
    if not _FINEST <= tolerance < 1:
        raise ArgumentError(f"tolerance is {tolerance:.6g}; it must be at least {_FINEST:g} and less than 1.")
    until = np.inf if time_limit is None else time.monotonic() + positive(time_limit, "time_limit", "s")
    given = {"joint": joint, "uncertain": uncertain, "within_limits": within_limits}
    search = _Search(hexapod, box, positive(at_least, "at_least", "rad/s"), given, thread_count(threads))
    keeper = _Keeper.of(search, tolerance, path, resume)
    stop = stop_asked(stop)
    watch = {"threads": threads, "progress": progress or None, "stop": stop}
    at = keeper.at
    first = high = min(at.refuted, search.greatest)
    given_up = float("inf")
    while max(at.low, _LEAST * first) < high * (1 - tolerance) and time.monotonic() < until and not stop():
        left = None if time_limit is None else max(1e-3, (until - time.monotonic()) / 2)
        certificate = search.prove(at.scale, {"time_limit": left, **watch, **keeper.watch})
        if stop() and certificate.status == "undecided":
            break
        if certificate.proved:
            at.low, at.found = at.scale, certificate
        else:
            high = at.scale
        if certificate.status == "refuted":
            at.refuted, at.pose = at.scale, certificate.pose
        elif not certificate.proved:
            given_up = at.scale
        at.scale = (at.low + high) / 2
        keeper.keep()
    if at.found is None:
        raise ArgumentError(search.nothing_proved(stop()))
    return CertifiedBox(search.box(at.low), at.low, at.found, at.refuted, at.pose, given_up)


class _Keeper:
    """How far a search is, and the file of it, if there is one."""

    def __init__(self, at: Progress, question: dict[str, Any], path: Path | None) -> None:
        self.at, self._question, self._path = at, question, path

    @classmethod
    def of(cls, search: _Search, tolerance: float, path: str | PathLike[str] | None, resume: bool) -> _Keeper:
        if path is None:
            if resume:
                raise ArgumentError("resume is True, but no path is given: what is to be gone on with? Give the file.")
            return cls(search.begun(tolerance), {}, None)
        place = check_file(output_path(path))
        question = {**search.question, "tolerance": tolerance}
        if resume and place.exists():
            return cls(largest_file.read(place, question), question, place)
        keeper = cls(search.begun(tolerance), question, place)
        largest_file.in_hand(place).unlink(missing_ok=True)
        keeper.keep()
        return keeper

    @property
    def watch(self) -> dict[str, Any]:
        """Where a certificate in hand is kept, and gone on with."""
        return {} if self._path is None else {"path": largest_file.in_hand(self._path), "resume": True}

    def keep(self) -> None:
        """After a box: the certificate that was in hand is done with."""
        if self._path is not None:
            largest_file.in_hand(self._path).unlink(missing_ok=True)
            largest_file.write(self._path, self._question, self.at)


class _Search:
    """Boxes of a shape by their scale."""

    def __init__(
        self,
        hexapod: Hexapod,
        shape: Box | Workspace,
        at_least: float,
        given: dict[str, Any],
        threads: int,
    ) -> None:
        where = as_region(shape)
        box = where.box(home_of(hexapod, where)) if isinstance(shape, Box | Workspace) else None
        if box is None:
            raise ArgumentError("box must be a Box or a Workspace with a range, which is made larger and smaller.")
        self._middle, self._half = (box.low + box.high) / 2, (box.high - box.low) / 2
        self._at_least, self._given = at_least, given
        self._hexapod, self._threads = hexapod, threads
        self.greatest = min(_GREATEST, _TURN / max(2 * float(self._half[3:].max()), _TURN / _GREATEST))

    @property
    def question(self) -> dict[str, Any]:
        """What is asked, as plain data."""
        asked = question(self._hexapod, self._middle, **self._given)
        return {
            "design": asked.hexapod.digest,
            "joint model": asked.joint,
            "shape": [self._middle.tolist(), self._half.tolist()],
            "bound": self._at_least,
            "within_limits": asked.within_limits,
            "uncertain places": [data_of(asked.strays), list(asked.payload)],
        }

    def begun(self, tolerance: float) -> Progress:
        """Where a search begins: nothing is proved."""
        refuted, pose = self.refuted(tolerance / 4)
        scale = min(refuted, self.greatest) * (1 - 0.8 * tolerance)
        return Progress(low=0.0, found=None, refuted=refuted, pose=pose, scale=scale)

    def box(self, scale: float) -> Box:
        half = scale * self._half
        return Box(*zip(self._middle - half, self._middle + half, strict=True))

    def refuted(self, tolerance: float) -> tuple[float, Array | None]:
        """About the least scale at which a pose below the bound is found, and the pose; infinity where none is."""
        if self._least(0.0)[0] < self._at_least:
            raise ArgumentError(
                f"the middle of the box has an index of {self._least(0.0)[0]:.6g} rad/s, less than the bound of "
                f"{self._at_least:.6g}: no box about it keeps that. Move the box, or give a lower bound."
            )
        near = self._refuted_by_corners(tolerance)
        if near is None:
            low, high = 0.0, min(1.0, self.greatest)
            while (found := self._least(high))[0] >= self._at_least:
                low, high = high, min(2 * high, self.greatest)
                if low >= self.greatest:
                    return float("inf"), None
        else:
            low, high = 0.0, (1 - tolerance) * near[0]
            found = self._least(high)
            if found[0] >= self._at_least:
                return near
        pose = found[1]
        while high - low > tolerance * high:
            middle = (low + high) / 2
            found = self._least(middle)
            if found[0] < self._at_least:
                high, pose = middle, found[1]
            else:
                low = middle
        return high, pose

    def _refuted_by_corners(self, tolerance: float) -> tuple[float, Array] | None:
        """About the least scale at which a corner is below the bound, and the corner: no search is needed for it."""
        low, high = 0.0, min(1.0, self.greatest)
        while (corner := self._corner(high)).value >= self._at_least:
            low, high = high, min(2 * high, self.greatest)
            if low >= self.greatest:
                return None
        while high - low > tolerance * high:
            middle = (low + high) / 2
            if (other := self._corner(middle)).value < self._at_least:
                high, corner = middle, other
            else:
                low = middle
        return high, corner.pose

    def _corner(self, scale: float) -> Known:
        box = self.box(scale)
        return least_of_corners(question(self._hexapod, box, **self._given), box, self._threads)

    def _least(self, scale: float) -> tuple[float, Array]:
        region = self.box(scale) if scale > 0 else self._middle
        try:
            found = least_index(question(self._hexapod, region, **self._given), self._threads)
        except PoseError:
            if scale > 0:
                return 0.0, self._middle
            raise
        return (0.0 if found.singular else found.value), found.pose

    def prove(self, scale: float, watch: dict[str, Any]) -> Certificate:
        """The certificate of the bound for a scale, or what came of it by `MOST_BOXES` where no time is given."""
        asked = question(self._hexapod, self.box(scale), **self._given)
        most = MOST_BOXES if watch["time_limit"] is None else np.inf
        return prove_index(asked, self._at_least, _GAP, Setup.of(**watch, most=most))

    def nothing_proved(self, stopped: bool) -> str:
        """What there is to say where no box was proved."""
        if stopped:
            return "no box of this shape was proved before the search ended. Give it more time."
        return (
            f"no box of this shape was proved to keep {self._at_least:.6g} rad/s; its middle has "
            f"{self._least(0.0)[0]:.6g} rad/s. Give a lower bound, or more time."
        )
