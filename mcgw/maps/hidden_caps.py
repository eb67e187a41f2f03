"""How many independent caps hide under taller ones, and how that bends what is counted.

A cap of height z is hidden where an asperity at a distance r has ``z_j - r^2/(2R) > z``. It cannot be
told from the slope of its neighbour where the valley between them is nearer to its summit than the
blur p of the map: where ``z_j - (r^2 - 2 r p)/(2R) > z``. Of a Poisson field the number of such
neighbours is Poisson distributed, so the share of visible summits of that height is the exponential of
minus its mean.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq
from scipy.special import ndtr

from analytic.arrays import Array

CROWDED = 0.05  # eta R sigma, from which one summit in six is hidden: the asperities are no longer apart

_REACH = 9.0
_X, _W = leggauss(200)  # heights over their reach, by the rule of Gauss and Legendre
_MOST = 10.0


class Visible(NamedTuple):
    """Of the summits that no taller neighbour hides.

    Parameters
    ----------
    share : float
        Of all summits.
    mean, std : float
        Of their reduced heights; 0 if none is visible.
    """

    share: float
    mean: float
    std: float


@lru_cache(maxsize=64)
def _taller_neighbours(blur: float) -> Array:
    """Mean number of neighbours that hide each height, over ``4 pi eta R sigma``."""
    reach = blur + math.sqrt(blur**2 + 2 * _REACH)  # beyond, nobody is tall enough
    r, w = reach * (1 + _X) / 2, reach * _W / 2
    return np.asarray(ndtr(-(_REACH * _X[:, None] + r * r - 2 * r * blur)) @ (w * r))


def visible(overlap: float, blur: float = 0.0) -> Visible:
    """Statistics of the visible summits of Gaussian heights, by quadrature over heights and distances.

    Parameters
    ----------
    overlap : float
        ``eta R sigma``.
    blur : float, optional
        Distance p from a valley that a summit needs, over ``sqrt(2 R sigma)``.
    """
    s = _REACH * _X
    hidden = np.exp(-s * s / 2 - 4 * math.pi * overlap * _taller_neighbours(blur))
    p = _REACH * _W * hidden / math.sqrt(2 * math.pi)
    share = float(p.sum())
    if share == 0:
        return Visible(0.0, 0.0, 0.0)
    mean = float(p @ s) / share
    return Visible(share, mean, math.sqrt(float(p @ (s - mean) ** 2) / share))


def unhidden(eta: float, radius: float, sigma: float, blur: float = 0.0) -> tuple[float, float] | None:
    """Density and standard deviation of all summits from those of the visible ones, SI units.

    Parameters
    ----------
    eta, radius, sigma : float
        Of the visible summits, SI units.
    blur : float, optional
        Distance p from a valley that a summit needs, m.

    Returns
    -------
    (float, float) or None
        None if no field of independent caps shows so many, or all have one height.
    """
    if not sigma > 0:
        return None
    reduced = blur / math.sqrt(2 * radius * sigma)

    def misfit(overlap: float) -> float:
        seen = visible(overlap, reduced)
        return overlap * seen.share * seen.std - eta * radius * sigma

    grid = np.geomspace(1e-9, _MOST, 60)
    above = [x for x in grid if misfit(float(x)) > 0]
    if not above:
        return None
    seen = visible(brentq(misfit, 0.0, float(above[0]), xtol=1e-15), reduced)
    return eta / seen.share, sigma / seen.std
