"""What a plane does not take off a map: a curved form."""

from dataclasses import dataclass

import numpy as np
from scipy import fft

from analytic.arrays import Array
from mcgw.maps.form import ORDERS, without_form
from mcgw.maps.steps import Form
from mcgw.maps.topography import Topography
from mcgw.maps.waves import block_means, coarser

_COARSE = 192
_ENOUGH = 1024  # points along each axis tell a form
_LONGEST = 2.3  # waves on the map; there are 20 such wave vectors
_STRONGER, _COUNTS = 3.0, 0.05


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
    share = variance / float(topography.heights.var())
    if share < _COUNTS or variance < _STRONGER * longest:
        return None
    return FormLeft(share, float(np.ptp(left)), more)


def _longest(z: Array) -> float:
    """Variance of the longest waves on a map."""
    coarse = block_means(z, _COARSE)
    power = np.abs(fft.fft2(coarse) / coarse.size) ** 2
    along, down = (fft.fftfreq(n) * n for n in coarse.shape[::-1])
    return float(power[np.hypot(along, down[:, None]) < _LONGEST].sum())
