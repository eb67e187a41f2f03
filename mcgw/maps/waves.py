"""How well one map can tell of its surface: long waves are few on it, and form takes some of them away."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy import fft
from scipy.special import gammaincinv, ndtr, polygamma, spherical_jn, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.maps.topography import Topography

_ACROSS = 1536  # points that are looked at; of the waves shorter than that there are always many
_BAND = 16  # rows that are looked at together: whole maps of what is made of them would not stay in the cache


class Uncertain(NamedTuple):
    """A positive number that a map tells."""

    value: float
    error: float  # standard error; error/value is that of the logarithm
    low: float  # both ends of an interval that holds the truth 95 times of 100
    high: float

    @property
    def relative(self) -> float:
        """Standard error of the logarithm."""
        return self.error / self.value


class Spread(NamedTuple):
    """How far the truth may lie from an estimate, in logarithms."""

    error: float  # standard error
    down: float  # how far below the estimate an interval of 95 % reaches
    up: float  # and above


def uncertain(value: float, error: float, waves: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Uncertain:
    """Put together an error seen between sub-areas, two of which hold 95 %, and a `Spread` of few long waves.

    The larger one counts: sub-areas see the short waves twice and the long ones not at all.
    """
    relative, (least, down, up) = error / value, waves
    down, up = max(2 * relative, down), max(2 * relative, up)
    high = value * math.exp(up) if up < 700 else math.inf  # where an arm has no end
    return Uncertain(value, value * max(relative, least), value * math.exp(-down), high)


@dataclass(frozen=True, slots=True)
class Waves:
    """How far estimates scatter over maps of this size, if the heights are Gaussian."""

    spreads: dict[str, Spread]  # of m0, m2, m4, alpha, eta, radius and sigma by spectral moments
    independent: float  # how many independent heights would tell m0 as well
    covariance: Array  # of the logarithms of m0, m2 and m4 over such maps, shape (3, 3), to a factor


def log_derivatives(moments: SpectralMoments) -> dict[str, Array]:
    """Of the logarithms of all that moments tell, by those of m0, m2 and m4."""
    m0, m2, m4 = np.eye(3)
    alpha = m0 + m4 - 2 * m2
    share = moments.sigma**2 / moments.m0  # sigma^2 is m0 - c m2^2/m4
    sigma = (m0 + (1 / share - 1) * alpha) / 2 if share > 0 else m0 / 2
    return {
        "m0": m0, "m2": m2, "m4": m4, "alpha": alpha, "eta": m4 - m2, "radius": -m4 / 2, "sigma": sigma
    }  # fmt: skip


def coarser(topography: Topography, most: int) -> Topography:
    """Return the map of means over blocks of pixels that leave `most` to twice as many along each axis."""
    z, (dx, dy) = topography.heights, topography.pixel
    down, along = (max(n // most, 1) for n in z.shape)
    if down == along == 1:
        return topography
    rows, columns = z.shape[0] // down, z.shape[1] // along
    blocks = z[: rows * down, : columns * along].reshape(rows, down, columns, along)
    return replace(topography, heights=blocks.mean(axis=(1, 3)), pixel=(along * dx, down * dy))


def waves_of(topography: Topography, moments: SpectralMoments, order: int = -1) -> Waves:
    """Errors that follow from the power of every wave on a map that lacks no points.

    A moment is a sum of the powers of waves, each exponentially distributed: its variance is the sum of
    their squared means, and that is half the sum of the squares seen. For m0 this is ``2/A`` times the
    integral of the squared autocorrelation. Ratios follow from derivatives of their logarithms. Sub-areas of
    the map see none of it: they all lie on the same waves. What a polynomial of this `order` (-1: none) took
    of long waves makes the `moments` of the map that is left too small, by as much as is known of the waves.
    """
    coarse = coarser(topography, _ACROSS)
    z, (dx, dy) = coarse.heights, coarse.pixel
    power, waves = _power(z)
    total = float((power @ waves).sum())
    # edges leave a little power to the very short waves, which would stand for most of m4
    by_moments = log_derivatives(moments)
    kinds = np.array(list(by_moments.values())) * [1 / total, 0.5 / moments.m2, 0.5 / moments.m4]
    x = (2 * math.pi / dx * fft.rfftfreq(z.shape[1])) ** 2
    y = (2 * math.pi / dy * fft.fftfreq(z.shape[0]))[:, None] ** 2
    down, along = _legendre_shares(z.shape, order)
    sums, taken, products = np.zeros((3, len(kinds))), 0.0, np.zeros((3, 3))
    for first in range(0, len(z), _BAND):
        band = slice(first, first + _BAND)
        features = np.array([np.ones_like(power[band]), x + y[band], x * x + y[band] ** 2])
        terms = np.tensordot(kinds, features, 1) * power[band]
        products += (terms[:3] * waves).reshape(3, -1) @ terms[:3].reshape(3, -1).T
        squares = terms * terms
        sums += [(t @ waves).sum(axis=1) for t in (squares, squares * terms, squares * squares)]
        share = down[band] @ along  # of a wave that the polynomial held; 1 of the mean, which is no wave
        taken += float((power[band] * (share / np.where(share < 1, 1 - share, np.inf)) @ waves).sum())
    low = taken / total
    spreads = {
        name: _spread(of, 0.5 if name in ("radius", "sigma") else 1.0, float(by_moments[name][0]) * low)
        for name, of in zip(by_moments, sums.T.tolist(), strict=True)
    }
    return Waves(spreads, 2 * _number(float(sums[0, 0])), products)


def _number(seen: float) -> float:
    """How many equal waves give this sum of squared shares, each twice, with its conjugate.

    On average ``1/(n + 1)`` and never more than 1, since the sum itself fluctuates with its terms.
    """
    return max(1 / max(seen, 1e-30) - 1, 0.5)  # waves: one that is cut in two


def _spread(sums: list[float], degree: float, low: float) -> Spread:
    """Of the power `degree` of a sum of exponential terms, which has a gamma distribution, over its mean.

    `sums` are those of their squares, cubes and fourth powers; `low` is the logarithm of the truth over the
    mean. Widened as Student's t asks, since the error is itself known from few waves: of n equal ones, each
    with its conjugate, the sum of fourth powers over the squared sum of squares is about ``3/(n + 5)``, and
    the squares of exponential powers scatter as ``5/n``.
    """
    seen, third, fourth = sums
    n = _number(seen / degree**2)
    freedom = max(0.4 * (3 * seen * seen / fourth - 5), 2.0)  # twice the mean over the variance
    wider = math.copysign(degree, third) * float(stdtrit(freedom, float(ndtr(2.0)))) / 2
    ends = sorted(-wider * math.log(gammaincinv(n, p) / n) for p in (0.025, 0.975))
    error = math.hypot(wider * math.sqrt(float(polygamma(1, n))), low)
    return Spread(error, -ends[0] + max(-low, 0.0), ends[1] + max(low, 0.0))


def _legendre_shares(shape: tuple[int, int], order: int) -> tuple[Array, Array]:
    """Two factors, down and along, of what a polynomial of least squares holds of every wave of ``rfft2``.

    The shares of Legendre polynomials in a wave of random phase are squared spherical Bessel functions.
    """
    x, y = np.pi * np.arange(shape[1] // 2 + 1.0), np.pi * np.abs(fft.fftfreq(shape[0]) * shape[0])
    along, down = (
        np.array([(2 * a + 1) * spherical_jn(a, q) ** 2 for a in range(order + 1)]).reshape(-1, q.size)
        for q in (x, y)
    )
    return down.T, np.cumsum(along, axis=0)[::-1]  # degrees a of x up to order - b


def _power(z: Array) -> tuple[Array, Array]:
    """Power at the wave vectors of ``rfft2``, and how many waves of the whole plane each column stands for.

    Edges that do not fit together would add power that no wave has: the smooth field that makes up for
    their jumps is taken off (Moisan 2011, periodic plus smooth decomposition). They lie on the outermost
    rows and columns alone, so that their transform is that of two lines.
    """
    rows, columns = z.shape
    x, y = 2 * math.pi * fft.rfftfreq(columns), 2 * math.pi * fft.fftfreq(rows)[:, None]
    across, along = fft.rfft(z[-1] - z[0]), fft.fft(z[:, -1] - z[:, 0])[:, None]
    jumps = across * (1 - np.exp(1j * y)) + along * (1 - np.exp(1j * x))  # from the last row to the first
    jumps /= 2 * (np.cos(x) + np.cos(y) - 2) + (x + np.abs(y) == 0)
    power = (np.abs(fft.rfft2(z - z.mean()) - jumps) / z.size) ** 2
    power[0, 0] = 0.0
    waves = np.full(x.size, 2.0)
    waves[0] = 1.0
    if columns % 2 == 0:
        waves[-1] = 1.0
    return power, waves
