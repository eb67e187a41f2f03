"""Cautions about a fit: the map, its pixel, heights and summits, one line each."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy import ndimage

from mcgw.maps.bad_points import spike_heights
from mcgw.maps.fit import Fit
from mcgw.maps.form import form_left
from mcgw.maps.hidden_caps import CROWDED, visible
from mcgw.maps.instrument import faults
from mcgw.maps.preparation import Prepared
from mcgw.maps.profile import Profile
from mcgw.maps.profile_fit import ProfileFit
from mcgw.maps.several_maps import disagreement
from mcgw.maps.topography import STEEPEST, Topography

_WIDEST = 1e-2  # m
_FEW_WAVES = 50  # waves for sigma to a tenth
_PIXELS = 10.0  # pixels that a cutoff wavelength should have
_RESOLVED = 0.05  # allowed ratio of two estimates of m4, reached at about ten pixels per wavelength
_LOST = 0.1  # of the summits
_SKEW, _ALPHA, _APART = 0.3, 1.5, 1.2
_FEW, _STREAKY = 100, 1.5
_PEAKS, _UNSURE = 1.2, 0.2


# First words of cautions, the most serious first: errors from a wrong unit to a few per cent.
_GRAVEST = (
    "slope", "unit", "maps", "spikes", "lines", "rounding", "form", "range",
    "cutoff", "pixel", "blur", "missing", "estimates", "lay", "skewness", "alpha", "peaks",
    "overlap", "summits", "waves", "x",
)  # fmt: skip
# Those that maps of one surface have together.
_OF_ALL = ("blur", "estimates", "lay", "skewness", "alpha", "overlap", "summits", "waves")


def _units(topography: Topography) -> Iterator[str]:
    if topography.steepness > STEEPEST:
        yield (
            f"slope: {topography.steepness:.3g} is typical of this map; are heights or pixel in another unit?"
        )
    if max(topography.pixel) > _WIDEST:
        yield f"unit: a pixel is {max(topography.pixel):g} m; was um or mm meant?"


def _spikes(topography: Topography) -> Iterator[str]:
    above = spike_heights(topography)
    if not above.any():
        return
    number = ndimage.label(above, structure=np.ones((3, 3)))[1]  # adjacent points count once
    places = "1 place stands" if number == 1 else f"{number} places stand"
    j, i = np.unravel_index(int(np.argmax(np.abs(above))), above.shape)
    x, y = ((int(k) + 0.5) * p for k, p in zip((i, j), topography.pixel, strict=True))
    kind = "high" if above[j, i] > 0 else "deep"
    yield (
        f"spikes: {places} out of the map, the largest at x = {x:.4g} m, y = {y:.4g} m, "
        f"{abs(above[j, i]):.3g} m {kind} and narrower than five pixels; a single one can dominate R, eta "
        "and sigma: use --spikes remove, or crop the map"
    )


def _form(fit: Fit, topography: Topography) -> list[str]:
    left = form_left(topography, fit.form)
    if left is None:
        return []
    share, height, more = left
    kind = "a tilt or a curved form" if fit.form == "none" else "a curved form"
    return [
        f"form: {kind} of {height:.3g} m from peak to valley remains, {100 * share:.0f} % of the "
        f"variance; give --form {more}"
    ]


def _waves(fit: Fit) -> list[str]:
    number = fit.waves.independent
    if number >= _FEW_WAVES:
        return []
    return [
        f"waves: the map has few of the longest waves, equivalent to {number:.2g} independent heights: sigma "
        f"may differ elsewhere by {100 * fit.waves.spreads['sigma'].error:.2g} % or more; measure a longer "
        f"map"
    ]


def cautions(fit: Fit, ready: Prepared, use: str = "auto") -> list[str]:
    """Warnings about the fit of a map, and the estimate to `use`: a line each, the most serious first."""
    level = ready.levelled
    return _gravest_first(
        [
            *_units(level),
            *_spikes(level),
            *(_form(fit, level) or _waves(fit)),
            *faults(ready, _longer(ready)),
            *_of_the_pixel(fit, ready),
            *_of_the_heights(fit),
            *_of_the_summits(fit, use if use in fit.estimates else fit.best),
        ]
    )


def cautions_of_several(fit: Fit, fits: Sequence[Fit], use: str = "auto") -> list[str]:
    """Warnings about maps of one surface: what each of them has, and what they tell together."""
    own = [
        f"{line} ({name})"
        for name, each in zip(fit.maps, fits, strict=True)
        for line in each.cautions
        if line.partition(":")[0] not in _OF_ALL
    ]
    used = use if use in fit.estimates else fit.best
    return _gravest_first(
        [*own, *disagreement(fits), *_waves(fit), *_of_the_heights(fit), *_of_the_summits(fit, used)]
    )


def _gravest_first(lines: list[str]) -> list[str]:
    return sorted(lines, key=lambda line: _GRAVEST.index(line.partition(":")[0]))


def _longer(ready: Prepared) -> float:
    """Return a longer cutoff, in pixels."""
    return max(_PIXELS, 1.5 * (ready.asked.cutoff or 0.0) / max(ready.used.pixel))


def _of_the_pixel(fit: Fit, ready: Prepared) -> list[str]:
    pixel, cutoff = max(ready.used.pixel), ready.asked.cutoff
    if cutoff is not None and cutoff < _PIXELS * pixel:
        return [
            f"cutoff: {cutoff / pixel:.3g} pixels per wavelength; below {_PIXELS:g} the pixel determines eta "
            "and R, not the specimen; use a longer cutoff or finer pixels"
        ]
    more = fit.mean_squares["bend"] / fit.mean_squares["bend_1"] - 1
    if more > _RESOLVED:
        return [
            f"pixel: m4 by differences of fourth order is {100 * more:.2g} % above that by plain ones, so "
            f"the pixel affects m4, R and eta; use a cutoff of {_longer(ready):.3g} pixels or more"
        ]
    return []


def _of_the_heights(fit: Fit) -> Iterator[str]:
    skewness, error = fit.skewness
    if abs(skewness) > max(_SKEW, 3 * error):
        yield (
            f"skewness: {skewness:.2f} of the heights; spectral moments give the summits of Gaussian heights "
            "only; use the measured summits (--heights summits)"
        )
    if fit.numbers["alpha"].value < _ALPHA:
        yield f"alpha: {fit.numbers['alpha'].value:.3g} is below 1.5, which no isotropic Gaussian surface has"
    if fit.lay > _STREAKY:
        yield (
            f"lay: mean square slopes across and along it have the ratio {fit.lay:.3g}; the map is not "
            f"isotropic"
        )


def _of_the_summits(fit: Fit, used: str) -> Iterator[str]:
    if fit.agreement is not None and fit.agreement > _APART:
        yield (
            f"estimates: moments and counted summits differ by a factor of {fit.agreement:.3g}, unlike on an "
            "isotropic Gaussian map; use the measured summits (--heights summits)"
        )
    if fit.summits.size < _FEW:
        yield f"summits: only {fit.summits.size} found; use a larger map or a shorter cutoff"
    overlap = fit.estimates[used].overlap
    if used == "caps" and fit.visible is not None:
        sharp = visible(overlap).share
        lost = sharp - fit.visible.share
        if lost > _LOST:
            yield (
                f"blur: {100 * lost:.0f} % of such caps are lost, where a valley is nearer than a pixel or a "
                "third of a cutoff; use finer pixels and a shorter cutoff"
            )
        hidden = f" {100 * (1 - sharp):.0f} % of such caps are hidden under others,"
    else:
        hidden = " summits are as broad as they are far apart,"
    if overlap > CROWDED:
        yield f"overlap: eta R sigma = {overlap:.2g};{hidden} so asperities are not independent"


def profile_cautions(fit: ProfileFit, profiles: Sequence[Profile], cutoff: float | None) -> list[str]:
    """Warnings about the fit of these profiles, the most serious first."""
    return _gravest_first([*_of_profile_points(profiles, cutoff), *_of_profile_heights(fit)])


def _of_profile_points(profiles: Sequence[Profile], cutoff: float | None) -> Iterator[str]:
    filled, points = sum(p.filled for p in profiles), sum(p.heights.size for p in profiles)
    if filled:
        yield f"missing: {filled} of {points} heights lie on straight lines between their neighbours"
    spacing = max(p.spacing for p in profiles)
    if any(p.resampled for p in profiles):
        yield "x: the points were not evenly spaced; heights were interpolated"
    if cutoff is None:
        yield (
            "cutoff: none, so noise and the tip determine m4, R and eta; give ten points "
            f"({10 * spacing:.2g} m) or more, and at least the radius of the tip"
        )
    elif cutoff < _PIXELS * spacing:
        yield (
            f"cutoff: {cutoff / spacing:.3g} points per wavelength; below {_PIXELS:g} the spacing determines "
            "eta and R, not the specimen; use a longer cutoff"
        )


def _of_profile_heights(fit: ProfileFit) -> Iterator[str]:
    if abs(fit.roughness.sk) > max(_SKEW, 6 * fit.numbers["m0"].relative):
        yield (
            f"skewness: {fit.roughness.sk:.2f} of the heights; moments give the summits of Gaussian heights "
            "only; measure a map and count its summits"
        )
    counted, expected = fit.peaks
    if not 1 / _PEAKS < counted / expected < _PEAKS:
        yield (
            f"peaks: {counted:.3g} per metre counted, but {expected:.3g} expected from the moments of the "
            "profile; it is not Gaussian, or noise makes peaks: measure a map"
        )
    if fit.moments.alpha < _ALPHA:
        yield (
            f"alpha: {fit.moments.alpha:.3g} is below 1.5, which no isotropic Gaussian surface has; a turned "
            "or ground surface needs a map"
        )
    if (error := fit.numbers["sigma"].relative) >= _UNSURE:
        yield (
            f"waves: sigma is known to {100 * error:.2g} % only, because there are few of the longest waves; "
            "give longer profiles, or more of them"
        )
