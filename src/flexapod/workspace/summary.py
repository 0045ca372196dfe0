"""What a designer reads off a sweep: the worst pose, quantiles, how much of the workspace is good enough.

Everything is gathered block by block, so that a store larger than memory is no different from a sweep in memory.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flexapod.conventions import AXES, Array
from flexapod.errors import PoseError
from flexapod.workspace.pose_sets import described
from flexapod.workspace.quantities import PENDING, statuses
from flexapod.workspace.store.blocks import Blocks, blocks

if TYPE_CHECKING:
    import xarray as xr

QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
_IN_MEMORY = 2**20  # poses looked at together
_EXACT = 2**22  # poses up to which all are sorted
_BINS = 2**16
_RANK_BINS = 2**10
_BANDS = 50


class At(NamedTuple):
    """One pose of a sweep: its number, its coordinates (x, y, z m; roll, pitch, yaw rad), omega_1 rad/s and cond(H)."""

    number: int
    pose: Array
    omega_1: float
    cond_H: float


class Above(NamedTuple):
    """Part of the poses whose index is at least `omega_1` (rad/s), and the volume of the box that this stands for."""

    omega_1: float
    fraction: float
    standard_error: float
    volume: float
    volume_unit: str


class SweepSummary(NamedTuple):
    """Numbers of a sweep. Poses whose index is NaN count in `statuses` only; cond(H) is NaN where it was not swept.

    poses: how many. statuses: poses by status. worst, best: least and largest omega_1. best_conditioned,
    worst_conditioned: least and largest cond(H). quantiles: of omega_1, rad/s. above: the part that has a wanted index,
    and its volume. correlation: Spearman's, of omega_1 with cond(H). spread: over bands of equal cond(H), the median of
    the ratio between the 95 % and 5 % quantiles of omega_1.

    Source: Section 3; the rank correlation is Spearman's (1904).
    """

    poses: int
    statuses: dict[str, int]
    worst: At
    best: At
    best_conditioned: At | None
    worst_conditioned: At | None
    quantiles: dict[float, float]
    above: Above | None
    correlation: float
    spread: float


def summarise(sweep: xr.Dataset, at_least: float | None = None) -> SweepSummary:
    """Summary of a sweep in memory or of `open_sweep`, which must hold `omega_1`. at_least: a wanted index, rad/s.

    Up to 2^22 poses everything is exact. For more, quantiles are exact to the width of one of 65536 bins between the
    least and the largest value, and the correlation and the spread come from ranks in 1024 bands. Standard errors are
    those of random poses; the even ones of grids and low-discrepancy sets do better. Volumes are in the pose
    coordinates, m and rad.

    Raises: PoseError where no pose has an index, or the sweep holds none.
    Source: Section 3.
    """
    if "omega_1" not in sweep:
        raise PoseError("a summary needs the quantity omega_1. Sweep it.")
    first = _extremes(sweep)
    both = "cond_H" in sweep and first.usable > 1
    names = ("omega_1", "cond_H") if both else ("omega_1",)
    spread_out = _exactly(sweep, names) if first.usable <= _EXACT else _binned(sweep, names, first)
    return SweepSummary(
        poses=first.poses,
        statuses=first.statuses,
        worst=_at(sweep, first.place["omega_1", "least"]),
        best=_at(sweep, first.place["omega_1", "most"]),
        best_conditioned=_at(sweep, first.place["cond_H", "least"]) if both else None,
        worst_conditioned=_at(sweep, first.place["cond_H", "most"]) if both else None,
        quantiles=dict(zip(QUANTILES, spread_out.quantiles.tolist(), strict=True)),
        above=None if at_least is None else _above(sweep, first, at_least),
        correlation=spread_out.correlation,
        spread=spread_out.spread,
    )


class _Extremes(NamedTuple):
    poses: int
    usable: int
    statuses: dict[str, int]
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


def _finite(sweep: xr.Dataset, names: tuple[str, ...]) -> Iterator[list[Array]]:
    """Columns without the poses that have no index."""
    for _, values in columns(sweep, names):
        good = np.isfinite(values[0])
        yield values if good.all() else [v[good] for v in values]


def _extremes(sweep: xr.Dataset) -> _Extremes:
    names = [name for name in ("omega_1", "cond_H") if name in sweep]
    value: dict[tuple[str, str], float] = {}
    place: dict[tuple[str, str], int] = {}
    seen = np.zeros(256, dtype=np.int64)
    count = usable = 0
    for start, (status, *found) in columns(sweep, ("status", *names)):
        seen += np.bincount(status, minlength=256)
        count += status.size
        good = np.isfinite(found[0])
        usable += int(good.sum())
        if not good.any():
            continue
        for name, numbers in zip(names, found, strict=True):
            for end, sign in (("least", 1.0), ("most", -1.0)):
                k = int(np.argmin(np.where(good, sign * numbers, np.inf)))
                if sign * numbers[k] < sign * value.get((name, end), sign * np.inf) or (name, end) not in value:
                    value[name, end], place[name, end] = float(numbers[k]), start + k
    if not usable:
        raise PoseError(f"none of the {count} poses has an index. See the variable `status` for the reasons.")
    words = statuses()
    return _Extremes(count, usable, {words[k]: int(n) for k, n in enumerate(seen) if n}, value, place)


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
    return At(number, pose, float(one["omega_1"]), cond)


def _above(sweep: xr.Dataset, extremes: _Extremes, wanted: float) -> Above:
    good = sum(int((values[0] >= wanted).sum()) for values in _finite(sweep, ("omega_1",)))
    computed = extremes.poses - extremes.statuses.get(statuses()[PENDING], 0)
    fraction = good / computed
    error = float(np.sqrt(fraction * (1 - fraction) / computed))
    volume = fraction * sweep.attrs.get("box_volume", np.nan)
    return Above(wanted, fraction, error, volume, sweep.attrs.get("box_volume_unit", ""))


class _Distribution(NamedTuple):
    """How omega_1 is spread, and how it goes with cond(H) (NaN without it)."""

    quantiles: Array
    correlation: float = float("nan")
    spread: float = float("nan")


def _exactly(sweep: xr.Dataset, names: tuple[str, ...]) -> _Distribution:
    """From all values at once."""
    from scipy.stats import rankdata

    found = [np.concatenate(column) for column in zip(*_finite(sweep, names), strict=True)]
    quantiles = np.quantile(found[0], QUANTILES)
    if len(found) == 1:
        return _Distribution(quantiles)
    omega, cond = found
    return _Distribution(quantiles, _pearson(rankdata(omega), rankdata(cond)), _spread(omega, cond))


def _pearson(a: Array, b: Array) -> float:
    a, b = a - a.mean(), b - b.mean()
    scale = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / scale) if scale > 0 else float("nan")


def _spread(omega: Array, cond: Array) -> float:
    """Median, over bands of equal count in cond(H), of the ratio of the 95 % to the 5 % quantile of omega_1."""
    bands = max(1, min(_BANDS, len(omega) // 100))
    parts = np.array_split(omega[np.argsort(cond, kind="stable")], bands)
    low, high = np.array([np.quantile(part, [0.05, 0.95]) for part in parts]).T
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.median(high / low))


class _Bins:
    """Narrow bins between two values, even in the logarithm where they are positive and far apart."""

    def __init__(self, least: float, most: float) -> None:
        self.most = min(most, np.finfo(float).max)
        self.logarithmic = least > 0 and self.most > 4 * least
        ends = np.array([least, self.most])
        self.low, self.high = np.log(ends) if self.logarithmic else ends
        self.scale = _BINS / (self.high - self.low) if self.high > self.low else 0.0
        self.counts = np.zeros(_BINS, dtype=np.int64)

    def place(self, values: Array) -> np.ndarray:
        """The number of each value's bin."""
        inside = np.minimum(values, self.most)
        if self.logarithmic:
            np.log(inside, out=inside)
        inside -= self.low
        inside *= self.scale
        return np.clip(inside.astype(np.int32), 0, _BINS - 1)

    def quantiles(self, at: Array) -> Array:
        """Within a bin, in proportion."""
        edges = np.linspace(self.low, self.high, _BINS + 1)
        cumulated = np.concatenate([[0], np.cumsum(self.counts)])
        found = np.interp(at * cumulated[-1], cumulated, edges)
        return np.exp(found) if self.logarithmic else found

    def ranks(self) -> np.ndarray:
        """Bin -> which of the `_RANK_BINS` parts of equal count its middle is in."""
        middle = np.cumsum(self.counts) - self.counts / 2
        return np.minimum(middle * _RANK_BINS / self.counts.sum(), _RANK_BINS - 1).astype(np.int32)


def _binned(sweep: xr.Dataset, names: tuple[str, ...], extremes: _Extremes) -> _Distribution:
    """From counts in bins, in two passes."""
    bins = [_Bins(extremes.value[name, "least"], extremes.value[name, "most"]) for name in names]
    for values in _finite(sweep, names):
        for one, column in zip(bins, values, strict=True):
            one.counts += np.bincount(one.place(column), minlength=_BINS)
    quantiles = bins[0].quantiles(np.array(QUANTILES))
    if len(bins) == 1:
        return _Distribution(quantiles)
    ranks = [one.ranks() for one in bins]
    table = np.zeros((_RANK_BINS, _RANK_BINS), dtype=np.int64)
    for values in _finite(sweep, names):
        omega, cond = (rank[one.place(column)] for rank, one, column in zip(ranks, bins, values, strict=True))
        table += np.bincount(cond * _RANK_BINS + omega, minlength=table.size).reshape(table.shape)
    edges = bins[0].quantiles(np.arange(_RANK_BINS + 1) / _RANK_BINS)
    return _Distribution(quantiles, _table_correlation(table), _table_spread(table, edges))


def _table_correlation(table: np.ndarray) -> float:
    """Of ranks, each taken in the middle of its part."""

    def middles(counts: np.ndarray) -> Array:
        return np.cumsum(counts) - counts / 2.0

    by_cond, by_omega = table.sum(axis=1), table.sum(axis=0)
    a, b = middles(by_cond), middles(by_omega)
    total = table.sum()
    a, b = a - (a @ by_cond) / total, b - (b @ by_omega) / total
    return float(a @ table @ b / np.sqrt((a * a @ by_cond) * (b * b @ by_omega)))


def _table_spread(table: np.ndarray, edges: Array) -> float:
    """As `_spread`; `edges` are those of the table's columns."""
    ratios = []
    for rows in np.array_split(table, _BANDS):
        cumulated = np.concatenate([[0], np.cumsum(rows.sum(axis=0))])
        low, high = np.interp([0.05 * cumulated[-1], 0.95 * cumulated[-1]], cumulated, edges)
        ratios.append(high / low if low > 0 else np.inf)
    return float(np.median(ratios))
