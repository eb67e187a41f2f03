"""Where the maps come from whose elastic mean is wanted."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy import fft

from analytic import Nayak, SpectralMoments
from analytic.arrays import Array
from mcgw.maps.map_files import read_map
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.maps.topography import Topography
from mcgw.scene.scene import Scene
from mcgw.scene.validity_place import moments_of_nayak

_POINTS = 8  # a shortest wave: twice as many change area by 2 %, and the rest by less
_MOST_POINTS = 2048  # a side


@dataclass(frozen=True)
class Drawn:
    """Gaussian maps of a spectrum.

    Parameters
    ----------
    spectrum : Spectrum
        Of each.
    shape : (int, int)
        Rows and columns.
    size : (float, float)
        m.
    """

    spectrum: Spectrum
    shape: tuple[int, int]
    size: tuple[float, float]
    number = None

    @property
    def words(self) -> str:
        """What they are."""
        return f"Gaussian maps of {self.shape[1]} x {self.shape[0]} points, {self.size[0]:.3g} m wide"

    def heights(self, number: int, seed: int) -> Array:
        """Heights of one, m: a pure function of seed and number."""
        pixel = self.size[0] / self.shape[1], self.size[1] / self.shape[0]
        return gaussian_map(self.spectrum, self.shape, pixel, np.random.default_rng([seed, number])).heights


@dataclass(frozen=True)
class Surrogates:
    """Gaussian maps with the spectrum of a measured one: its own waves with other phases.

    Parameters
    ----------
    amplitude : ndarray
        Of its waves, those of ``rfft2``.
    shape : (int, int)
        Rows and columns.
    size : (float, float)
        m.
    """

    amplitude: Array
    shape: tuple[int, int]
    size: tuple[float, float]
    number = None
    words = "Gaussian maps of the measured map's spectrum"

    @classmethod
    def of(cls, measured: Topography) -> "Surrogates":
        """Of a map; one that is not periodic is tapered, so that its edges are no waves (Hann window)."""
        z = measured.heights - measured.heights.mean()
        if not measured.periodic:
            window = np.sqrt(np.outer(*(np.hanning(n + 1)[:n] for n in z.shape)))
            z = z * window / math.sqrt(float((window**2).mean()))
            z -= z.mean()
        return cls(np.abs(fft.rfft2(z)), z.shape, measured.size)

    def heights(self, number: int, seed: int) -> Array:
        """Heights of one, m: a pure function of seed and number."""
        noise = fft.rfft2(np.random.default_rng([seed, number]).standard_normal(self.shape))
        return np.asarray(fft.irfft2(self.amplitude * noise, s=self.shape) / math.sqrt(math.prod(self.shape)))


@dataclass(frozen=True)
class Listed:
    """Maps that are given, whose own mean is wanted.

    Parameters
    ----------
    maps : tuple of Topography
        Periodic ones of one size.
    """

    maps: tuple[Topography, ...]

    @property
    def words(self) -> str:
        """What they are."""
        return f"the {len(self.maps)} given maps"

    @property
    def number(self) -> int:
        """How many there are."""
        return len(self.maps)

    @property
    def size(self) -> tuple[float, float]:
        """Of each, m."""
        return self.maps[0].size

    def heights(self, number: int, seed: int) -> Array:  # noqa: ARG002 - nothing is drawn
        """Heights of one, m."""
        z = self.maps[number].heights
        return np.asarray(z - z.mean())


Maps = Drawn | Surrogates | Listed  # periodic maps by number; of `number` None there are as many as one likes


def maps_of(source: "Scene | Spectrum | Topography | str | Path | Sequence[Topography | str | Path]") -> Maps:
    """Make the maps of what was given; see `mcgw.elastic`.

    Raises
    ------
    ValueError
        If a scene has no spectrum, its area is too large or too small for its waves, a map has missing
        points, or those of a list are not periodic or not of one size.
    """
    if isinstance(source, Scene):
        spectrum = Spectrum.with_moments(_moments_of(source))
        return _drawn(spectrum, math.sqrt(source.surface.nominal_area))
    if isinstance(source, Spectrum):
        return _drawn(source, source.long)
    if isinstance(source, str | Path | Topography):
        return Surrogates.of(_whole(source))
    maps = tuple(_whole(one) for one in source)
    if not maps or len({one.size for one in maps}) > 1 or not all(one.periodic for one in maps):
        raise ValueError("maps: give one or more periodic maps, all of one size")
    return Listed(maps)


def _whole(given: "Topography | str | Path") -> Topography:
    read = given if isinstance(given, Topography) else read_map(Path(given))
    if read.missing:
        raise ValueError(f"{read.missing} points are missing; fill them first")
    return read


def _moments_of(scene: Scene) -> SpectralMoments:
    if scene.fitted is not None:
        return scene.fitted.moments
    if not isinstance(scene.heights, Nayak):
        raise ValueError('the scene has no spectrum: give m0, m2, m4 under [surface], or law = "nayak"')
    return moments_of_nayak(scene.surface, scene.heights.alpha)


def _drawn(spectrum: Spectrum, side: float) -> Drawn:
    """Square maps of this side, with as many points as the shortest wave takes."""
    if spectrum.long > (1 + 1e-9) * side:
        raise ValueError(
            f"waves of {spectrum.long:.3g} m are longer than the map of {side:.3g} m; give nominal_area = "
            f"{1.01 * spectrum.long**2:.3g} m^2 or more"
        )
    points = fft.next_fast_len(math.ceil(_POINTS * side / spectrum.short), real=True)
    if points > _MOST_POINTS:
        wide = _MOST_POINTS / _POINTS * spectrum.short
        raise ValueError(
            f"{points} points per side for waves of {spectrum.short:.3g} m on {side:.3g} m: more than "
            f"{_MOST_POINTS}; give nominal_area = {0.99 * wide**2:.3g} m^2 or less"
        )
    return Drawn(spectrum, (points, points), (side, side))
