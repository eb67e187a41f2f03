"""Statistics over the surfaces of an ensemble: from their values, or from what is kept in their place."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.ensemble.results import Results
from mcgw.scene.scene import Scene

if TYPE_CHECKING:
    from mcgw.ensemble.summarised import Summarised

__all__ = [
    "PROBABILITIES",
    "STATISTICS_OF",
    "covariance",
    "extremes",
    "mean_and_std",
    "quantile",
    "skewness",
    "total_number",
]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

PROBABILITIES = (0.0, 0.001, 0.01, 0.025, 0.05, 0.25, 0.5, 0.75, 0.95, 0.975, 0.99, 0.999, 1.0)
STATISTICS_OF = {
    "mean": "mean of the {}",
    "std": "standard deviation of the {} over surfaces",
    "skewness": "skewness of the {} over surfaces",
}

_ROWS = 8192  # surfaces at a time, for ensembles larger than the memory
_LOW = 2**32 - 1  # the lower half of an integer: sums of halves do not overflow


def _summarised(scene: Scene, sums: Results) -> "Summarised | None":
    """The results, if they are statistics alone."""
    return cast("Summarised", sums) if scene.keep == "statistics" else None


def _chunks(sums: Results, name: str, kind: type = np.float64) -> Iterator[NDArray[Any]]:
    m = sums.rows()
    for start in range(0, m, _ROWS):
        yield sums.read(name, start, min(start + _ROWS, m)).astype(kind)


def mean_and_std(scene: Scene, sums: Results, name: str) -> tuple[Array, Array]:
    """Mean and standard deviation (divisor M - 1); shifted by the first row, so nothing cancels."""
    m = sums.rows()
    if held := _summarised(scene, sums):
        columns = held.columns(name)
        mean, squares = held.whole.mean[columns], held.whole.squares[columns]
    else:
        few = [sums.read(name, 0, m).astype(np.float64)] if m <= _ROWS else None  # read once
        shift = next(iter(few or _chunks(sums, name)))[0]
        mean = sum((chunk - shift).sum(axis=0) for chunk in few or _chunks(sums, name)) / m + shift
        squares = sum(((chunk - mean) ** 2).sum(axis=0) for chunk in few or _chunks(sums, name))
    return np.asarray(mean), np.sqrt(squares / (m - 1)) if m > 1 else np.full(np.shape(mean), np.nan)


def total_number(scene: Scene, sums: Results, name: str) -> Array:
    """Sum of whole numbers over all surfaces: exact but for the rounding to double precision."""
    if held := _summarised(scene, sums):
        return np.rint(held.whole.mean[held.columns(name)] * held.whole.n)
    total = [0] * scene.shapes[name][0]
    for rows in _chunks(sums, name, np.int64):
        halves = zip((rows >> 32).sum(axis=0).tolist(), (rows & _LOW).sum(axis=0).tolist(), strict=True)
        total = [so_far + (high << 32) + low for so_far, (high, low) in zip(total, halves, strict=True)]
    return np.array([float(x) for x in total])


def covariance(scene: Scene, sums: Results, name: str, other: str) -> Array:
    """Between all numbers of two tables (divisor M - 1), shape (*shape, *shape of the other)."""
    m = sums.rows()
    shape = scene.shapes[name] + scene.shapes[other]
    if m == 1:
        return np.full(shape, np.nan)
    if held := _summarised(scene, sums):
        i, j = np.meshgrid(held.columns(name).ravel(), held.columns(other).ravel(), indexing="ij")
        i, j = np.maximum(i, j), np.minimum(i, j)
        return np.asarray(held.whole.products[i * (i + 1) // 2 + j] / (m - 1)).reshape(shape)
    means = [mean_and_std(scene, sums, each)[0].ravel() for each in (name, other)]
    total = np.zeros((means[0].size, means[1].size))
    for x, y in zip(_chunks(sums, name), _chunks(sums, other), strict=True):
        total += (x.reshape(len(x), -1) - means[0]).T @ (y.reshape(len(y), -1) - means[1])
    return (total / (m - 1)).reshape(shape)


def skewness(scene: Scene, sums: Results, name: str) -> Array:
    """Third cumulant over the 3/2 power of the second, both with the divisor M; nan where nothing varies."""
    m = sums.rows()
    if held := _summarised(scene, sums):
        squares, cubes = (x[held.columns(name)] for x in (held.whole.squares, held.whole.cubes))
    else:
        mean = mean_and_std(scene, sums, name)[0]
        squares = np.asarray(sum(((chunk - mean) ** 2).sum(axis=0) for chunk in _chunks(sums, name)))
        cubes = np.asarray(sum(((chunk - mean) ** 3).sum(axis=0) for chunk in _chunks(sums, name)))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(cubes * np.sqrt(m) / squares**1.5)


def extremes(scene: Scene, sums: Results, name: str) -> tuple[Array, Array, Ints, Ints]:
    """Least and greatest value, and the first surfaces that have them."""
    if held := _summarised(scene, sums):
        columns = held.columns(name)
        (low, high), (at_low, at_high) = held.whole.extremes, held.whole.at
        return low[columns], high[columns], at_low[columns], at_high[columns]
    values = sums.read(name, 0, None)
    at = values.argmin(axis=0), values.argmax(axis=0)
    return values.min(axis=0), values.max(axis=0), *at


def quantile(scene: Scene, sums: Results, name: str, share: float) -> tuple[Array, Array, Array]:
    """Quantile of the values there are, as `numpy.quantile`, and both ends of where it lies."""
    if not (held := _summarised(scene, sums)):
        exact = np.quantile(sums.read(name, 0, None), share, axis=0)
        return exact, exact, exact
    columns = held.columns(name).ravel()
    place = share * (held.whole.n - 1)
    below, above = (_in_order(held, name, columns, int(k)) for k in (np.floor(place), np.ceil(place)))
    part = place - np.floor(place)
    found = ((1 - part) * x + part * y for x, y in zip(below, above, strict=True))
    value, low, high = (x.reshape(scene.shapes[name]) for x in found)
    return value, low, high


def _in_order(held: "Summarised", name: str, columns: Ints, k: int) -> tuple[Array, Array, Array]:
    """The value with `k` others below it, by even spacing in its bin, and the ends of that."""
    whole, whole_numbers = held.whole, quantity_of(name).counts
    upto = np.cumsum(whole.counts[columns], axis=1)
    bins = (upto <= k).sum(axis=1)
    row = np.arange(len(columns))
    inside = whole.counts[columns][row, bins]
    before = upto[row, bins] - inside
    ends = held.bins.ends(columns, bins, whole=whole_numbers)
    low, high = (
        np.maximum(ends[0], whole.extremes[0, columns]),
        np.minimum(ends[1], whole.extremes[1, columns]),
    )
    value = low + (high - low) * ((k - before + 0.5) / inside)
    value = np.rint(value) if whole_numbers else value
    for end, at in ((whole.extremes[0, columns], 0), (whole.extremes[1, columns], held.whole.n - 1)):
        if k == at:  # it is known
            value, low, high = end, end, end
    return value, low, high
