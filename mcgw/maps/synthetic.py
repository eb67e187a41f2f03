"""Synthetic surfaces: Gaussian maps of a power-law spectrum; asperities at random places."""

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.optimize import brentq

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.units import parse, signed
from mcgw.maps.topography import Topography, checked_shape
from mcgw.sampling.asperities import summits
from mcgw.sampling.philox import POSITIONS, uniforms
from mcgw.scene.scene import Scene

_HURST = 0.8
_UNITS = {"rms": "m", "long": "m", "short": "m", "m0": "m^2", "m2": "1", "m4": "1/m^2"}


@dataclass(frozen=True)
class Spectrum:
    """Power spectrum ``C(q) ~ q^(-2-2H)`` between two wavelengths, zero elsewhere.

    Parameters
    ----------
    rms : float
        Root mean square height of the map, m.
    long, short : float
        Longest and shortest wavelength, m.
    hurst : float, optional
        H; -1 makes the spectrum flat.

    Raises
    ------
    ValueError
        If `short` is not smaller than `long`, or a length is not positive.
    """

    rms: float
    long: float
    short: float
    hurst: float = _HURST

    def __post_init__(self) -> None:
        for name in ("rms", "long", "short"):
            if not (math.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise ValueError(f"{name} = {getattr(self, name)!r}: give a length > 0 m")
        if not self.short < self.long:
            raise ValueError(f"short = {self.short:g} m: give a wavelength below long = {self.long:g} m")
        if not -1 <= self.hurst <= 1:
            raise ValueError(f"hurst = {self.hurst!r}: give a number from -1 (a flat spectrum) to 1")

    @classmethod
    def with_moments(cls, moments: SpectralMoments, hurst: float = _HURST) -> "Spectrum":
        """Spectrum with these moments: its two wavelengths follow from alpha and m2/m0.

        Raises
        ------
        ValueError
            If no such spectrum has this alpha, which is above 1.5.
        """

        def alpha(log_ratio: float) -> float:
            q4, q2 = (_mean_power(k, math.exp(log_ratio), hurst) for k in (4, 2))
            return 1.5 * q4 / q2**2

        low, high = 1e-6, math.log(1e6)  # of the ratio of the wavelengths
        if not alpha(low) < moments.alpha < alpha(high):
            raise ValueError(
                f"m0 m4/m2^2 = {moments.alpha:.6g}: give a ratio above 1.5 and below {alpha(high):.4g}"
            )
        ratio = math.exp(brentq(lambda x: alpha(x) - moments.alpha, low, high, xtol=1e-14))
        q_long = math.sqrt(2 * moments.m2 / moments.m0 / _mean_power(2, ratio, hurst))
        return cls(math.sqrt(moments.m0), 2 * math.pi / q_long, 2 * math.pi / q_long / ratio, hurst)

    def density(self, q: Array) -> Array:
        """Spectral density of the variance over the plane of wave vectors, up to a factor; `q` in 1/m."""
        inside = (q >= 2 * math.pi / self.long) & (q <= 2 * math.pi / self.short)
        relative = np.where(inside, q * self.short, 1.0)
        return np.asarray(np.where(inside, relative ** (-2 - 2 * self.hurst), 0.0))


def _mean_power(k: int, ratio: float, hurst: float) -> float:
    """Mean of q^k over a spectrum from q = 1 to `ratio`."""

    def integral(power: float) -> float:
        return math.log(ratio) if power == 0 else math.expm1(power * math.log(ratio)) / power

    return integral(k - 2 * hurst) / integral(-2 * hurst)


def _waves(
    spectrum: Spectrum, shape: tuple[int, int], pixel: tuple[float, float]
) -> tuple[Array, Array, Array]:
    """Wave numbers along x and y of ``rfft2``, 1/m, and the variance of its waves, with their conjugates."""
    rows, columns = checked_shape(*shape)
    if spectrum.short < 2 * max(pixel):
        raise ValueError(f"short = {spectrum.short:g} m: a pixel of {max(pixel):g} m shows 2 pixels or more")
    if spectrum.long > (1 + 1e-9) * min(columns * pixel[0], rows * pixel[1]):
        raise ValueError(f"long = {spectrum.long:g} m: longer than the map; give more pixels")
    qx = 2 * math.pi * fft.rfftfreq(columns, pixel[0])
    qy = 2 * math.pi * fft.fftfreq(rows, pixel[1])[:, None]
    power = spectrum.density(np.hypot(qx, qy))
    if not power.any():
        raise ValueError("the spectrum lies between two wave vectors of the map; give more pixels")
    power[:, 1 : (columns + 1) // 2] *= 2  # rfft2 leaves out their conjugates
    power *= spectrum.rms**2 / power.sum()
    return qx, qy, power


def moments_on_grid(
    spectrum: Spectrum, shape: tuple[int, int], pixel: tuple[float, float]
) -> SpectralMoments:
    """Return the expected moments of `gaussian_map` with the same arguments, means of profiles along x and y.

    They are sums over the waves of the grid instead of integrals over the spectrum.
    """
    qx, qy, power = _waves(spectrum, shape, pixel)
    m2, m4 = (float((power * (qx**k + qy**k)).sum() / 2) for k in (2, 4))
    return SpectralMoments(spectrum.rms**2, m2, m4)


def gaussian_map(
    spectrum: Spectrum, shape: tuple[int, int], pixel: tuple[float, float], rng: np.random.Generator
) -> Topography:
    """Draw a periodic isotropic Gaussian map: heights of mean 0 whose expected variance is ``rms**2``.

    Parameters
    ----------
    spectrum : Spectrum
        Its two wavelengths must fit the grid.
    shape : (int, int)
        Rows and columns.
    pixel : (float, float)
        dx and dy, m.
    rng : numpy.random.Generator
        Generator of the random numbers.

    Raises
    ------
    ValueError
        If the shortest wavelength is below two pixels or the longest does not fit on the map.
    """
    *_, power = _waves(spectrum, shape, pixel)
    power[:, 1 : (shape[1] + 1) // 2] /= 2
    noise = fft.rfft2(rng.standard_normal(shape), overwrite_x=True)
    noise *= np.sqrt(shape[0] * shape[1] * power)
    return Topography(np.asarray(fft.irfft2(noise, s=shape, overwrite_x=True)), pixel, periodic=True)


def spectrum_from(text: str) -> Spectrum:
    """Spectrum of a list ``rms=1um,long=100um,short=5um,hurst=0.8`` or ``m0=1e-12,m2=1e-2,m4=5e8``.

    Raises
    ------
    ValueError
        If a key is unknown, missing or no number.
    """
    given: dict[str, float] = {}
    for part in text.split(","):
        key, _, value = part.partition("=")
        key = key.strip()
        if key not in (*_UNITS, "hurst") or key in given:
            raise ValueError(f"{part!r}: give rms, long, short and hurst, or m0, m2, m4 and hurst, each once")
        given[key] = parse(value, _UNITS[key], key) if key in _UNITS else signed(value, "1")
    hurst = given.pop("hurst", _HURST)
    if math.isnan(hurst):
        raise ValueError(f"{text!r}: hurst is no number; give one from -1 (a flat spectrum) to 1")
    if set(given) == {"m0", "m2", "m4"}:
        return Spectrum.with_moments(SpectralMoments(**given), hurst)
    if set(given) == {"rms", "long", "short"}:
        return Spectrum(**given, hurst=hurst)
    raise ValueError(f"{text!r}: give rms, long and short, or m0, m2 and m4")


@dataclass(frozen=True)
class Asperities:
    """Asperities of one surface.

    Parameters
    ----------
    x, y, z : ndarray
        Positions of the summits in the nominal area and heights about the mean of all summit heights,
        m, shape (asperities,). Those that touch at the scene's lowest separation come first.
    radii : ndarray
        Radius of each summit, m.
    radius : float
        Radius R of the surface, m: that of every summit, or the inverse of the mean curvature.
    size : (float, float)
        Extent of the nominal area along x and y, m.
    """

    x: Array
    y: Array
    z: Array
    radii: Array
    radius: float
    size: tuple[float, float]

    @property
    def number(self) -> int:
        """Number of asperities."""
        return len(self.z)


def asperities_of(scene: Scene, surface: int) -> Asperities:
    """Place the asperities of one surface of an ensemble, including those that cannot touch, on a square.

    The heights are those whose loads are in the ensemble's file. The positions are uniform and independent,
    and a pure function of the seed and the surface.

    Raises
    ------
    ValueError
        If there is no such surface, or the sampler keeps no heights.
    """
    if not 0 <= surface < scene.n_surfaces:
        raise ValueError(f"surface = {surface}: the scene has surfaces 0 to {scene.n_surfaces - 1}")
    side = math.sqrt(scene.surface.nominal_area)
    s, ratios = summits(scene, surface)
    z, radius = scene.surface.sigma * s, scene.surface.radius
    radii = np.full(s.shape, radius) if ratios is None else radius * ratios
    x, y = (uniforms(scene.seed, POSITIONS, surface, stream, len(z)) for stream in (0, 1))
    return Asperities(side * x, side * y, z, radii, radius, (side, side))
