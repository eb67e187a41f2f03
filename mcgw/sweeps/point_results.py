"""What a sweep holds of one of its points, as the numbers of an ensemble."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.results import Held
from mcgw.sweeps.groups import Place
from mcgw.sweeps.pooled import Pooled

__all__ = ["PointResults"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PointResults(Held):
    """Mean and deviation of a point, a weighted mean of what is pooled.

    Parameters
    ----------
    pooled : Pooled
        Of its group.
    place : Place
        Its own.
    """

    pooled: Pooled
    place: Place

    no_more = (
        'a sweep keeps mean and standard deviation; sweep a scene with keep = "statistics" for quantiles, '
        "skewness and extremes, or simulate the scene of the point"
    )

    def rows(self) -> int:
        """Number of surfaces."""
        return self.pooled.n

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        some = self.place.of(name)
        return self.pooled.mean(name, *some), np.sqrt(self.pooled.variance(name, *some))

    def total_number(self, name: str) -> Array:
        """The mean times the number of surfaces, as a whole number."""
        return np.rint(self.pooled.mean(name, *self.place.of(name)) * self.pooled.n)
