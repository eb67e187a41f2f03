"""Measured radii of summits, each that of the summit whose height was measured with it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analytic.measured_heights import MeasuredHeights

__all__ = ["MeasuredRadii"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MeasuredRadii:
    """Radius ratios c = R_i/R of measured summits: height and radius of a summit stay together.

    Parameters
    ----------
    heights : MeasuredHeights
        Of the same summits.
    ratios : sequence of float
        Radius of each over that of the surface, in the order of the heights; positive.

    Raises
    ------
    ValueError
        If there is not one positive finite ratio for each height.

    Examples
    --------
    >>> law = MeasuredRadii(MeasuredHeights([1.0, 3.0]), [2.0, 0.5])
    >>> law.summits(np.random.default_rng(), 2)
    (array([-1.,  1.]), array([2. , 0.5]))
    """

    heights: MeasuredHeights
    ratios: tuple[float, ...]

    def __init__(self, heights: MeasuredHeights, ratios: Sequence[float] | Array) -> None:
        c = np.asarray(ratios, dtype=np.float64)
        if c.shape != (len(heights.heights),):
            raise ValueError(f"ratios: {c.size} for {len(heights.heights)} heights; give one for each")
        wrong = np.flatnonzero(~(np.isfinite(c) & (c > 0)))
        if wrong.size:
            raise ValueError(f"ratios: number {wrong[0]} is {c[wrong[0]]:g}; give finite numbers > 0")
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "ratios", tuple(c.tolist()))

    def summits(self, rng: np.random.Generator, n: int) -> tuple[Array, Array]:
        """Reduced heights and radius ratios of `n` summits, drawn with replacement; or of all, as they are.

        Raises
        ------
        ValueError
            If they are not drawn, and `n` is not their number.
        """
        s, c = self._pairs
        if not self.heights.resampled:
            return self.heights.rvs(n, rng), c
        which = rng.integers(0, c.size, n)
        return s[which], c[which]

    @cached_property
    def _pairs(self) -> tuple[Array, Array]:
        return np.array(self.heights.heights), np.array(self.ratios)
