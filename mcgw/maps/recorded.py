"""What the numbers of a map tell of the instrument that recorded them: its range, and its smallest step."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Recorded", "recorded"]

Array = NDArray[np.float64]

_LOOKED_AT = 2**18  # points tell the steps of up to some thousand levels
_MOST_LEVELS = 2**12
_MORE = 1.3  # times the points of the next level: of a summit that a step cuts, no level has more


@dataclass(frozen=True, slots=True)
class Recorded:
    """Of a map as it was read.

    Parameters
    ----------
    step : float
        Between two heights that follow each other, m; 0 if they are as good as continuous.
    at_end : float
        Share of the points that have the greatest height, or the least, where they are more than a range
        that holds all heights leaves there; else 0.
    """

    step: float
    at_end: float


def recorded(heights: Array) -> Recorded:
    """Look at a map before anything is taken off it; points may be missing, not all."""
    some = heights.ravel()[:: max(heights.size // _LOOKED_AT, 1)]
    levels = np.unique(some[np.isfinite(some)])
    steps = np.diff(levels)
    step = float(np.median(steps)) if 1 < levels.size < min(_MOST_LEVELS, some.size / 8) else 0.0
    ends = ((np.nanmax(heights), -step), (np.nanmin(heights), step))
    return Recorded(step, max(_at_end(heights, *end) for end in ends))


def _at_end(heights: Array, end: float, step: float) -> float:
    """Share of the points at one end of the heights, if the next level has clearly fewer."""
    number = np.count_nonzero(heights == end)
    below = np.count_nonzero(np.abs(heights - (end + step)) < abs(step) / 2) if step else 0
    return number / heights.size if number > max(_MORE * below, 1) else 0.0
