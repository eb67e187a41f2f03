"""From profiles of one isotropic surface to its summits, with their uncertainty.

A peak of a profile is not a summit of the surface: that usually lies beside the line. But both share their
moments: for an isotropic surface, m0, m2 and m4 of any profile are those of the surface (Nayak 1971), and if
heights are Gaussian they determine density, curvature and heights of its summits.

A profile sees a wave of the surface the longer, the more obliquely it crosses it. So the profile of a
filtered surface is not a filtered profile: filtered along itself, a profile keeps short waves that it
crosses slantwise, and its m2 and m4 are too large by tenths. What is the same in both is the
autocorrelation. Of an isotropic surface it depends on the distance alone, and to filter the surface with
exp(-a q^2), in power, is to take the mean of it under a plane Gaussian of variance 2a. For a wave k of the
profile that mean is Kummer's function M, with x^2 = a k^2 ::

    w0(k) = integral of cos(k r) exp(-r^2/(4a)) r/(2a) over r from 0 on = M(1, 1/2, -x^2).

Derivatives with respect to a bring q^2 down, so that

    w2 = -1/2 dw0/da = k^2 M(2, 3/2, -x^2),      w4 = 3/8 d^2w0/da^2 = k^4 M(3, 5/2, -x^2).

Sums of the profile's power with these weights are the areal moments m0, m2 and m4 of `mcgw.maps.fit`,
without bias. They are negative for short waves: those take back what the longer ones have too much.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.special import hyp1f1, stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.table import Column, Drawn, Table
from mcgw.maps.estimates import Estimate, Roughness, roughness_of
from mcgw.maps.steps import Form
from mcgw.maps.topography import Profile, filter_variance
from mcgw.maps.waves import Uncertain, log_derivatives, uncertain

_ORDERS = {"none": 0, "plane": 1, "quadratic": 2}
_SMOOTH = 3  # waves over which power is averaged


@dataclass(frozen=True, repr=False)
class ProfileFit(Drawn):
    """Surface parameters from profiles, if the surface is isotropic and its heights are Gaussian.

    Parameters
    ----------
    moments : SpectralMoments
        Moments of the surface, filtered as `mcgw.fit` filters a map.
    numbers : dict of str to Uncertain
        m0, m2, m4, alpha, eta, radius and sigma; errors are widened so that the value plus or minus two of
        them is a 95 % interval.
    roughness : Roughness
        Roughness of the filtered profiles without their form.
    peaks : (float, float)
        Peaks per length of these filtered profiles, 1/m: counted, and from their own moments,
        sqrt(m4/m2)/(2 pi).
    lengths : tuple of float
        Lengths of the profiles, m.
    form : {"none", "plane", "quadratic"}
        What was taken off.
    covariance : ndarray
        Of the logarithms of m0, m2 and m4, by their waves, shape (3, 3), to a factor.
    cautions : tuple of str, optional
        Why not to trust it.
    """

    moments: SpectralMoments
    numbers: dict[str, Uncertain]
    roughness: Roughness
    peaks: tuple[float, float]
    lengths: tuple[float, ...]
    form: Form
    covariance: Array
    cautions: tuple[str, ...] = ()

    @property
    def area(self) -> float:
        """Square of the mean length, m^2, since a profile has no area."""
        return (sum(self.lengths) / len(self.lengths)) ** 2

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The only estimate, ``moments``, under the same name as in the fit of a map."""
        return {"moments": Estimate(*(self.numbers[name] for name in ("eta", "radius", "sigma")))}

    def sheet(self) -> Table:
        """Each number with its 95 % interval, and the first of the cautions."""
        counted, expected = self.peaks
        facts = [
            ("profiles", self.roughness.text("P")),
            ("peaks", f"{counted:.4g} per metre; {expected:.4g} expected from the moments"),
            ("summits", f"{self.moments.mean_height:.3g} m above the mean plane; sigma is about that height"),
            ("model", "isotropic surface, Gaussian heights (Nayak, McCool), after the areal filter"),
        ]
        facts += [("caution", line) for line in self.cautions[:1]]
        title = f"Fit of {len(self.lengths)} profile(s), {sum(self.lengths):.4g} m together"
        return self.table().under(title, facts)

    def table(self) -> Table:
        """Return a row for each number, with its 95 % interval."""
        units = {"m0": "m^2", "m4": "1/m^2", "eta": "1/m^2", "radius": "m", "sigma": "m"}
        value, _, low, high = zip(*self.numbers.values(), strict=True)
        return Table((
            Column("name", list(self.numbers), " "),
            Column("unit", [units.get(name, "1") for name in self.numbers]),
            Column("value", value, form=".4g"),
            Column("low_95", low, "95 %", form=".3g"),
            Column("high_95", high, form=".3g", between=" to "),
        ))  # fmt: skip


def fit_profiles(profiles: Sequence[Profile], *, cutoff: float | None, form: Form = "plane") -> ProfileFit:
    """Estimate moments and summits of the surface that profiles were taken from, far enough apart.

    Longer profiles count more. Standard errors follow from the power of the waves seen, as for maps
    (`mcgw.maps.waves`), with the profiles independent of each other; or from what stretches of them differ,
    if that is more. The form is that of a line: its mean, a straight line or a parabola.
    """
    if form not in _ORDERS:
        raise ValueError(f"form = {form!r}: a profile has plane (a line), quadratic (a parabola) or none")
    if not profiles:
        raise ValueError("give at least one profile")
    plain = [p.without_form(_ORDERS[form]) for p in profiles]
    pairs = zip(plain, profiles, strict=True)
    if not any(np.ptp(p.heights) > 1e-12 * np.abs(q.heights).max() for p, q in pairs):
        raise ValueError("the profile is flat, without roughness")
    filtered = plain if cutoff is None else [p.smoothed(cutoff) for p in plain]
    pieces = math.ceil(16 / len(profiles))
    shortest = min(p.heights.size for p in profiles)
    if shortest < 4 * pieces:
        raise ValueError(f"{shortest} points: too few for {pieces} stretches; give a longer profile")
    seen = [_waves(p, cutoff, _ORDERS[form] + 1, pieces) for p in plain]
    shares = np.array([p.length for p in plain]) / sum(p.length for p in plain)
    stretches, waves = (
        np.concatenate([share * part for share, part in zip(shares, each, strict=True)], axis=1)
        for each in zip(*seen, strict=True)
    )
    values = stretches.sum(axis=1) / pieces
    if not np.all(values > 0):
        raise ValueError(
            f"m0, m2, m4 = {', '.join(f'{v:.3g}' for v in values)}: not all are > 0; the profile is too "
            "short for this cutoff, or the surface is not isotropic; give a longer one"
        )
    moments = SpectralMoments(*values.tolist())
    if moments.alpha < 0.9:  # below it summit heights have no variance
        raise ValueError(
            f"m0 m4/m2^2 = {moments.alpha:.3g}, impossible for an isotropic surface (1.5 or more): the "
            "surface has a lay, or the profile is too short"
        )
    waves /= values[:, None]
    stretches *= len(plain) / values[:, None]
    return ProfileFit(
        moments,
        {
            name: uncertain(value := getattr(moments, name), value * _error(by @ stretches, by @ waves))
            for name, by in log_derivatives(moments).items()
        },
        roughness_of(np.concatenate([p.heights for p in filtered])),
        _peaks(filtered),
        tuple(p.length for p in profiles),
        form,
        waves @ waves.T,
    )


def _error(stretches: Array, waves: Array) -> float:
    """Of the logarithm of a number, by its stretches and its waves; two of them hold 95 % (Student's t)."""
    squares = waves**2
    by_waves = math.sqrt(float(squares.sum()) / (1 + 1 / _SMOOTH))
    freedom = max(float(squares.sum() ** 2 / (squares**2).sum()) / 2, 2.0)  # neighbours share power
    by_stretches = float(stretches.std(ddof=1)) / math.sqrt(stretches.size)
    both = (by_waves, freedom), (by_stretches, stretches.size - 1)
    return max(error * float(stdtrit(n, 0.975)) / 2 for error, n in both)


def _peaks(profiles: list[Profile]) -> tuple[float, float]:
    """Peaks per length of filtered profiles, counted and by Rice's formula."""
    steps = [(np.diff(p.heights) / p.spacing, p.spacing) for p in profiles]
    counted = sum(np.count_nonzero((slope[:-1] > 0) & (slope[1:] <= 0)) for slope, _ in steps)
    length = sum((slope.size - 1) * spacing for slope, spacing in steps)
    slopes = sum(float(np.sum(slope[:-1] ** 2)) for slope, _ in steps)
    bends = sum(float(np.sum((np.diff(slope) / spacing) ** 2)) for slope, spacing in steps)
    return counted / length, math.sqrt(bends / slopes) / (2 * math.pi)


# --- sums over the waves of a profile ---


def _areal_weights(wave_numbers: Array, cutoff: float) -> Array:
    """Weights of waves in m0, m2 and m4, the latter two over ``k^2`` and ``k^4``, shape (3, waves)."""
    order = np.array([[1.0], [2.0], [3.0]])
    return np.asarray(hyp1f1(order, order - 0.5, -filter_variance(cutoff) * wave_numbers**2))


def _waves(profile: Profile, cutoff: float | None, terms: int, pieces: int) -> tuple[Array, Array]:
    """Return m0, m2 and m4 by each stretch of a profile without form, and what each wave has in their means.

    A moment is the sum, over distances along the line, of the mean product of two heights (slopes, second
    differences) times a weight. No end has to fit the other, and no window bends it. Each of the `terms` of
    the form took a wave with it, of the longest there are, which m0 gets back.
    """
    h, z = profile.spacing, profile.heights
    # exp(-16) of the weights lies beyond 1.5 cutoffs; with a short cutoff they decay slowly
    reach = min(4 if cutoff is None else max(math.ceil(1.5 * cutoff / h), 24), z.size // 2)  # points
    weights = fft.irfft(_gains(fft.rfftfreq(16 * reach), h, cutoff), 16 * reach)[:, : reach + 1]
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
    taken = float(np.mean(power[1:5] * of_waves[0, 1:5])) / 2  # a wave has two terms
    stretches[0] += terms * taken
    smoothed = np.convolve(power, np.full(_SMOOTH, 1 / _SMOOTH), mode="same")
    return stretches, np.asarray(of_waves * smoothed)


def _gains(frequencies: Array, spacing: float, cutoff: float | None) -> Array:
    """Weights of waves over the squares of what plain differences see of them."""
    phases = 2 * math.pi * frequencies
    if cutoff is None:  # what differences of the fourth order see, as a map is looked at
        c = np.cos(phases)
        return np.array([np.ones_like(c), (np.cos(phases / 2) * (4 - c) / 3) ** 2, ((7 - c) / 6) ** 2])
    weights = _areal_weights(phases / spacing, cutoff)
    return np.asarray(weights * np.sinc(frequencies) ** np.array([[0], [-2], [-4]]))


def _stretches(u: Array, weights: Array, pieces: int) -> Array:
    """Return the sums over distances of weight times mean product, from pairs that begin on each stretch."""
    n, reach = u.size, weights.size - 1
    size = fft.next_fast_len(n + reach, real=True)
    one_side = weights * n / (n - np.arange(reach + 1))  # by the number of pairs
    even = np.concatenate([one_side, np.zeros(size - 2 * reach - 1), one_side[:0:-1]])
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
