"""Cautions about a fit: the map, its instrument, its pixel, heights and summits, one line each.

Most faults of an instrument put power into waves as short as a pixel, which is all of m4 and of the curvature
of summits. So they are measured on the map between its cutoffs, where they count, by second differences; of a
large map about a million of them are looked at. No row of an isotropic Gaussian map differs from its
neighbours more than waves that cross it slantwise do.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np
from scipy import fft, ndimage
from scipy.special import chdtrc

from analytic.arrays import Array
from mcgw.maps.estimates import CROWDED, visible
from mcgw.maps.fit import Fit
from mcgw.maps.form import form_left, gaussian_transmission
from mcgw.maps.preparation import Prepared, spike_heights
from mcgw.maps.profile_fit import ProfileFit
from mcgw.maps.topography import STEEPEST, Profile

_PIXELS = 10.0  # pixels that a cutoff wavelength should have
_RESOLVED = 0.05  # allowed ratio of two estimates of m4, reached at about ten pixels per wavelength
_SKEW, _ALPHA, _APART = 0.3, 1.5, 1.2
LIMITS = {"range": 1e-3, "rounding": 0.05, "rows": 0.05, "columns": 0.05}  # shares that are let pass

Found = tuple[Any, ...]  # a key of `WORDS`, and what its words take

# By first word, and case, the most serious first: errors from a wrong unit to a few per cent.
WORDS = {
    "slope": "{:.3g} is typical of this map; are heights or pixel in another unit?",
    "unit": "a pixel is {:g} m; was um or mm meant?",
    "maps": "mean square {} differ by a factor of {:.3g} between maps, more than their own errors allow; are "
    "they of one surface, with one pixel?",
    "spikes": "{} out of the map, the largest at x = {:.4g} m, y = {:.4g} m, {:.3g} m {} and narrower than "
    "five pixels; a single one can dominate R, eta and sigma: use --spikes remove, or crop the map",
    "lines": "offsets between {0}, as in a line scan, make {1:.2g} % of the curvature across them; level "
    "them with --lines {0}",
    "rounding": "heights are multiples of {:.3g} m; this rounding makes {:.2g} % of m4, and false summits; "
    "use --cutoff of {:.3g} pixels or more",
    "form": "{} of {:.3g} m from peak to valley remains, {:.0f} % of the variance; give --form {}",
    "range": "{:.2g} % of the points have the same extreme height, as if the range of the instrument cut off "
    "summits; measure with a larger range, or use --use moments, which is affected less",
    "cutoff": "{:.3g} pixels per wavelength; below {:g} the pixel determines eta and R, not the specimen; "
    "use a longer cutoff or finer pixels",
    "cutoff of a profile": "{:.3g} points per wavelength; below {:g} the spacing determines eta and R, not "
    "the specimen; use a longer cutoff",
    "cutoff left out": "none, so noise and the tip determine m4, R and eta; give ten points ({:.2g} m) or "
    "more, and at least the radius of the tip",
    "pixel": "m4 by differences of fourth order is {:.2g} % above that by plain ones, so the pixel affects "
    "m4, R and eta; use a cutoff of {:.3g} pixels or more",
    "blur": "{:.0f} % of such caps are lost, where a valley is nearer than a pixel or a third of a cutoff; "
    "use finer pixels and a shorter cutoff",
    "missing": "{} of {} heights lie on straight lines between their neighbours",
    "estimates": "moments and counted summits differ by a factor of {:.3g}, unlike on an isotropic Gaussian "
    "map; use the measured summits (--heights summits)",
    "lay": "mean square slopes across and along it have the ratio {:.3g}; the map is not isotropic",
    "skewness": "{:.2f} of the heights; spectral moments give the summits of Gaussian heights only; use the "
    "measured summits (--heights summits)",
    "skewness of a profile": "{:.2f} of the heights; moments give the summits of Gaussian heights only; "
    "measure a map and count its summits",
    "alpha": "{:.3g} is below 1.5, which no isotropic Gaussian surface has",
    "alpha of a profile": "{:.3g} is below 1.5, which no isotropic Gaussian surface has; a turned or ground "
    "surface needs a map",
    "peaks": "{:.3g} per metre counted, but {:.3g} expected from the moments of the profile; it is not "
    "Gaussian, or noise makes peaks: measure a map",
    "overlap": "eta R sigma = {:.2g};{} so asperities are not independent",
    "summits": "only {} found; use a larger map or a shorter cutoff",
    "waves": "the map has few of the longest waves, equivalent to {:.2g} independent heights: sigma may "
    "differ elsewhere by {:.2g} % or more; measure a longer map",
    "waves of a profile": "sigma is known to {:.2g} % only, because there are few of the longest waves; give "
    "longer profiles, or more of them",
    "x": "the points were not evenly spaced; heights were interpolated",
}
_ORDER = list(dict.fromkeys(key.partition(" ")[0] for key in WORDS))
# Those that maps of one surface have together.
_OF_ALL = ("blur", "estimates", "lay", "skewness", "alpha", "overlap", "summits", "waves")


def cautions(fit: Fit, ready: Prepared, use: str = "auto") -> list[str]:
    """Warnings about the fit of a map, and the estimate to `use`: a line each, the most serious first."""
    return _lines([*_of_the_map(fit, ready), *_of_the_fit(fit, use)])


def cautions_of_several(fit: Fit, fits: Sequence[Fit], use: str = "auto") -> list[str]:
    """Warnings about maps of one surface: what each of them has, and what they tell together."""
    own = [
        f"{line} ({name})"
        for name, each in zip(fit.maps, fits, strict=True)
        for line in each.cautions
        if line.partition(":")[0] not in _OF_ALL
    ]
    return _lines([*_disagreement(fits), *_few_waves(fit), *_of_the_fit(fit, use)], own)


def _disagreement(fits: Sequence[Fit]) -> Iterator[Found]:
    """Find what differs between the maps by more than its errors, once in 1000 by chance, and the factor."""
    words = {"m0": "heights", "m2": "slopes", "m4": "curvatures"}
    for name, word in words.items():
        each = [fit.numbers[name] for fit in fits]
        logs, certain = np.log([x.value for x in each]), 1 / np.array([x.relative for x in each]) ** 2
        chi_square = float(certain @ (logs - np.average(logs, weights=certain)) ** 2)
        if chdtrc(len(each) - 1, chi_square) < 1e-3 / len(words):
            yield "maps", word, math.exp(np.ptp(logs))


def profile_cautions(fit: ProfileFit, profiles: Sequence[Profile], cutoff: float | None) -> list[str]:
    """Warnings about the fit of these profiles, the most serious first."""
    return _lines(_of_profiles(fit, profiles, cutoff))


def _lines(found: Iterable[Found], own: Sequence[str] = ()) -> list[str]:
    """Return the words of what was found, with lines that are there already."""
    lines = [*own, *(f"{key.partition(' ')[0]}: {WORDS[key].format(*numbers)}" for key, *numbers in found)]
    return sorted(lines, key=lambda line: _ORDER.index(line.partition(":")[0]))


def _of_the_map(fit: Fit, ready: Prepared) -> Iterator[Found]:
    level, pixel, cutoff = ready.levelled, max(ready.used.pixel), ready.asked.cutoff
    if level.steepness > STEEPEST:
        yield "slope", level.steepness
    if max(level.pixel) > 1e-2:  # m
        yield "unit", max(level.pixel)
    above = spike_heights(level)
    if above.any():
        number = ndimage.label(above, structure=np.ones((3, 3)))[1]  # adjacent points count once
        j, i = np.unravel_index(int(np.argmax(np.abs(above))), above.shape)
        x, y = ((int(k) + 0.5) * p for k, p in zip((i, j), level.pixel, strict=True))
        places = "1 place stands" if number == 1 else f"{number} places stand"
        yield "spikes", places, x, y, abs(above[j, i]), "high" if above[j, i] > 0 else "deep"
    if left := form_left(level, fit.form):
        share, height, more = left
        kind = "a tilt or a curved form" if fit.form == "none" else "a curved form"
        yield "form", kind, height, 100 * share, more
    else:
        yield from _few_waves(fit)
    longer = max(_PIXELS, 1.5 * (cutoff or 0.0) / pixel)
    yield from faults(ready, longer)
    if cutoff is not None and cutoff < _PIXELS * pixel:
        yield "cutoff", cutoff / pixel, _PIXELS
    elif (excess := fit.mean_squares["bend"] / fit.mean_squares["bend_1"] - 1) > _RESOLVED:
        yield "pixel", 100 * excess, longer


def _few_waves(fit: Fit) -> Iterator[Found]:
    if fit.waves.independent < 50:  # waves for sigma to a tenth
        yield "waves", fit.waves.independent, 100 * fit.waves.spreads["sigma"].error


def _of_the_fit(fit: Fit, use: str) -> Iterator[Found]:
    skewness, error = fit.skewness
    if abs(skewness) > max(_SKEW, 3 * error):
        yield "skewness", skewness
    if fit.numbers["alpha"].value < _ALPHA:
        yield "alpha", fit.numbers["alpha"].value
    if fit.lay > 1.5:
        yield "lay", fit.lay
    if fit.agreement is not None and fit.agreement > _APART:
        yield "estimates", fit.agreement
    if fit.summits.size < 100:
        yield "summits", fit.summits.size
    used = use if use in fit.estimates else fit.best
    overlap, hidden = fit.estimates[used].overlap, " summits are as broad as they are far apart,"
    if used == "caps" and fit.visible is not None:
        sharp = visible(overlap).share
        if (lost := sharp - fit.visible.share) > 0.1:  # of the summits
            yield "blur", 100 * lost
        hidden = f" {100 * (1 - sharp):.0f} % of such caps are hidden under others,"
    if overlap > CROWDED:
        yield "overlap", overlap, hidden


def _of_profiles(fit: ProfileFit, profiles: Sequence[Profile], cutoff: float | None) -> Iterator[Found]:
    spacing = max(p.spacing for p in profiles)
    if filled := sum(p.filled for p in profiles):
        yield "missing", filled, sum(p.heights.size for p in profiles)
    if any(p.resampled for p in profiles):
        yield ("x",)
    if cutoff is None:
        yield "cutoff left out", 10 * spacing
    elif cutoff < _PIXELS * spacing:
        yield "cutoff of a profile", cutoff / spacing, _PIXELS
    if abs(fit.roughness.sk) > max(_SKEW, 6 * fit.numbers["m0"].relative):
        yield "skewness of a profile", fit.roughness.sk
    if not 1 / 1.2 < fit.peaks[0] / fit.peaks[1] < 1.2:
        yield "peaks", *fit.peaks
    if fit.moments.alpha < _ALPHA:
        yield "alpha of a profile", fit.moments.alpha
    if (error := fit.numbers["sigma"].relative) >= 0.2:
        yield "waves of a profile", 100 * error


def shares(ready: Prepared) -> dict[str, float]:
    """Return how much of each fault a map shows: a share of its points (range) or of its mean square bend."""
    return {
        "range": ready.recorded[1],
        "rounding": _rounding(ready),
        "rows": _offsets(ready, 0),
        "columns": _offsets(ready, 1),
    }


def faults(ready: Prepared, longer: float) -> Iterator[Found]:
    """Faults of the instrument beyond their limits; `longer` is a cutoff, in pixels."""
    percent = {name: 100 * share for name, share in shares(ready).items() if share > LIMITS[name]}
    if "range" in percent:
        yield "range", percent["range"]
    if "rounding" in percent:
        yield "rounding", ready.recorded[0], percent["rounding"], longer
    yield from (("lines", name, percent[name]) for name in ("rows", "columns") if name in percent)


def _rounding(ready: Prepared) -> float:
    """Share of the mean square bend, by plain differences, that rounding to steps adds."""
    (step, _), cutoff, z = ready.recorded, ready.asked.cutoff, ready.used.heights
    if not step:
        return 0.0
    # Of independent heights of variance 1, filtered: mean squares along x and y, and of second differences.
    k = math.pi * (np.arange(128) + 0.5) / 128
    left = [
        np.ones_like(k) if cutoff is None else gaussian_transmission(k / p, cutoff) ** 2
        for p in ready.used.pixel
    ]
    bends = [float(np.mean((2 - 2 * np.cos(k)) ** 2 * t)) for t in left]
    return max(
        step**2 / 12 * bend * float(np.mean(across)) / max(float(np.mean(_second(along) ** 2)), 1e-300)
        for along, bend, across in zip((z.T, z), bends, left[::-1], strict=True)
    )


def _offsets(ready: Prepared, axis: int) -> float:
    """Share of the mean square bend across rows (0) or columns (1) that is the same all along a line.

    Beyond twice what any of its neighbours in the spectrum has; nothing, if the means of lines do not
    alternate as independent offsets do: grooves along the lines are as wide as several of them.
    """
    means = np.diff(ready.levelled.heights.mean(axis=1 - axis), 2)
    if not float(means[1:] @ means[:-1]) < -0.4 * float(means @ means):  # -2/3 of independent offsets
        return 0.0
    bends = _second(np.moveaxis(ready.used.heights, axis, 0))
    power = np.mean(np.abs(fft.rfft(bends)) ** 2, axis=0)
    power[1:] *= 2
    return float((power[0] - power[1:9].max()) / power.sum())  # waves nearly as long along a line


def _second(z: Array) -> Array:
    """Second differences from row to row, around rows that are equally far apart."""
    j = np.arange(1, len(z) - 1, max(z.size // 2**20, 1))  # second differences
    return np.asarray(z[j - 1] - 2 * z[j] + z[j + 1])
