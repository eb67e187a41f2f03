"""Laws that follow from those of sums: of what rises or falls with a sum, and of where sums reach a value."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic.arrays import Array
from analytic.quadrature import gauss_legendre

_NODES, _RAREST = 48, 1e-13  # of the integrals that give moments
_STEP = 1e-3  # of a difference, in interquartile ranges
_DIFFERENCE = np.array([1, -8, 8, -1]) / 12.0
_MOST = 60


class _Derived:
    """A law of which cdf, sf and quantiles are known."""

    atom = 0.0

    def cdf(self, y: ArrayLike) -> Array:
        raise NotImplementedError

    def sf(self, y: ArrayLike) -> Array:
        raise NotImplementedError

    def ppf(self, q: ArrayLike) -> Array:
        raise NotImplementedError

    def isf(self, q: ArrayLike) -> Array:
        raise NotImplementedError

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
        """Half of the surfaces have less."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Array, Array]:
        """Ends of the range with equal shares of the surfaces below and above."""
        out = (1 - np.asarray(confidence, dtype=np.float64)) / 2
        return self.ppf(out), self.isf(out)

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: Any = None) -> Array:
        """Values of surfaces, drawn by inversion."""
        return self.ppf(np.random.default_rng(random_state).random(size))

    def pdf(self, y: ArrayLike) -> Array:
        """Density, by differences of the cdf."""
        y = np.asarray(y, dtype=np.float64)
        step = _STEP * float(self.ppf(0.75) - self.ppf(0.25))
        return np.tensordot(_DIFFERENCE, [self.cdf(y + k * step) for k in (-2, -1, 1, 2)], 1) / step


@dataclass(frozen=True, eq=False)
class Mapped(_Derived):
    """The law of what rises, or falls, with a sum.

    Parameters
    ----------
    of : law
        Of the sum.
    forward, back : callable
        Take the sum to it, and back.
    falls : bool
        Whether it falls with the sum.
    """

    of: Any
    forward: Callable[[Any], Any]
    back: Callable[[Any], Any]
    falls: bool = False

    @property
    def error(self) -> float:
        """As of the sum."""
        return float(self.of.error)

    def cdf(self, y: ArrayLike) -> Array:
        """P(Y <= y)."""
        x = self.back(np.asarray(y, dtype=np.float64))
        return np.asarray(self.of.sf(x) if self.falls else self.of.cdf(x))

    def sf(self, y: ArrayLike) -> Array:
        """P(Y > y)."""
        x = self.back(np.asarray(y, dtype=np.float64))
        return np.asarray(self.of.cdf(x) if self.falls else self.of.sf(x))

    def ppf(self, q: ArrayLike) -> Array:
        """Least value up to which a share q of the surfaces lies."""
        return np.asarray(self.forward(self.of.isf(q) if self.falls else self.of.ppf(q)))

    def isf(self, q: ArrayLike) -> Array:
        """Least value above which no more than a share q of the surfaces lies."""
        return np.asarray(self.forward(self.of.ppf(q) if self.falls else self.of.isf(q)))


@dataclass(frozen=True, eq=False)
class Along(_Derived):
    """The law of where surfaces, whose sum falls with y, meet a value: P(Y <= y) = P(S(y) <= x(y)).

    Parameters
    ----------
    law : callable
        Takes y to the law of the sum there.
    value : callable
        Takes y to x.
    start, spread : float
        About where, and how far around, to look first.
    """

    law: Callable[[float], Any]
    value: Callable[[float], float]
    start: float
    spread: float

    @cached_property
    def error(self) -> float:
        """As of the sum at the start."""
        return float(self.law(self.start).error)

    def cdf(self, y: ArrayLike) -> Array:
        """P(Y <= y)."""
        return self._each(lambda at: self.law(at).cdf(self.value(at)), y)

    def sf(self, y: ArrayLike) -> Array:
        """P(Y > y)."""
        return self._each(lambda at: self.law(at).sf(self.value(at)), y)

    def ppf(self, q: ArrayLike) -> Array:
        """Least value up to which a share q of the surfaces lies."""
        return self._each(lambda share: self._where(share, upper=False), q)

    def isf(self, q: ArrayLike) -> Array:
        """Least value above which no more than a share q of the surfaces lies."""
        return self._each(lambda share: self._where(share, upper=True), q)

    @staticmethod
    def _each(function: Callable[[float], Any], at: ArrayLike) -> Array:
        at = np.asarray(at, dtype=np.float64)
        return np.array([float(function(x)) for x in at.ravel().tolist()]).reshape(at.shape)[()]

    def _where(self, share: float, *, upper: bool) -> float:
        if not 0 < share < 1:
            return np.nan
        above, tail = upper ^ (share > 0.5), min(share, 1 - share)

        def excess(y: float) -> float:
            at = self.law(y)
            reached = float(at.sf(self.value(y)) if above else at.cdf(self.value(y)))
            with np.errstate(divide="ignore"):
                return float(np.fmax(np.log(reached / tail), -700.0)) * (1 if above else -1)

        low, high, step = self.start - self.spread, self.start + self.spread, self.spread
        for _ in range(_MOST):
            if (too_low := excess(low) <= 0) or excess(high) >= 0:
                step *= 2
                low, high = (low - step, low) if too_low else (high, high + step)
                continue
            from scipy.optimize import brentq  # imports half of SciPy

            return float(brentq(excess, low, high, xtol=1e-13 * self.spread, rtol=1e-14))
        return np.nan
