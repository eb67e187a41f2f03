"""Where the maps come from whose elastic mean is wanted."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy import fft

from analytic.arrays import Array
from mcgw.maps.heights_files import read_map
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.maps.topography import Topography
from mcgw.scene.measured import NO_SPECTRUM
from mcgw.scene.scene import Scene

_POINTS = 8  # a shortest wave: twice as many change area by 2 %, and the rest by less
_MOST_POINTS = 2048  # a side


@dataclass(frozen=True)
class Maps:
    """Periodic maps by number."""

    heights: Callable[[int, int], Array]  # of one, m: a pure function of its number and a seed
    size: tuple[float, float]  # of each, m
    words: str  # what they are
    number: int | None = None  # how many there are; None: as many as one likes


def maps_of(source: "Scene | Spectrum | Topography | str | Path | Sequence[Topography | str | Path]") -> Maps:
    """Make the maps of what was given; see `mcgw.elastic`.

    Raises
    ------
    ValueError
        If a scene has no spectrum, its area is too large or too small for its waves, a map has missing
        points, or those of a list are not periodic or not of one size.
    """
    if isinstance(source, Scene):
        if source.moments is None:
            raise ValueError(f"the scene {NO_SPECTRUM}")
        return _drawn(Spectrum.with_moments(source.moments), math.sqrt(source.surface.nominal_area))
    if isinstance(source, Spectrum):
        return _drawn(source, source.long)
    if isinstance(source, str | Path | Topography):
        return _like(_whole(source))
    maps = tuple(_whole(one) for one in source)
    if not maps or len({one.size for one in maps}) > 1 or not all(one.periodic for one in maps):
        raise ValueError("maps: give one or more periodic maps, all of one size")
    words = f"the {len(maps)} given maps"
    return Maps(lambda k, _: maps[k].heights - maps[k].heights.mean(), maps[0].size, words, len(maps))


def _whole(given: "Topography | str | Path") -> Topography:
    read = given if isinstance(given, Topography) else read_map(Path(given))
    if read.missing:
        raise ValueError(f"{read.missing} points are missing; fill them first")
    return read


def _drawn(spectrum: Spectrum, side: float) -> Maps:
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
    shape, pixel = (points, points), (side / points, side / points)
    return Maps(
        lambda k, seed: gaussian_map(spectrum, shape, pixel, np.random.default_rng([seed, k])).heights,
        (side, side),
        f"Gaussian maps of {points} x {points} points, {side:.3g} m wide",
    )


def _like(measured: Topography) -> Maps:
    """Gaussian maps with the spectrum of a measured one: its own waves with other phases.

    One that is not periodic is tapered, so that its edges are no waves (Hann window).
    """
    z = measured.heights - measured.heights.mean()
    if not measured.periodic:
        window = np.sqrt(np.outer(*(np.hanning(n + 1)[:n] for n in z.shape)))
        z = z * window / math.sqrt(float((window**2).mean()))
        z -= z.mean()
    amplitude, unit = np.abs(fft.rfft2(z)), math.sqrt(z.size)

    def heights(number: int, seed: int) -> Array:
        noise = fft.rfft2(np.random.default_rng([seed, number]).standard_normal(z.shape))
        return np.asarray(fft.irfft2(amplitude * noise, s=z.shape) / unit)

    return Maps(heights, measured.size, "Gaussian maps of the measured map's spectrum")
