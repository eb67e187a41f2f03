"""How well one map can tell of its surface: long waves are few on it, and form takes some of them away."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.special import gammaincinv, ndtr, polygamma, spherical_jn, stdtrit

from analytic import SpectralMoments
from mcgw.maps.topography import Topography
from mcgw.maps.uncertain import Spread

__all__ = ["Waves", "block_means", "waves_of"]

Array = NDArray[np.float64]

_ACROSS = 2048  # points that are looked at; of the waves shorter than that there are always many
_FEWEST = 0.5  # waves: one that is cut in two
_LEAST_FREEDOM = 2.0
_OUTSIDE = 0.025  # at either end of an interval


@dataclass(frozen=True, slots=True)
class Waves:
    """How far estimates scatter over maps of this size, if the heights are Gaussian.

    Parameters
    ----------
    m0, m2, m4, alpha : Spread
        Of the spectral moments, and of ``m0 m4/m2^2``.
    eta, radius, sigma : Spread
        Of what the spectral moments give.
    independent : float
        How many independent heights would tell m0 as well.
    """

    m0: Spread
    m2: Spread
    m4: Spread
    alpha: Spread
    eta: Spread
    radius: Spread
    sigma: Spread
    independent: float


def block_means(heights: Array, most: int) -> Array:
    """Means over blocks of pixels that leave between `most` and two times as many along each axis."""
    down, along = (max(n // most, 1) for n in heights.shape)
    rows, columns = heights.shape[0] // down, heights.shape[1] // along
    blocks = heights[: rows * down, : columns * along].reshape(rows, down, columns, along)
    return np.asarray(blocks.mean(axis=(1, 3)))


def waves_of(topography: Topography, moments: SpectralMoments, order: int = -1) -> Waves:
    """Errors that follow from the power of every wave on a map that lacks no points.

    A moment is a sum of the powers of waves, each exponentially distributed: its variance is the sum of
    their squared means, and that is half the sum of the squares seen. For m0 this is ``2/A`` times the
    integral of the squared autocorrelation. Ratios follow from derivatives of their logarithms. Sub-areas of
    the map see none of it: they all lie on the same waves. What a polynomial takes of long waves makes the
    moments too small, by as much as is known of these waves.

    Parameters
    ----------
    topography : Topography
        After its form was taken off.
    moments : SpectralMoments
        Of this map.
    order : int, optional
        Of the polynomial that was taken off; -1: none.
    """
    z = block_means(topography.heights - topography.heights.mean(), _ACROSS)
    rows, columns = topography.heights.shape
    dx, dy = topography.pixel[0] * (columns // z.shape[1]), topography.pixel[1] * (rows // z.shape[0])
    power, waves = _power(z)
    x, y = (
        (2 * math.pi / dx * fft.rfftfreq(z.shape[1])) ** 2,
        (2 * math.pi / dy * fft.fftfreq(z.shape[0])) ** 2,
    )
    # edges leave a little power to the very short waves, which would stand for most of m4
    of_m0 = np.full_like(power, 1 / float((waves * power).sum()))
    of_m2, of_m4 = (x + y[:, None]) / (2 * moments.m2), (x * x + (y * y)[:, None]) / (2 * moments.m4)
    of_alpha = of_m0 + of_m4 - 2 * of_m2
    # sigma^2 is m0 - c m2^2/m4
    share = moments.sigma**2 / moments.m0
    of_sigma = (of_m0 + (1 / share - 1) * of_alpha) / 2 if share > 0 else of_m0 / 2
    low = float((of_m0 * waves * power * _taken(z.shape, order)).sum())

    def spread(derivative: Array, degree: float = 1.0, with_m0: float = 0.0) -> Spread:
        terms = derivative * power
        seen = float((waves * terms * terms).sum()) / degree**2
        sign = math.copysign(degree, float((waves * terms**3).sum()))
        fourth = float((waves * terms**4).sum()) / degree**4
        return _spread(_number(seen), _freedom(seen, fourth), sign, with_m0 * low)

    return Waves(
        m0=spread(of_m0, with_m0=1.0),
        m2=spread(of_m2),
        m4=spread(of_m4),
        alpha=spread(of_alpha, with_m0=1.0),
        eta=spread(of_m4 - of_m2),
        radius=spread(-of_m4 / 2, 0.5),
        sigma=spread(of_sigma, 0.5, with_m0=0.5 / share if share > 0 else 0.5),
        independent=2 * _number(float((waves * (of_m0 * power) ** 2).sum())),
    )


def _number(seen: float) -> float:
    """How many equal waves give this sum of squared shares, each twice, with its conjugate.

    On average ``1/(n + 1)`` and never more than 1, since the sum itself fluctuates with its terms.
    """
    return max(1 / max(seen, 1e-30) - 1, _FEWEST)


def _freedom(seen: float, fourth: float) -> float:
    """Degrees of freedom of an error that was found from the waves themselves, twice its mean over variance.

    Of n equal waves, each with its conjugate, the sum of fourth powers over the squared sum of squares is
    about ``3/(n + 5)``, and the squares of exponential powers scatter as ``5/n``.
    """
    return max(0.4 * (3 * seen * seen / fourth - 5), _LEAST_FREEDOM)


def _spread(n: float, freedom: float, degree: float, low: float) -> Spread:
    """Of the power `degree` of a sum of n exponential terms, which has a gamma distribution, over its mean.

    Widened as Student's t asks where n is itself known from few waves; `low` is the logarithm of the truth
    over the mean.
    """
    wider = degree * float(stdtrit(freedom, float(ndtr(2.0)))) / 2
    ends = sorted(-wider * math.log(gammaincinv(n, p) / n) for p in (_OUTSIDE, 1 - _OUTSIDE))
    error = math.hypot(wider * math.sqrt(float(polygamma(1, n))), low)
    return Spread(error, -ends[0] + max(-low, 0.0), ends[1] + max(low, 0.0))


def _taken(shape: tuple[int, int], order: int) -> Array:
    """What a polynomial of least squares takes of every wave of ``rfft2``, over what it leaves.

    The shares of Legendre polynomials in a wave of random phase are squared spherical Bessel functions.
    """
    x, y = np.pi * np.arange(shape[1] // 2 + 1.0), np.pi * np.abs(fft.fftfreq(shape[0]) * shape[0])
    along, down = ([(2 * a + 1) * spherical_jn(a, q) ** 2 for a in range(order + 1)] for q in (x, y))
    share = np.zeros((y.size, x.size))
    for b, of_y in enumerate(down):
        for of_x in along[: order + 1 - b]:
            share += of_y[:, None] * of_x
    share[0, 0] = 0.0
    return np.asarray(share / (1 - share))


def _power(z: Array) -> tuple[Array, Array]:
    """Power at the wave vectors of ``rfft2``, and how many waves of the whole plane each stands for.

    Edges that do not fit together would add power that no wave has: the smooth field that makes up for
    their jumps is taken off (Moisan 2011, periodic plus smooth decomposition).
    """
    rows, columns = z.shape
    jumps = np.zeros_like(z)
    across, along = z[-1] - z[0], z[:, -1] - z[:, 0]
    jumps[0] += across
    jumps[-1] -= across
    jumps[:, 0] += along
    jumps[:, -1] -= along
    x, y = np.cos(2 * math.pi * fft.rfftfreq(columns)), np.cos(2 * math.pi * fft.fftfreq(rows))
    laplacian = 2 * (x + y[:, None] - 2)
    laplacian[0, 0] = 1.0
    periodic = fft.rfft2(z) - fft.rfft2(jumps) / laplacian
    periodic[0, 0] = 0.0
    waves = np.full(x.shape, 2.0)
    waves[0] = 1.0
    if columns % 2 == 0:
        waves[-1] = 1.0
    return np.abs(periodic / z.size) ** 2, np.broadcast_to(waves, periodic.shape)
