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
_LEAST = 1e-60  # below all sums but 0
_SAFE = 8.0  # times what two computations differ by: their errors may have one sign
_USUAL = 5e-7  # over the root of a share: what two computations may have in common, by a grid of 630 laws
_SHARES = np.geomspace(1e-9, 0.5, 60)
_NEIGHBOURS = 5  # on either side
_SCIPY = 1e-14


class Law:
    """Distribution of a value over surfaces; arguments have any shape.

    It has cdf, sf, pdf, ppf, isf, mean, var, `atom` (probability that no asperity touches), `error` (bound of
    the error of cdf) and `error_at` (relative, of the smaller one of cdf and sf).
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
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return float(self.cdf(0.0))

    @property
    def error(self) -> float:
        """Error bound of `cdf`."""
        return _SCIPY

    def __repr__(self) -> str:
        """One line: all that it holds would fill pages."""
        return f"{type(self).__name__}(mean={self.mean():.4g}, std={self.std():.4g})"

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
    mean_and_variance : (float, float)
        Over surfaces.
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
    mean_and_variance: tuple[float, float]
    ends: tuple[float, float]
    rounding: float
    again: Callable[[], Any]

    @property
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return float(self.cdf(0.0) - self.cdf(-_LEAST)) if self.x[0] <= 0 else 0.0

    def cdf(self, y: ArrayLike) -> Array:
        """Return P(Y <= y)."""
        return self._shares(y)[0]

    def sf(self, y: ArrayLike) -> Array:
        """Return P(Y > y)."""
        return self._shares(y)[1]

    def _shares(self, y: ArrayLike) -> tuple[Array, Array]:
        """Shares up to and above; the greater one is what the smaller one leaves of 1."""
        y, (mean, variance) = np.asarray(y, dtype=np.float64), self.mean_and_variance
        with np.errstate(divide="ignore", invalid="ignore"):
            chebyshev = variance / (y - mean) ** 2
        bounds = (
            np.fmin(max(float(end), self.rounding), chebyshev) for end in (self.below[0], self.above[-1])
        )
        below = np.where(y < self.x[0], next(bounds), np.interp(y, self.x, self.below))
        above = np.where(y > self.x[-1], next(bounds), np.interp(y, self.x, self.above))
        above, below = np.where(y < self.ends[0], 1.0, above), np.where(y < self.ends[0], 0.0, below)
        below, above = np.where(y >= self.ends[1], 1.0, below), np.where(y >= self.ends[1], 0.0, above)
        lower = np.where(np.isnan(y), np.nan, np.where(below < above, below, 1 - above))
        return lower[()], np.where(np.isnan(y), np.nan, np.where(below < above, 1 - below, above))[()]

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
        found = np.where(below == 0, self.ends[0], np.where(above == 0, self.ends[1], found))
        found = np.where(np.abs(found) < _LEAST, 0.0, found)
        return np.where((below >= 0) & (above >= 0), found, np.nan)[()]

    def mean(self) -> float:
        """Return the mean over surfaces."""
        return self.mean_and_variance[0]

    def var(self) -> float:
        """Return the variance over surfaces."""
        return self.mean_and_variance[1]

    def pdf(self, y: ArrayLike) -> Array:
        """Return the density of all values but those with a probability of their own."""
        middle, shares, widths = self._cells
        wide = widths > _NARROW * (self.x[-1] - self.x[0])
        y = np.asarray(y, dtype=np.float64)
        inside = (y >= self.x[0]) & (y <= self.x[-1])
        return np.where(inside, np.interp(y, middle[wide], shares[wide] / widths[wide]), 0.0)[()]

    @cached_property
    def _cells(self) -> tuple[Array, Array, Array]:
        """Middle, share and width of what lies between neighbours in the table."""
        low = self.below[1:] < self.above[1:]
        shares = np.where(low, np.diff(self.below), -np.diff(self.above))
        return (self.x[1:] + self.x[:-1]) / 2, shares, np.diff(self.x)

    def error_at(self, y: ArrayLike) -> Array:
        """Return a relative error bound of the smaller one of cdf and sf, from the second computation."""
        y = np.asarray(y, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.maximum(self._apart(y) / self._rarer(y), np.interp(y, *self._near))
        beyond = (y < self.x[0]) | (y > self.x[-1])
        known = (y < self.ends[0]) | (y >= self.ends[1])
        return np.where(known, 0.0, np.where(beyond, 1.0, found))[()]

    @property
    def error(self) -> float:
        """Error bound of `cdf`, from the second computation."""
        return float(self._apart(self._places).max(initial=self.rounding))

    def _rarer(self, y: Array) -> Array:
        return np.asarray(np.minimum(*self._shares(y)))

    def _apart(self, y: Array) -> Array:
        """Error bound by the second computation at these values alone."""
        (below, above), (lower, upper) = self._shares(y), self._other._shares(y)
        apart = np.where(below < above, np.abs(below - lower), np.abs(above - upper))
        own = _USUAL * np.sqrt(np.minimum(below, above))
        return np.asarray(_SAFE * apart + self._bend(y) + own + self.rounding)

    @cached_property
    def _places(self) -> Array:
        """Values over the whole table."""
        even = np.linspace(self.x[0], self.x[-1], _SHARES.size)
        x = np.concatenate([self.ppf(_SHARES), self.isf(_SHARES), even])
        return np.unique(x[self._rarer(x) > self.rounding])

    @cached_property
    def _near(self) -> tuple[Array, Array]:
        """Those values, and the largest relative bound in the neighbourhood: differences pass through 0."""
        x = self._places if self._places.size else self.x[-1:]
        bounds = np.pad(self._apart(x) / np.maximum(self._rarer(x), self.rounding), _NEIGHBOURS, "edge")
        return x, np.lib.stride_tricks.sliding_window_view(bounds, 2 * _NEIGHBOURS + 1).max(axis=1)

    def _bend(self, y: Array) -> Array:
        """What shares may be off by that are linear between neighbours: twice a turning density's."""
        _, shares, widths = self._cells
        wide = widths > _NARROW * (self.x[-1] - self.x[0])
        turned = np.diff(shares[wide] / widths[wide], append=0.0) * widths[wide] / 4
        return np.asarray(np.interp(y, self.x[1:][wide], np.abs(turned)))

    @cached_property
    def _other(self) -> "Table":
        other: Table = self.again()
        return other

    def with_moments(self) -> "Table":
        """Return it with the mean and variance of the table."""
        middle, shares, _ = self._cells
        mean = float(shares @ middle / shares.sum())
        return replace(self, mean_and_variance=(mean, float(shares @ (middle - mean) ** 2)))

    def mapped(self, forward: Callable[[Any], Any], *, falls: bool = False) -> "Table":
        """Return the law of a function that rises, or falls, with the value."""
        middle, shares, _ = self._cells
        mean, std = self.mean(), self.std() or 1.0
        f, slope = forward(middle), (forward(mean + std / 8) - forward(mean - std / 8)) / (std / 4)
        of_x, of_f = float(shares @ middle), float(shares @ f)
        more = self.var() - float(shares @ (middle - of_x) ** 2)  # than the table has
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
            mean_and_variance=moments,
            ends=tuple(ends[turned].tolist()),
            again=lambda: self._other.mapped(forward, falls=falls),
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
        hold(self, **functions, pdf=law.pmf)

    def error_at(self, y: ArrayLike) -> Array:
        """As `Law.error_at`: that of SciPy's functions."""
        return np.full(np.shape(y), _SCIPY)[()]
