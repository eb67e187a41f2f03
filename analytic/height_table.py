"""A law of heights that is linear between points: resampled measured heights."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints, hold
from analytic.heights import HeightLaw

_GROWTH = 1.1  # ratio of the ranks of neighbouring points, counted from the nearer end
_FLAT = 1e-9  # reduced heights closer than this are one


def reduced(heights: ArrayLike) -> Array:
    """Heights in any unit, reduced to mean 0 and standard deviation 1 (divisor K)."""
    z = checked_heights(heights)
    return np.asarray((z - z.mean()) / z.std())


def checked_heights(heights: ArrayLike) -> Array:
    """Heights as an array; a ValueError if there are fewer than two, or they are not finite, or all alike."""
    z = np.asarray(heights, dtype=np.float64).ravel()
    if z.size < 2 or not np.all(np.isfinite(z)):
        raise ValueError("heights: give two or more finite numbers")
    if not z.std() > 1e-12 * np.abs(z).max():
        raise ValueError("heights: they are all equal; give the heights of a rough surface")
    return z


@dataclass(frozen=True)
class HeightTable(HeightLaw):
    """A law whose distribution function is linear between points: resampled measured heights.

    The density is constant between neighbouring points. The heights are shifted and scaled so that
    the law has mean 0 and standard deviation 1 exactly.

    Parameters
    ----------
    s : sequence of float
        Heights in any unit, increasing, two or more.
    share : sequence of float
        Probability of a lower height, increasing from 0 to 1.

    Raises
    ------
    ValueError
        If the points are not such.

    Examples
    --------
    >>> law = HeightTable.of([1.2e-6, 1.5e-6, 1.6e-6, 2.2e-6])
    >>> len(law.s)
    4
    """

    s: tuple[float, ...]
    share: tuple[float, ...]

    def __init__(self, s: Sequence[float], share: Sequence[float]) -> None:
        x, p = np.array(s, dtype=np.float64), np.array(share, dtype=np.float64)
        if x.shape != p.shape or x.ndim != 1 or x.size < 2 or not np.all(np.isfinite(x)):
            raise ValueError(f"s, share: give two lists of one length >= 2, not of {x.size} and {p.size}")
        if not (np.all(np.diff(x) > 0) and np.all(np.diff(p) > 0) and p[0] == 0 and p[-1] == 1):
            raise ValueError("s, share: both must increase, share from 0 to 1")
        mean, std = _mean_std(x, p)
        if abs(mean) > 1e-12 or abs(std - 1) > 1e-12:  # so that a table read again stays as it is
            x = (x - mean) / std
        hold(self, s=tuple(x.tolist()), share=tuple(p.tolist()))

    @classmethod
    def of(cls, heights: ArrayLike) -> "HeightTable":
        """Return the law of a sample, smooth between its order statistics.

        Of K heights the ranks counted from either end are kept one by one up to 10, then in steps of a
        tenth: about 200 points, dense where the contacts are. Heights between two of them count as
        evenly spread.

        Parameters
        ----------
        heights : array_like
            In any unit.

        Returns
        -------
        HeightTable
            Reduced.

        Raises
        ------
        ValueError
            If there are fewer than two, or they are not finite, or all alike.
        """
        z = np.sort(reduced(heights))
        ranks = _ranks(z.size)
        rising = np.concatenate([[True], np.diff(z[ranks]) > _FLAT])
        rising[-1] = True
        x, p = z[ranks][rising], ranks[rising] / (z.size - 1)
        if x.size > 2 and x[-1] - x[-2] <= _FLAT:
            x, p = np.delete(x, -2), np.delete(p, -2)
        return cls(x.tolist(), p.tolist())

    @property
    def support(self) -> tuple[float, float]:
        """First and last point."""
        return self.s[0], self.s[-1]

    @property
    def breaks(self) -> tuple[float, ...]:
        """Every point."""
        return self.s

    def span(self, s: float) -> float:  # noqa: ARG002 - the same everywhere
        """Return infinity: between the points the density is constant."""
        return np.inf

    @cached_property
    def _points(self) -> tuple[Array, Array, Array]:
        x, p = np.array(self.s), np.array(self.share)
        return x, p, np.diff(p) / np.diff(x)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw by interpolation between the points at uniform fractions."""
        return np.asarray(np.interp(rng.random(n), self._points[1], self._points[0]))

    def pdf(self, s: Array) -> Array:
        """Return the slope of the distribution function."""
        x, _, slope = self._points
        piece = np.searchsorted(x, s, side="right") - 1
        inside = (piece >= 0) & (piece < slope.size)
        return np.asarray(np.where(inside, slope[np.clip(piece, 0, slope.size - 1)], 0.0))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return 0 up to the next point, which no cell reaches beyond."""
        return 0 * t + 0 * s

    def cdf(self, s: Array) -> Array:
        """Return the distribution function."""
        x, p, _ = self._points
        return np.asarray(np.interp(s, x, p))

    def sf(self, s: Array) -> Array:
        """Return the upper tail, counted from the top, so that the last fractions keep their digits."""
        x, p, _ = self._points
        return np.asarray(np.interp(-np.asarray(s), -x[::-1], 1 - p[::-1]))

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Return the inverse of the distribution function."""
        x, share, _ = self._points
        return np.asarray(np.interp(p * self.cdf(np.array(below)), share, x))

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Return the inverse, counted from the top."""
        x, share, _ = self._points
        return np.asarray(np.interp(p * self.sf(np.array(above)), 1 - share[::-1], x[::-1]))


def _mean_std(x: Array, p: Array) -> tuple[float, float]:
    """Of heights spread evenly between the points."""
    mass, middle, width = np.diff(p), (x[1:] + x[:-1]) / 2, np.diff(x)
    mean = float((mass * middle).sum())
    return mean, float(np.sqrt((mass * ((middle - mean) ** 2 + width**2 / 12)).sum()))


def _ranks(k: int) -> Ints:
    """Ranks 0 ... k - 1 to keep: all near both ends, ever fewer towards the middle."""
    ranks = [0]
    while 2 * ranks[-1] < k - 1:
        ranks.append(max(ranks[-1] + 1, int(np.ceil(_GROWTH * ranks[-1]))))
    kept = np.array([r for r in ranks if 2 * r < k - 1], dtype=np.int64)
    return np.unique(np.concatenate([kept, k - 1 - kept]))
