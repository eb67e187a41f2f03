"""From the numbers of asperities in the cells to their moments.

``OneByOne``   a uniform for each asperity, anywhere in the cell or in one of as many equal strata
``Crowds``     for cells with few asperities as `OneByOne`, else one Gaussian number a moment

Where summits have radii of their own there is a third way, `mcgw.sampling.weighted_sums`.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from analytic.arrays import Array
from mcgw.sampling.aggregate import add_gaussian_moments
from mcgw.sampling.counts import Counts
from mcgw.sampling.layout import Layout
from mcgw.sampling.moments import cell_moments


class Drawing(Protocol):
    """A way to draw the moments of the cells."""

    @property
    def distance(self) -> float:
        """Of the laws of values from the exact ones; nan if nobody knows."""
        ...

    def moments(self, seed: int, first: int, counts: Counts, layout: Layout) -> Array:
        """Moments of surfaces `first` ..., shape (moments, surfaces)."""
        ...

    def draws(self, asperities: float, layout: Layout) -> float:
        """Numbers drawn for so many asperities in the cells of a surface."""
        ...


@dataclass(frozen=True)
class OneByOne:
    """A uniform for each asperity.

    Parameters
    ----------
    strata : bool, optional
        Draw it in one of as many equal strata of the cell, with the weight that it stands for.
    """

    strata: bool = False
    distance = 0.0

    def moments(self, seed: int, first: int, counts: Counts, layout: Layout) -> Array:
        """Sums over the uniforms of each cell."""
        moments = cell_moments(seed, first, counts.cells, layout, stratified=self.strata)
        if self.strata:
            moments *= np.repeat(counts.weights[1:-1], layout.sizes)[:, None]
        return moments

    def draws(self, asperities: float, layout: Layout) -> float:
        """All of them, unless nobody asks for a moment."""
        return asperities if layout.sizes.any() else 0.0


@dataclass(frozen=True)
class Crowds:
    """Crowded cells by the Gaussian limit of their moments (`mcgw.sampling.aggregate`).

    Parameters
    ----------
    varying : Layout
        Moments that vary; the others stay at their means.
    threshold : int
        Asperities in a cell, from which its moments count as Gaussian.
    distance : float, optional
        What is known of the distance from the exact laws: largest difference of distribution functions.
    """

    varying: Layout
    threshold: int
    distance: float = np.nan

    def moments(self, seed: int, first: int, counts: Counts, layout: Layout) -> Array:
        """Of crowded cells as Gaussian numbers, of the others asperity by asperity."""
        crowded = np.where(counts.cells >= self.threshold, counts.cells, 0)
        moments = cell_moments(seed, first, counts.cells - crowded, layout)
        add_gaussian_moments(seed, first, crowded, layout, self.varying, moments)
        return moments

    def draws(self, asperities: float, layout: Layout) -> float:
        """One a moment where that is less."""
        return min(asperities, float(layout.sizes.sum()))
