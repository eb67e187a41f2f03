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

    def sample(self, rng: np.random.Generator, n: int) -> Array:
        """`n` heights from NumPy's generator."""
        ...

    def density(self, s: Array) -> Array:
        """Probability density at `s`, at a jump that above it."""
        ...

    def log_ratio(self, s: Array, t: Array) -> Array:
        """``log(density(s + t)/density(s))``, accurate for small `t`."""
        ...

    def below(self, s: Array) -> Array:
        """Probability of a height below `s`, to full relative accuracy."""
        ...

    def above(self, s: Array) -> Array:
        """Probability of a height above `s`, to full relative accuracy."""
        ...

    def from_below(self, p: Array, s: float) -> Array:
        """Height at the share `p` of the heights below `s`."""
        ...

    def from_above(self, p: Array, s: float) -> Array:
        """Height at the share `p` of the heights above `s`, counted from the top."""
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
    >>> float(Gaussian().above(np.array(0.0)))
    0.5
    """

    support: ClassVar[tuple[float, float]] = (-np.inf, np.inf)
    breaks: ClassVar[tuple[float, ...]] = ()
    singular: ClassVar[tuple[float, ...]] = ()

    def span(self, s: float) -> float:
        """Where the logarithm of the density changes by about 0.8."""
        return 0.8 / (1 + abs(s))

    def sample(self, rng: np.random.Generator, n: int) -> Array:
        """Standard normal numbers."""
        return rng.standard_normal(n)

    def density(self, s: Array) -> Array:
        """``exp(-s^2/2)/sqrt(2 pi)``."""
        return np.asarray(exp_minus_half_square(s) / np.sqrt(2 * np.pi))

    def log_ratio(self, s: Array, t: Array) -> Array:
        """``-t (s + t/2)``."""
        return np.asarray(normal_log_ratio(s, t))

    def below(self, s: Array) -> Array:
        """``Phi(s)``."""
        return ndtr(s)

    def above(self, s: Array) -> Array:
        """``Phi(-s)``."""
        return ndtr(-s)

    def from_below(self, p: Array, s: float) -> Array:
        """``Phi^-1(p Phi(s))``, by logarithms where that underflows."""
        if s > _FAR:
            return ndtri(p * ndtr(s))
        return np.asarray(ndtri_exp(np.log(p) + log_ndtr(s)))

    def from_above(self, p: Array, s: float) -> Array:
        """``-Phi^-1(p Phi(-s))``."""
        return -self.from_below(p, -s)


GAUSSIAN = Gaussian()
