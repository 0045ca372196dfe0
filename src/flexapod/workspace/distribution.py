"""How omega_1 is spread, and how it goes with cond(H): from all values, or from counts in bins."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexapod.conventions import Array

QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
_BINS = 2**16
_RANK_BINS = 2**10
_BANDS = 50


class Distribution(NamedTuple):
    """How omega_1 is spread, and how it goes with cond(H) (NaN without it)."""

    quantiles: Array
    correlation: float = float("nan")
    spread: float = float("nan")


def exactly(usable: Iterator[list[Array]]) -> Distribution:
    """From all values at once: columns omega_1 and, if there is one, cond(H), part by part."""
    omega, *others = (np.concatenate(column) for column in zip(*usable, strict=True))
    if not others:
        return Distribution(np.quantile(omega, QUANTILES))
    (cond,) = others

    def of_omega() -> tuple[Array, Array]:
        order, ranks = _ranked(omega)
        return np.quantile(omega[order], QUANTILES), ranks  # of sorted values, which takes a fifth of the time

    def of_cond() -> tuple[float, Array]:
        order, ranks = _ranked(cond)
        return _spread(omega[order]), ranks

    with ThreadPoolExecutor(2) as pool:  # sorting takes longest, and NumPy sorts without the interpreter's lock
        first, second = pool.submit(of_omega), pool.submit(of_cond)
        (quantiles, ranks), (spread, by_cond) = first.result(), second.result()
    return Distribution(quantiles, _pearson(ranks, by_cond), spread)


def _ranked(values: Array) -> tuple[NDArray[np.intp], Array]:
    """The places of the values from least to largest, equal ones in the order given, and the values' ranks from 1.

    Equal values share their mean rank.
    """
    order = np.argsort(values)  # several times as fast as the stable sort, which only equal values need
    ascending, ranks = values[order], np.empty(len(order))
    new = ascending[1:] != ascending[:-1]
    if new.all():
        ranks[order] = np.arange(1.0, len(order) + 1)
        return order, ranks
    order = np.argsort(values, kind="stable")
    ends = np.flatnonzero(np.append(new, True)) + 1
    counts = np.diff(ends, prepend=0)
    ranks[order] = np.repeat(ends - 0.5 * (counts - 1), counts)
    return order, ranks


def _pearson(a: Array, b: Array) -> float:
    a, b = a - a.mean(), b - b.mean()
    scale = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / scale) if scale > 0 else float("nan")


def _spread(omega: Array) -> float:
    """Median, over bands of equal count in cond(H), of the ratio of the 95 % to the 5 % quantile of omega_1.

    omega: in the order of cond(H).
    """
    bands = max(1, min(_BANDS, len(omega) // 100))
    low, high = np.array([np.quantile(part, [0.05, 0.95]) for part in np.array_split(omega, bands)]).T
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


def binned(usable: Callable[[], Iterator[list[Array]]], ends: Sequence[tuple[float, float]]) -> Distribution:
    """From counts in bins between the least and the largest value of each column, in two passes over the parts."""
    bins = [_Bins(*pair) for pair in ends]
    for values in usable():
        for one, column in zip(bins, values, strict=True):
            one.counts += np.bincount(one.place(column), minlength=_BINS)
    quantiles = bins[0].quantiles(np.array(QUANTILES))
    if len(bins) == 1:
        return Distribution(quantiles)
    ranks = [one.ranks() for one in bins]
    table = np.zeros((_RANK_BINS, _RANK_BINS), dtype=np.int64)
    for values in usable():
        omega, cond = (rank[one.place(column)] for rank, one, column in zip(ranks, bins, values, strict=True))
        table += np.bincount(cond * _RANK_BINS + omega, minlength=table.size).reshape(table.shape)
    edges = bins[0].quantiles(np.arange(_RANK_BINS + 1) / _RANK_BINS)
    return Distribution(quantiles, _table_correlation(table), _table_spread(table, edges))


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
