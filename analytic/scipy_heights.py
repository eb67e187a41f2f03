"""Any distribution of scipy.stats as a distribution of heights, with a time limit on slow calls."""

import math
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from time import thread_time
from types import FrameType
from typing import Any, TypeVar

import numpy as np

from analytic.arrays import Array, hold
from analytic.heights import HeightLaw
from analytic.resolution import resolved_breaks

T = TypeVar("T")

_SECONDS = 5.0  # for moments, or jumps, of a law of scipy: some are integrals of integrals
_NOISE = 2.0**-30  # of a density that is the exponential of large terms, as of gamma(1e4)
_RARE, _RARER = np.array([1e-3, 1e-9, 1e-15, 1e-24, 1e-36]), 10.0 ** -np.arange(1.0, 37.0)
_ALIKE, _NEARLY = 1e-6, 1e-2  # how near shares come to themselves by way of heights: all of them, some
_MOST_STEPS, _SETTLED = 100, 2.0**-30  # of Newton; a step whose square is nothing
_HALVINGS, _NEXT = 60, 1e-8  # of a height, to its last digit; as near to the lower end as is as good as there
_NO_RARER = 1e-300  # share beyond which a law has no heights, if its density ends there:
_INSIDE, _OUTSIDE = 1e-2, 1e-6  # it is positive so far inside, in standard deviations, and 0 so far outside
_TRIAL, _TRIAL_SECONDS = np.array([1e-9, 0.1, 0.5, 0.9]), 1.0  # a few of the thousands of calls to come


@dataclass(frozen=True, eq=False)
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
        hold(self, distribution=_without_place(self.distribution))
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
        problem = f"{self._name}: {what} take SciPy longer than {seconds:g} s; give another law, or a table"
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
        low, high = map(float, self.distribution.support())
        if math.isinf(low):
            low = self._end(self.distribution.ppf, -std)
        if math.isinf(high):
            high = self._end(self.distribution.isf, std)
        return (low - mean) / std, (high - mean) / std

    def _end(self, inverse: Callable[[float], Any], outward: float) -> float:
        """Where heights end of which SciPy says that they do not, as Pearson's of type III; or infinity."""
        pdf = self.distribution.pdf
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # Boost's, of what it does not find
            end = float(inverse(_NO_RARER))
            ends = math.isfinite(end) and pdf(end + _OUTSIDE * outward) == 0 < pdf(end - _INSIDE * outward)
        return end if ends else math.copysign(math.inf, outward)

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

    def _x(self, s: Array) -> Array:
        mean, std = self._mean_std
        return np.asarray(mean + std * np.asarray(s))

    def _s(self, x: Array) -> Array:
        mean, std = self._mean_std
        return np.asarray((np.asarray(x) - mean) / std)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Draw random variates of it, reduced."""
        return self._s(self.distribution.rvs(size=n, random_state=rng))

    def pdf(self, s: Array) -> Array:
        """Return its ``pdf``, reduced."""
        return np.asarray(self._mean_std[1] * self.distribution.pdf(self._x(s)))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """Return the difference of its ``logpdf``."""
        low, high = self.support
        start = np.asarray(s)
        moved = np.clip(start + t, low, high)
        both = np.concatenate([moved.ravel(), start.ravel()])  # a call takes longer than a hundred values
        logarithm = self.distribution.logpdf(self._x(both))
        after, before = logarithm[: moved.size], logarithm[moved.size :]
        return np.asarray(after.reshape(moved.shape) - before.reshape(start.shape))

    def cdf(self, s: Array) -> Array:
        """Return its ``cdf``."""
        return np.asarray(self.distribution.cdf(self._x(s)))

    def sf(self, s: Array) -> Array:
        """Return its ``sf``."""
        return np.asarray(self.distribution.sf(self._x(s)))

    def ppf(self, p: Array, below: float = math.inf) -> Array:
        """Return its ``ppf``, or where its ``cdf`` is `p`: SciPy loses inverse Gaussian ones at 1e-17."""
        share, middle = np.asarray(p * self.cdf(np.array(below))), self._median
        low, high = np.full(share.shape, self.support[0]), np.full(share.shape, middle)
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # Boost's, of what it does not find
            s = self._s(self.distribution.ppf(share))
            s = np.where((share < 0.5) & ~(s <= middle), low, s)
            lost = (share > 0) & (s <= low) & np.isfinite(low)
            if np.any(lost) and self.cdf(np.array(self.support[0] + _NEXT)) < share[lost].max():
                for _ in range(_HALVINGS):
                    half = low + (high - low) / 2
                    under = self.cdf(half) < share
                    low, high = np.where(under, half, low), np.where(under, high, half)
                s = np.where(lost, low, s)
        return s

    @cached_property
    def _median(self) -> float:
        return float(self._s(self.distribution.median()))

    def isf(self, p: Array, above: float = -math.inf) -> Array:
        """Return its ``isf``, or where that loses the tail the inverse of ``sf``, as far as that is good."""
        inverse, rarest = self._from_share
        return self._s(inverse(np.maximum(p * self.sf(np.array(above)), rarest)))

    @cached_property
    def _from_share(self) -> tuple[Callable[[Array], Array], float]:
        """An inverse of ``sf``, and the least share that it is good for.

        SciPy's of F takes 1 - p, and is infinite soon; of Rice's law ``sf`` is 1 - ``cdf`` as well.
        """
        if math.isfinite(self.support[1]):
            return self.distribution.isf, 0.0
        for inverse in (self.distribution.isf, self._newton):
            if self._good_to(inverse, _RARE, _ALIKE) == _RARE[-1]:
                return inverse, 0.0
        return self.distribution.isf, self._good_to(self.distribution.isf, _RARER, _NEARLY)

    def _good_to(self, inverse: Callable[[Array], Array], shares: Array, near: float) -> float:
        """The last of some shares, ever smaller, up to which ``sf`` of an inverse gives each again."""
        with np.errstate(all="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # Boost's, of what it does not find
            good = np.isclose(self.distribution.sf(inverse(shares)), shares, rtol=near, atol=0)
        return float(shares[max(np.cumprod(good).sum() - 1, 0)])

    def _newton(self, share: Array) -> Array:
        """Where ``sf`` has these values, by Newton's steps on its logarithm inside a bracket."""
        law, sign = self.distribution, np.where(share < 0.5, 1.0, -1.0)
        low = high = np.full(share.shape, float(law.median()))
        step = float(law.std())
        with np.errstate(all="ignore"):
            wanted = np.log(share)
            while np.any(far := sign * (law.sf(high) - share) > 0):
                low, high, step = np.where(far, high, low), np.where(far, high + sign * step, high), 2 * step
            low, high = np.minimum(low, high), np.maximum(low, high)
            x = low + (high - low) / 2
            for _ in range(_MOST_STEPS):
                found = np.log(law.sf(x))  # logsf may take a thousand times as long
                low, high = np.where(found > wanted, x, low), np.where(found > wanted, high, x)
                last, x = x, x + (found - wanted) * np.exp(found - law.logpdf(x))
                x = np.where((low <= x) & (x <= high), x, low + (high - low) / 2)
                if np.all(np.abs(x - last) <= _SETTLED * np.abs(x)):
                    break
        return np.asarray(x)


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


def in_time(seconds: float, call: Callable[[], T], problem: str) -> T:
    """Result of a call that takes no more than so many seconds of this thread's own CPU time.

    Looks at the clock at each Python function that the call enters. So it does not depend on what else the
    machine does, and works in any thread; only a single compiled function cannot be interrupted. No bound
    under a profiler. `problem` is what a ValueError says if it
    takes longer.
    """
    if sys.getprofile() is not None:  # a profiler at work would be thrown out: whoever runs it sees the time
        return call()
    end = thread_time() + seconds

    def look(frame: FrameType, event: str, arg: Any) -> None:  # noqa: ARG001 - the interpreter's own form
        if thread_time() > end:
            raise ValueError(problem)

    sys.setprofile(look)
    try:
        return call()
    finally:
        sys.setprofile(None)
