"""Which moments of each cell a surface keeps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Layout:
    """Which moments a surface keeps.

    Parameters
    ----------
    plain, rooted : ndarray of int
        How many T_j and R_j each cell has.
    """

    plain: NDArray[np.int64]
    rooted: NDArray[np.int64]

    @property
    def sizes(self) -> NDArray[np.int64]:
        """Moments of each cell."""
        return self.plain + self.rooted

    @property
    def starts(self) -> NDArray[np.int64]:
        """First row of each cell, and the number of all rows."""
        return np.concatenate([[0], np.cumsum(self.sizes)])

    def at_most(self, other: "Layout") -> "Layout":
        """No more than another one has."""
        return Layout(np.minimum(self.plain, other.plain), np.minimum(self.rooted, other.rooted))

    @classmethod
    def covering(cls, layouts: Sequence["Layout"]) -> "Layout":
        """The moments that any of some layouts of the same cells has."""
        return cls(
            np.max([layout.plain for layout in layouts], axis=0),
            np.max([layout.rooted for layout in layouts], axis=0),
        )

    def rows_of(self, part: "Layout") -> NDArray[np.int64]:
        """Where the rows of a layout lie in this one, which covers it."""
        first = np.stack([self.starts[:-1], self.starts[:-1] + self.plain], axis=1).ravel()
        size = np.stack([part.plain, part.rooted], axis=1).ravel()
        return np.repeat(first - np.cumsum(size) + size, size) + np.arange(size.sum())
