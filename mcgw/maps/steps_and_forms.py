"""What a plane does not take off a map: a step between two terraces, a curved form."""

from dataclasses import dataclass

import numpy as np
from scipy import fft

from analytic.arrays import Array
from mcgw.maps.form import ORDERS, without_form
from mcgw.maps.steps import Form
from mcgw.maps.topography import Topography
from mcgw.maps.waves import block_means, coarser

_COARSE, _BLOCKS = 192, 24
_ENOUGH = 1024  # points along each axis tell a form
_ISOLATED = 6.0  # times the usual difference along a line: 4 standard deviations of Gaussian ones
_LINES = 0.5  # of all lines across a step
_FIRST = 0.05  # of all lines may see it elsewhere
_LONGEST = 2.3  # waves on the map; there are 20 such wave vectors
_STRONGER, _COUNTS = 3.0, 0.05


@dataclass(frozen=True, slots=True)
class Step:
    """Two levels that meet at a line.

    Parameters
    ----------
    axis : {"x", "y"}
        Along which the level changes.
    place : float
        About where, m.
    height : float
        Difference of the levels, m.
    begin, end : float
        Between which it lies, where it is oblique or ragged, m.
    """

    axis: str
    place: float
    height: float
    begin: float
    end: float


@dataclass(frozen=True, slots=True)
class FormLeft:
    """A smooth form that was not taken off.

    Parameters
    ----------
    share : float
        Of the variance of heights.
    height : float
        Its peak to valley, m.
    form : str
        What takes it off.
    """

    share: float
    height: float
    form: Form


def step_of(topography: Topography) -> Step | None:
    """Find the step between two terraces, the larger one of the two axes.

    On at least half of all lines across it, one difference between medians of small areas must be six
    times the usual one, all of one sign, and two times any of the other sign: waves, form and roughness
    change their level everywhere, and a ridge rises and falls. It must be larger than the standard deviation
    of all heights without plane. No point may be missing.
    """
    medians = block_means(block_means(topography.heights, _COARSE), _BLOCKS, np.median)
    found = []
    for axis, size, levels in zip("xy", topography.size, (medians, medians.T), strict=True):
        changes = levels[:, 2:] - levels[:, :-2]  # over two, since a step may cross an area
        changes = changes - np.median(changes)
        at = np.argmax(np.abs(changes), axis=1)
        largest = np.take_along_axis(changes, at[:, None], axis=1)[:, 0]
        sign = np.sign(np.median(largest))
        back = np.max(-sign * changes, axis=1)
        steps = sign * largest > np.maximum(_ISOLATED * np.median(np.abs(changes), axis=1), 2 * back)
        if steps.mean() >= _LINES:
            height = float(abs(np.median(largest[steps])))
            area = size / levels.shape[1]
            begin, place, end = (area * (q + 1.5) for q in np.quantile(at[steps], (_FIRST, 0.5, 1 - _FIRST)))
            found.append(Step(axis, place, height, max(begin - 2 * area, 0.0), min(end + 2 * area, size)))
    step = max(found, key=lambda s: s.height, default=None)
    if step is None or not step.height > float(without_form(topography, "plane").heights.std()):
        return None
    return step


def form_left(topography: Topography, form: Form) -> FormLeft | None:
    """Find a polynomial that is more than long waves, on a map that this form was taken off.

    It is of second order, or of fourth where that was taken off already. It must hold more than a twentieth
    of the variance, and three times what the longest waves do, two on the map, once it is taken off too. No
    point may be missing.
    """
    more: Form = "quadratic" if ORDERS[form] < ORDERS["quadratic"] else "quartic"
    coarse = coarser(topography, _ENOUGH)
    rest = without_form(coarse, more).heights
    longest, left = _longest(rest), coarse.heights - rest
    variance = float(left.var())
    share = variance / _variance(topography.heights)
    if share < _COUNTS or variance < _STRONGER * longest:
        return None
    return FormLeft(share, float(np.ptp(left)), more)


def _longest(z: Array) -> float:
    """Variance of the longest waves on a map."""
    coarse = block_means(z, _COARSE)
    power = np.abs(fft.fft2(coarse) / coarse.size) ** 2
    along, down = (fft.fftfreq(n) * n for n in coarse.shape[::-1])
    return float(power[np.hypot(along, down[:, None]) < _LONGEST].sum())


def _variance(z: Array) -> float:
    """By two passes that make no second map: `z` is about its own mean, or near it."""
    flat = z.ravel()
    return float(flat @ flat) / flat.size - float(flat.mean()) ** 2
