"""What a designer reads off a sweep: the worst pose, quantiles, and how much of the workspace is good enough.

Everything is gathered block by block, so that a store larger than memory is no different from a sweep in memory.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flexapod import _core, checks
from flexapod.conventions import AXES, Array
from flexapod.errors import ArgumentError, PoseError
from flexapod.showing import in_notebooks
from flexapod.workspace.distribution import QUANTILES, binned, exactly
from flexapod.workspace.limit_margins import none_within
from flexapod.workspace.pose_sets import described
from flexapod.workspace.quantities import PENDING, statuses
from flexapod.workspace.store.blocks import Blocks, blocks

if TYPE_CHECKING:
    import xarray as xr

_IN_MEMORY = 2**20  # poses looked at together
_OF_SINGULAR = {"omega_1": 0.0, "cond_H": np.inf}  # what a sweep holds of them is rounding
EXACT = 2**22  # poses up to which all are sorted


class At(NamedTuple):
    """One pose of a sweep: its number, its coordinates (x, y, z m; roll, pitch, yaw rad), omega_1 rad/s and cond(H)."""

    number: int
    pose: Array
    omega_1: float
    cond_H: float


class Above(NamedTuple):
    """Part of the poses that count whose index is at least `omega_1` (rad/s), and the volume of the box it stands for.

    Poses that count are those within the design's limits, or all.
    """

    omega_1: float
    fraction: float
    standard_error: float
    volume: float
    volume_unit: str


@in_notebooks
class SweepSummary(NamedTuple):
    """What a sweep says of a workspace: extremes, quantiles, and the part that is good enough.

    Attributes
    ----------
    poses : int
        Number of poses. Those whose index is NaN count here and in `statuses` only.
    statuses : dict of str to int
        Number of poses by status.
    within_limits : int or None
        Number of poses within the design's limits; None if ``within_limits`` was not swept. Where it was, all that
        follows is of these poses, unless all are asked for.
    worst, best : At
        The poses with the least and the largest omega_1: `number`, `pose` (6,), `omega_1` (rad/s), `cond_H`.
    best_conditioned, worst_conditioned : At or None
        The poses with the least and the largest cond(H); None if it was not swept.
    quantiles : dict of float to float
        Quantiles of omega_1, rad/s, by share.
    above : Above or None
        The part of the poses that has a wanted index: `omega_1` (rad/s), `fraction`, `standard_error`, `volume` and
        `volume_unit`; None if no index is wanted.
    correlation : float
        Spearman's rank correlation of omega_1 with cond(H).
    spread : float
        Ratio of the 95 % quantile to the 5 % quantile of omega_1 in a band of equal cond(H): the median over all bands.
    """

    poses: int
    statuses: dict[str, int]
    within_limits: int | None
    worst: At
    best: At
    best_conditioned: At | None
    worst_conditioned: At | None
    quantiles: dict[float, float]
    above: Above | None
    correlation: float
    spread: float


def summarise(sweep: xr.Dataset, at_least: float | None = None, *, all_poses: bool = False) -> SweepSummary:
    """Summarise a sweep: worst and best poses, quantiles, and the part that is good enough.

    Parameters
    ----------
    sweep : xarray.Dataset
        A sweep in memory, or of `open_sweep`; it must hold ``omega_1``.
    at_least : float, optional
        A wanted index, rad/s, for `SweepSummary.above`.
    all_poses : bool, optional
        If True, poses beyond the design's limits count as well. If False (default), they do not where
        ``within_limits`` was swept.

    Returns
    -------
    SweepSummary
        The numbers.

    Raises
    ------
    ArgumentError
        If the sweep does not hold ``omega_1``.
    PoseError
        If no pose has an index, or none of those that have one is within the limits.

    See Also
    --------
    sweep : Makes what is summarised.
    worst_pose : The least index between the poses of a sweep as well.

    Notes
    -----
    Numbers as in Section 3 of [1]_. Up to 2^22 poses everything is exact. For more, quantiles are exact to the width of
    one of 65536 bins between the least and the largest value, and the correlation (Spearman, 1904) and the spread come
    from ranks in 1024 bands. Standard errors are those of random poses; the even ones of grids and low-discrepancy sets
    are better. Volumes are in the pose coordinates, m and rad.

    References
    ----------
    .. [1] P. Mukherjee, B. Dasgupta and A. K. Mallik, "Dynamic stability index and vibration analysis of a flexible
       Stewart platform", Journal of Sound and Vibration 307 (2007), 495-512.

    Examples
    --------
    >>> machine = fx.load("motion-base")
    >>> summary = fx.summarise(fx.sweep(machine, fx.Workspace.about_home(0.2, 0.1), samples=1024), at_least=150.0)
    >>> round(summary.quantiles[0.5], 1), round(summary.above.fraction, 2)
    (28.2, 0.0)
    """
    import xarray as xr

    checks.instance(sweep, xr.Dataset, "sweep", "as flexapod.sweep and flexapod.open_sweep give it")
    if "omega_1" not in sweep:
        raise ArgumentError("sweep does not hold omega_1, which a summary needs. Sweep it.")
    counted = Counted(sweep, all_poses)
    first = _extremes(counted)
    both = "cond_H" in sweep and first.usable > 1
    names = ("omega_1", "cond_H") if both else ("omega_1",)

    def usable() -> Iterator[list[Array]]:
        return (values for _, values in counted.columns(names))

    ends = [(first.value[name, "least"], first.value[name, "most"]) for name in names]
    spread_out = exactly(usable()) if first.usable <= EXACT else binned(usable, ends)
    return SweepSummary(
        poses=first.poses,
        statuses=first.statuses,
        within_limits=first.within_limits,
        worst=_at(sweep, first.place["omega_1", "least"]),
        best=_at(sweep, first.place["omega_1", "most"]),
        best_conditioned=_at(sweep, first.place["cond_H", "least"]) if both else None,
        worst_conditioned=_at(sweep, first.place["cond_H", "most"]) if both else None,
        quantiles=dict(zip(QUANTILES, spread_out.quantiles.tolist(), strict=True)),
        above=None if at_least is None else _above(counted, first, checks.number(at_least, "at_least", "rad/s")),
        correlation=spread_out.correlation,
        spread=spread_out.spread,
    )


class Counted:
    """The poses of a sweep that count: those with an index, and unless all are asked for, those within the limits."""

    def __init__(self, sweep: xr.Dataset, all_poses: bool) -> None:
        self.sweep, self.within = sweep, "within_limits" in sweep and not all_poses

    def columns(self, names: tuple[str, ...]) -> Iterator[tuple[np.ndarray, list[Array]]]:
        """Numbers of poses that count, and their columns of quantities (the first omega_1), block by block."""
        last = ("within_limits",) if self.within else ()
        for start, (status, *found) in columns(self.sweep, ("status", *names, *last)):
            good = np.isfinite(found[0])
            singular = status == _core.SweepStatus.singular.value
            if singular.any():
                for k, name in enumerate(names):
                    found[k] = np.where(singular, _OF_SINGULAR[name], found[k])
            if self.within:
                good &= np.asarray(found.pop(), dtype=bool)
            number = start + np.flatnonzero(good)
            yield number, (found if number.size == good.size else [column[good] for column in found])


class _Extremes(NamedTuple):
    poses: int
    usable: int
    statuses: dict[str, int]
    within_limits: int | None
    value: Mapping[tuple[str, str], float]
    place: Mapping[tuple[str, str], int]


def cut(sweep: xr.Dataset) -> Blocks:
    """The blocks in which a sweep is best read."""
    omega = sweep["omega_1"]
    chunk = omega.encoding.get("chunks")
    return blocks(omega.shape, _IN_MEMORY) if chunk is None else Blocks(omega.shape, tuple(chunk))


def columns(sweep: xr.Dataset, names: tuple[str, ...]) -> Iterator[tuple[int, list[Array]]]:
    """Number of the first pose, and columns of quantities, block by block."""
    dims = sweep["omega_1"].dims
    for block in cut(sweep):
        part = sweep.isel(dict(zip(dims, block.region, strict=True)))
        yield block.start, [np.asarray(part[name].values).ravel() for name in names]


def _extremes(counted: Counted) -> _Extremes:
    sweep = counted.sweep
    poses, with_index, statuses, within = _counts(sweep)
    names = tuple(name for name in ("omega_1", "cond_H") if name in sweep)
    value: dict[tuple[str, str], float] = {}
    place: dict[tuple[str, str], int] = {}
    usable = 0
    for number, found in counted.columns(names):
        usable += number.size
        if not number.size:
            continue
        for name, values in zip(names, found, strict=True):
            for end, sign in (("least", 1.0), ("most", -1.0)):
                k = int(np.argmin(sign * values))
                if (name, end) not in value or sign * values[k] < sign * value[name, end]:
                    value[name, end], place[name, end] = float(values[k]), int(number[k])
    if not usable:
        if with_index:
            raise none_within(poses)
        raise PoseError(f"none of the {poses} poses has an index. See the variable `status` for the reasons.")
    return _Extremes(poses, usable, statuses, within, value, place)


def _counts(sweep: xr.Dataset) -> tuple[int, int, dict[str, int], int | None]:
    """How many poses there are, how many have an index, how many by status, and how many are within the limits."""
    seen = np.zeros(256, dtype=np.int64)
    with_index = within = 0
    limited = ("within_limits",) if "within_limits" in sweep else ()
    for _, (status, omega, *inside) in columns(sweep, ("status", "omega_1", *limited)):
        seen += np.bincount(status, minlength=256)
        with_index += int(np.isfinite(omega).sum())
        within += sum(int(np.asarray(one, dtype=bool).sum()) for one in inside)
    words = statuses()
    return int(seen.sum()), with_index, {words[k]: int(n) for k, n in enumerate(seen) if n}, within if limited else None


def _at(sweep: xr.Dataset, number: int) -> At:
    omega = sweep["omega_1"]
    place = dict(zip(omega.dims, np.unravel_index(number, omega.shape), strict=True))
    one = sweep.isel(place)
    if all(name in one.coords for name in AXES):
        pose = np.array([float(one[name]) for name in AXES])
    else:
        points = described(json.loads(sweep.attrs["poses"]))
        pose = np.full(6, np.nan) if points is None else points.rows(number, number + 1)[0]
    cond = float(one["cond_H"]) if "cond_H" in one else np.nan
    if "status" in one and int(one["status"]) == _core.SweepStatus.singular.value:
        return At(number, pose, _OF_SINGULAR["omega_1"], _OF_SINGULAR["cond_H"] if "cond_H" in one else np.nan)
    return At(number, pose, float(one["omega_1"]), cond)


def _above(counted: Counted, extremes: _Extremes, wanted: float) -> Above:
    attrs = counted.sweep.attrs
    good = sum(int((values[0] >= wanted).sum()) for _, values in counted.columns(("omega_1",)))
    computed = extremes.poses - extremes.statuses.get(statuses()[PENDING], 0)
    whole = extremes.within_limits if counted.within and extremes.within_limits is not None else computed
    fraction = good / whole
    error = float(np.sqrt(fraction * (1 - fraction) / whole))
    volume = good / computed * attrs.get("box_volume", np.nan)
    return Above(wanted, fraction, error, volume, attrs.get("box_volume_unit", ""))
