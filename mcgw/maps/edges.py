"""Rows and columns at the edge of a map that the instrument got wrong."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["bad_edges"]

_MOST = 8  # points from an edge that are looked at
_JUMP = 5.0  # times the usual difference between neighbouring lines
_LINES = 32  # fewer have no usual difference


def bad_edges(heights: NDArray[np.float64]) -> int:
    """How many points from an edge reach the last line that differs from its neighbour unlike all others.

    Root mean squares of the differences between neighbouring rows, and columns, are compared with their
    median over the map. No point may be missing.
    """
    worst = 0
    for z in (heights, heights.T):
        if len(z) < _LINES:
            continue
        jumps = np.array([np.sqrt(np.mean((z[k + 1] - z[k]) ** 2)) for k in range(len(z) - 1)])
        wild = jumps > _JUMP * np.median(jumps)
        if wild[_MOST:-_MOST].any():
            continue  # such lines lie everywhere
        for side in (wild, wild[::-1]):
            worst = max(worst, int(np.flatnonzero(np.append(False, side[:_MOST])).max(initial=0)))
    return worst
