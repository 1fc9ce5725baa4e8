"""Statistics over members that are read one after another.

A source is a function that starts a new pass: it yields, in member order, one array for each member, all of the same
length; NaN is no value. No statistic keeps more than a fixed number of arrays, whatever the number of members, and each
depends on the values and their order alone, so it has the same bits for any number of workers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Moments", "Percentiles", "moments", "percentiles", "shares"]

Source = Callable[[], Iterator[NDArray[np.floating]]]
Floats = NDArray[np.float64]


def shares(source: Source, thresholds: Sequence[float], *, above: bool) -> tuple[Floats, int]:
    """Share of members whose value is above (or below) each threshold, shape (thresholds, cells), and their number.

    No value is neither above nor below.
    """
    counts: NDArray[np.int64] | None = None
    members = 0
    for values in source():
        if counts is None:
            counts = np.zeros((len(thresholds), values.size), np.int64)
        for row, threshold in enumerate(thresholds):
            counts[row] += values > threshold if above else values < threshold
        members += 1
    assert counts is not None, "a source has at least one member"
    return counts / members, members


@dataclass(frozen=True)
class Moments:
    """Number of values, mean, and standard error of the mean, by cell."""

    count: NDArray[np.int64]
    mean: Floats
    standard_error: Floats


def moments(source: Source, absent: float) -> Moments:
    """Means and standard errors by Welford's method (Technometrics 4, 1962), in member order.

    No value counts as `absent`; if that is not finite, it is left out. A mean of no values is NaN, and so is a
    standard error of fewer than two.
    """
    count = mean = squares = None
    for values in source():
        values = _filled(values, absent).astype(np.float64)
        if count is None or mean is None or squares is None:
            count, mean, squares = np.zeros(values.size, np.int64), np.zeros(values.size), np.zeros(values.size)
        counted = np.isfinite(values)
        count += counted
        delta = np.where(counted, values - mean, 0.0)
        mean += delta / np.maximum(count, 1)
        squares += delta * np.where(counted, values - mean, 0.0)
    assert count is not None and mean is not None and squares is not None, "a source has at least one member"
    with np.errstate(invalid="ignore", divide="ignore"):
        error = np.where(count > 1, np.sqrt(squares / (count - 1) / count), np.nan)
    return Moments(count, np.where(count > 0, mean, np.nan), error)


@dataclass(frozen=True)
class Percentiles:
    """Percentiles, shape (percentiles, cells), a bound of their error by cell, and the method that gave them."""

    values: Floats
    error: Floats
    method: str
    members: int


def percentiles(source: Source, percents: Sequence[float], absent: float, *, method: str, bins: int, memory_bytes: int) -> Percentiles:
    """Percentiles with linear interpolation between order statistics (definition 7 of Hyndman and Fan, 1996).

    No value counts as `absent`: a number, infinity, or NaN, which leaves it out.

    `method` "exact" sorts the values of a block of cells after another, "histogram" counts them in `bins` bins between
    the cell's smallest and largest, and "auto" is exact while one block of `memory_bytes` holds all values.
    """
    extremes = _extremes(source)
    cells = np.flatnonzero(extremes.count)
    values = np.full((len(percents), extremes.count.size), absent)
    error = np.zeros(extremes.count.size)
    fits = extremes.members * cells.size * extremes.itemsize <= memory_bytes
    exact = method == "exact" or (method == "auto" and fits)
    per_cell = extremes.members * extremes.itemsize if exact else bins * 5
    block = max(1, memory_bytes // per_cell)
    for start in range(0, cells.size, block):
        part = cells[start : start + block]
        if exact:
            values[:, part] = _exact(source, part, percents, absent, extremes)
        else:
            values[:, part], error[part] = _binned(source, part, percents, absent, extremes, bins)
    return Percentiles(values, error, "exact" if exact else "histogram", extremes.members)


@dataclass(frozen=True)
class _Extremes:
    """Number of values, smallest and largest value by cell, number of members, bytes of a value."""

    count: NDArray[np.int64]
    low: Floats
    high: Floats
    members: int
    itemsize: int
    dtype: np.dtype


def _extremes(source: Source) -> _Extremes:
    count = low = high = None
    members, dtype = 0, np.dtype(np.float32)
    for values in source():
        if count is None or low is None or high is None:
            count, dtype = np.zeros(values.size, np.int64), values.dtype
            low, high = np.full(values.size, np.inf, dtype), np.full(values.size, -np.inf, dtype)
        count += ~np.isnan(values)
        np.fmin(low, values, out=low)
        np.fmax(high, values, out=high)
        members += 1
    assert count is not None and low is not None and high is not None, "a source has at least one member"
    return _Extremes(count, low.astype(np.float64), high.astype(np.float64), members, dtype.itemsize, dtype)


def _exact(source: Source, cells: NDArray[np.intp], percents: Sequence[float], absent: float, extremes: _Extremes) -> Floats:
    values = np.empty((extremes.members, cells.size), extremes.dtype)
    for row, member in enumerate(source()):
        values[row] = _filled(member[cells], absent)
    values.sort(axis=0)  # NaN last
    counted = extremes.count[cells] if np.isnan(absent) else np.full(cells.size, extremes.members)
    column = np.arange(cells.size)
    return _between(percents, counted, lambda rank: values[rank, column].astype(np.float64))


def _binned(
    source: Source, cells: NDArray[np.intp], percents: Sequence[float], absent: float, extremes: _Extremes, bins: int
) -> tuple[Floats, Floats]:
    """Percentiles from histograms, and half a bin's width as bound of their error.

    An order statistic is within half a width of the middle of its bin, and so is a value between two of them. No
    value that counts as 0 or infinity is no bin's but counted by itself, and exact, before or after all bins; only
    where values are negative as well is 0 counted in the bins.
    """
    low, high, count = extremes.low[cells], extremes.high[cells], extremes.count[cells]
    none = extremes.members - count
    inside = (low < absent) & np.isfinite(absent)  # `absent` lies among the values
    low = np.where(inside, np.minimum(low, absent), low)
    high = np.where(inside, np.maximum(high, absent), high)
    width = (high - low) / bins
    cumulative = _histogram(source, cells, low, width, np.where(inside, absent, np.nan), bins)
    before = np.where(~inside & np.isfinite(absent), none, 0)
    binned = np.where(inside, extremes.members, count)

    def statistic(rank: NDArray[np.int64]) -> Floats:
        bin_ = (cumulative <= (rank - before)[:, None]).sum(axis=1)
        value = low + (bin_ + 0.5) * width
        return np.where((rank < before) | (rank >= before + binned), absent, value)

    counted = count if np.isnan(absent) else np.full(cells.size, extremes.members)
    rounding = 8 * np.finfo(np.float64).eps * np.maximum(np.abs(low), np.abs(high))
    return _between(percents, counted, statistic), width / 2 + rounding


def _histogram(source: Source, cells: NDArray[np.intp], low: Floats, width: Floats, absent: Floats, bins: int) -> NDArray[np.int32]:
    """Cumulative counts, shape (cells, bins)."""
    counts = np.zeros((cells.size, bins), np.int32)
    flat = counts.reshape(-1)
    first = np.arange(cells.size, dtype=np.int64) * bins
    per_width = np.divide(1.0, width, out=np.zeros_like(width), where=width > 0)
    for member in source():
        values = member[cells].astype(np.float64)
        values = np.where(np.isnan(values), absent, values)
        counted = np.flatnonzero(~np.isnan(values))
        bin_ = ((values[counted] - low[counted]) * per_width[counted]).astype(np.int64)
        flat[first[counted] + np.clip(bin_, 0, bins - 1)] += 1  # a cell occurs once
    return np.cumsum(counts, axis=1, out=counts)


def _between(percents: Sequence[float], counted: NDArray[np.int64], statistic: Callable[[NDArray[np.int64]], Floats]) -> Floats:
    """Percentiles from order statistics; infinite where the upper of the two neighbours has a weight and is."""
    rows = []
    for percent in percents:
        position = percent / 100 * (counted - 1)
        rank = np.floor(position).astype(np.int64)
        weight = position - rank
        lower = statistic(rank)
        upper = statistic(np.minimum(rank + 1, counted - 1))
        with np.errstate(invalid="ignore"):  # infinity minus infinity, and 0 times infinity
            between = lower + np.where(weight > 0, weight * (upper - lower), 0.0)
        rows.append(np.where(np.isfinite(lower), between, lower))
    return np.array(rows)


def _filled(values: NDArray[np.floating], absent: float) -> NDArray[np.floating]:
    """The values with `absent` where there is none."""
    return values if np.isnan(absent) else np.where(np.isnan(values), values.dtype.type(absent), values)
