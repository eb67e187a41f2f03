"""Moments of a surface from the waves of one profile, and what each stretch of it adds to them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from mcgw.maps.areal_weights import areal_weights, stencil_weights
from mcgw.maps.profile import Profile

__all__ = ["ProfileWaves", "waves_of_profile"]

Array = NDArray[np.float64]

_REACH = 1.5  # cutoffs that the weights of distances reach: beyond, exp(-16)
_LEAST = 24  # points: with a short cutoff, weights fall off slowly at the shortest wave
_STENCIL = 4  # points, without a cutoff
_FINE = 16  # points of a spectrum to each weight of a distance
_ENDS = 0.1  # of a profile, faded out before its waves are counted
_LOW = slice(1, 5)  # waves that tell what the form took off


@dataclass(frozen=True)
class ProfileWaves:
    """What one profile tells of its isotropic surface.

    Parameters
    ----------
    moments : ndarray
        m0, m2, m4, shape (3,).
    pieces : ndarray
        The same of equal stretches, which they are the mean of, shape (3, pieces).
    power : ndarray
        Mean square of each wave, shape (waves,), m^2.
    weights : ndarray
        Of each wave in the moments, shape (3, waves).
    length : float
        m.
    """

    moments: Array
    pieces: Array
    power: Array
    weights: Array
    length: float


def waves_of_profile(profile: Profile, *, cutoff: float | None, terms: int, pieces: int) -> ProfileWaves:
    """Look at a profile without form.

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
    return ProfileWaves(stretches.mean(axis=1), stretches, power, of_waves, profile.length)


def _gains(frequencies: Array, spacing: float, cutoff: float | None) -> Array:
    """Weights of waves over the squares of what plain differences see of them."""
    phases = 2 * math.pi * frequencies
    weights = stencil_weights(phases) if cutoff is None else areal_weights(phases / spacing, cutoff)
    return np.asarray(weights * np.sinc(frequencies) ** np.array([[0], [-2], [-4]]))


def _stretches(u: Array, weights: Array, pieces: int) -> Array:
    """Sums over distances of weight times mean product, from pairs that begin on each stretch."""
    n, reach = u.size, weights.size - 1
    size = fft.next_fast_len(n + reach, real=True)
    even = np.zeros(size)
    even[: reach + 1] = weights * n / (n - np.arange(reach + 1))  # so many pairs there are
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
