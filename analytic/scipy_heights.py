"""Any distribution of scipy.stats as a distribution of heights."""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from time import thread_time
from timeit import repeat
from typing import Any

import numpy as np

from analytic.arrays import Array, hold
from analytic.heights import HeightLaw
from analytic.resolution import cuts_of

_SLOW = 5e-3  # seconds for one of thousands of densities: some are integrals of integrals
_NOISE = 2.0**-30  # of a density that is the exponential of large terms, as of gamma(1e4)
_SAME = 1e-12  # share that is given back but for rounding
_RARE, _NEXT = 1e-9, 1e-8  # share beyond rare heights; how near to an end is as good as there
_NO_RARER = 1e-300  # share beyond which a law has no heights, if its density ends there:
_INSIDE, _OUTSIDE = 1e-2, 1e-6  # it is positive so far inside, in standard deviations, and 0 so far outside


@dataclass(frozen=True)
class ScipyHeights(HeightLaw):
    """Any frozen continuous distribution of scipy.stats, reduced by its own mean and variance.

    Parameters
    ----------
    distribution : scipy.stats frozen distribution
        Such as ``scipy.stats.gamma(4)``; its location and scale drop out. Results are as accurate as its
        ``cdf``, ``sf``, ``ppf`` and ``isf``.

    Raises
    ------
    ValueError
        If it is not continuous, its variance is not positive and finite, or a density takes SciPy 5 ms.

    Examples
    --------
    >>> import scipy.stats
    >>> law = ScipyHeights(scipy.stats.uniform())
    >>> [round(end, 6) for end in law.support]
    [-1.732051, 1.732051]
    """

    distribution: Any = field(compare=False)
    _key: tuple[Any, ...] = field(default=(), init=False, repr=False)  # kind, name and shapes

    def __post_init__(self) -> None:
        from scipy import stats  # loaded with the distribution

        if not hasattr(self.distribution, "pdf"):
            raise ValueError(f"{self.distribution!r}: give a frozen continuous distribution of scipy.stats")
        hold(self, distribution=_without_place(self.distribution))
        kind = getattr(self.distribution, "dist", self.distribution)
        if type(kind) is type(getattr(stats, self._name, None)):
            kind = type(kind)
        hold(self, _key=(kind, self._name, *sorted(self.shapes.items())))
        low, high = np.clip(self.distribution.support(), -3.0, 3.0)
        density = partial(self.distribution.pdf, (low + high) / 2)
        seconds = min(repeat(density, number=1, repeat=3, timer=thread_time))  # the first may load something
        if seconds > _SLOW:
            raise ValueError(
                f"{self._name}: one density takes SciPy {1e3 * seconds:.0f} ms; give another law, or a table"
            )
        mean, std = self._mean_std
        if not (math.isfinite(mean) and math.isfinite(std) and std > 0):
            raise ValueError(
                f"{self._name}: its mean is {mean:g} and its deviation {std:g}; both must be finite"
            )

    @property
    def _name(self) -> str:
        return str(getattr(getattr(self.distribution, "dist", None), "name", self.distribution))

    @property
    def shapes(self) -> dict[str, float]:
        """Its shape parameters by their names."""
        return {key: float(value) for key, value in getattr(self.distribution, "kwds", {}).items()}

    @cached_property
    def _mean_std(self) -> tuple[float, float]:
        return float(self.distribution.mean()), float(self.distribution.std())

    @cached_property
    def support(self) -> tuple[float, float]:
        """Its support, reduced."""
        mean, std = self._mean_std
        low, high = map(float, self.distribution.support())
        if math.isinf(low):
            low = self._end(self.distribution.ppf, -std)
        if math.isinf(high):
            high = self._end(self.distribution.isf, std)
        return (low - mean) / std, (high - mean) / std

    def _end(self, inverse: Callable[[float], Any], outward: float) -> float:
        """Where heights end of which SciPy says that they do not, as Pearson's of type III; or infinity."""
        pdf = self.distribution.pdf
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore", category=RuntimeWarning):
            end = float(inverse(_NO_RARER))
            ends = math.isfinite(end) and pdf(end + _OUTSIDE * outward) == 0 < pdf(end - _INSIDE * outward)
        return end if ends else math.copysign(math.inf, outward)

    @cached_property
    def breaks(self) -> tuple[float, ...]:
        """Heights that cut the density, between rare heights, into smooth curves."""
        ends = float(self.ppf(np.array(_RARE))), float(self.isf(np.array(_RARE)))
        low, high = (end if abs(s - end) < _NEXT else s for s, end in zip(ends, self.support, strict=True))
        return cuts_of(self.pdf, (), low, high, _NOISE)  # of a density, which may be infinite

    @property
    def singular(self) -> tuple[float, ...]:
        """Every finite end of the support."""
        return tuple(end for end in self.support if math.isfinite(end))

    def _x(self, s: Array) -> Array:
        mean, std = self._mean_std
        return np.asarray(mean + std * np.asarray(s))

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw random variates of it, reduced."""
        mean, std = self._mean_std
        return np.asarray((self.distribution.rvs(size=n, random_state=rng) - mean) / std)

    def pdf(self, s: Array) -> Array:
        """Return its ``pdf``, reduced."""
        return np.asarray(self._mean_std[1] * self.distribution.pdf(self._x(s)))

    def log_pdf(self, s: Array) -> Array:
        """Return its ``logpdf``, reduced."""
        with np.errstate(divide="ignore"):
            return np.asarray(math.log(self._mean_std[1]) + self.distribution.logpdf(self._x(s)))

    def cdf(self, s: Array) -> Array:
        """Return its ``cdf``."""
        return np.asarray(self.distribution.cdf(self._x(s)))

    def sf(self, s: Array) -> Array:
        """Return its ``sf``."""
        return np.asarray(self.distribution.sf(self._x(s)))

    def between(self, below: Array, above: Array) -> Array:
        """Return its ``ppf`` or ``isf`` of the smaller share; as any law where SciPy loses it in the tail.

        And where SciPy has no formula of its own: it would search the root of one share after another.
        """
        from scipy import stats

        if getattr(type(getattr(self.distribution, "dist", None)), "_ppf", None) is stats.rv_continuous._ppf:
            return super().between(below, above)
        found, law, (mean, std) = np.empty(below.shape), self.distribution, self._mean_std
        lost = np.ones(below.shape, dtype=bool)
        low = below < above
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore", category=RuntimeWarning):
            for side, share, inverse, tail in (
                (low, below, law.ppf, self.cdf),
                (~low, above, law.isf, self.sf),
            ):
                found[side] = (inverse(share[side]) - mean) / std
                lost[side] = ~(np.abs(np.log(tail(found[side]) / share[side])) < _SAME)
        found[lost] = super().between(below[lost], above[lost])
        return found


def _without_place(distribution: Any) -> Any:
    """Return the same law frozen with its shapes alone, by name: however given, it has the same digits."""
    frozen = distribution() if hasattr(distribution, "freeze") else distribution
    if not hasattr(frozen, "dist"):
        return frozen
    names = [name.strip() for name in (frozen.dist.shapes or "").split(",") if name.strip()]
    given = {**dict(zip(names, frozen.args, strict=False)), **frozen.kwds}
    if not set(names) <= set(given):
        return frozen  # shapes of a kind that has no names
    return frozen.dist(**{name: float(given[name]) for name in names})
