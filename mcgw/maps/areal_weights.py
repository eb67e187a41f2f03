"""What every wave of a profile adds to the moments of its isotropic surface, filtered as a map is.

A profile sees a wave of the surface the longer, the more obliquely it crosses it. So the profile of a
filtered surface is not a filtered profile: filtered along itself, a profile keeps short waves that it
crosses slantwise, and its m2 and m4 are too large by tenths. What is the same in both is the
autocorrelation. Of an isotropic surface it depends on the distance alone, and to filter the surface with
exp(-a q^2), in power, is to take the mean of it under a plane Gaussian of variance 2a. For a wave k of the
profile that mean is

    w0(k) = integral of cos(k r) exp(-r^2/(4a)) r/(2a) over r from 0 on = F'(x),  x = k sqrt(a),

with Dawson's integral F, for which F' = 1 - 2 x F. Derivatives with respect to a bring q^2 down, so that

    w2 = -1/2 dw0/da = k^2 (F + x F')/(2 x),      w4 = 3/8 d^2w0/da^2 = k^4 3/32 (x F''' - F'')/x^3.

Sums of the profile's power with these weights are the areal moments m0, m2 and m4 of `mcgw.maps.fit`,
without bias. They are negative for short waves: those take back what the longer ones have too much.
"""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.special import dawsn

from mcgw.maps.form import gaussian_transmission

__all__ = ["areal_weights", "filter_variance", "stencil_weights"]

Array = NDArray[np.float64]

_SERIES = 0.02  # below, two terms of the series have 1e-9


def filter_variance(cutoff: float) -> float:
    """Of the window of the Gaussian filter, m^2: it leaves ``exp(-a q^2/2)`` of an amplitude."""
    return -2 * math.log(float(gaussian_transmission(np.array(1 / cutoff), cutoff))) * cutoff**2


def areal_weights(wave_numbers: Array, cutoff: float) -> Array:
    """Weights of waves of a profile in m0, m2 and m4, the latter two over ``k^2`` and ``k^4``.

    Parameters
    ----------
    wave_numbers : ndarray
        k, 1/m, shape (waves,).
    cutoff : float
        Of the areal Gaussian filter (ISO 16610-61), m.

    Returns
    -------
    ndarray
        Shape (3, waves).
    """
    x = wave_numbers * math.sqrt(filter_variance(cutoff))
    few = x < _SERIES
    y = np.where(few, 1.0, x)
    f = dawsn(y)
    first = 1 - 2 * y * f
    second = -2 * f - 2 * y * first
    third = -4 * first - 2 * y * second
    return np.array(
        [
            np.where(few, 1 - 2 * x**2 + 4 / 3 * x**4, first),
            np.where(few, 1 - 4 / 3 * x**2 + 4 / 5 * x**4, (f + y * first) / (2 * y)),
            np.where(few, 1 - 6 / 5 * x**2 + 24 / 35 * x**4, 3 / 32 * (y * third - second) / y**3),
        ]
    )


def stencil_weights(phases: Array) -> Array:
    """The same without a cutoff: what the differences of the fourth order see, as a map is looked at.

    Parameters
    ----------
    phases : ndarray
        Wave number times spacing, from 0 to pi.
    """
    c, half = np.cos(phases), np.sinc(phases / (2 * math.pi))
    slope, bend = np.cos(phases / 2) * (4 - c) / 3, (7 - c) / 6  # over those of plain differences
    return np.array([np.ones_like(c), (slope * half) ** 2, (bend * half**2) ** 2])
