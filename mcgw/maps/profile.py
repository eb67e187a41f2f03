"""Profiles: heights along a line, as a stylus measures them; and moments of the surface from their waves.

A profile sees a wave of the surface the longer, the more obliquely it crosses it. So the profile of a
filtered surface is not a filtered profile: filtered along itself, a profile keeps short waves that it
crosses slantwise, and its m2 and m4 are too large by tenths. What is the same in both is the
autocorrelation. Of an isotropic surface it depends on the distance alone, and to filter the surface with
exp(-a q^2), in power, is to take the mean of it under a plane Gaussian of variance 2a. For a wave k of the
profile that mean is

    w0(k) = integral of cos(k r) exp(-r^2/(4a)) r/(2a) over r from 0 on = F'(x),  x = k sqrt(a),

with Dawson's integral F, for which F' = 1 - 2 x F. Derivatives with respect to a bring q^2 down, so that

    w2 = -1/2 dw0/da = k^2 (F + x F')/(2 x),      w4 = 3/8 d^2w0/da^2 = k^4 3/32 (x F''' - F'')/x^3.

Sums of the profile's power with these weights are the areal moments m0, m2 and m4 of `mcgw.maps.fit`,
without bias. They are negative for short waves: those take back what the longer ones have too much.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Legendre
from scipy import fft
from scipy.ndimage import gaussian_filter1d
from scipy.special import dawsn

from analytic.arrays import Array
from mcgw.maps.form import filter_variance
from mcgw.maps.steps import Form
from mcgw.maps.topography import STEEPEST

_EVEN = 0.1  # share of a step that places may be off an even grid
_LEAST = 8  # points
_WIDEST, _LONGEST = 1e-2, 0.2  # m, longest spacing and profile of a stylus
PROFILE_ORDERS = {"none": 0, "plane": 1, "quadratic": 2}
_REACH = 1.5  # range of the weights, in cutoffs: exp(-16) beyond
_LEAST_REACH = 24  # points: with a short cutoff weights decay slowly
_STENCIL = 4  # points, without a cutoff
_FINE = 16  # points of a spectrum per weight
SMOOTH = 3  # waves over which power is averaged
_LOW = slice(1, 5)  # waves that show what the form removed


@dataclass(frozen=True)
class Profile:
    """Heights on an even grid along a line.

    Parameters
    ----------
    heights : ndarray
        m, shape (points,); none is missing.
    spacing : float
        Between two points, m.
    assumed_unit : str, optional
        Unit assumed for the lengths if the file does not state it; empty if it is known.
    filled : int, optional
        Number of missing heights that were filled along straight lines.
    resampled : bool, optional
        Whether the places were uneven, so that heights were interpolated.

    Raises
    ------
    ValueError
        If there are fewer than 8 points, one is missing, or the spacing is no length.
    """

    heights: Array
    spacing: float
    assumed_unit: str = ""
    filled: int = 0
    resampled: bool = False

    def __post_init__(self) -> None:
        if self.heights.ndim != 1:
            raise ValueError(f"a profile has one row of heights, not {self.heights.ndim} dimensions")
        if self.heights.size < _LEAST:
            raise ValueError(f"{self.heights.size} points: a profile has {_LEAST} or more")
        if not np.all(np.isfinite(self.heights)):
            raise ValueError("points of the profile are missing (nan); fill them first")
        if not (math.isfinite(self.spacing) and self.spacing > 0):
            raise ValueError(f"spacing = {self.spacing!r}: give a length > 0 m")

    @property
    def length(self) -> float:
        """Length along the line, m, including the whole spacing of the outer points."""
        return self.heights.size * self.spacing

    @property
    def steepness(self) -> float:
        """Typical slope, from the median difference between neighbours."""
        return float(np.median(np.abs(np.diff(self.heights)))) / self.spacing

    @property
    def doubtful(self) -> str:
        """Why the assumed unit of the lengths is implausible; empty if it is plausible."""
        if not self.assumed_unit:
            return ""
        if self.steepness > STEEPEST:
            return f"the typical slope is {self.steepness:.3g}"
        if self.spacing > _WIDEST:
            return f"the points are {self.spacing:g} m apart"
        return f"it is {self.length:.3g} m long" if self.length > _LONGEST else ""


def profile_at(places: Array, heights: Array, assumed_unit: str = "") -> Profile:
    """Return a profile of heights at places along a line, on an even grid of as many points.

    Places a tenth of a step beside an even grid are taken as rounded. Otherwise, and where heights are
    missing (nan), those on the grid are interpolated along straight lines.

    Parameters
    ----------
    places, heights : ndarray
        m, shape (points,); places rise or fall.
    assumed_unit : str, optional
        As in `Profile`.

    Raises
    ------
    ValueError
        If places do not rise or fall, or too many heights are missing.
    """
    known = np.isfinite(heights)
    if not known.any():
        raise ValueError("the profile has no heights")
    first, last = int(np.argmax(known)), int(known.size - np.argmax(known[::-1]))
    places, heights, known = places[first:last], heights[first:last], known[first:last]
    missing = int(np.count_nonzero(~known))
    if missing > 0.1 * known.size:  # share of all points
        raise ValueError(f"{missing} of the {known.size} heights are missing; measure the profile again")
    if places.size > 1 and places[-1] < places[0]:
        places, heights, known = places[::-1], heights[::-1], known[::-1]
    if places.size < _LEAST:
        raise ValueError(f"{places.size} points: a profile has {_LEAST} or more")
    steps = np.diff(places)
    if not np.all(steps > 0):
        k = int(np.argmin(steps))
        raise ValueError(
            f"x = {places[k]:g} m is followed by {places[k + 1]:g} m; give x in increasing or decreasing "
            f"order"
        )
    even = np.linspace(places[0], places[-1], places.size)
    spacing = float(even[1] - even[0])
    resampled = bool(np.abs(places - even).max() > _EVEN * spacing)
    if resampled or missing:
        heights = np.interp(even if resampled else places, places[known], heights[known])
    return Profile(np.array(heights, dtype=np.float64), spacing, assumed_unit, missing, resampled)


def without_profile_form(profile: Profile, form: Form) -> Profile:
    """Subtract the line, or the parabola, of least squares; the mean in any case."""
    t = np.linspace(-1, 1, profile.heights.size)
    left = profile.heights - Legendre.fit(t, profile.heights, PROFILE_ORDERS[form])(t)
    return replace(profile, heights=left)


def smooth_profile(profile: Profile, cutoff: float) -> Profile:
    """Apply the Gaussian filter of ISO 16610-21 and leave off the margins of one cutoff it cannot reach.

    Raises
    ------
    ValueError
        If nothing would be left.
    """
    radius = math.ceil(cutoff / profile.spacing)
    if 2 * radius + _LEAST > profile.heights.size:
        raise ValueError(
            f"cutoff = {cutoff:g} m: leaves nothing of a profile of {profile.length:g} m after removing "
            "margins of one cutoff"
        )
    width = math.sqrt(filter_variance(cutoff)) / profile.spacing
    smoothed = gaussian_filter1d(profile.heights, width, radius=radius)
    return replace(profile, heights=smoothed[radius : smoothed.size - radius])


def areal_weights(wave_numbers: Array, cutoff: float) -> Array:
    """Weights of waves of a profile in m0, m2 and m4, the latter two over ``k^2`` and ``k^4``.

    Parameters
    ----------
    wave_numbers : ndarray
        k, 1/m, shape (waves,).
    cutoff : float
        Of the areal Gaussian filter (ISO 16610-61), m.

    Returns
    -------
    ndarray
        Shape (3, waves).
    """
    x = wave_numbers * math.sqrt(filter_variance(cutoff))
    few = x < 0.02  # below it two terms of the series suffice for 1e-9
    y = np.where(few, 1.0, x)
    f = dawsn(y)
    first = 1 - 2 * y * f
    second = -2 * f - 2 * y * first
    third = -4 * first - 2 * y * second
    return np.array(
        [
            np.where(few, 1 - 2 * x**2 + 4 / 3 * x**4, first),
            np.where(few, 1 - 4 / 3 * x**2 + 4 / 5 * x**4, (f + y * first) / (2 * y)),
            np.where(few, 1 - 6 / 5 * x**2 + 24 / 35 * x**4, 3 / 32 * (y * third - second) / y**3),
        ]
    )


def waves_of_profile(
    profile: Profile, *, cutoff: float | None, terms: int, pieces: int
) -> tuple[Array, Array]:
    """Return the moments of an isotropic surface from stretches of a profile, and the parts of its waves.

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

    Returns
    -------
    moments : ndarray
        m0, m2 and m4 by each stretch, shape (3, pieces); their means are those by the profile.
    waves : ndarray
        What each wave has in these means, its power averaged over neighbours, shape (3, waves).
    """
    h, z = profile.spacing, profile.heights
    reach = _STENCIL if cutoff is None else max(math.ceil(_REACH * cutoff / h), _LEAST_REACH)
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
    smoothed = np.convolve(power, np.full(SMOOTH, 1 / SMOOTH), mode="same")
    return stretches, np.asarray(of_waves * smoothed)


def _gains(frequencies: Array, spacing: float, cutoff: float | None) -> Array:
    """Weights of waves over the squares of what plain differences see of them."""
    phases = 2 * math.pi * frequencies
    if cutoff is None:  # what differences of the fourth order see, as a map is looked at
        c = np.cos(phases)
        return np.array([np.ones_like(c), (np.cos(phases / 2) * (4 - c) / 3) ** 2, ((7 - c) / 6) ** 2])
    weights = areal_weights(phases / spacing, cutoff)
    return np.asarray(weights * np.sinc(frequencies) ** np.array([[0], [-2], [-4]]))


def _stretches(u: Array, weights: Array, pieces: int) -> Array:
    """Return the sums over distances of weight times mean product, from pairs that begin on each stretch."""
    n, reach = u.size, weights.size - 1
    size = fft.next_fast_len(n + reach, real=True)
    even = np.zeros(size)
    even[: reach + 1] = weights * n / (n - np.arange(reach + 1))  # number of pairs
    even[size - reach :] = even[1 : reach + 1][::-1]
    products = u * fft.irfft(fft.rfft(u, size) * fft.rfft(even), size)[:n]
    edges = np.linspace(0, n, pieces + 1).round().astype(np.int64)
    return np.asarray(np.add.reduceat(products, edges[:-1]) * pieces / n)


def _power(z: Array) -> Array:
    """Of the waves of ``rfft``, without the mean; ends are faded out, so that they fit."""
    fade = max(round(0.1 * z.size), 1)  # share of a profile faded out at its ends
    window = np.ones(z.size)
    window[:fade] = np.sin(math.pi / 2 * (np.arange(fade) + 0.5) / fade) ** 2
    window[-fade:] = window[:fade][::-1]
    window /= math.sqrt(np.mean(window**2))
    power = 2 * np.abs(fft.rfft(z * window) / z.size) ** 2
    power[0] = 0.0
    return np.asarray(power)
