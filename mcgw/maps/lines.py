"""Lines of a scan that lie too high or too low, as where an instrument drifts from one to the next."""

from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from scipy.ndimage import gaussian_filter1d

from mcgw.maps.topography import Topography

__all__ = ["LINES", "LinesTo", "without_offsets"]

LinesTo = Literal["keep", "rows", "columns"]
LINES: tuple[str, ...] = get_args(LinesTo)

_WIDTH = 10.0  # lines, standard deviation: of waves as long as 53 lines half is kept


def without_offsets(topography: Topography, lines: LinesTo) -> tuple[Topography, float]:
    """A map whose lines are shifted by the medians of their differences; and the rms of the shifts, m.

    Medians of the differences between neighbouring lines add up to offsets, and to waves that run across all
    lines. Those that a Gaussian window of ten lines lets pass are kept.
    """
    z = topography.heights if lines == "rows" else topography.heights.T
    level, last = np.zeros(len(z)), z[0]
    for j in range(1, len(z)):
        steps = z[j] - last
        steps = steps[np.isfinite(steps)]
        level[j] = level[j - 1] + (np.median(steps) if steps.size else 0.0)
        last = z[j] if steps.size else last  # a line without heights is passed over
    offsets = level - gaussian_filter1d(level, _WIDTH, mode="nearest")
    shifted = z - offsets[:, None]
    heights = shifted if lines == "rows" else np.ascontiguousarray(shifted.T)
    return replace(topography, heights=heights), float(np.sqrt(np.mean(offsets**2)))
