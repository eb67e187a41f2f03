"""A height law whose density counts with a weight."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.heights import HeightLaw

__all__ = ["WeightedHeights"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WeightedHeights:
    """A height law whose density counts with a weight: what summits of each height add in the mean.

    Parameters
    ----------
    law : HeightLaw
        The law itself, which all but `density` is of.
    weight : callable
        Takes reduced heights to their weights.
    """

    law: HeightLaw
    weight: Callable[[Array], Array]

    @property
    def support(self) -> tuple[float, float]:
        """As the law's."""
        return self.law.support

    @property
    def breaks(self) -> tuple[float, ...]:
        """As the law's."""
        return self.law.breaks

    @property
    def singular(self) -> tuple[float, ...]:
        """As the law's."""
        return self.law.singular

    def span(self, s: float) -> float:
        """As the law's."""
        return self.law.span(s)

    def rvs(self, n: int, rng: np.random.Generator) -> Array:
        """Heights of the law, without the weight."""
        return self.law.rvs(n, rng)

    def pdf(self, s: Array) -> Array:
        """Density times weight."""
        return self.law.pdf(s) * self.weight(s)

    def log_ratio(self, s: Array, t: Array) -> Array:
        """As the law's."""
        return self.law.log_ratio(s, t)

    def cdf(self, s: Array) -> Array:
        """As the law's."""
        return self.law.cdf(s)

    def sf(self, s: Array) -> Array:
        """As the law's."""
        return self.law.sf(s)

    def ppf(self, p: Array, below: float = np.inf) -> Array:
        """As the law'below."""
        return self.law.ppf(p, below)

    def isf(self, p: Array, above: float = -np.inf) -> Array:
        """As the law'above."""
        return self.law.isf(p, above)
