"""What each node of the tree gives to the rows: series, one after the other."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints


@dataclass(frozen=True)
class Entries:
    """Series of rows on nodes, one an array element.

    Parameters
    ----------
    node, row : ndarray of int
        Whose they are.
    rooted : ndarray of bool
        Whether they multiply the R_j of a cell, or the T_j of a node.
    length : ndarray of int
        How many coefficients each has; further ones are zero.
    coefficients : ndarray
        Of all of them, one after the other.
    """

    node: Ints
    row: Ints
    rooted: NDArray[np.bool_]
    length: Ints
    coefficients: Array

    @property
    def start(self) -> Ints:
        """Where the coefficients of each begin."""
        return np.cumsum(self.length) - self.length

    @classmethod
    def joined(cls, parts: list["Entries"]) -> "Entries":
        """Some after the others."""
        return cls(
            np.concatenate([_NO_INDEX, *(part.node for part in parts)]),
            np.concatenate([_NO_INDEX, *(part.row for part in parts)]),
            np.concatenate([_NO_INDEX.astype(bool), *(part.rooted for part in parts)]),
            np.concatenate([_NO_INDEX, *(part.length for part in parts)]),
            np.concatenate([np.empty(0), *(part.coefficients for part in parts)]),
        )


_NO_INDEX = np.empty(0, dtype=np.int64)
