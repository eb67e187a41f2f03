"""Measured heights: resampled smoothly, or used as they are, and the radii that were measured with them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, Ints, hold
from analytic.heights import HeightLaw

_GROWTH = 1.1  # ratio of the ranks of neighbouring points, counted from the nearer end
_FLAT = 1e-9  # reduced heights closer than this are one


def reduced(heights: ArrayLike) -> Array:
    """Return heights in any unit reduced to mean 0 and standard deviation 1 (divisor K), if they are not."""
    z = np.asarray(heights, dtype=np.float64).ravel()
    if z.size < 2 or not np.all(np.isfinite(z)):
        raise ValueError("heights: give two or more finite numbers")
    mean, std = z.mean(), z.std()
    if not std > 1e-12 * np.abs(z).max():
        raise ValueError("heights: they are all equal; give the heights of a rough surface")
    return np.asarray(z if abs(mean) <= 1e-12 and abs(std - 1) <= 1e-12 else (z - mean) / std)


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
    _s: Any = field(default=None, init=False, repr=False, compare=False)
    _share: Any = field(default=None, init=False, repr=False, compare=False)

    def __init__(self, s: Sequence[float], share: Sequence[float]) -> None:
        x, p = np.array(s, dtype=np.float64), np.array(share, dtype=np.float64)
        if x.shape != p.shape or x.ndim != 1 or x.size < 2 or not np.all(np.isfinite(x)):
            raise ValueError(f"s, share: give two lists of one length >= 2, not of {x.size} and {p.size}")
        if not (np.all(np.diff(x) > 0) and np.all(np.diff(p) > 0) and p[0] == 0 and p[-1] == 1):
            raise ValueError("s, share: both must increase, share from 0 to 1")
        mass, middle = np.diff(p), (x[1:] + x[:-1]) / 2  # heights are spread evenly between the points
        mean = float((mass * middle).sum())
        std = math.sqrt((mass * ((middle - mean) ** 2 + np.diff(x) ** 2 / 12)).sum())
        if abs(mean) > 1e-12 or abs(std - 1) > 1e-12:  # so that a table read again stays as it is
            x = (x - mean) / std
        hold(self, s=tuple(x.tolist()), share=tuple(p.tolist()), _s=x, _share=p)

    @classmethod
    def of(cls, heights: ArrayLike) -> "HeightTable":
        """Return the law of a sample, smooth between its order statistics.

        Of K heights the ranks counted from either end are kept one by one up to 10, then in steps of a tenth:
        about 200 points, dense where the contacts are. Heights between two of them count as evenly spread.

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
        near = [0]  # ranks from either end: all near both, ever fewer towards the middle
        while 2 * near[-1] < z.size - 1:
            near.append(max(near[-1] + 1, math.ceil(_GROWTH * near[-1])))
        kept = np.array(near[:-1], dtype=np.int64)
        ranks = np.unique(np.concatenate([kept, z.size - 1 - kept]))
        x = z[ranks]
        apart = (np.diff(x, prepend=-np.inf) > _FLAT) & (x[-1] - x > _FLAT)
        apart[-1] = True
        return cls(x[apart].tolist(), (ranks[apart] / (z.size - 1)).tolist())

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

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw by interpolation between the points at uniform fractions."""
        return np.asarray(np.interp(rng.random(n), self._share, self._s))

    def pdf(self, s: Array) -> Array:
        """Return the slope of the distribution function."""
        slopes = np.concatenate([[0.0], np.diff(self._share) / np.diff(self._s), [0.0]])
        return np.asarray(slopes[np.searchsorted(self._s, s, side="right")])

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return 0 up to the next point, which no cell reaches beyond."""
        return 0 * t + 0 * s

    def cdf(self, s: Array) -> Array:
        """Return the distribution function."""
        return np.asarray(np.interp(s, self._s, self._share))

    def sf(self, s: Array) -> Array:
        """Return the upper tail, whose last fractions keep their digits."""
        return np.asarray(np.interp(s, self._s, 1 - self._share))

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Return the inverse of the distribution function."""
        return np.asarray(np.interp(p * self.cdf(np.array(below)), self._share, self._s))

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Return the inverse, counted from the top."""
        return np.asarray(np.interp(p * self.sf(np.array(above)), 1 - self._share[::-1], self._s[::-1]))


@dataclass(frozen=True)
class MeasuredHeights(HeightLaw):
    """Measured heights themselves: one surface, nothing drawn; or drawn from these very heights.

    Parameters
    ----------
    heights : sequence of float
        In any unit; reduced to mean 0 and standard deviation 1 (divisor K).
    resampled : bool, optional
        Whether each asperity of a surface has one of the heights, drawn with replacement. Default: the
        surface has each height once.

    Raises
    ------
    ValueError
        If there are fewer than two, or they are not finite, or all alike.

    Examples
    --------
    >>> MeasuredHeights([1.0, 3.0]).heights
    (-1.0, 1.0)
    """

    heights: tuple[float, ...]
    resampled: bool = False
    _sorted: Any = field(default=None, init=False, repr=False, compare=False)

    def __init__(self, heights: Sequence[float] | Array, *, resampled: bool = False) -> None:
        s = reduced(heights)
        hold(self, heights=tuple(s.tolist()), resampled=resampled, _sorted=np.sort(s))

    @property
    def support(self) -> tuple[float, float]:
        """Lowest and highest of them."""
        return float(self._sorted[0]), float(self._sorted[-1])

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Return the heights themselves, in their own order; or draw `n` of them with replacement.

        Raises
        ------
        ValueError
            If they are not drawn, and `n` is not their number.
        """
        return np.array(self.heights)[self._chosen(n, rng)]

    def _chosen(self, n: int, rng: np.random.Generator) -> Ints:
        """Numbers of the summits of a surface."""
        if self.resampled:
            return rng.integers(0, len(self.heights), n)
        if n != len(self.heights):
            raise ValueError(f"n = {n}: give {len(self.heights)}, the number of measured heights")
        return np.arange(n)

    def pdf(self, s: Array) -> Array:
        """Refuse to answer, by a ValueError: there is no density."""
        raise ValueError(
            f"measured heights have no density at s = {np.ravel(s)[0]:g}; make a HeightTable, or sum them "
            "directly"
        )

    def cdf(self, s: Array) -> Array:
        """Return the share of lower heights."""
        return np.asarray(np.searchsorted(self._sorted, s, side="right") / len(self.heights))

    def sf(self, s: Array) -> Array:
        """Return the share of higher heights."""
        return np.asarray(1 - self.cdf(s))

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Return the height at the share `p` of those below one."""
        n = int(np.searchsorted(self._sorted, below, side="right"))
        return np.asarray(self._sorted[np.clip((p * n).astype(np.int64), 0, max(n - 1, 0))])

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Return the height at the share `p` of those above one, counted from the top."""
        n = len(self.heights) - int(np.searchsorted(self._sorted, above, side="right"))
        return np.asarray(self._sorted[::-1][np.clip((p * n).astype(np.int64), 0, max(n - 1, 0))])


@dataclass(frozen=True)
class MeasuredRadii:
    """Radius ratios c = R_i/R of measured summits: height and radius of a summit stay together.

    Parameters
    ----------
    heights : MeasuredHeights
        Of the same summits.
    ratios : sequence of float
        Radius of each over that of the surface, in the order of the heights; positive.

    Raises
    ------
    ValueError
        If there is not one positive finite ratio for each height.

    Examples
    --------
    >>> law = MeasuredRadii(MeasuredHeights([1.0, 3.0]), [2.0, 0.5])
    >>> law.summits(np.random.default_rng(), 2)
    (array([-1.,  1.]), array([2. , 0.5]))
    """

    heights: MeasuredHeights
    ratios: tuple[float, ...]

    def __init__(self, heights: MeasuredHeights, ratios: Sequence[float] | Array) -> None:
        c = np.asarray(ratios, dtype=np.float64)
        if c.shape != (len(heights.heights),):
            raise ValueError(f"ratios: {c.size} for {len(heights.heights)} heights; give one for each")
        wrong = np.flatnonzero(~(np.isfinite(c) & (c > 0)))
        if wrong.size:
            raise ValueError(f"ratios: number {wrong[0]} is {c[wrong[0]]:g}; give finite numbers > 0")
        hold(self, heights=heights, ratios=tuple(c.tolist()))

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Draw reduced heights and radius ratios of `n` summits with replacement; or return all, as they are.

        Raises
        ------
        ValueError
            If they are not drawn, and `n` is not their number.
        """
        chosen = self.heights._chosen(n, rng)
        return np.array(self.heights.heights)[chosen], np.array(self.ratios)[chosen]
