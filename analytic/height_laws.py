"""Laws of summit heights beside the Gaussian: exponential, Weibull, and any of scipy.stats.

All are reduced: s = (z - mean)/(standard deviation). Separations stay d/sigma from the mean height.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammaln, zeta

from analytic.elementary import exp, expm1, log, log1p
from analytic.heights import HeightLaw
from analytic.in_time import in_time
from analytic.resolution import resolved_breaks

__all__ = ["ExponentialHeights", "ScipyHeights", "Weibull", "narrowest"]

Array = NDArray[np.float64]
T = TypeVar("T")

_SERIES = 4.0  # shape of a Weibull law from which on its spread is summed in powers of its inverse
_BEND = 0.5  # change of the logarithm of the density over a span
_SECONDS = 5.0  # for moments, or jumps, of a law of scipy: some are integrals of integrals
_NOISE = 2.0**-30  # of a density that is the exponential of large terms, as of gamma(1e4)
_RARE = np.array([1e-3, 1e-9, 1e-15, 1e-24, 1e-36])
_TRIAL, _TRIAL_SECONDS = np.array([1e-9, 0.1, 0.5, 0.9]), 1.0  # a few of the thousands of calls to come


@lru_cache(maxsize=4096)  # every quantity asks for the same heights, and a call of scipy's laws is slow
def narrowest(law: HeightLaw, s: float) -> float:
    """Width, halved until no quarter changes the logarithm of the density by more than 1/8."""
    width = max(_BEND, abs(s) / 8)  # far out in a heavy tail, a share of the height
    parts = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    for _ in range(5):
        widths = width / 2.0 ** np.arange(8)  # at once: a call of scipy's laws takes a millisecond
        with np.errstate(all="ignore"):
            change = np.abs(np.diff(law.log_ratio(np.array(s), widths[:, None] * parts)))
        even = np.flatnonzero(np.all(change <= _BEND / 4, axis=1))
        if even.size:
            return float(widths[even[0]])
        width = float(widths[-1]) / 2
    if np.isnan(change).all():  # there would be no end of ever smaller cells
        raise ValueError(
            f"heights: their density is 0 at s = {s:.6g}, inside the support; fill the gap, say by wider bins"
        )
    return width


@dataclass(frozen=True)
class ExponentialHeights:
    """Exponential law: ``exp(-1 - s)`` for s > -1.

    Greenwood and Williamson (1966) used it for its closed form, ``F_n(h) = Gamma(n+1) exp(-1 - h)``
    for h >= -1: load, area and number of contacts are proportional to each other.

    Examples
    --------
    >>> import numpy as np
    >>> float(ExponentialHeights().sf(np.array(-1.0)))
    1.0
    """

    support: tuple[float, float] = (-1.0, math.inf)
    breaks: tuple[float, ...] = (-1.0,)
    singular: tuple[float, ...] = ()

    def span(self, s: float) -> float:  # noqa: ARG002 - the same everywhere
        """One half: the logarithm of the density is linear."""
        return _BEND

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Standard exponential numbers, less their mean."""
        return rng.standard_exponential(n) - 1

    def pdf(self, s: Array) -> Array:
        """``exp(-1 - s)`` for s >= -1."""
        return np.asarray(np.where(s >= -1, exp(-1 - np.maximum(s, -1.0)), 0.0))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """``-t``."""
        return -t + 0 * s

    def cdf(self, s: Array) -> Array:
        """``1 - exp(-1 - s)``."""
        return np.asarray(-expm1(-1 - np.maximum(s, -1.0)))

    def sf(self, s: Array) -> Array:
        """``exp(-1 - s)``."""
        return np.asarray(exp(-1 - np.maximum(s, -1.0)))

    def ppf(self, p: Array, below: float = math.inf) -> Array:
        """``-1 - log(1 - p cdf(below))``."""
        return np.asarray(-1 - log1p(-p * self.cdf(np.array(below))))

    def isf(self, p: Array, above: float = -math.inf) -> Array:
        """``max(above, -1) - log(p)``."""
        return np.asarray(max(above, -1.0) - log(p))


@dataclass(frozen=True)
class Weibull:
    """Weibull law of a given shape (McCool 1992, Int. J. Mach. Tools Manuf. 32, 115).

    Parameters
    ----------
    shape : float
        1 is exponential, 3.6 has no skewness (0 at 3.60235, +1 at 1.56391, -1 at 40.743).

    Raises
    ------
    ValueError
        If the shape is not between 1 and 100.

    Examples
    --------
    >>> Weibull(2.0).support
    (-1.9130583802711005, inf)
    """

    shape: float

    def __post_init__(self) -> None:
        if not 1 <= self.shape <= 100:
            raise ValueError(f"shape = {self.shape!r}: give a number from 1 to 100")

    @cached_property
    def _spread(self) -> tuple[float, float]:
        """Deviation over mean of the unreduced x of scale 1, and the logarithm of the mean of x times k."""
        return _weibull_spread(self.shape)

    @property
    def support(self) -> tuple[float, float]:
        """From x = 0 on."""
        return (-1 / self._spread[0], math.inf)

    @property
    def breaks(self) -> tuple[float, ...]:
        """The lower end, where the density is smooth from above for shape 1 only."""
        return self.support[:1] if self.shape == 1 else ()

    @property
    def singular(self) -> tuple[float, ...]:
        """The lower end, a broken power unless the shape is 1."""
        return () if self.shape == 1 else self.support[:1]

    def span(self, s: float) -> float:
        """Where the logarithm of the density changes evenly, by at most one half."""
        return narrowest(self, s)

    def _log_x(self, s: Array) -> Array:
        """Logarithm of x over its mean: neither near 1 nor near the lower end does a digit cancel."""
        spread = self._spread[0]
        relative = np.maximum(spread * np.asarray(s), -1.0)
        above_end = np.maximum(spread * (np.asarray(s) - self.support[0]), 0.0)
        with np.errstate(divide="ignore"):
            return np.where(relative > -0.5, np.log1p(relative), np.log(above_end))

    def _power(self, s: Array) -> Array:
        """``x^k``."""
        return np.asarray(np.exp(self.shape * self._log_x(s) + self._spread[1]))

    def _s(self, power: Array) -> Array:
        """Height of a given ``x^k``."""
        spread, log_mean = self._spread
        with np.errstate(divide="ignore"):
            return np.asarray(np.expm1((np.log(power) - log_mean) / self.shape) / spread)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Powers of NumPy's standard exponential numbers, reduced."""
        return self._s(rng.standard_exponential(n))

    def pdf(self, s: Array) -> Array:
        """``k x^(k-1) exp(-x^k)`` times the standard deviation of x."""
        spread, log_mean = self._spread
        rise = (self.shape - 1) * self._log_x(s) if self.shape > 1 else 0.0
        slope = self.shape * spread * np.exp(rise + log_mean)
        inside = np.asarray(s) >= self.support[0]
        return np.asarray(np.where(inside, slope * np.exp(-self._power(s)), 0.0))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Of the density, by the relative change of x."""
        k = self.shape
        if k == 1:
            return np.asarray(-t + 0 * np.asarray(s))
        step = np.log1p(t / (np.asarray(s) - self.support[0]))
        return np.asarray((k - 1) * step - self._power(s) * np.expm1(k * step))

    def cdf(self, s: Array) -> Array:
        """``1 - exp(-x^k)``."""
        return np.asarray(-np.expm1(-self._power(s)))

    def sf(self, s: Array) -> Array:
        """``exp(-x^k)``."""
        return np.asarray(np.exp(-self._power(s)))

    def ppf(self, p: Array, below: float = math.inf) -> Array:
        """``(-log(1 - p cdf(below)))^(1/k)``, reduced."""
        return self._s(-np.log1p(-p * self.cdf(np.array(below))))

    def isf(self, p: Array, above: float = -math.inf) -> Array:
        """``(x(above)^k - log(p))^(1/k)``, reduced."""
        return self._s(self._power(np.array(above)) - np.log(p))


def _weibull_spread(k: float) -> tuple[float, float]:
    """Deviation over mean of a Weibull variable of scale 1, and k times the logarithm of its mean.

    ``x^k`` makes k times an error of the first, so it is summed in powers of 1/k, whose coefficients are
    zeta functions, where the difference of logarithms of Gamma functions would cancel.
    """
    if k < _SERIES:
        logs = gammaln(1 + 1 / k), gammaln(1 + 2 / k)
        return math.sqrt(math.expm1(logs[1] - 2 * logs[0])), float(k * logs[0])
    m = np.arange(2, 80)
    terms = (-1.0) ** m * zeta(m) / m
    log_square = math.fsum(terms * (2.0**m - 2) * k ** (-1.0 * m))
    log_mean = math.fsum([-np.euler_gamma, *(terms * k ** (1.0 - m))])
    return math.sqrt(math.expm1(log_square)), log_mean


@dataclass(frozen=True, eq=False)
class ScipyHeights:
    """Any frozen continuous distribution of scipy.stats, reduced by its own mean and variance.

    Parameters
    ----------
    distribution : scipy.stats frozen distribution
        As ``scipy.stats.gamma(4)``; its location and scale drop out. Accurate as its ``cdf``, ``sf``,
        ``ppf`` and ``isf`` are.

    Raises
    ------
    ValueError
        If it is not continuous, its variance is not positive and finite, or scipy takes seconds to
        evaluate it.

    Examples
    --------
    >>> import scipy.stats
    >>> law = ScipyHeights(scipy.stats.uniform())
    >>> [round(end, 6) for end in law.support]
    [-1.732051, 1.732051]
    """

    distribution: Any

    def __post_init__(self) -> None:
        if not hasattr(self.distribution, "pdf"):
            raise ValueError(f"{self.distribution!r}: give a frozen continuous distribution of scipy.stats")
        object.__setattr__(self, "distribution", _without_place(self.distribution))
        mean, std = self._mean_std
        if not (math.isfinite(mean) and math.isfinite(std) and std > 0):
            raise ValueError(
                f"{self._name}: its mean is {mean:g} and its deviation {std:g}; both must be finite"
            )
        for function in (self.distribution.ppf, self.distribution.isf):
            self._in_time(_TRIAL_SECONDS, partial(function, _TRIAL), "a few heights of given probability")

    @property
    def _name(self) -> str:
        return str(getattr(getattr(self.distribution, "dist", None), "name", self.distribution))

    def _in_time(self, seconds: float, call: Callable[[], T], what: str) -> T:
        problem = f"{self._name}: {what} take scipy longer than {seconds:g} s; give another law, or a table"
        return in_time(seconds, call, problem)

    @property
    def shapes(self) -> dict[str, float]:
        """Its shape parameters by their names."""
        return {key: float(value) for key, value in getattr(self.distribution, "kwds", {}).items()}

    @property
    def _key(self) -> tuple[Any, ...]:
        from scipy import stats  # loaded with the distribution

        law = self.distribution
        kind = getattr(law, "dist", law)
        named = type(kind) is type(getattr(stats, self._name, None))
        return type(kind) if named else kind, self._name, tuple(sorted(self.shapes.items()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ScipyHeights) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @cached_property
    def _mean_std(self) -> tuple[float, float]:
        law = self.distribution
        return self._in_time(_SECONDS, lambda: (float(law.mean()), float(law.std())), "mean and deviation")

    @cached_property
    def support(self) -> tuple[float, float]:
        """Its support, reduced."""
        mean, std = self._mean_std
        low, high = self.distribution.support()
        return (float(low) - mean) / std, (float(high) - mean) / std

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """Heights that cut the density, between its 1e-9 quantiles, into smooth curves."""
        low, high = self.ppf(np.array(1e-9)), self.isf(np.array(1e-9))
        found = partial(resolved_breaks, _Density(self), float(low), float(high), _NOISE)
        return self._in_time(_SECONDS, found, "jumps and kinks of the density")

    @property
    def singular(self) -> tuple[float, ...]:
        """Every finite end of the support."""
        return tuple(end for end in self.support if math.isfinite(end))

    def span(self, s: float) -> float:
        """Where the logarithm of the density changes evenly, by at most one half."""
        return narrowest(self, s)

    def _x(self, s: Array) -> Array:
        mean, std = self._mean_std
        return np.asarray(mean + std * np.asarray(s))

    def _s(self, x: Array) -> Array:
        mean, std = self._mean_std
        return np.asarray((np.asarray(x) - mean) / std)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Its own random variates, reduced."""
        return self._s(self.distribution.rvs(size=n, random_state=rng))

    def pdf(self, s: Array) -> Array:
        """Its ``pdf``, reduced."""
        return np.asarray(self._mean_std[1] * self.distribution.pdf(self._x(s)))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Difference of its ``logpdf``."""
        low, high = self.support
        start = np.asarray(s)
        moved = np.clip(start + t, low, high)
        both = np.concatenate([moved.ravel(), start.ravel()])  # a call takes longer than a hundred values
        logarithm = self.distribution.logpdf(self._x(both))
        after, before = logarithm[: moved.size], logarithm[moved.size :]
        return np.asarray(after.reshape(moved.shape) - before.reshape(start.shape))

    def cdf(self, s: Array) -> Array:
        """Its ``cdf``."""
        return np.asarray(self.distribution.cdf(self._x(s)))

    def sf(self, s: Array) -> Array:
        """Its ``sf``."""
        return np.asarray(self.distribution.sf(self._x(s)))

    def ppf(self, p: Array, below: float = math.inf) -> Array:
        """Its ``ppf``."""
        return self._s(self.distribution.ppf(p * self.cdf(np.array(below))))

    def isf(self, p: Array, above: float = -math.inf) -> Array:
        """Its ``isf``, or where that loses the tail the inverse of its ``sf``."""
        share = np.asarray(p * self.sf(np.array(above)))
        return self._s(self._halved(share) if self._loses_tail else self.distribution.isf(share))

    @cached_property
    def _loses_tail(self) -> bool:
        """Whether ``isf`` does not invert a good ``sf``: SciPy's of F takes 1 - p, and is infinite soon."""

        def good(inverse: Callable[[Array], Array]) -> bool:
            with np.errstate(all="ignore"):
                return bool(np.allclose(self.distribution.sf(inverse(_RARE)), _RARE, rtol=1e-6, atol=0))

        return math.isinf(self.support[1]) and not good(self.distribution.isf) and good(self._halved)

    def _halved(self, share: Array) -> Array:
        """Where ``sf`` has these values: above the median by halving, as far up as it takes."""
        with np.errstate(all="ignore"):
            low = np.full(share.shape, float(self.distribution.median()))
            high, step = low, float(self.distribution.std())
            while np.any(far := (self.distribution.sf(high) > share) & (high < np.inf)):
                low, high, step = np.where(far, high, low), np.where(far, high + step, high), 2 * step
            while np.any(inside := (low < (middle := low + (high - low) / 2)) & (middle < high)):
                above = self.distribution.sf(middle) > share
                low, high = np.where(inside & above, middle, low), np.where(inside & ~above, middle, high)
            return np.where(share < 0.5, high, self.distribution.isf(share))


def _without_place(distribution: Any) -> Any:
    """The same law frozen with nothing but its shapes, by name: however given, it has the same digits."""
    frozen = distribution() if hasattr(distribution, "freeze") else distribution
    if not hasattr(frozen, "dist"):
        return frozen
    names = [name.strip() for name in (frozen.dist.shapes or "").split(",") if name.strip()]
    given = {**dict(zip(names, frozen.args, strict=False)), **frozen.kwds}
    if not set(names) <= set(given):
        return frozen  # shapes of a kind that has no names
    return frozen.dist(**{name: float(given[name]) for name in names})


@dataclass(frozen=True)
class _Density:
    """A density in the clothes of a grading, so that its jumps and kinks are found alike."""

    law: ScipyHeights
    breaks: tuple[float, ...] = ()
    smooth: bool = False

    def __call__(self, s: Array) -> Array:
        return self.law.pdf(s)
