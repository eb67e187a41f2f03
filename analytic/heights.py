"""Laws of the summit heights, reduced to mean 0 and standard deviation 1."""

from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr, ndtri_exp

from analytic.elementary import exp_minus_half_square, ndtr, ndtri

__all__ = ["GAUSSIAN", "Gaussian", "HeightLaw"]

Array = NDArray[np.float64]

_FAR = -30.0  # below, where no height is ever drawn, probabilities underflow


class HeightLaw(Protocol):
    """Distribution of the reduced height s = z/sigma, of mean 0 and standard deviation 1."""

    @property
    def support(self) -> tuple[float, float]:
        """Lowest and highest height there are; infinite for no bound."""
        ...

    @property
    def breaks(self) -> tuple[float, ...]:
        """Heights where the density or a derivative of it jumps, smooth on either side."""
        ...

    @property
    def singular(self) -> tuple[float, ...]:
        """Ends of the support where the density is a broken power of the distance from the end."""
        ...

    def span(self, s: float) -> float:
        """Width of a cell above `s` on which the density hardly bends; breaks and ends left aside."""
        ...

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """`n` heights from NumPy's generator."""
        ...

    def pdf(self, s: Array) -> Array:
        """Probability density at `s`, at a jump that above it."""
        ...

    def log_ratio(self, s: Array, t: Array) -> Array:
        """``log(density(s + t)/density(s))``, accurate for small `t`."""
        ...

    def cdf(self, s: Array) -> Array:
        """Probability of a height below `s`, to full relative accuracy."""
        ...

    def sf(self, s: Array) -> Array:
        """Probability of a height above `s`, to full relative accuracy."""
        ...

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """Height at the share `p` of the heights below one, or of all."""
        ...

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """Height at the share `p` of the heights above one, or of all, counted from the top."""
        ...


def normal_log_ratio(s: Any, t: Any) -> Any:
    """``log(density(s + t)/density(s))`` of the normal law, of arrays or of numbers: it may be compiled."""
    return -t * (s + t / 2)


@dataclass(frozen=True)
class Gaussian:
    """The normal law of Greenwood and Williamson.

    Examples
    --------
    >>> import numpy as np
    >>> float(Gaussian().sf(np.array(0.0)))
    0.5
    """

    support: ClassVar[tuple[float, float]] = (-np.inf, np.inf)
    breaks: ClassVar[tuple[float, ...]] = ()
    singular: ClassVar[tuple[float, ...]] = ()

    def span(self, s: float) -> float:
        """Where the logarithm of the density changes by about 0.8."""
        return 0.8 / (1 + abs(s))

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Standard normal numbers."""
        return rng.standard_normal(n)

    def pdf(self, s: Array) -> Array:
        """``exp(-s^2/2)/sqrt(2 pi)``."""
        return np.asarray(exp_minus_half_square(s) / np.sqrt(2 * np.pi))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """``-t (s + t/2)``."""
        return np.asarray(normal_log_ratio(s, t))

    def cdf(self, s: Array) -> Array:
        """``Phi(s)``."""
        return ndtr(s)

    def sf(self, s: Array) -> Array:
        """``Phi(-s)``."""
        return ndtr(-s)

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """``Phi^-1(p Phi(below))``, by logarithms where that underflows."""
        if below > _FAR:
            return ndtri(p * ndtr(below))
        return np.asarray(ndtri_exp(np.log(p) + log_ndtr(below)))

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """``-Phi^-1(p Phi(-above))``."""
        return -self.ppf(p, -above)


GAUSSIAN = Gaussian()
