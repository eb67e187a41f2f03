"""Profiles of isotropic surfaces: the surface's own moments and summits, with errors that hold."""

import math
import re

import matplotlib.pyplot as plt
import mpmath
import numpy as np
import pytest

import mcgw
from analytic import SpectralMoments
from mcgw.cli import main
from mcgw.maps.areal_weights import areal_weights, filter_variance, stencil_weights
from mcgw.maps.form import gaussian_transmission
from mcgw.maps.profile import Profile, smooth_profile, without_profile_form
from mcgw.maps.profile_fit import fit_profiles
from mcgw.maps.profile_waves import waves_of_profile
from mcgw.maps.spectrum import Spectrum, gaussian_map

UM = 1e-6
NAMES = ("m0", "m2", "m4", "alpha", "eta", "radius", "sigma")


def by_quadrature(x, order):
    """m0, m2 or m4 of a wave k = 1 of a profile, with a = x^2: derivatives of an integral over distances."""
    with mpmath.workdps(20):

        def w0(a):
            return mpmath.quad(
                lambda r: mpmath.cos(r) * mpmath.exp(-r * r / (4 * a)) * r / (2 * a),
                mpmath.linspace(0, 20 * mpmath.sqrt(a), 20),
            )

        factor = {0: 1, 1: mpmath.mpf(-1) / 2, 2: mpmath.mpf(3) / 8}[order]
        return float(
            factor * (mpmath.diff(w0, mpmath.mpf(x) ** 2, order) if order else w0(mpmath.mpf(x) ** 2))
        )


@pytest.mark.parametrize("x", [0.019, 0.021, 1.0, 3.0])
def test_weights_are_means_of_the_autocorrelation_under_a_gaussian(x):
    cutoff = 1.0
    k = x / math.sqrt(filter_variance(cutoff))
    found = areal_weights(np.array([k]), cutoff)[:, 0]
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


def test_a_profile_of_a_few_waves_has_their_weighted_power():
    """Whole waves on the profile: products of neighbours meet every phase but for the margins."""
    n, h, cutoff = 200_000, 0.5 * UM, 6 * UM
    x = (np.arange(n) + 0.5) * h
    waves = [(1e-6, 700 * UM, 0.3), (2e-7, 31 * UM, 1.0), (3e-8, 7 * UM, 2.0), (2e-8, 3 * UM, 0.1)]
    z = sum(a * np.cos(2 * math.pi * x / length + p) for a, length, p in waves)
    k = np.array([2 * math.pi / length for _, length, _ in waves])
    power = np.array([a * a / 2 for a, _, _ in waves])
    found = waves_of_profile(Profile(z, h), cutoff=cutoff, terms=0, pieces=8)
    expected = (areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])) @ power
    np.testing.assert_allclose(found.moments, expected, rtol=1.2e-3)  # 1/(2 pi) of one of the 143 longest
    np.testing.assert_allclose(found.pieces.mean(axis=1), found.moments, rtol=1e-12)
    assert found.power.sum() == pytest.approx(power.sum(), rel=1e-2)


def test_without_a_cutoff_moments_are_mean_squares_of_stencils():
    z = np.random.default_rng(2).normal(size=4000)
    found = waves_of_profile(Profile(z, 0.5), cutoff=None, terms=0, pieces=4).moments
    slope = np.convolve(z, np.array([-1, 8, 0, -8, 1]) / 6, mode="valid")
    bend = np.convolve(z, np.array([-1, 16, -30, 16, -1]) / 3, mode="valid")
    expected = [np.mean(z * z), np.mean(slope**2), np.mean(bend**2)]
    np.testing.assert_allclose(found, expected, rtol=5e-3)  # four points at each end
    phases = np.array([0.1, 1.0, 3.0])
    sees = np.abs(
        [np.sum(np.array([1, -8, 0, 8, -1]) / 12 * np.exp(1j * p * np.arange(-2, 3))) for p in phases]
    )
    np.testing.assert_allclose(stencil_weights(phases)[1] * phases**2, sees**2, rtol=1e-12)


def truth(spectrum, cutoff, points):
    """Moments of the surface after the areal filter: sums over the waves of the map that is drawn."""
    q = 2 * np.pi * np.fft.fftfreq(points, UM)
    both = np.hypot(q, q[:, None])
    power = spectrum.density(both)
    power *= spectrum.rms**2 / power.sum()
    left = power if cutoff is None else power * gaussian_transmission(both, cutoff) ** 2
    return SpectralMoments(*(float((left * q**k).sum()) for k in (0, 2, 4)))


def cut(spectrum, points, maps, seed):
    """Profiles along x and y, as far apart as the longest wave, from maps twice as long; pixel 1 um."""
    rng = np.random.default_rng(seed)
    apart = round(spectrum.long / UM)
    for _ in range(maps):
        z = gaussian_map(spectrum, (2 * points, 2 * points), (UM, UM), rng).heights
        for lines in (z, z.T):
            for line in lines[::apart]:
                yield Profile(line[:points].copy(), UM)
                yield Profile(line[points:].copy(), UM)


CASES = {  # spectrum, cutoff, profiles together: 10 of the longest waves on a profile, or 4
    "alpha 12": (Spectrum(UM, 100 * UM, 8 * UM, 0.8), 10 * UM, 1),
    "alpha 12, four": (Spectrum(UM, 100 * UM, 8 * UM, 0.8), 10 * UM, 4),
    "noisy": (Spectrum(UM, 100 * UM, 4 * UM, -0.5), 16 * UM, 1),
    "as measured": (Spectrum(UM, 100 * UM, 16 * UM, 0.5), None, 1),
    "few long waves": (Spectrum(UM, 250 * UM, 12 * UM, 0.8), 16 * UM, 3),
}


@pytest.mark.parametrize("case", CASES)
def test_intervals_hold_on_profiles_cut_from_maps(case):
    """Truth is the spectrum. z is the error of the logarithm over the one stated.

    5 % may lie beyond two errors; more than 10 % do so by chance in 1 of 500 tests of 200 fits (binomial), in
    1 of 100 of 120. The spread of z is 1 to a twentieth if errors are right, less where they are careful.
    """
    spectrum, cutoff, together = CASES[case]
    expected = truth(spectrum, cutoff, 2000)
    number = 120 if case == "few long waves" else 200
    per_map = 4 * math.ceil(2000 * UM / spectrum.long)
    profiles = list(cut(spectrum, 1000, math.ceil(number * together / per_map), seed=4))
    np.random.default_rng(5).shuffle(profiles)
    fits = [
        fit_profiles(profiles[i : i + together], cutoff=cutoff)
        for i in range(0, len(profiles) - together + 1, together)
    ][:number]
    assert len(fits) == number
    for name in NAMES:
        z = [math.log(getattr(f.moments, name) / getattr(expected, name)) / f.errors[name] for f in fits]
        assert np.mean(np.abs(z) > 2) <= 0.1, name
        assert 0.6 < np.std(z) < 1.25, name
        assert abs(np.mean(z)) < 0.35, name  # logarithms of few waves: minus half a variance
    if case == "noisy":  # the companion: filtered along the line instead
        wrong = [np.mean((np.diff(smooth_profile(p, cutoff).heights, 2) / UM**2) ** 2) for p in profiles[:40]]
        outside = [
            abs(math.log(w / expected.m4)) > 2 * f.errors["m4"] for w, f in zip(wrong, fits, strict=False)
        ]
        assert np.mean(outside) > 0.5


def test_a_profile_and_its_map_agree():
    """Map and profiles of one surface, one cutoff: summits within the errors of both."""
    drawn = gaussian_map(Spectrum(UM, 60 * UM, 6 * UM), (1024, 1024), (UM, UM), np.random.default_rng(8))
    of_map = mcgw.fit(drawn, cutoff="10 um", form="none")
    of_profiles = mcgw.fit([Profile(z, UM) for z in drawn.heights[::64]], cutoff="10 um")
    for name in ("eta", "radius", "sigma"):
        (a, da), (b, db) = (getattr(f.estimates["moments"], name)[:2] for f in (of_map, of_profiles))
        assert abs(math.log(a / b)) < 3 * math.hypot(da / a, db / b)
        low, high = of_profiles.interval(name)
        assert low < b < high
        assert math.sqrt(low * high) == pytest.approx(b, rel=1e-12)


def test_several_profiles_are_averaged_and_know_more():
    profiles = list(cut(Spectrum(UM, 100 * UM, 8 * UM), 1000, 1, seed=6))[:9]
    together, alone = (fit_profiles(p, cutoff=10 * UM) for p in (profiles, profiles[:1]))
    each = [fit_profiles([p], cutoff=10 * UM) for p in profiles]
    assert together.moments.m4 == pytest.approx(np.mean([f.moments.m4 for f in each]), rel=1e-3)
    assert 0.2 < together.errors["m4"] / alone.errors["m4"] < 0.5  # a third, as one knows one's own error
    longer = Profile(np.concatenate([p.heights for p in profiles[:3]]), UM)
    mixed = fit_profiles([longer, profiles[5]], cutoff=10 * UM)
    weighted = (3 * fit_profiles([longer], cutoff=10 * UM).moments.m2 + each[5].moments.m2) / 4
    assert mixed.moments.m2 == pytest.approx(weighted, rel=1e-12)


def test_peaks_of_a_profile_follow_rice_and_are_no_summits():
    """A Gaussian surface has 2 pi/(3 sqrt 3) = 1.21 times as many summits as its profile's peaks squared."""
    drawn = gaussian_map(Spectrum(UM, 60 * UM, 12 * UM), (1024, 1024), (UM, UM), np.random.default_rng(3))
    fit = fit_profiles([Profile(z, UM) for z in drawn.heights[::40]], cutoff=None)
    counted, expected = fit.peaks
    assert counted == pytest.approx(expected, rel=0.03)
    assert fit.moments.eta / counted**2 == pytest.approx(2 * math.pi / (3 * math.sqrt(3)), rel=0.06)


def test_roughness_is_that_of_what_is_left():
    drawn = gaussian_map(Spectrum(UM, 40 * UM, 8 * UM), (512, 512), (UM, UM), np.random.default_rng(3))
    of_map = mcgw.fit(drawn, cutoff="10 um", form="none")
    assert of_map.roughness.q == pytest.approx(math.sqrt(of_map.moments.m0), rel=1e-12)
    assert of_map.roughness.sk == pytest.approx(of_map.skewness[0], rel=1e-9)
    assert of_map.roughness.a / of_map.roughness.q == pytest.approx(math.sqrt(2 / math.pi), rel=0.01)
    z = np.sin(np.arange(6280) / 10) * UM  # 100 waves
    of_profile = fit_profiles([Profile(z, UM)], cutoff=None, form="none").roughness
    assert of_profile.a == pytest.approx(2 / math.pi * UM, rel=1e-3)
    assert of_profile.q == pytest.approx(UM / math.sqrt(2), rel=1e-3)
    assert of_profile.sk == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize("form", ["none", "plane", "quadratic"])
def test_form_of_a_profile_is_taken_off(form):
    t = np.linspace(0, 1, 500)
    shape = np.full(500, 3.0) + (0 if form == "none" else 2 * t) + (t**2 if form == "quadratic" else 0)
    assert np.abs(without_profile_form(Profile(shape, 1.0), form).heights).max() < 1e-13
    assert np.abs(without_profile_form(Profile(shape + t**3, 1.0), form).heights).max() > 0.01


@pytest.mark.parametrize(
    ("heights", "cutoff", "told"),
    [
        (np.ones(900), 10 * UM, "flat"),
        (np.random.default_rng(1).normal(size=900) * UM, 800 * UM, "leaves nothing"),
        (np.random.default_rng(1).normal(size=40) * UM, None, "too few for 16 stretches"),
        (np.sin(np.arange(9000) / 10) * UM, 37 * UM, "no isotropic surface has"),
        (np.random.default_rng(3).normal(size=100) * UM, 40 * UM, "too short"),
    ],
)
def test_profiles_that_cannot_be_fitted_are_refused(heights, cutoff, told):
    with pytest.raises(ValueError, match=told):
        fit_profiles([Profile(heights, UM)], cutoff=cutoff)
    with pytest.raises(ValueError, match="no profile"):
        fit_profiles([], cutoff=cutoff)


def cautions(profiles, cutoff):
    return [line.partition(":")[0] for line in mcgw.fit(profiles, cutoff=cutoff).cautions]


def test_profiles_that_should_be_doubted_are():
    (good, other, *_) = cut(Spectrum(UM, 60 * UM, 8 * UM), 2000, 1, seed=6)
    assert cautions([good, other], 10 * UM) == []
    assert cautions([good, other], None) == ["cutoff"]
    assert "cutoff" in cautions([good], 4 * UM)
    bent = Profile(np.exp(good.heights / UM) * UM, UM)
    assert "skewness" in cautions([bent], 10 * UM)
    assert "missing" in cautions([Profile(good.heights, UM, filled=3)], 10 * UM)
    assert "x" in cautions([Profile(good.heights, UM, resampled=True)], 10 * UM)
    assert "waves" in cautions([Profile(good.heights[:300], UM)], 10 * UM)
    steps = np.round(good.heights / UM * 2) / 2 * UM + 1e-9 * np.random.default_rng(1).normal(size=2000)
    assert "peaks" in cautions([Profile(steps, UM)], None)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("profiles")
    for k, p in enumerate(list(cut(Spectrum(UM, 100 * UM, 8 * UM), 1000, 1, seed=6))[:2]):
        lines = [f"{i / 1000:.4f};{z * 1e6:.6f}".replace(".", ",") for i, z in enumerate(p.heights)]
        text = "\n".join(["Taster 2 um, Nr. 7", "x [mm];z [µm]", *lines])
        (folder / f"p{k}.txt").write_text(text, encoding="utf-8")
    return folder


def test_the_command_tells_a_profile_by_its_shape(files, tmp_path, capsys):
    paths = [str(files / f"p{k}.txt") for k in range(2)]
    out = tmp_path / "scene.toml"
    assert main(["fit", *paths, "--cutoff", "10um", "--E-star", "70 GPa", "-o", str(out)]) == 0
    told = capsys.readouterr().out
    assert "2 profiles, 0.002 m together" in told
    assert "Pa = " in told
    assert "Ra, Rq, Rsk" in told
    found = mcgw.fit(paths, cutoff="10 um")
    scene = mcgw.load_scene(out)
    assert scene.surface.radius == found.moments.radius
    assert scene.surface.sigma == found.moments.sigma
    assert scene.surface.nominal_area == pytest.approx(1e-6, rel=1e-9)
    assert mcgw.fitted_scene(found, E_star="70 GPa").surface == scene.surface
    assert mcgw.simulate(scene, n_surfaces=2, separations=[2.0]).load.shape == (2, 1)
    assert "95 %" in repr(found)
    assert len(repr(found).splitlines()) <= 12


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--summits", "s.csv"], "--summits s.csv: a profile shows no summits"),
        (["--heights", "table"], "profiles show no summits"),
        (["--pixel", "1um"], "tells x in mm itself; leave --pixel out"),
        (["--unit", "nm"], "heights are in .m as the file says, not in nm"),
    ],
)
def test_what_a_profile_cannot_be_asked(words, told, files, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["fit", str(files / "p0.txt"), "--cutoff", "10um", *words, "-o", "s.toml"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert re.search(told, error), error


def test_two_maps_are_one_too_many(tmp_path, capsys):
    np.save(tmp_path / "m.npy", np.zeros((9, 9)))
    words = ["fit", str(tmp_path / "m.npy"), str(tmp_path / "n.npy"), "--cutoff", "none"]
    assert main([*words, "-o", str(tmp_path / "s.toml")]) == 2
    assert "give one map, or profiles" in capsys.readouterr().err


def test_the_picture_shows_heights_and_summits(files):
    found = mcgw.fit(files / "p0.txt", cutoff="10 um")
    axes = found.plot()
    heights, summits = (line.get_data() for line in axes.get_lines())
    for (z, density), mean, spread in (
        (heights, 0.0, math.sqrt(found.moments.m0)),
        (summits, found.moments.mean_height, found.moments.sigma),
    ):
        whole = np.trapezoid(density, z)
        assert whole == pytest.approx(1, abs=1e-3)
        assert np.trapezoid(z * density, z) == pytest.approx(mean, abs=1e-2 * spread)
        assert np.trapezoid((z - mean) ** 2 * density, z) == pytest.approx(spread**2, rel=1e-2)
    plt.close("all")
