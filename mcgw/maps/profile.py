"""Profiles: heights along a line, as a stylus measures them."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Legendre
from scipy.ndimage import gaussian_filter1d

from analytic.arrays import Array
from mcgw.maps.form import filter_variance
from mcgw.maps.topography import STEEPEST

_EVEN = 0.1  # share of a step that places may be off an even grid
_LEAST = 8  # points
_WIDEST, _LONGEST = 1e-2, 0.2  # m, longest spacing and profile of a stylus


@dataclass(frozen=True)
class Profile:
    """Heights on an even grid along a line.

    Parameters
    ----------
    heights : ndarray
        m, shape (points,); none is missing.
    spacing : float
        Between two points, m.
    assumed_unit : str, optional
        Unit assumed for the lengths if the file does not state it; empty if it is known.
    filled : int, optional
        Number of missing heights that were filled along straight lines.
    resampled : bool, optional
        Whether the places were uneven, so that heights were interpolated.

    Raises
    ------
    ValueError
        If there are fewer than 8 points, one is missing, or the spacing is no length.
    """

    heights: Array
    spacing: float
    assumed_unit: str = ""
    filled: int = 0
    resampled: bool = False

    def __post_init__(self) -> None:
        if self.heights.ndim != 1:
            raise ValueError(f"a profile has one row of heights, not {self.heights.ndim} dimensions")
        if self.heights.size < _LEAST:
            raise ValueError(f"{self.heights.size} points: a profile has {_LEAST} or more")
        if not np.all(np.isfinite(self.heights)):
            raise ValueError("points of the profile are missing (nan); fill them first")
        if not (math.isfinite(self.spacing) and self.spacing > 0):
            raise ValueError(f"spacing = {self.spacing!r}: give a length > 0 m")

    @property
    def length(self) -> float:
        """Length along the line, m, including the whole spacing of the outer points."""
        return self.heights.size * self.spacing

    @property
    def steepness(self) -> float:
        """Typical slope, from the median difference between neighbours."""
        return float(np.median(np.abs(np.diff(self.heights)))) / self.spacing

    @property
    def doubtful(self) -> str:
        """Why the assumed unit of the lengths is implausible; empty if it is plausible."""
        if not self.assumed_unit:
            return ""
        if self.steepness > STEEPEST:
            return f"the typical slope is {self.steepness:.3g}"
        if self.spacing > _WIDEST:
            return f"the points are {self.spacing:g} m apart"
        return f"it is {self.length:.3g} m long" if self.length > _LONGEST else ""

    def without_form(self, order: int) -> "Profile":
        """Subtract the polynomial of least squares of this order; the mean in any case."""
        t = np.linspace(-1, 1, self.heights.size)
        return replace(self, heights=self.heights - Legendre.fit(t, self.heights, order)(t))

    def smoothed(self, cutoff: float) -> "Profile":
        """Apply the Gaussian filter of ISO 16610-21 and leave off the margins of one cutoff it cannot reach.

        Raises
        ------
        ValueError
            If nothing would be left.
        """
        radius = math.ceil(cutoff / self.spacing)
        if 2 * radius + _LEAST > self.heights.size:
            raise ValueError(
                f"cutoff = {cutoff:g} m: leaves nothing of a profile of {self.length:g} m after removing "
                "margins of one cutoff"
            )
        width = math.sqrt(filter_variance(cutoff)) / self.spacing
        filtered = gaussian_filter1d(self.heights, width, radius=radius)
        return replace(self, heights=filtered[radius : filtered.size - radius])


def profile_at(places: Array, heights: Array, assumed_unit: str = "") -> Profile:
    """Return a profile of heights at places along a line, on an even grid of as many points.

    Places a tenth of a step beside an even grid are taken as rounded. Otherwise, and where heights are
    missing (nan), those on the grid are interpolated along straight lines.

    Parameters
    ----------
    places, heights : ndarray
        m, shape (points,); places rise or fall.
    assumed_unit : str, optional
        As in `Profile`.

    Raises
    ------
    ValueError
        If places do not rise or fall, or too many heights are missing.
    """
    known = np.isfinite(heights)
    if not known.any():
        raise ValueError("the profile has no heights")
    first, last = int(np.argmax(known)), int(known.size - np.argmax(known[::-1]))
    places, heights, known = places[first:last], heights[first:last], known[first:last]
    missing = int(np.count_nonzero(~known))
    if missing > 0.1 * known.size:  # share of all points
        raise ValueError(f"{missing} of the {known.size} heights are missing; measure the profile again")
    if places.size > 1 and places[-1] < places[0]:
        places, heights, known = places[::-1], heights[::-1], known[::-1]
    if places.size < _LEAST:
        raise ValueError(f"{places.size} points: a profile has {_LEAST} or more")
    steps = np.diff(places)
    if not np.all(steps > 0):
        k = int(np.argmin(steps))
        raise ValueError(
            f"x = {places[k]:g} m is followed by {places[k + 1]:g} m; give x in increasing or decreasing "
            f"order"
        )
    even = np.linspace(places[0], places[-1], places.size)
    spacing = float(even[1] - even[0])
    resampled = bool(np.abs(places - even).max() > _EVEN * spacing)
    if resampled or missing:
        heights = np.interp(even if resampled else places, places[known], heights[known])
    return Profile(np.array(heights, dtype=np.float64), spacing, assumed_unit, missing, resampled)
