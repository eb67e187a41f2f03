"""Periodic height maps to be solved, in cells of side 1: Gaussian ones of a power law, and random caps."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.optimize import brentq

Array = NDArray[np.float64]

DRAWN_PIXELS = 8  # a shortest wave, of the grid on which a map is drawn; finer ones are interpolated
EXCLUSION = 0.5  # centres of caps are further apart than this over the root of their density


def waves_on(n: int) -> Array:
    """Waves across the cell, of each term of a real Fourier transform: shape (n, n//2 + 1)."""
    return np.hypot(fft.fftfreq(n, 1 / n)[:, None], fft.rfftfreq(n, 1 / n))


def spectrum(k: Array, shortest: float, ratio: float, hurst: float) -> Array:
    """Power spectrum: flat up to the roll-off wave, then a power law, nothing beyond the shortest wave."""
    flat = shortest / ratio
    inside = (k > 0) & (k <= shortest)
    return np.where(inside, (np.maximum(k, flat) / flat) ** (-2 * (1 + hurst)), 0.0)


def profile_moments(power: Array, k: Array) -> tuple[float, float, float]:
    """m0, m2, m4 of profiles of an isotropic surface, from powers of all its waves."""
    q2 = (2 * math.pi * k) ** 2
    return float(power.sum()), float((power * q2).sum() / 2), float((power * q2 * q2).sum() * 3 / 8)


@cache
def roll_off(alpha: float, hurst: float, shortest: int) -> float:
    """Ratio of shortest to roll-off wave at which the expected moments on the grid give alpha."""
    n = DRAWN_PIXELS * shortest
    k = np.hypot(fft.fftfreq(n, 1 / n)[:, None], fft.fftfreq(n, 1 / n))

    def excess(log_ratio: float) -> float:
        m0, m2, m4 = profile_moments(spectrum(k, shortest, math.exp(log_ratio), hurst), k)
        return m0 * m4 / m2**2 - alpha

    if alpha == 2:  # what a flat disc has
        return 1.0
    return math.exp(brentq(excess, 0.0, math.log(shortest), xtol=1e-12))


@dataclass(frozen=True)
class GaussianMap:
    """A Gaussian isotropic map.

    Parameters
    ----------
    hurst, alpha : float
        Exponent of the power law, and Nayak's parameter expected of the map.
    seed : int
        Of its white noise.
    shortest : int
        Shortest waves across the cell.
    pixels : int
        A shortest wave.
    """

    hurst: float
    alpha: float
    seed: int
    shortest: int
    pixels: int = DRAWN_PIXELS
    kind = "gaussian"

    @property
    def n(self) -> int:
        """Points along a side."""
        return self.shortest * self.pixels

    @property
    def name(self) -> str:
        """Tells this map from all others."""
        return f"gaussian-H{self.hurst:g}-a{self.alpha:g}-s{self.seed}-k{self.shortest}-x{self.pixels}"

    @property
    def group(self) -> str:
        """Its spectrum, for people."""
        return f"α = {self.alpha:g}, H = {self.hurst:g}"

    def _series(self) -> Array:
        """Fourier series of the heights on the grid that is drawn, at rms slope 1 of the surface."""
        n = DRAWN_PIXELS * self.shortest
        k = waves_on(n)
        ratio = roll_off(self.alpha, self.hurst, self.shortest)
        noise = fft.rfft2(np.random.default_rng(self.seed).standard_normal((n, n))) / n**2
        series = noise * np.sqrt(spectrum(k, self.shortest, ratio, self.hurst))
        return series / math.sqrt(2 * profile_moments(self._power(series), k)[1])

    @staticmethod
    def _power(series: Array) -> Array:
        """Mean squares: waves between the first column and the last stand for their mirror images too."""
        power = np.abs(series) ** 2
        power[:, 1 : (series.shape[0] + 1) // 2] *= 2
        return power

    def heights(self) -> Array:
        """The map: shape (n, n), mean 0, rms slope 1."""
        coarse, n = self._series(), self.n
        half = self.shortest + 1
        fine = np.zeros((n, n // 2 + 1), dtype=complex)
        fine[:half, :half], fine[-half:, :half] = coarse[:half, :half], coarse[-half:, :half]
        return np.ascontiguousarray(fft.irfft2(fine * n**2, s=(n, n)))

    def independent(self) -> float:
        """How many independent heights would tell m0 as well: by the waves that the spectrum expects."""
        n = DRAWN_PIXELS * self.shortest
        k = np.hypot(fft.fftfreq(n, 1 / n)[:, None], fft.fftfreq(n, 1 / n))
        power = spectrum(k, self.shortest, roll_off(self.alpha, self.hurst, self.shortest), self.hurst)
        return float(power.sum() ** 2 / (power**2).sum())

    def moments(self) -> tuple[float, float, float]:
        """m0, m2, m4 of this very map."""
        series = self._series()
        return profile_moments(self._power(series), waves_on(series.shape[0]))


@dataclass(frozen=True)
class CapsMap:
    """Paraboloids of one radius at random places, with Gaussian heights, sigma = R.

    Parameters
    ----------
    crowding : float
        eta R sigma.
    seed : int
        Of places and heights.
    n : int
        Points along a side.
    caps : int
        How many.
    """

    crowding: float
    seed: int
    n: int
    caps: int = 100
    kind = "caps"

    @property
    def name(self) -> str:
        """Tells this map from all others."""
        return f"caps-{self.crowding:g}-s{self.seed}-N{self.caps}-n{self.n}"

    @property
    def group(self) -> str:
        """Its crowding, for people."""
        return f"η R σ = {self.crowding:g}"

    @property
    def sigma(self) -> float:
        """Standard deviation of the heights, and radius."""
        return math.sqrt(self.crowding / self.caps)

    def summits(self) -> tuple[Array, Array]:
        """Places, shape (caps, 2), and heights: one after the other, each clear of those before."""
        rng = np.random.default_rng(self.seed)
        clear, places = EXCLUSION / math.sqrt(self.caps), np.empty((0, 2))
        while len(places) < self.caps:
            new = rng.random(2)
            away = places - new
            away -= np.rint(away)
            if not np.any(np.hypot(*away.T) < clear):
                places = np.vstack([places, new])
        return places, self.sigma * rng.standard_normal(self.caps)

    def heights(self) -> Array:
        """The highest of all paraboloids: shape (n, n), counted from the mean of the law of their heights."""
        grid = np.arange(self.n) / self.n
        z = np.full((self.n, self.n), -np.inf)
        for place, top in zip(*self.summits(), strict=True):
            x, y = ((grid - p + 0.5) % 1 - 0.5 for p in place)
            np.maximum(z, top - (x[:, None] ** 2 + y**2) / (2 * self.sigma), out=z)
        return z

    def moments(self) -> tuple[float, float, float]:
        """Variance of the heights of caps; paraboloids that cut each other have no m4."""
        return self.sigma**2, math.nan, math.nan
