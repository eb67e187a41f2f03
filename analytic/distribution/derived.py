"""Distributions that follow from those of sums: of functions of a sum, and of where sums reach a value."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.inversion import LOWEST
from analytic.quadrature import gauss_legendre

_NODES, _RAREST = 48, 1e-13  # of the integrals that give moments
_STEP = 1e-3  # of a difference, in interquartile ranges
_DIFFERENCE = np.array([1, -8, 8, -1]) / 12.0
_MOST = 60
_SCIPY = 1e-14


class Law:
    """Distribution of a value over surfaces, with the methods of `scipy.stats`; arguments have any shape."""

    def __repr__(self) -> str:
        """One line: all that it holds would fill pages."""
        return f"{type(self).__name__}(mean={self.mean():.4g}, std={self.std():.4g})"

    @property
    def error(self) -> float:
        """Error bound of `cdf`."""
        raise NotImplementedError

    def error_at(self, y: ArrayLike) -> Array:
        """Relative error bound of the smaller one of cdf and sf at these values."""
        raise NotImplementedError

    @property
    def atom(self) -> float:
        """Probability that no asperity touches."""
        return 0.0

    def _tail(self, y: ArrayLike, *, upper: bool) -> Array:
        """Share of the surfaces above y, or up to it."""
        raise NotImplementedError

    def _quantile(self, q: ArrayLike, *, upper: bool) -> Array:
        """Value with this share of the surfaces above, or below it."""
        raise NotImplementedError

    def cdf(self, y: ArrayLike) -> Array:
        """P(Y <= y)."""
        return self._tail(y, upper=False)

    def sf(self, y: ArrayLike) -> Array:
        """P(Y > y)."""
        return self._tail(y, upper=True)

    def ppf(self, q: ArrayLike) -> Array:
        """Smallest value y with P(Y <= y) >= q."""
        return self._quantile(q, upper=False)

    def isf(self, q: ArrayLike) -> Array:
        """Smallest value y with P(Y > y) <= q."""
        return self._quantile(q, upper=True)

    @cached_property
    def _moments(self) -> tuple[float, float]:
        """Mean and variance, by integrals of the tails on either side of the median."""
        middle, low, high = float(self.ppf(0.5)), float(self.ppf(_RAREST)), float(self.isf(_RAREST))
        x, w = gauss_legendre(_NODES)
        below, above = (middle - low) * x, (high - middle) * x
        less, more = self.cdf(middle - below) * w, self.sf(middle + above) * w
        first = (high - middle) * more.sum() - (middle - low) * less.sum()
        second = 2 * ((high - middle) * (above @ more) + (middle - low) * (below @ less))
        return middle + float(first), float(second - first**2)

    def mean(self) -> float:
        """Mean over surfaces."""
        return self._moments[0]

    def var(self) -> float:
        """Variance over surfaces."""
        return self._moments[1]

    def std(self) -> float:
        """Standard deviation over surfaces."""
        return float(np.sqrt(self.var()))

    def median(self) -> float:
        """Median over surfaces: half of them lie below it."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Array, Array]:
        """Ends of the range with equal shares of the surfaces below and above."""
        out = (1 - np.asarray(confidence, dtype=np.float64)) / 2
        return self.ppf(out), self.isf(out)

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: Any = None) -> Array:
        """Random values, drawn by inversion."""
        return self.ppf(np.random.default_rng(random_state).random(size))

    def pdf(self, y: ArrayLike) -> Array:
        """Density, from differences of the cdf."""
        y = np.asarray(y, dtype=np.float64)
        step = _STEP * float(self.ppf(0.75) - self.ppf(0.25))
        return np.tensordot(_DIFFERENCE, [self.cdf(y + k * step) for k in (-2, -1, 1, 2)], 1) / step


@dataclass(frozen=True, eq=False, repr=False)
class Mapped(Law):
    """Distribution of a function that rises, or falls, with a sum.

    Parameters
    ----------
    of : law
        Of the sum.
    forward, back : callable
        The function of the sum, and its inverse.
    falls : bool
        Whether the function falls with the sum.
    """

    of: Law
    forward: Callable[[Any], Any]
    back: Callable[[Any], Any]
    falls: bool = False

    @property
    def error(self) -> float:
        """As of the sum."""
        return float(self.of.error)

    def error_at(self, y: ArrayLike) -> Array:
        """As `Law.error_at`."""
        return self.of.error_at(self.back(np.asarray(y, dtype=np.float64)))

    @property
    def atom(self) -> float:
        """As of the sum."""
        return float(self.of.atom)

    def _tail(self, y: ArrayLike, *, upper: bool) -> Array:
        x = self.back(np.asarray(y, dtype=np.float64))
        return np.asarray(self.of.sf(x) if self.falls ^ upper else self.of.cdf(x))

    def _quantile(self, q: ArrayLike, *, upper: bool) -> Array:
        return np.asarray(self.forward(self.of.isf(q) if self.falls ^ upper else self.of.ppf(q)))


@dataclass(frozen=True, eq=False, repr=False)
class Along(Law):
    """Distribution of where sums that fall with y reach a value: P(Y <= y) = P(S(y) <= x(y)).

    Parameters
    ----------
    law : callable
        Gives the distribution of the sum at y.
    value : callable
        Gives x at y.
    start, spread : float
        About where, and how far around, to look first.
    """

    law: Callable[[float], Any]
    value: Callable[[float], float]
    start: float
    spread: float

    @property
    def error(self) -> float:
        """As of the sum at the start."""
        return float(self.law(self.start).error)

    def error_at(self, y: ArrayLike) -> Array:
        """As `Law.error_at`."""
        return self._each(lambda x: self.law(x).error_at(self.value(x)), y)

    def _tail(self, y: ArrayLike, *, upper: bool) -> Array:
        return self._each(partial(self._reached, upper=upper), y)

    def _quantile(self, q: ArrayLike, *, upper: bool) -> Array:
        return self._each(partial(self._where, upper=upper), q)

    def _reached(self, y: float, *, upper: bool) -> float:
        law = self.law(y)
        return float((law.sf if upper else law.cdf)(self.value(y)))

    @staticmethod
    def _each(function: Callable[[float], Any], at: ArrayLike) -> Array:
        at = np.asarray(at, dtype=np.float64)
        return np.array([float(function(x)) for x in at.ravel().tolist()]).reshape(at.shape)[()]

    def _where(self, share: float, *, upper: bool) -> float:
        if not 0 < share < 1:
            return np.nan
        above, tail = upper ^ (share > 0.5), min(share, 1 - share)

        def excess(y: float) -> float:
            with np.errstate(divide="ignore"):
                log = np.log(self._reached(y, upper=above) / tail)
            return float(np.fmax(log, -700.0)) * (1 if above else -1)

        low, high, step = self.start - self.spread, self.start + self.spread, self.spread
        for _ in range(_MOST):
            if (too_low := excess(low) <= 0) or excess(high) >= 0:
                if too_low and low <= LOWEST:  # as a share of surfaces without any asperity
                    break
                step *= 2
                low, high = (max(low - step, LOWEST), low) if too_low else (high, high + step)
                continue
            from scipy.optimize import brentq  # imports half of SciPy

            return float(brentq(excess, low, high, xtol=1e-13 * self.spread, rtol=1e-14))
        return np.nan


@dataclass(frozen=True, repr=False)
class Counted(Law):
    """Exact distribution of a number of asperities, binomial or Poisson, from `scipy.stats`.

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

    @property
    def error(self) -> float:
        """Of SciPy's functions."""
        return _SCIPY

    def error_at(self, y: ArrayLike) -> Array:
        """As `Law.error_at`."""
        return np.full(np.shape(y), _SCIPY)[()]

    @cached_property
    def _law(self) -> Any:
        from scipy.stats import binom, poisson  # takes long to import

        if self.poisson:
            return poisson(self.number * self.share)
        return binom(round(self.number), self.share)

    @property
    def atom(self) -> float:
        """Probability of no asperity."""
        return float(self.pdf(0))

    def pdf(self, y: ArrayLike) -> Array:
        """Probability of a number."""
        return np.asarray(self._law.pmf(y))

    def mean(self) -> float:
        """Mean over surfaces."""
        return float(self._law.mean())

    def var(self) -> float:
        """Variance over surfaces."""
        return float(self._law.var())

    def _tail(self, y: ArrayLike, *, upper: bool) -> Array:
        return np.asarray((self._law.sf if upper else self._law.cdf)(y))

    def _quantile(self, q: ArrayLike, *, upper: bool) -> Array:
        return np.asarray((self._law.isf if upper else self._law.ppf)(q))
