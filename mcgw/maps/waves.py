"""How well one map can tell of its surface: long waves are few on it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from analytic import SpectralMoments
from mcgw.maps.topography import Topography

__all__ = ["Waves", "block_means", "waves_of"]

Array = NDArray[np.float64]

_ACROSS = 2048  # points that are looked at; of the waves shorter than that there are always many


@dataclass(frozen=True, slots=True)
class Waves:
    """Relative standard errors over other maps of this size, if the heights are Gaussian.

    Parameters
    ----------
    m0, alpha : float
        Of the mean square height, and of ``m0 m4/m2^2``.
    eta, radius, sigma : float
        Of what the spectral moments give.
    """

    m0: float
    alpha: float
    eta: float
    radius: float
    sigma: float

    @property
    def independent(self) -> float:
        """How many independent heights would tell m0 as well: ``2/m0^2``."""
        return 2 / self.m0**2


def block_means(heights: Array, most: int) -> Array:
    """Means over blocks of pixels that leave between `most` and two times as many along each axis."""
    down, along = (max(n // most, 1) for n in heights.shape)
    rows, columns = heights.shape[0] // down, heights.shape[1] // along
    blocks = heights[: rows * down, : columns * along].reshape(rows, down, columns, along)
    return np.asarray(blocks.mean(axis=(1, 3)))


def waves_of(topography: Topography) -> Waves:
    """Errors that follow from the power of every wave on a map without form, which lacks no points.

    A moment is a sum of the powers of waves, each exponentially distributed: its variance is the sum of
    their squared means, and that is half the sum of the squares seen. For m0 this is ``2/A`` times the
    integral of the squared autocorrelation. Ratios follow from derivatives of their logarithms. Sub-areas of
    the map see none of it: they all lie on the same waves.
    """
    z = block_means(topography.heights - topography.heights.mean(), _ACROSS)
    rows, columns = topography.heights.shape
    dx, dy = topography.pixel[0] * (columns // z.shape[1]), topography.pixel[1] * (rows // z.shape[0])
    power, waves = _power(z)
    x, y = (
        (2 * math.pi / dx * fft.rfftfreq(z.shape[1])) ** 2,
        (2 * math.pi / dy * fft.fftfreq(z.shape[0])) ** 2,
    )
    weights = (np.ones_like(power), (x + y[:, None]) / 2, (x * x + (y * y)[:, None]) / 2)
    m0, m2, m4 = (float((waves * power * w).sum()) for w in weights)
    of_m0, of_m2, of_m4 = (w / m for w, m in zip(weights, (m0, m2, m4), strict=True))
    of_alpha = of_m0 + of_m4 - 2 * of_m2
    # sigma^2 is m0 - c m2^2/m4
    share = SpectralMoments(m0, m2, m4).sigma ** 2 / m0
    of_sigma = (of_m0 + (1 / share - 1) * of_alpha) / 2 if share > 0 else of_m0 / 2

    def error(derivative: Array) -> float:
        return math.sqrt(float((waves * (derivative * power) ** 2).sum()))

    return Waves(error(of_m0), error(of_alpha), error(of_m4 - of_m2), error(of_m4) / 2, error(of_sigma))


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
