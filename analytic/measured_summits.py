"""Measured heights used as they are, and the radii that were measured with them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.arrays import Array, hold
from analytic.height_table import checked_heights, reduced
from analytic.heights import HeightLaw


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

    def __init__(self, heights: Sequence[float] | Array, *, resampled: bool = False) -> None:
        z = checked_heights(heights)
        if abs(z.mean()) > 1e-12 or abs(z.std() - 1) > 1e-12:
            z = reduced(z)
        hold(self, heights=tuple(z.tolist()), resampled=resampled)

    @cached_property
    def _sorted(self) -> Array:
        return np.sort(np.array(self.heights))

    @property
    def support(self) -> tuple[float, float]:
        """Lowest and highest of them."""
        return float(self._sorted[0]), float(self._sorted[-1])

    def span(self, s: float) -> float:
        """Return no width: there is no density.

        Raises
        ------
        ValueError
            Always.
        """
        raise ValueError(
            f"measured heights have no density at s = {s:g}; make a HeightTable, or sum them directly"
        )

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Return the heights themselves, in their own order; or draw `n` of them with replacement.

        Raises
        ------
        ValueError
            If they are not drawn, and `n` is not their number.
        """
        if self.resampled:
            return np.array(self.heights)[rng.integers(0, len(self.heights), n)]
        if n != len(self.heights):
            raise ValueError(f"n = {n}: give {len(self.heights)}, the number of measured heights")
        return np.array(self.heights)

    def pdf(self, s: Array) -> Array:
        """Refuse to answer: there is no density; see `span`."""
        self.span(float(np.ravel(s)[0]))
        raise AssertionError

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
        s, c = self._pairs
        if not self.heights.resampled:
            return self.heights.rvs(n, rng), c
        which = rng.integers(0, c.size, n)
        return s[which], c[which]

    @cached_property
    def _pairs(self) -> tuple[Array, Array]:
        return np.array(self.heights.heights), np.array(self.ratios)
