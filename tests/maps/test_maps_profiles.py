"""Profiles of isotropic surfaces: the surface's own moments and summits, with errors that hold."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import filter_variance, gaussian_transmission, profile_cautions
from oracles.profile_weights import by_quadrature
from scipy.stats import t as t_law

import mcgw
from analytic import Nayak, SpectralMoments
from mcgw.cli import main
from mcgw.maps import Profile, Spectrum, gaussian_map
from mcgw.maps.profile import profile_at, smooth_profile, without_profile_form
from mcgw.maps.profile_fit import _checked, fit_profiles
from mcgw.maps.profile_waves import areal_weights, waves_of_profile

UM = 1e-6
NAMES = ("m0", "m2", "m4", "alpha", "eta", "radius", "sigma")


@pytest.mark.parametrize("x", [0.019, 0.021, 1.0, 3.0])
def test_weights_are_means_of_the_autocorrelation_under_a_gaussian(x):
    k = x / math.sqrt(filter_variance(1.0))
    found = areal_weights(np.array([k]), 1.0)[:, 0]
    for order in range(3):
        assert found[order] == pytest.approx(by_quadrature(x, order), rel=1e-8, abs=1e-9)


@pytest.mark.parametrize("q", [0.5, 3.0, 8.0])
def test_waves_of_one_length_in_all_directions_give_the_moments_of_the_filtered_surface(q):
    """A profile crosses them at every angle and sees q cos(angle). What the areal filter leaves is known."""
    cutoff, n = 1.0, 4000
    angle = (np.arange(n) + 0.5) * math.pi / n
    k = np.abs(q * np.cos(angle))  # the trapezium over a period: all digits
    weights = areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])
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
    (some, waves), (none, _) = (
        waves_of_profile(Profile(z, h), cutoff=cutoff, terms=t, pieces=8) for t in (3, 0)
    )
    k = 2 * math.pi * np.fft.rfftfreq(n) / h
    weights = areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])
    shared = [(a + b + c) / 3 for a, b, c in zip([0, *seen], seen, [*seen[1:], 0], strict=False)]
    np.testing.assert_allclose(waves, weights * shared, rtol=1e-9, atol=1e-12 * np.abs(waves).max())
    added = 3 * (seen[1:5] * weights[0, 1:5]).mean() / 2
    np.testing.assert_allclose(some - none, [[added] * 8, [0] * 8, [0] * 8], rtol=1e-6, atol=1e-30)


def test_a_surface_has_an_alpha_of_nine_tenths_or_more():
    """Below it summits have no spread."""
    assert _checked(np.array([1.0, 1.0, 0.905])).m4 == 0.905
    with pytest.raises(ValueError, match=r"m0 m4/m2\^2 = 0.895, impossible for an isotropic"):
        _checked(np.array([1.0, 1.0, 0.895]))


def test_without_a_cutoff_moments_are_mean_squares_of_stencils():
    z = np.random.default_rng(2).normal(size=4000)
    found = waves_of_profile(Profile(z, 0.5), cutoff=None, terms=0, pieces=4)[0].mean(axis=1)
    slope = np.convolve(z, np.array([-1, 8, 0, -8, 1]) / 6, mode="valid")
    bend = np.convolve(z, np.array([-1, 16, -30, 16, -1]) / 3, mode="valid")
    expected = [np.mean(z * z), np.mean(slope**2), np.mean(bend**2)]
    np.testing.assert_allclose(found, expected, rtol=5e-3)  # four points at each end


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
    plain = [without_profile_form(p, "plane") for p in profiles]
    fit = fit_profiles(profiles, cutoff=10 * UM)
    filtered = np.concatenate([smooth_profile(p, 10 * UM).heights for p in plain])
    assert (fit.roughness.q, fit.area) == (pytest.approx(filtered.std()), pytest.approx((0.7e-3) ** 2))
    shares = 900 / 1400, 500 / 1400
    seen = [waves_of_profile(p, cutoff=10 * UM, terms=2, pieces=8) for p in plain]  # 16 stretches together
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
            2 * share * x
            for share, (of_it, _) in zip(shares, seen, strict=True)
            for x in exponents / values @ of_it
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
        z = [
            math.log(getattr(f.moments, name) / getattr(expected, name)) / f.numbers[name].relative
            for f in fits
        ]
        assert np.mean(np.abs(z) > 2) <= 0.11, name
        assert 0.6 < np.std(z) < 1.25, name
        assert abs(np.mean(z)) < 0.4, name  # logarithms of few waves: minus half a variance
    if case == "noisy":  # the companion: filtered along the line instead
        wrong = [np.mean((np.diff(smooth_profile(p, cutoff).heights, 2) / UM**2) ** 2) for p in profiles[:40]]
        outside = [
            abs(math.log(w / expected.m4)) > 2 * f.numbers["m4"].relative
            for w, f in zip(wrong, fits, strict=False)
        ]
        assert np.mean(outside) > 0.5


def test_profiles_that_cannot_be_fitted_are_refused():
    """Four points for each of sixteen stretches together, of the shortest profile, are enough."""
    noise = np.random.default_rng(1).normal(size=900) * UM
    (one,) = list(cut(Spectrum(UM, 20 * UM, 8 * UM), 400))[:1]
    for several in ([64], [32, 400]):
        fit_profiles([Profile(one.heights[:n], UM) for n in several], cutoff=None)
    for profiles, cutoff, told in (
        ([], None, "at least one profile"),
        ([np.ones(900)], 10 * UM, "flat"),
        ([noise], 800 * UM, "leaves nothing"),
        ([noise[:63]], None, "63 points: too few for 16 stretches"),
        ([noise[:31], noise[:400]], None, "31 points: too few for 8 stretches"),
        ([np.sin(np.arange(9000) / 10) * UM], 37 * UM, "impossible for an isotropic surface"),
        (
            [np.random.default_rng(3).normal(size=100) * UM],
            40 * UM,
            "not all are > 0; the profile is too short",
        ),
    ):
        with pytest.raises(ValueError, match=told):
            fit_profiles([Profile(z, UM) for z in profiles], cutoff=cutoff)


def known(fit, name, relative):
    number = fit.numbers[name]
    return replace(fit, numbers={**fit.numbers, name: number._replace(error=relative * number.value)})


# Of each caution: how far it goes without a word, and what is changed to be there.
LIMITS = {
    "skewness": (0.3, lambda f, x: replace(known(f, "m0", 0.01), roughness=replace(f.roughness, sk=-x))),
    "skewness, little known": (
        0.6, lambda f, x: replace(known(f, "m0", 0.1), roughness=replace(f.roughness, sk=x)),
    ),
    "peaks": (1.2, lambda f, x: replace(f, peaks=(x, 1.0))),
    "peaks, too few": (1.2, lambda f, x: replace(f, peaks=(1.0, x))),
    "alpha": (1 / 1.5, lambda f, x: replace(f, moments=SpectralMoments(1.0, 1.0, 1 / x))),
    "waves": (0.2, lambda f, x: known(f, "sigma", x)),
}  # fmt: skip


@pytest.mark.parametrize("name", LIMITS)
def test_a_caution_begins_at_its_limit(name):
    """Half a per cent below it, nothing is said."""
    profiles = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 2000))[:2]
    fit = fit_profiles(profiles, cutoff=10 * UM)
    limit, change = LIMITS[name]
    for factor, there in ((0.995, False), (1.005, True)):
        lines = profile_cautions(change(fit, factor * limit), profiles, 10 * UM)
        assert [line.partition(":")[0] for line in lines] == [name.partition(",")[0]] * there


def test_cautions_of_points():
    """Of all profiles; ten of the coarser spacings to a cutoff are enough."""
    one, two = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 2000))[:2]
    fit = fit_profiles([one, two], cutoff=10 * UM)
    gaps = [replace(one, filled=3), replace(two, filled=4, resampled=True, spacing=2 * UM)]
    missing, uneven = profile_cautions(fit, gaps, 20 * UM)
    assert missing.startswith("missing: 7 of 4000 ")
    assert uneven.startswith("x: ")
    assert profile_cautions(fit, gaps, 19.9 * UM)[0].startswith("cutoff: 9.95 points")
    assert "ten points (1e-05 m) or more" in profile_cautions(fit, [one, two], None)[0]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("profiles")
    for k, p in enumerate(list(cut(Spectrum(UM, 100 * UM, 8 * UM), 1000))[:2]):
        lines = [f"{i / 1000:.4f};{z * 1e6:.6f}".replace(".", ",") for i, z in enumerate(p.heights)]
        text = "\n".join(["Taster 2 um, Nr. 7", "x [mm];z [µm]", *lines])
        (folder / f"p{k}.txt").write_text(text, encoding="utf-8")
    return folder


def test_the_command_tells_a_profile_by_its_shape(files, tmp_path, capsys):
    paths = [str(files / f"p{k}.txt") for k in range(2)]
    out = tmp_path / "scene.toml"
    assert main(["fit", *paths, "--cutoff", "10um", "--E-star", "70 GPa", "-o", str(out), "-v"]) == 0
    told = capsys.readouterr().out
    assert "2 profile(s), 0.002 m together" in told
    found = mcgw.fit(paths, cutoff="10 um")
    assert set(found.table().text().splitlines()) <= set(told.splitlines())
    scene = mcgw.load_scene(out)
    assert scene.surface.radius == pytest.approx(found.moments.radius, rel=5e-4)
    assert scene.surface.sigma == pytest.approx(found.moments.sigma, rel=5e-4)
    assert scene.surface.nominal_area == pytest.approx(1e-6, rel=1e-9)
    assert mcgw.fitted_scene(found, E_star="70 GPa").surface.sigma == found.moments.sigma
    assert mcgw.fitted_scene(found, heights="nayak").heights == Nayak(found.moments.alpha)
    with pytest.raises(ValueError, match="a profile has plane"):
        fit_profiles([Profile(np.arange(99.0) % 7, UM)], cutoff=None, form="cubic")


@pytest.mark.parametrize(("asked", "told"), [
    *(({name: value}, f"--{name.replace('_', '-')}: is for maps") for name, value in (
        ("long_cutoff", 1e-3), ("missing", "fill"), ("spikes", "remove"), ("lines", "rows"), ("trim", 3),
    )),
    ({"pixel": 1e-6}, "gives x in mm; leave --pixel out"),
    ({"unit": "nm"}, "heights are in .m as the file says, not in nm"),
])  # fmt: skip
def test_what_a_profile_cannot_be_asked(asked, told, files):
    with pytest.raises(ValueError, match=told):
        mcgw.fit(files / "p0.txt", cutoff="10um", **asked)


def test_the_limits_of_places_and_gaps():
    """A tenth of a step beside the grid, a tenth of the heights; at either end nothing is filled."""
    x, z = np.arange(40.0), np.arange(40.0) ** 2
    line = np.where((x == 0) | (x == 39), np.nan, 3 * x + 1)  # straight lines do not change it
    np.testing.assert_array_equal(profile_at(-x, line).heights, 3 * x[38:0:-1] + 1)
    for shift, resampled in ((0.099, False), (0.101, True)):
        moved = x.copy()
        moved[20] += shift
        found = profile_at(moved, z)
        assert found.resampled == resampled
        assert (found.heights[20] == 400.0) == (not resampled)
    holed = z.copy()
    holed[3:11:2] = np.nan
    found = profile_at(x, holed, "um")
    assert (found.filled, found.assumed_unit, found.heights[5]) == (4, "um", 26.0)
    holed[11] = np.nan
    assert profile_at(x[:8], z[:8].astype(int)).length == 8.0
    doubled = np.array([0, 1, 2, 3, 4, 5, 5, 6, 7.0])
    for call, told in (
        (lambda: profile_at(x, np.full(40, np.nan)), "no heights"),
        (lambda: profile_at(x, holed), "5 of the 40 heights are missing"),
        (lambda: profile_at(x[:7], z[:7]), "^7 points: a profile has 8 or more"),
        (lambda: profile_at(np.zeros(1), np.zeros(1)), "1 points: a profile has"),
        (lambda: profile_at(doubled, np.zeros(9)), "x = 5 m is followed by 5 m; give x in increasing or "),
        (lambda: Profile(np.zeros((3, 9)), 1.0), "not 2 dimensions"),
        (lambda: Profile(z[:7], 1.0), "8 or more"),
        (lambda: Profile(np.append(z, np.nan), 1.0), "are missing"),
        (lambda: Profile(z, 0.0), "give a length > 0 m"),
    ):
        with pytest.raises(ValueError, match=told):
            call()


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


@pytest.mark.parametrize("size", [27, 28])
def test_a_filtered_profile_is_a_sum_over_its_window(size):
    """Literal weights to one cutoff; eight points are left, or none."""
    z, cutoff = np.random.default_rng(1).normal(size=size), 9.5
    if size == 27:
        with pytest.raises(ValueError, match="leaves nothing of a profile of 27 m"):
            smooth_profile(Profile(z, 1.0), cutoff)
        return
    t = np.arange(-10, 11.0)
    w = np.exp(-math.pi * (t / (math.sqrt(math.log(2) / math.pi) * cutoff)) ** 2)
    found = smooth_profile(Profile(z, 1.0, filled=2), cutoff)
    np.testing.assert_allclose(found.heights, np.convolve(z, w / w.sum(), mode="valid"), rtol=1e-10)
    assert found.filled == 2


def test_peaks_are_counted_between_their_neighbours():
    """Of equal neighbours the first is one; Rice's formula takes mean squares of the same profiles."""
    z = np.tile([0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 3.0, -1.0], 40) * UM
    long, short = Profile(z, UM), Profile(z[:160], 2 * UM)
    counted, expected = fit_profiles([long, short], cutoff=None, form="none").peaks
    slopes = bends = peaks = length = 0.0
    for p in (long, short):
        u, h = (p.heights - p.heights.mean()).tolist(), p.spacing
        for k in range(1, len(u) - 1):
            peaks += u[k] > u[k - 1] and u[k] >= u[k + 1]
            slopes += ((u[k] - u[k - 1]) / h) ** 2
            bends += ((u[k + 1] - 2 * u[k] + u[k - 1]) / h**2) ** 2
            length += h
    assert counted == pytest.approx(peaks / length, rel=1e-12)
    assert expected == pytest.approx(math.sqrt(bends / slopes) / (2 * math.pi), rel=1e-9)
