"""Distributions over surfaces, with the methods of `scipy.stats`: tables, and numbers of asperities."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold

_NARROW = 1e-9  # of the table: cells that have no density to be told
_FAR = 1e100  # beyond all sums
NOTHING = 1e-100  # less than any sum but 0
_SAFE = 8.0  # times what two computations differ by: their errors may have one sign
_USUAL = 5e-7  # over the root of a share: what two computations may have in common, by a grid of 630 laws
_NEIGHBOURS = 1 / 40  # of the table, in which the largest difference counts: differences pass through 0
_LEAST = 1e-30  # less than any fraction that is reported
_SCIPY = 1e-14


class Law:
    """Distribution of a value over surfaces; arguments have any shape.

    It has cdf, sf, pdf, ppf, isf, mean, var, `error` (bound of the error of cdf) and `error_at` (relative, of
    the smaller one of cdf and sf).
    """

    cdf: Callable[[ArrayLike], Array]
    sf: Callable[[ArrayLike], Array]
    pdf: Callable[[ArrayLike], Array]
    ppf: Callable[[ArrayLike], Array]
    isf: Callable[[ArrayLike], Array]
    error_at: Callable[[ArrayLike], Array]
    mean: Callable[[], float]
    var: Callable[[], float]
    mapped: Callable[..., "Law"]

    @property
    def error(self) -> float:
        """Error bound of `cdf`."""
        return _SCIPY

    def __repr__(self) -> str:
        """One line: all that it holds would fill pages."""
        return f"{type(self).__name__}(mean={self.mean():.4g}, std={self.std():.4g})"

    @property
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return float(self.cdf(0.0) - self.cdf(-NOTHING * _FAR**0.5))

    def std(self) -> float:
        """Return the standard deviation over surfaces."""
        return float(np.sqrt(self.var()))

    def median(self) -> float:
        """Return the median over surfaces: half of them lie below it."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Array, Array]:
        """Return the ends of the range with equal shares of the surfaces below and above."""
        out = (1 - np.asarray(confidence, dtype=np.float64)) / 2
        return self.ppf(out), self.isf(out)

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: Any = None) -> Array:
        """Draw random values, by inversion."""
        return self.ppf(np.random.default_rng(random_state).random(size))


@dataclass(frozen=True, eq=False, repr=False)
class Table(Law):
    """Distribution of a value over surfaces as a table.

    Between the points of the table, of which the first and the last are those that lattices resolve, shares
    are linear. Beyond them the smaller share is an upper bound (Chebyshev's, and that at the last
    point) with `error_at` = 1, and quantiles are nan.

    Parameters
    ----------
    x : ndarray
        Values, increasing.
    below, above : ndarray
        Shares of the surfaces up to and above each, as accurate as they are small.
    moments : (float, float)
        Mean and variance over surfaces.
    ends : (float, float)
        The least and the greatest value that there is.
    rounding : float
        Of the shares.
    again : callable
        Computes the law once more, by other lattices and other cells of the heights.
    """

    x: Array
    below: Array
    above: Array
    moments: tuple[float, float]
    ends: tuple[float, float]
    rounding: float
    again: Callable[[], Any]

    def mean(self) -> float:
        """Return the mean over surfaces."""
        return self.moments[0]

    def var(self) -> float:
        """Return the variance over surfaces."""
        return self.moments[1]

    def cdf(self, y: ArrayLike) -> Array:
        """Return P(Y <= y)."""
        return self._shares(y)[0]

    def sf(self, y: ArrayLike) -> Array:
        """Return P(Y > y)."""
        return self._shares(y)[1]

    def _shares(self, y: ArrayLike) -> tuple[Array, Array]:
        """Shares up to and above; the greater one is what the smaller one leaves of 1."""
        y, (mean, variance) = np.asarray(y, dtype=np.float64), self.moments
        with np.errstate(divide="ignore", invalid="ignore"):
            chebyshev = variance / (y - mean) ** 2
        rarest = (
            np.fmin(max(float(end), self.rounding), chebyshev) for end in (self.below[0], self.above[-1])
        )
        below = np.where(y < self.x[0], next(rarest), np.interp(y, self.x, self.below))
        above = np.where(y > self.x[-1], next(rarest), np.interp(y, self.x, self.above))
        lower, outside = below < above, [y < self.ends[0], y >= self.ends[1], np.isnan(y)]
        below, above = np.where(lower, below, 1 - above), np.where(lower, 1 - below, above)
        return np.select(outside, [0.0, 1.0, np.nan], below)[()], np.select(
            outside, [1.0, 0.0, np.nan], above
        )[()]

    def ppf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y <= y) >= q; nan beyond what lattices resolve."""
        return self._quantiles(np.asarray(q, dtype=np.float64), 1 - np.asarray(q, dtype=np.float64))

    def isf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y > y) <= q; nan beyond what lattices resolve."""
        return self._quantiles(1 - np.asarray(q, dtype=np.float64), np.asarray(q, dtype=np.float64))

    def _quantiles(self, below: Array, above: Array) -> Array:
        by_below = np.interp(below, self.below, self.x, left=np.nan)
        by_above = np.interp(above, self.above[::-1], self.x[::-1], left=np.nan)
        found = np.where(below < above, by_below, by_above)
        found = np.where(np.abs(found) <= NOTHING * _FAR**0.5, 0.0, found)
        outside = [(below < 0) | (above < 0) | np.isnan(below), below == 0, above == 0]
        return np.select(outside, [np.nan, *self.ends], found)[()]

    def pdf(self, y: ArrayLike) -> Array:
        """Return the density of all values but those with a probability of their own."""
        middle, shares, widths = self._cells
        wide = widths > _NARROW * (self.x[-1] - self.x[0])
        y, density = np.asarray(y, dtype=np.float64), shares[wide] / widths[wide]
        return np.asarray(np.interp(y, middle[wide], density, left=0.0, right=0.0))[()]

    @cached_property
    def _cells(self) -> tuple[Array, Array, Array]:
        """Middle, share and width of what lies between neighbours in the table."""
        low = self.below[1:] < self.above[1:]
        shares = np.where(low, np.diff(self.below), -np.diff(self.above))
        return (self.x[1:] + self.x[:-1]) / 2, shares, np.diff(self.x)

    def error_at(self, y: ArrayLike) -> Array:
        """Return a relative error bound of the smaller one of cdf and sf, from the second computation."""
        y = np.asarray(y, dtype=np.float64)
        known, beyond = (y < self.ends[0]) | (y >= self.ends[1]), (y < self.x[0]) | (y > self.x[-1])
        found = self._bound(y, self._near) / np.maximum(np.minimum(*self._shares(y)), _LEAST)
        return np.select([known, beyond], [0.0, 1.0], found)[()]

    @property
    def error(self) -> float:
        """Error bound of `cdf`, from the second computation."""
        return float(self._bound(self.x, self._apart).max())

    def _bound(self, y: Array, apart: Array) -> Array:
        """Error bound by the differences of the second computation at the points of the table."""
        usual = _USUAL * np.sqrt(np.minimum(*self._shares(y)))
        return np.asarray(_SAFE * np.interp(y, self.x, apart) + usual + self.rounding)

    @cached_property
    def _apart(self) -> Array:
        """Differences between the two computations at the points of the table."""
        lower, upper = self.again()._shares(self.x)
        rarer = self.below < self.above
        return np.asarray(np.where(rarer, np.abs(self.below - lower), np.abs(self.above - upper)))

    @cached_property
    def _near(self) -> Array:
        """The largest in a neighbourhood, or as large in relation to the share, whichever is less."""
        from scipy.ndimage import maximum_filter1d  # few ask

        rarer, size = np.minimum(self.below, self.above), 1 + 2 * int(_NEIGHBOURS * self.x.size)
        relative = np.where(rarer > self.rounding, self._apart / np.maximum(rarer, _LEAST), 0.0)
        near = np.minimum(maximum_filter1d(self._apart, size), rarer * maximum_filter1d(relative, size))
        return np.asarray(np.maximum(self._apart, near))

    def with_moments(self) -> "Table":
        """Return it with the mean and variance of the table."""
        middle, shares, _ = self._cells
        mean = float(shares @ middle / shares.sum())
        return replace(self, moments=(mean, float(shares @ (middle - mean) ** 2)))

    def mapped(self, forward: Callable[[Any], Any], *, falls: bool = False) -> "Table":
        """Return the law of a function that rises, or falls, with the value.

        What the table lacks of the moments counts by the slope at the mean.
        """
        (middle, shares, _), (mean, variance), std = self._cells, self.moments, self.std() or 1.0
        f, slope = forward(middle), (forward(mean + std / 8) - forward(mean - std / 8)) / (std / 4)
        of_x, of_f = float(shares @ middle), float(shares @ f)
        more = variance - float(shares @ (middle - of_x) ** 2)
        moments = of_f + slope * (mean - of_x), float(shares @ (f - of_f) ** 2) + slope**2 * more
        turned = slice(None, None, -1 if falls else 1)
        below, above = (self.above, self.below) if falls else (self.below, self.above)
        ends = np.array([float(forward(end)) for end in np.clip(self.ends, -_FAR, _FAR).tolist()])
        ends[np.abs(ends) > np.sqrt(_FAR)] *= np.inf
        return replace(
            self,
            x=forward(self.x)[turned],
            below=below[turned],
            above=above[turned],
            moments=moments,
            ends=tuple(ends[turned].tolist()),
            again=lambda: self.again().mapped(forward, falls=falls),
        )


@dataclass(frozen=True, eq=False, repr=False)
class Counted(Law):
    """Distribution of a number of asperities, binomial or Poisson, from `scipy.stats`.

    Parameters
    ----------
    share : float
        Probability that an asperity counts.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    """

    share: float
    number: float
    poisson: bool

    def __post_init__(self) -> None:
        """Take the functions from SciPy."""
        from scipy.stats import binom, poisson  # takes long to import

        of_number = poisson(self.number * self.share)
        law = of_number if self.poisson else binom(round(self.number), self.share)
        functions = {name: getattr(law, name) for name in ("cdf", "sf", "ppf", "isf", "mean", "var")}
        hold(self, **functions, pdf=law.pmf, error_at=lambda y: np.full(np.shape(y), _SCIPY)[()])
