"""Distributions of summit heights of mean 0 and standard deviation 1: normal, exponential, Weibull."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar, Protocol

import numpy as np
import scipy

from analytic.arrays import Array
from analytic.roots import height_between

_FAR = -30.0  # below, where no height is ever drawn, probabilities underflow
_BEND = 0.5  # change of the logarithm of the density over a span
_NO_DENSITY = 1e4  # beyond, a normal density is 0
_AT_END = 1e-6  # next to an end of the support a density may vanish by rounding


def exp_minus_half_square(h: Any) -> Array:
    """exp(-h^2/2) to full relative accuracy: the square is split so that its rounding drops out."""
    h = np.clip(np.asarray(h, dtype=np.float64), -_NO_DENSITY, _NO_DENSITY)
    a = np.round(16 * h) / 16
    return np.asarray(np.exp(a * a * -0.5) * np.exp((h - a) * (h + a) * -0.5))


def _below(x: Any) -> Array:
    """Probability of a standard normal number below `x`, to full relative accuracy; in the shape of `x`."""
    tail = scipy.special.erfcx(np.abs(x) * math.sqrt(0.5)) / 2 * exp_minus_half_square(x)
    return np.asarray(np.where(np.greater(x, 0), 1 - tail, tail))


class HeightLaw(Protocol):
    """Distribution of the reduced height s = z/sigma, of mean 0 and standard deviation 1.

    A subclass gives `pdf` or `log_pdf`, `cdf`, `sf` and `rvs`, and the rest where it differs.
    """

    @property
    def support(self) -> tuple[float, float]:
        """Lowest and highest possible height; infinite without a bound."""
        return -math.inf, math.inf

    @property
    def breaks(self) -> tuple[float, ...]:
        """Heights where the density or a derivative of it jumps, smooth on either side."""
        return ()

    @property
    def singular(self) -> tuple[float, ...]:
        """Ends of the support where the density is a broken power of the distance from the end."""
        return ()

    def span(self, s: float) -> float:
        """Return the width of a cell above `s` on which the density hardly bends, without breaks and ends."""
        return narrowest(self, s)  # type: ignore[arg-type]  # laws are frozen

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw `n` heights by NumPy's generator."""

    def pdf(self, s: Array) -> Array:
        """Return the probability density at `s`; at a jump, its value just above."""
        return np.exp(self.log_pdf(s))

    def log_pdf(self, s: Array) -> Array:
        """Return the logarithm of the density."""
        with np.errstate(divide="ignore"):
            return np.log(self.pdf(s))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return ``log(pdf(s + t)/pdf(s))``, accurate for small `t`."""
        return np.asarray(self.log_pdf(np.clip(np.asarray(s) + t, *self.support)) - self.log_pdf(s))

    def cdf(self, s: Array) -> Array:
        """Return the probability of a height below `s`, to full relative accuracy."""

    def sf(self, s: Array) -> Array:
        """Return the probability of a height above `s`, to full relative accuracy."""

    def between(self, below: Array, above: Array) -> Array:
        """Return the heights with these probabilities on either side."""
        return height_between(self, below, above)

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Return the height at the share `p` of the heights below one, or of all."""
        p, lower, higher = np.asarray(p), self.cdf(np.array(below)), self.sf(np.array(below))
        found = self.between(p * lower, higher + (1 - p) * lower)
        return np.minimum(found, below) if lower > 0 else np.full(p.shape, max(below, self.support[0]))

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Return the height at the share `p` of the heights above one, or of all, counted from the top."""
        p, lower, higher = np.asarray(p), self.cdf(np.array(above)), self.sf(np.array(above))
        found = self.between(lower + (1 - p) * higher, p * higher)
        return np.maximum(found, above) if higher > 0 else np.full(p.shape, min(above, self.support[1]))


@dataclass(frozen=True)
class Gaussian(HeightLaw):
    """Normal (Gaussian) distribution of heights, as used by Greenwood and Williamson.

    Examples
    --------
    >>> float(Gaussian().sf(0.0))
    0.5
    """

    def span(self, s: float) -> float:
        """Return the width over which the logarithm of the density changes by about 0.8."""
        return 0.8 / (1 + abs(s))

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw standard normal numbers."""
        return rng.standard_normal(n)

    def pdf(self, s: Array) -> Array:
        """Return ``exp(-s^2/2)/sqrt(2 pi)``."""
        return np.asarray(exp_minus_half_square(s) / np.sqrt(2 * np.pi))

    def log_pdf(self, s: Array) -> Array:
        """Return ``-s^2/2 - log(2 pi)/2``."""
        return np.asarray(-np.square(s) / 2 - math.log(2 * math.pi) / 2)

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return ``-t (s + t/2)``."""
        return np.asarray(-t * (s + t / 2))

    def cdf(self, s: Array) -> Array:
        """Return ``Phi(s)``."""
        return _below(s)

    def sf(self, s: Array) -> Array:
        """Return ``Phi(-s)``."""
        return _below(-s)

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Return ``Phi^-1(p Phi(below))``, by logarithms where that underflows."""
        if below > _FAR:
            return np.asarray(scipy.special.ndtri(p * _below(below)))
        return np.asarray(scipy.special.ndtri_exp(np.log(p) + scipy.special.log_ndtr(below)))

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Return ``-Phi^-1(p Phi(-above))``."""
        return -self.ppf(p, -above)


GAUSSIAN = Gaussian()


@lru_cache(maxsize=4096)  # every quantity asks for the same heights, and a call of scipy's laws is slow
def narrowest(law: Any, s: float) -> float:
    """Width, halved until no quarter changes the logarithm of the density by more than 1/8."""
    widths = max(_BEND, abs(s) / 8) / 2.0 ** np.arange(41)  # far out in a heavy tail, a share of the height
    parts = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    with np.errstate(all="ignore"):  # all at once: a call of scipy's laws takes a millisecond
        change = np.abs(np.diff(law.log_ratio(np.array(s), widths[:, None] * parts)))
    if np.isnan(change).all():  # there would be no end of ever smaller cells
        if np.abs(np.array(law.support) - s).min() < _AT_END * max(1.0, abs(s)):
            return _BEND  # a density that vanishes at its end: who asks takes no more than is left
        raise ValueError(
            f"heights: their density is 0 at s = {s:.6g}, inside the support; fill the gap, for example "
            f"with wider bins"
        )
    even = np.flatnonzero(np.all(change <= _BEND / 4, axis=1))
    return float(widths[even[0] if even.size else -1])


@dataclass(frozen=True)
class Weibull(HeightLaw):
    """Weibull distribution of heights (McCool 1992, Int. J. Mach. Tools Manuf. 32, 115).

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
        """Deviation over mean of the unreduced x of scale 1, and k times the logarithm of its mean."""
        first, second = (float(scipy.special.gammaln(1 + n / self.shape)) for n in (1, 2))
        return math.sqrt(math.expm1(second - 2 * first)), self.shape * first

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

    def _log_x(self, s: Array) -> Array:
        """Logarithm of x over its mean: neither near 1 nor near the lower end does a digit cancel."""
        spread = self._spread[0]
        relative = np.maximum(spread * np.asarray(s), -1.0)
        above_end = np.maximum(spread * (np.asarray(s) - self.support[0]), 0.0)
        with np.errstate(divide="ignore"):
            return np.where(relative > -0.5, np.log1p(relative), np.log(above_end))

    def _power(self, s: Array) -> Array:
        """``x^k``."""
        with np.errstate(over="ignore"):
            return np.asarray(np.exp(self.shape * self._log_x(s) + self._spread[1]))

    def _s(self, power: Array) -> Array:
        """Height of a given ``x^k``."""
        spread, log_mean = self._spread
        with np.errstate(divide="ignore"):
            return np.asarray(np.expm1((np.log(power) - log_mean) / self.shape) / spread)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw powers of NumPy's standard exponential numbers, reduced."""
        return self._s(rng.standard_exponential(n))

    def log_pdf(self, s: Array) -> Array:
        """Return the logarithm of ``k x^(k-1) exp(-x^k)`` times the standard deviation of x."""
        spread, log_mean = self._spread
        rise = (self.shape - 1) * self._log_x(s) if self.shape > 1 else 0.0
        inside = np.asarray(s) >= self.support[0]
        return np.where(inside, math.log(self.shape * spread) + log_mean + rise - self._power(s), -np.inf)

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return the ratio of densities, by the relative change of x."""
        k = self.shape
        if k == 1:
            return np.asarray(-t + 0 * np.asarray(s))
        step = np.log1p(t / (np.asarray(s) - self.support[0]))
        return np.asarray((k - 1) * step - self._power(s) * np.expm1(k * step))

    def cdf(self, s: Array) -> Array:
        """Return ``1 - exp(-x^k)``."""
        return np.asarray(-np.expm1(-self._power(s)))

    def sf(self, s: Array) -> Array:
        """Return ``exp(-x^k)``."""
        return np.asarray(np.exp(-self._power(s)))

    def ppf(self, p: Array, below: float = math.inf) -> Array:
        """Return ``(-log(1 - p cdf(below)))^(1/k)``, reduced."""
        return self._s(-np.log1p(-p * self.cdf(np.array(below))))

    def isf(self, p: Array, above: float = -math.inf) -> Array:
        """Return ``(x(above)^k - np.log(p))^(1/k)``, reduced."""
        return self._s(self._power(np.array(above)) - np.log(p))


@dataclass(frozen=True)
class ExponentialHeights(Weibull):
    """Exponential distribution of heights: the density ``exp(-1 - s)`` for s > -1, Weibull's of shape 1.

    Greenwood and Williamson (1966) used it for its closed form, ``F_n(h) = Gamma(n+1) exp(-1 - h)``
    for h >= -1: load, area and number of contacts are proportional to each other.

    Examples
    --------
    >>> float(ExponentialHeights().sf(-1.0))
    1.0
    """

    shape: ClassVar[float] = 1.0  # type: ignore[misc]  # no field: there is one

    def span(self, s: float) -> float:  # noqa: ARG002 - the same everywhere
        """Return one half: the logarithm of the density is linear."""
        return _BEND

    def _power(self, s: Array) -> Array:
        return np.maximum(1 + np.asarray(s), 0.0)
