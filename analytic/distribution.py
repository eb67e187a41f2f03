"""Distributions over surfaces, with the methods of `scipy.stats`."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array, hold

_FAR = 1e100  # beyond all sums


@dataclass(frozen=True, eq=False, repr=False)
class Law:
    """Distribution of a value over surfaces, as a table; arguments have any shape.

    Shares are linear between the points of the table, of which the first and the last are those that lattices
    resolve. Beyond them the share is a bound, that at the last point, and quantiles are nan.
    """

    x: Array  # values, increasing; twice where one has a probability of its own
    upto: Array  # shares of the surfaces up to each
    ends: tuple[float, float]  # values that none is below, or above
    again: Callable[[], Any]  # computes the law once more, by other lattices and other cells of the heights
    moments: tuple[float, float] | None = None  # mean and variance over surfaces; default: of the table

    def __repr__(self) -> str:
        """One line: all that it holds would fill pages."""
        return f"{type(self).__name__}(mean={self.mean():.4g}, std={self.std():.4g})"

    def mean(self) -> float:
        """Return the mean over surfaces."""
        return self._mean_var[0]

    def var(self) -> float:
        """Return the variance over surfaces."""
        return self._mean_var[1]

    @cached_property
    def _mean_var(self) -> tuple[float, float]:
        if self.moments is not None:
            return self.moments
        p, middle = np.diff(self.upto), (self.x[1:] + self.x[:-1]) / 2
        mean = float(p @ middle / p.sum())
        return mean, float(p @ (middle - mean) ** 2)

    def std(self) -> float:
        """Return the standard deviation over surfaces."""
        return float(np.sqrt(self.var()))

    def cdf(self, y: ArrayLike) -> Array:
        """Return P(Y <= y)."""
        y = np.asarray(y, dtype=np.float64)
        outside = [np.isnan(y), y < self.ends[0], y >= self.ends[1]]
        return np.select(outside, [np.nan, 0.0, 1.0], np.interp(y, self.x, self.upto))[()]

    def sf(self, y: ArrayLike) -> Array:
        """Return P(Y > y)."""
        return 1 - self.cdf(y)

    def ppf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y <= y) >= q; nan beyond what lattices resolve."""
        q = np.asarray(q, dtype=np.float64)
        found = np.interp(q, self.upto, self.x, left=np.nan, right=np.nan)
        return np.select([q == 0, q == 1], self.ends, found)[()]

    def isf(self, q: ArrayLike) -> Array:
        """Return the smallest value y with P(Y > y) <= q; nan beyond what lattices resolve."""
        return self.ppf(1 - np.where(np.asarray(q) > 0, np.maximum(q, 2.0**-53), q))

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

    def pdf(self, y: ArrayLike) -> Array:
        """Return the density of all values but those with a probability of their own."""
        widths = np.diff(self.x)
        wide = widths > 1e-9 * (self.x[-1] - self.x[0])  # others have no density to be told
        middle, density = self.x[:-1][wide] + widths[wide] / 2, np.diff(self.upto)[wide] / widths[wide]
        return np.asarray(np.interp(np.asarray(y, dtype=np.float64), middle, density, left=0, right=0))[()]

    @property
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return float(self.cdf(0.0) - self.cdf(-1e-50))

    @cached_property
    def error(self) -> float:
        """Error bound of `cdf`, from the second computation."""
        again, x = self.again(), np.append(self.x, (self.x[1:] + self.x[:-1]) / 2)
        return float(8 * np.abs(self.cdf(x) - again.cdf(x)).max() + 5e-7)  # by a grid of 630 laws

    def mapped(self, forward: Callable[[Any], Any], *, falls: bool = False) -> "Law":
        """Return the law of a function that rises, or falls, with the value."""
        way = -1 if falls else 1
        ends = np.array([float(forward(end)) for end in np.clip(self.ends, -_FAR, _FAR).tolist()])
        ends[np.abs(ends) > np.sqrt(_FAR)] *= np.inf
        return replace(
            self,
            x=forward(self.x)[::way],
            upto=1 - self.upto[::-1] if falls else self.upto,
            moments=None,
            ends=tuple(ends[::way].tolist()),
            again=lambda: self.again().mapped(forward, falls=falls),
        )


class Counted(Law):
    """Distribution of a number of asperities, with the functions of one of `scipy.stats`."""

    def __init__(self, of_number: Any) -> None:
        """Take its functions; `pdf` is the probability of a number."""
        functions = {name: getattr(of_number, name) for name in ("cdf", "sf", "ppf", "isf", "mean", "var")}
        hold(self, **functions, pdf=of_number.pmf, error=1e-14)
