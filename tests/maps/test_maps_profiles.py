"""Profiles of isotropic surfaces: the surface's own moments and summits, with errors that hold."""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from oracles.inside import filter_variance, gaussian_transmission, profile_cautions
from scipy.stats import t as t_law

import mcgw
from analytic import SpectralMoments
from mcgw.maps import Profile, Spectrum, gaussian_map
from mcgw.maps.heights_files import _profile_at
from mcgw.maps.profile_fit import _areal_weights, _waves, fit_profiles

UM = 1e-6
NAMES = ("m0", "m2", "m4", "alpha", "eta", "radius", "sigma")


def by_quadrature(x, order):
    """m0, m2 or m4 of a wave k = 1 of a profile, with a = x^2: derivatives under an integral."""
    with mpmath.workdps(25):
        a = mpmath.mpf(x) ** 2

        def under(r):  # cos(r) r exp(-r^2/(4a))/(2a), differentiated so often by a
            first = r * r / (4 * a * a) - 1 / a
            factor = (1, first, first**2 - r * r / (2 * a**3) + 1 / a**2)[order]
            return mpmath.cos(r) * mpmath.exp(-r * r / (4 * a)) * r / (2 * a) * factor

        whole = mpmath.quad(under, mpmath.linspace(0, 18 * mpmath.sqrt(a), 5))
        return float((1, mpmath.mpf(-1) / 2, mpmath.mpf(3) / 8)[order] * whole)


@pytest.mark.parametrize("x", [0.019, 0.021, 3.0])
def test_weights_are_means_of_the_autocorrelation_under_a_gaussian(x):
    k = x / math.sqrt(filter_variance(1.0))
    found = _areal_weights(np.array([k]), 1.0)[:, 0]
    for order in range(3):
        assert found[order] == pytest.approx(by_quadrature(x, order), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("q", [3.0, 8.0])
def test_waves_of_one_length_in_all_directions_give_the_moments_of_the_filtered_surface(q):
    """A profile crosses them at every angle and sees q cos(angle). What the areal filter leaves is known."""
    cutoff, n = 1.0, 4000
    angle = (np.arange(n) + 0.5) * math.pi / n
    k = np.abs(q * np.cos(angle))  # the trapezium over a period: all digits
    weights = _areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])
    left = float(gaussian_transmission(np.array(q), cutoff)) ** 2
    expected = np.array([1, q**2 / 2, 3 * q**4 / 8]) * left
    np.testing.assert_allclose(weights.mean(axis=1), expected, rtol=1e-12, atol=1e-13 * q**4)
    if q == 8.0:  # filtered along the line, the same waves have too much power
        plain = gaussian_transmission(k, cutoff) ** 2 * k ** np.array([[0], [2], [4]])
        assert np.all(plain.mean(axis=1) > 1.5 * expected)


def test_parts_of_the_waves_of_a_profile_literally():
    """A tenth at each end is faded by a squared sine; three neighbours share power.

    A wave that the form took is as four of the longest.
    """
    n, h, cutoff = 173, 0.5 * UM, 6 * UM
    z = np.random.default_rng(4).normal(size=n)
    window = np.ones(n)
    for k in range(17):
        window[k] = window[-1 - k] = math.sin(math.pi / 2 * (k + 0.5) / 17) ** 2
    seen = np.abs(np.fft.rfft(z * window / math.sqrt((window**2).mean()))) ** 2 * 2 / n**2
    seen[0] = 0
    (some, waves), (none, _) = (_waves(Profile(z, h), cutoff, t, 8) for t in (3, 0))
    k = 2 * math.pi * np.fft.rfftfreq(n) / h
    weights = _areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])
    shared = [(a + b + c) / 3 for a, b, c in zip([0, *seen], seen, [*seen[1:], 0], strict=False)]
    np.testing.assert_allclose(waves, weights * shared, rtol=1e-9, atol=1e-12 * np.abs(waves).max())
    added = 3 * (seen[1:5] * weights[0, 1:5]).mean() / 2
    np.testing.assert_allclose(some - none, [[added] * 8, [0] * 8, [0] * 8], rtol=1e-6, atol=1e-30)


def truth(spectrum, cutoff, shape):
    """Moments of the surface after the areal filter: sums over the waves of the map that is drawn."""
    qy, qx = (2 * np.pi * np.fft.fftfreq(n, UM) for n in shape)
    both = np.hypot(qx, qy[:, None])
    power = spectrum.density(both)
    power *= spectrum.rms**2 / power.sum()
    left = power if cutoff is None else power * gaussian_transmission(both, cutoff) ** 2
    return SpectralMoments(*(float((left * q**k).sum()) for q, k in ((qx, 0), (qx, 2), (qx, 4))))


def cut(spectrum, points, maps=1, seed=6, apart=2):
    """Profiles as far apart as the longest wave, two on a line, from maps of `apart` lines; pixel 1 um."""
    rng = np.random.default_rng(seed)
    step = round(spectrum.long / UM)
    for _ in range(maps):
        z = gaussian_map(spectrum, (apart * step, 2 * points), (UM, UM), rng).heights
        for line in z[::step]:
            yield Profile(line[:points].copy(), UM)
            yield Profile(line[points:].copy(), UM)


def test_errors_of_a_fit_literally():
    """Of profiles of unequal length: power of the waves seen, and what stretches differ, the larger one."""
    profiles = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 900))[:2]
    profiles[1] = Profile(profiles[1].heights[:500], UM)
    plain = [p.without_form(1) for p in profiles]
    fit = fit_profiles(profiles, cutoff=10 * UM)
    filtered = np.concatenate([p.smoothed(10 * UM).heights for p in plain])
    assert (fit.roughness.q, fit.area) == (pytest.approx(filtered.std()), pytest.approx((0.7e-3) ** 2))
    shares = 900 / 1400, 500 / 1400
    seen = [_waves(p, 10 * UM, 2, 8) for p in plain]  # 16 stretches together
    values = sum(share * stretches.mean(axis=1) for share, (stretches, _) in zip(shares, seen, strict=True))
    assert (fit.moments.m0, fit.moments.m2, fit.moments.m4) == pytest.approx(tuple(values), rel=1e-12)
    parts = [share * waves / values[:, None] for share, (_, waves) in zip(shares, seen, strict=True)]
    np.testing.assert_allclose(fit.covariance, sum(part @ part.T for part in parts), rtol=1e-9)
    m0 = 0.8968057562340189 * fit.moments.m2**2 / fit.moments.m4 / fit.moments.sigma**2  # m0/sigma^2 - 1
    by_logarithms = {
        "m0": (1, 0, 0), "m2": (0, 1, 0), "m4": (0, 0, 1), "alpha": (1, -2, 1), "eta": (0, -1, 1),
        "radius": (0, 0, -0.5), "sigma": ((1 + m0) / 2, -m0, m0 / 2),
    }  # fmt: skip
    for name, exponents in by_logarithms.items():
        squares = [x * x for part in parts for x in exponents @ part]
        stretches = [
            2 * share * (exponents / values) @ of_it for share, (of_it, _) in zip(shares, seen, strict=True)
        ]
        freedom = max(sum(squares) ** 2 / sum(q * q for q in squares) / 2, 2)
        by_waves = math.sqrt(sum(squares) / (1 + 1 / 3)) * t_law.ppf(0.975, freedom) / 2
        by_stretches = np.std(stretches, ddof=1) / 4 * t_law.ppf(0.975, 15) / 2
        assert fit.numbers[name].relative == pytest.approx(max(by_waves, by_stretches), rel=1e-9), name
        assert fit.numbers[name].value == getattr(fit.moments, name)


CASES = {  # spectrum, cutoff, profiles together: 10 of the longest waves on a profile, or 4
    "alpha 12, four": (Spectrum(UM, 100 * UM, 8 * UM, 0.8), 10 * UM, 4),
    "noisy": (Spectrum(UM, 100 * UM, 4 * UM, -0.5), 16 * UM, 1),
    "as measured": (Spectrum(UM, 100 * UM, 16 * UM, 0.5), None, 1),
    "few long waves": (Spectrum(UM, 250 * UM, 12 * UM, 0.8), 16 * UM, 1),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_intervals_hold_on_profiles_cut_from_maps(case):
    """Truth is the spectrum. z is the error of the logarithm over the one stated.

    5 % may lie beyond two errors; more than 11 % do so by chance in 1 of 100 tests of 120 fits (binomial).
    The spread of z is 1 to a fifteenth if errors are right, less where they are careful.
    """
    spectrum, cutoff, together = CASES[case]
    lines = round(2000 * UM / spectrum.long)
    expected = truth(spectrum, cutoff, (2000, 2000))
    profiles = list(cut(spectrum, 1000, math.ceil(120 * together / (2 * lines)), seed=4, apart=lines))
    np.random.default_rng(5).shuffle(profiles)
    fits = [fit_profiles(profiles[i * together : (i + 1) * together], cutoff=cutoff) for i in range(120)]
    for name in NAMES:
        told = [(getattr(f.moments, name) / getattr(expected, name), f.numbers[name].relative) for f in fits]
        z = [math.log(ratio) / error for ratio, error in told]
        assert np.mean(np.abs(z) > 2) <= 0.11, name
        assert 0.6 < np.std(z) < 1.25, name
        assert abs(np.mean(z)) < 0.4, name  # logarithms of few waves: minus half a variance
    if case == "noisy":  # the companion: filtered along the line instead
        wrong = [np.mean((np.diff(p.smoothed(cutoff).heights, 2) / UM**2) ** 2) for p in profiles[:40]]
        errors = [2 * f.numbers["m4"].relative for f in fits[:40]]
        assert np.mean(np.abs(np.log(np.array(wrong) / expected.m4)) > errors) > 0.5


NOISE = np.random.default_rng(1).normal(size=900) * UM


def test_four_points_for_each_of_sixteen_stretches_are_enough():
    """Together, of the shortest profile."""
    (one,) = list(cut(Spectrum(UM, 20 * UM, 8 * UM), 400))[:1]
    for several in ([64], [32, 400]):
        fit_profiles([Profile(one.heights[:n], UM) for n in several], cutoff=None)


def known(fit, name, relative):
    number = fit.numbers[name]
    return replace(fit, numbers={**fit.numbers, name: number._replace(error=relative * number.value)})


# Of each caution: how far it goes without a word, and what is changed to be there.
LIMITS = {
    "skewness": (0.3, lambda f, x: replace(known(f, "m0", 0.01), roughness=f.roughness._replace(sk=-x))),
    "skewness, known": (0.6, lambda f, x: replace(known(f, "m0", 0.1), roughness=f.roughness._replace(sk=x))),
    "peaks": (1.2, lambda f, x: replace(f, peaks=(x, 1.0))),
    "peaks, too few": (1.2, lambda f, x: replace(f, peaks=(1.0, x))),
    "alpha": (1 / 1.5, lambda f, x: replace(f, moments=SpectralMoments(1.0, 1.0, 1 / x))),
    "waves": (0.2, lambda f, x: known(f, "sigma", x)),
}  # fmt: skip


@pytest.fixture(scope="module")
def two():
    """Two profiles of one surface, and their fit."""
    profiles = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 2000))[:2]
    return profiles, fit_profiles(profiles, cutoff=10 * UM)


@pytest.mark.parametrize("name", LIMITS)
def test_a_caution_begins_at_its_limit(name, two):
    """Half a per cent below it, nothing is said."""
    (profiles, fit), (limit, change) = two, LIMITS[name]
    for factor, there in ((0.995, False), (1.005, True)):
        lines = profile_cautions(change(fit, factor * limit), profiles, 10 * UM)
        assert [line.partition(":")[0] for line in lines] == [name.partition(",")[0]] * there


def test_cautions_of_points(two):
    """Of all profiles; ten of the coarser spacings to a cutoff are enough."""
    (one, other), fit = two
    gaps = [replace(one, filled=3), replace(other, filled=4, resampled=True, spacing=2 * UM)]
    missing, uneven = profile_cautions(fit, gaps, 20 * UM)
    assert missing.startswith("missing: 7 of 4000 ")
    assert uneven.startswith("x: ")
    assert profile_cautions(fit, gaps, 19.9 * UM)[0].startswith("cutoff: 9.95 points")
    assert "ten points (1e-05 m) or more" in profile_cautions(fit, two[0], None)[0]


X, SQUARES = np.arange(40.0), np.arange(40.0) ** 2


def test_the_limits_of_places_and_gaps():
    """A tenth of a step beside the grid, a tenth of the heights; at either end nothing is filled."""
    line = np.where((X == 0) | (X > 37), np.nan, 3 * X + 1)  # straight lines do not change it
    np.testing.assert_array_equal(_profile_at(-X, line).heights, 3 * X[37:0:-1] + 1)
    for shift, resampled in ((0.099, False), (0.101, True)):
        found = _profile_at(X + shift * (X == 20), SQUARES)
        assert found.resampled == (found.heights[20] != 400.0) == resampled
    found = _profile_at(X, np.where((X > 2) & (X < 11) & (X % 2 == 1), np.nan, SQUARES), "um")
    assert (found.filled, found.assumed_unit, found.heights[5]) == (4, "um", 26.0)
    assert _profile_at(X[:8], SQUARES[:8].astype(int)).length == 8.0


def fitted(cutoff, *heights):
    return fit_profiles([Profile(z, UM) for z in heights], cutoff=cutoff)


REFUSED = [
    (lambda: _profile_at(X, np.full(40, np.nan)), "no heights"),
    (lambda: _profile_at(X, np.where((X > 2) & (X < 8), np.nan, X)), "5 of the 40 heights are missing"),
    (lambda: _profile_at(X[:7], X[:7]), "^7 points: a profile has 8 or more"),
    (lambda: _profile_at(X[:1], X[:1]), "1 points: a profile has"),
    (lambda: _profile_at(np.sort([*X[:8], 5]), X[:9]), "x = 5 m is followed by 5 m; give x in increas"),
    (lambda: Profile(np.zeros((3, 9)), 1.0), "not 2 dimensions"),
    (lambda: Profile(np.append(X, np.nan), 1.0), "are missing"),
    (lambda: Profile(X, 0.0), "give a length > 0 m"),
    (lambda: fitted(None), "at least one profile"),
    (lambda: fitted(10 * UM, np.ones(900)), "flat"),
    (lambda: fitted(800 * UM, NOISE), "leaves nothing"),
    (lambda: fitted(None, NOISE[:63]), "63 points: too few for 16 stretches"),
    (lambda: fitted(None, NOISE[:31], NOISE[:400]), "31 points: too few for 8 stretches"),
    (lambda: fitted(37 * UM, np.sin(np.arange(9000) / 10) * UM), "impossible for an isotropic surface"),
    (lambda: fitted(40 * UM, NOISE[300:400]), "not all are > 0; the profile is too short"),
    (lambda: mcgw.fit(Profile(NOISE, UM), cutoff="10um", form="cubic"), "a profile has plane"),
    *((lambda key=key, value=value: mcgw.fit(Profile(NOISE, UM), cutoff="10um", **{key: value}),
       f"--{key.replace('_', '-')}: is for maps") for key, value in (
        ("long_cutoff", 1e-3), ("missing", "fill"), ("spikes", "remove"), ("lines", "rows"), ("trim", 3))),
]  # fmt: skip


@pytest.mark.parametrize(("made", "told"), REFUSED, ids=[told for _, told in REFUSED])
def test_what_makes_no_profile_and_no_fit_is_refused(made, told):
    with pytest.raises(ValueError, match=told):
        made()


@pytest.mark.parametrize(("points", "height", "spacing", "said"), [
    (40, 9.99e-3, 1e-3, ""), (40, 10.01e-3, 1e-3, "the typical slope is 10"),
    (8, 1e-4, 0.99e-2, ""), (8, 1e-4, 1.01e-2, "the points are 0.0101 m apart"),
    (40, 1e-4, 0.199 / 40, ""), (40, 1e-4, 0.201 / 40, "it is 0.201 m long"),
])  # fmt: skip
def test_an_assumed_unit_is_doubted_from_a_limit_on(points, height, spacing, said):
    """Slopes of ten, points a centimetre apart, 20 cm; of a unit that is known, nothing is."""
    z = height * (np.arange(points) % 2)
    assert Profile(z, spacing, "m").doubtful == said
    assert Profile(z, spacing).doubtful == ""


def test_a_filtered_profile_is_a_sum_over_its_window():
    """Literal weights to one cutoff; eight points are left, or none."""
    z, cutoff = np.random.default_rng(1).normal(size=28), 9.5
    t = np.arange(-10, 11.0)
    w = np.exp(-math.pi * (t / (math.sqrt(math.log(2) / math.pi) * cutoff)) ** 2)
    found = Profile(z, 1.0, filled=2).smoothed(cutoff)
    np.testing.assert_allclose(found.heights, np.convolve(z, w / w.sum(), mode="valid"), rtol=1e-10)
    assert found.filled == 2
    with pytest.raises(ValueError, match="leaves nothing of a profile of 27 m"):
        Profile(z[:27], 1.0).smoothed(cutoff)
