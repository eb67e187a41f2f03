"""Moments of an isotropic surface, filtered as a map is, from the waves of one profile.

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
from scipy import fft
from scipy.special import dawsn

from analytic.arrays import Array
from mcgw.maps.form import filter_variance
from mcgw.maps.profile import Profile

_SERIES = 0.02  # below it two terms of the series suffice for 1e-9
_REACH = 1.5  # range of the weights, in cutoffs: exp(-16) beyond
_LEAST = 24  # points: with a short cutoff weights decay slowly
_STENCIL = 4  # points, without a cutoff
_FINE = 16  # points of a spectrum per weight
_ENDS = 0.1  # share of a profile faded out at its ends
SMOOTH = 3  # waves over which power is averaged
_LOW = slice(1, 5)  # waves that show what the form removed


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
    """Return the same without a cutoff: what the differences of the fourth order see, as a map is looked at.

    Parameters
    ----------
    phases : ndarray
        Wave number times spacing, from 0 to pi.
    """
    c, half = np.cos(phases), np.sinc(phases / (2 * math.pi))
    slope, bend = np.cos(phases / 2) * (4 - c) / 3, (7 - c) / 6  # over those of plain differences
    return np.array([np.ones_like(c), (slope * half) ** 2, (bend * half**2) ** 2])


def waves_of_profile(
    profile: Profile, *, cutoff: float | None, terms: int, pieces: int
) -> tuple[Array, Array]:
    """Return the moments of an isotropic surface from stretches of a profile, and the parts of its waves.

    A moment is the sum, over distances along the line, of the mean product of two heights (slopes, second
    differences) times a weight. No end has to fit the other, and no window bends it.

    Parameters
    ----------
    profile : Profile
        Without form.
    cutoff : float or None
        Of the areal filter, m.
    terms : int
        Of the form that was taken off, its mean too: each took a wave with it, of the longest there are,
        which m0 gets back.
    pieces : int
        Stretches.

    Returns
    -------
    moments : ndarray
        m0, m2 and m4 by each stretch, shape (3, pieces); their means are those by the profile.
    waves : ndarray
        What each wave has in these means, its power averaged over neighbours, shape (3, waves).
    """
    h, z = profile.spacing, profile.heights
    reach = _STENCIL if cutoff is None else max(math.ceil(_REACH * cutoff / h), _LEAST)
    reach = min(reach, z.size // 2)
    weights = fft.irfft(_gains(fft.rfftfreq(_FINE * reach), h, cutoff), _FINE * reach)[:, : reach + 1]
    stretches = np.array(
        [
            _stretches(np.diff(z, order) / h**order, row, pieces)
            for order, row in zip((0, 1, 2), weights, strict=True)
        ]
    )
    frequencies = fft.rfftfreq(z.size)
    differences = (2 / h * np.sin(math.pi * frequencies)) ** np.array([[0], [2], [4]])
    of_waves = _gains(frequencies, h, cutoff) * differences
    power = _power(z)
    taken = float(np.mean(power[_LOW] * of_waves[0, _LOW])) / 2  # a wave has two terms
    stretches[0] += terms * taken
    smoothed = np.convolve(power, np.full(SMOOTH, 1 / SMOOTH), mode="same")
    return stretches, np.asarray(of_waves * smoothed)


def _gains(frequencies: Array, spacing: float, cutoff: float | None) -> Array:
    """Weights of waves over the squares of what plain differences see of them."""
    phases = 2 * math.pi * frequencies
    weights = stencil_weights(phases) if cutoff is None else areal_weights(phases / spacing, cutoff)
    return np.asarray(weights * np.sinc(frequencies) ** np.array([[0], [-2], [-4]]))


def _stretches(u: Array, weights: Array, pieces: int) -> Array:
    """Return the sums over distances of weight times mean product, from pairs that begin on each stretch."""
    n, reach = u.size, weights.size - 1
    size = fft.next_fast_len(n + reach, real=True)
    even = np.zeros(size)
    even[: reach + 1] = weights * n / (n - np.arange(reach + 1))  # number of pairs
    even[size - reach :] = even[1 : reach + 1][::-1]
    products = u * fft.irfft(fft.rfft(u, size) * fft.rfft(even), size)[:n]
    edges = np.linspace(0, n, pieces + 1).round().astype(np.int64)
    return np.asarray(np.add.reduceat(products, edges[:-1]) * pieces / n)


def _power(z: Array) -> Array:
    """Of the waves of ``rfft``, without the mean; ends are faded out, so that they fit."""
    fade = max(round(_ENDS * z.size), 1)
    window = np.ones(z.size)
    window[:fade] = np.sin(math.pi / 2 * (np.arange(fade) + 0.5) / fade) ** 2
    window[-fade:] = window[:fade][::-1]
    window /= math.sqrt(np.mean(window**2))
    power = 2 * np.abs(fft.rfft(z * window) / z.size) ** 2
    power[0] = 0.0
    return np.asarray(power)
