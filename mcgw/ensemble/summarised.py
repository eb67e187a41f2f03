"""The numbers of an ensemble that keeps statistics over its surfaces, and no surface."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.bins import Bins
from mcgw.ensemble.summary import Summary, total
from mcgw.scene.scene import Scene

__all__ = ["Summarised"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Summarised:
    """The numbers of an ensemble of which no values are kept.

    Parameters
    ----------
    scene : Scene
        Whose columns these are.
    blocks : tuple of Summary
        Joined blocks as `push` leaves them.
    """

    scene: Scene
    blocks: tuple[Summary, ...]

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(block.n for block in self.blocks)

    def read(self, name: str, start: int, stop: int | None) -> Array:  # noqa: ARG002 - as all results have it
        """Refuse: there are no values.

        Raises
        ------
        ValueError
            Always.
        """
        raise ValueError(
            f'{name}: single surfaces are not kept with keep = "statistics"; ask for mean, std, covariance, '
            'skewness, quantile or extremes, or draw some of them again with keep = "sums"'
        )

    @cached_property
    def whole(self) -> Summary:
        """All blocks as one."""
        return total(self.blocks)

    @cached_property
    def bins(self) -> Bins:
        """In which values are counted."""
        return Bins.of(self.scene)

    def columns(self, name: str) -> NDArray[np.int64]:
        """Where the numbers of a table stand, in the shape it has for one surface."""
        start = 0
        for other, shape in self.scene.shapes.items():
            size = int(np.prod(shape))
            if other == name:
                return np.arange(start, start + size).reshape(shape)
            start += size
        raise KeyError(name)
