"""Edges of pieces that shrink towards a separation, above which sums begin as broken powers."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

__all__ = ["NEAREST", "above_neighbours", "towards"]

Array = NDArray[np.float64]

NEAREST = 2.0**-30  # below, a power >= 0 is 1e-9 of the whole, and integrated to 1e-7
_RATIO = 8.0  # of a piece to its distance from the separation below


def towards(separation: float, nearest: float) -> list[float]:
    """Heights from as near as `nearest`, each 8 times as far from the separation, up to a distance of 1."""
    edges, distance = [], nearest
    while distance < 1:
        edges.append(float(separation + distance))
        distance *= _RATIO
    return edges


def above_neighbours(separations: Array) -> list[float]:
    """The same above close separations, as near to the upper one as the lower one is.

    The root of the approach to the lower one almost has its kink inside the next piece.
    """
    return [edge for lower, upper in pairwise(separations) for edge in towards(upper, upper - lower)]
