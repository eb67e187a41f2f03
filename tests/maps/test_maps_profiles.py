"""Profiles of isotropic surfaces: the surface's own moments and summits, with errors that hold."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import filter_variance, gaussian_transmission, holds_profile, profile_cautions
from oracles.profile_weights import by_quadrature
from scipy.stats import t as t_law

import mcgw
from analytic import Nayak, SpectralMoments
from mcgw.cli import main
from mcgw.maps import Profile, Spectrum, gaussian_map, read_profile
from mcgw.maps.profile import profile_at, smooth_profile, without_profile_form
from mcgw.maps.profile_fit import _checked, fit_profiles
from mcgw.maps.profile_waves import areal_weights, stencil_weights, waves_of_profile

UM = 1e-6
SMOOTH = 3  # neighbouring waves whose power is averaged
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


@pytest.mark.parametrize("n", [57, 200])
def test_power_of_a_profile_is_that_of_its_faded_waves(n):
    """A tenth at each end is faded by a squared sine; a wave that the form took is as four of the longest."""
    z, h, cutoff = np.random.default_rng(4).normal(size=n), 0.5 * UM, 6 * UM
    fade = round(n / 10)
    window = np.ones(n)
    for k in range(fade):
        window[k] = window[-1 - k] = math.sin(math.pi / 2 * (k + 0.5) / fade) ** 2
    seen = np.abs(np.fft.rfft(z * window / math.sqrt((window**2).mean()))) ** 2 * 2 / n**2
    seen[0] = 0
    some, none = (waves_of_profile(Profile(z, h), cutoff=cutoff, terms=t, pieces=8) for t in (3, 0))
    np.testing.assert_allclose(some.power, seen, rtol=1e-10)
    k = 2 * math.pi * np.fft.rfftfreq(n) / h
    weights = areal_weights(k, cutoff) * k ** np.array([[0], [2], [4]])
    np.testing.assert_allclose(some.weights, weights, rtol=1e-9, atol=1e-12 * np.abs(weights).max())
    added = 3 * (seen[1:5] * weights[0, 1:5]).mean() / 2
    np.testing.assert_allclose(
        some.pieces - none.pieces, [[added] * 8, [0] * 8, [0] * 8], rtol=1e-6, atol=1e-30
    )
    assert some.length == n * h


def test_moments_that_no_surface_has_are_refused():
    """Summits have no spread below 0.9 of alpha."""
    assert _checked(np.array([1.0, 1.0, 0.905])).m4 == 0.905
    for values, told in (
        ((1.0, 1.0, 0.895), r"m0 m4/m2\^2 = 0.895, impossible for an isotropic"),
        ((1.0, 1.0, 0.0), "not all are > 0; the profile is too"),
        ((-1.0, 1.0, 1.0), "not all are > 0"),
    ):
        with pytest.raises(ValueError, match=told):
            _checked(np.array(values))


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
    seen = [waves_of_profile(p, cutoff=10 * UM, terms=2, pieces=8) for p in plain]  # 16 stretches together
    whole = sum(w.length for w in seen)
    values = sum(w.length / whole * w.moments for w in seen)
    assert (fit.moments.m0, fit.moments.m2, fit.moments.m4) == pytest.approx(tuple(values), rel=1e-12)
    covariance = np.zeros((3, 3))
    for w in seen:
        power = np.convolve(w.power, np.full(SMOOTH, 1 / SMOOTH), mode="same")
        terms = w.length / whole * w.weights * power / values[:, None]
        covariance += terms @ terms.T
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-9)
    m0 = 0.8968057562340189 * fit.moments.m2**2 / fit.moments.m4 / fit.moments.sigma**2  # m0/sigma^2 - 1
    by_logarithms = {
        "m0": (1, 0, 0), "m2": (0, 1, 0), "m4": (0, 0, 1), "alpha": (1, -2, 1), "eta": (0, -1, 1),
        "radius": (0, 0, -0.5), "sigma": ((1 + m0) / 2, -m0, m0 / 2),
    }  # fmt: skip
    for name, exponents in by_logarithms.items():
        squares, stretches = [], []
        for w in seen:
            each = sum(e / v * row for e, v, row in zip(exponents, values, w.weights, strict=True))
            power = np.convolve(w.power, np.full(SMOOTH, 1 / SMOOTH), mode="same")
            squares += [(w.length / whole * a * b) ** 2 for a, b in zip(each, power, strict=True)]
            of_pieces = sum(e / v * row for e, v, row in zip(exponents, values, w.pieces, strict=True))
            stretches += [w.length / whole * 2 * x for x in of_pieces]
        freedom = max(sum(squares) ** 2 / sum(q * q for q in squares) / 2, 2)
        by_waves = math.sqrt(sum(squares) / (1 + 1 / SMOOTH)) * t_law.ppf(0.975, freedom) / 2
        by_stretches = np.std(stretches, ddof=1) / 4 * t_law.ppf(0.975, 15) / 2
        assert fit.numbers[name].relative == pytest.approx(max(by_waves, by_stretches), rel=1e-9), name


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
        ([np.random.default_rng(3).normal(size=100) * UM], 40 * UM, "too short"),
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


def test_cautions_of_profiles_tell_their_numbers():
    """Those of points, of both profiles; a cutoff of ten spacings is enough."""
    one, two = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 2000))[:2]
    fit = fit_profiles([one, two], cutoff=10 * UM)
    gaps = [replace(one, filled=3), replace(two, filled=4, resampled=True, spacing=2 * UM)]
    missing, uneven = profile_cautions(fit, gaps, 20 * UM)
    assert missing == "missing: 7 of 4000 heights lie on straight lines between their neighbours"
    assert uneven.startswith("x: ")
    (line,) = profile_cautions(fit, [one, two], None)
    assert "give ten points (1e-05 m) or more" in line
    assert profile_cautions(fit, gaps, 19.9 * UM)[0].startswith("cutoff: 9.95 points")  # of the coarser one
    (line,) = profile_cautions(fit, [one, two], 9.95 * UM)
    assert line.startswith("cutoff: 9.95 points per wavelength; below 10 ")
    (line,) = profile_cautions(known(fit, "sigma", 0.345), [one, two], 10 * UM)
    assert "sigma is known to 34 % only" in line


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
    assert "2 profiles, 0.002 m together" in told
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


@pytest.mark.parametrize(("words", "told"), [
    (["--summits", "s.csv"], "--summits s.csv: a profile shows no summits"),
    *(([f"--{name}", value], f"--{name}: is for maps") for name, value in (
        ("long-cutoff", "1mm"), ("missing", "fill"), ("spikes", "remove"),
        ("lines", "rows"), ("trim", "3"),
    )),
    (["--heights", "table"], "profiles do not show summits"),
    (["--pixel", "1um"], "gives x in mm; leave --pixel out"),
    (["--unit", "nm"], "heights are in .m as the file says, not in nm"),
])  # fmt: skip
def test_what_a_profile_cannot_be_asked(words, told, files, tmp_path, capsys, in_tmp_path):
    assert main(["fit", str(files / "p0.txt"), "--cutoff", "10um", *words, "-o", "s.toml"]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert re.search(told, error), error


Z = np.array([0.1, 0.3, -0.2, 0.5, 0.4, 0.0, -0.1, 0.2, 0.35, 0.15])
UM, MM = 1e-6, 1e-3


def lines(columns, separator, comma):
    rows = (separator.join(f"{v:g}" for v in row) for row in zip(*columns, strict=True))
    return [row.replace(".", ",") if comma else row for row in rows]


X = np.arange(10) * 0.5
BOTH, ALONE = (X, Z), (Z,)
ROWS = {  # name: text, ending, spacing given, spacing and unit of z expected in m
    "two columns, SI": (lines((X * UM, Z * UM), " ", False), ".txt", None, (0.5 * UM, UM)),
    "tabs, units in brackets": (["x [mm]\tz [um]", *lines(BOTH, "\t", False)], ".txt", None, (0.5 * MM, UM)),
    "decimal commas": (["X (µm);Z (nm)", *lines(BOTH, ";", True)], ".csv", None, (0.5 * UM, 1e-9)),
    "after a slash": (["Weg/mm;Hoehe/um", *lines(BOTH, ";", True)], ".asc", None, (0.5 * MM, UM)),
    "commas": (["x,z", "um,nm", *lines(BOTH, ",", False)], ".csv", None, (0.5 * UM, 1e-9)),
    "Gwyddion": (
        ["Profile 1", "x [m] y [m]", *lines((X * UM, Z * UM), "  ", False)], ".txt", None, (0.5 * UM, UM),
    ),
    "comments": (["# x in um; z in nm", *lines(BOTH, " ", False)], ".dat", None, (0.5 * UM, 1e-9)),
    "one unit for both": (["Units (um)", *lines(BOTH, ";", False)], ".txt", None, (0.5 * UM, UM)),
    "metadata": (
        ["Speed (mm/s): 0.5", "Length (mm): 4.8", "x (um);z (nm)", *lines(BOTH, ";", False)],
        ".txt", None, (0.5 * UM, 1e-9),
    ),
    "Dektak": (
        ["Scan Parameters", "ID,0", "Stylus,Radius: 2.5 um", "Length,4.5 um", "Location,0.0 um, 0.0 um", "",
         "Analytical Results", "Function,R.Cur Pos,Result", "Ra,4.0 um,0.005 um", "Skew,4.0 um,6.96", "",
         "Scan Data", "Lateral um,Raw Micrometer,", *(f"{x},,"  for x in lines(BOTH, ",", False))],
        ".csv", None, (0.5 * UM, UM),
    ),
    **{
        f"one column in {ending}": (["z (um)", *lines(ALONE, "", False)], ending, 2 * UM, (2 * UM, UM))
        for ending in (".txt", ".csv", ".asc", ".dat", ".tsv", ".prf", ".xy", ".XY")
    },
    "one column of commas": (["z (um)", *lines(ALONE, "", True)], ".txt", 2 * UM, (2 * UM, UM)),
    "a count for x": (["n z", *lines((np.arange(10), Z * UM), " ", False)], ".txt", 2 * UM, (2 * UM, UM)),
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_text_of_every_kind(name, encoding, tmp_path):
    text, ending, given, (spacing, unit) = ROWS[name]
    path = tmp_path / f"p{ending}"
    path.write_text("\n".join(text) + "\n", encoding=encoding)
    assert holds_profile(path)
    found = read_profile(path, spacing=given)
    assert found.spacing == pytest.approx(spacing, rel=1e-9)
    np.testing.assert_allclose(found.heights, Z * unit, rtol=1e-9, atol=1e-20)
    assert not found.filled
    assert not found.resampled


@pytest.mark.parametrize(("text", "given", "told"), [
    ("1\n2\n3\n", {}, "does not give the distance between its points; give --pixel"),
    ("x (um);z (um)\n0;1\n1;2\n", {"spacing": 1e-6}, "gives x in um; leave --pixel out"),
    ("x (um);z (um)\n0;1\n1;2\n", {"unit": "nm"}, "heights are in um as the file says, not in nm"),
    ("0 1\n1 2\n2 1\n3 1\n1 2\n4 2\n5 2\n6 1\n7 1\n", {}, "x = 3 m is followed by 1 m"),
    ("\n".join(f"{i} {i % 2 * 1e-6}" for i in range(20)), {}, "the points are 1 m apart; give --unit"),
    ("\n".join(f"{i * 1.0004e-3} {i % 9 * 1e-4}" for i in range(1250)), {}, "it is 1.25 m long; give --unit"),
    ("\n".join(f"{i * 1e-6} {i % 2}" for i in range(20)), {}, "the typical slope is 1e\\+06; give --unit"),
    ("0 1\n1 2\n", {}, "2 points: a profile has 8 or more"),
    ("0 1\n1 2 3\n2 2\n", {}, "line 2 has 3 numbers, the first row 2"),
    ("0 1\n1 2\nend\n", {}, "line 3: could not convert"),
    ("0 1 2\n1 2 3\n", {}, "3 numbers a line; a profile has z, or x and z"),
    ("x z\n", {}, "line 1: could not convert"),
    ("# x z\n", {}, "holds no numbers"),
    ("word\n" * 501 + "0 1\n1 2\n", {}, "the first 500 lines are not numbers; is it a map or a profile"),
    ("\n".join(f"{i} {'nan' if i % 3 else 1}" for i in range(30)), {}, "18 of the 28 heights are missing"),
])  # fmt: skip
def test_what_is_no_profile_is_refused_in_one_line(text, given, told, tmp_path):
    path = tmp_path / "p.txt"
    path.write_text(text)
    with pytest.raises(ValueError, match=told) as error:
        read_profile(path, **given)
    assert "\n" not in str(error.value)
    assert "p.txt" in str(error.value)


@pytest.mark.parametrize(("unit", "metre"), [
    ("m", 1), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("µm", 1e-6), ("μm", 1e-6), ("micron", 1e-6),
    ("nm", 1e-9), ("pm", 1e-12), ("fm", 1e-15), ("km", 1e3), ("Angstrom", 1e-10), ("Å", 1e-10),
    ("Nanometer", 1e-9), ("Micrometer", 1e-6), ("Millimeter", 1e-3),
])  # fmt: skip
@pytest.mark.parametrize("form", ["z ({})", "z [{}]", "z/{}", "height in {}", "Raw {}", "{}"])
def test_every_unit_in_a_header(unit, metre, form, tmp_path):
    (tmp_path / "p.txt").write_text("\n".join([form.format(unit), *map(str, Z)]), encoding="utf-8")
    found = read_profile(tmp_path / "p.txt", spacing=1e3)
    np.testing.assert_allclose(found.heights, Z * metre, rtol=1e-12)
    assert found.assumed_unit == ""


@pytest.mark.parametrize(("full", "found"), [(19, False), (20, True)])
def test_the_first_twenty_lines_tell_a_profile(full, found, tmp_path):
    """If a separator ends all of them, there is nothing behind it."""
    (tmp_path / "p.csv").write_text("1.5,2.5,,\n" * full + "3.5,4.5,5.5,6.5\n")
    assert holds_profile(tmp_path / "p.csv") == found


def test_profiles_and_what_is_none_by_their_files(tmp_path):
    """Maps are no profiles; those that cannot be read name their file."""
    (tmp_path / "m.txt").write_text("1 2 3\n4 5 6\n")
    np.save(tmp_path / "m.npy", np.zeros((3, 4)))
    np.save(tmp_path / "p.npy", np.arange(100.0) % 7 * UM)
    np.save(tmp_path / "short.npy", np.zeros(7))
    for ending in (".sdf", ".x3p", ".h5"):  # no question to another library
        (tmp_path / f"m{ending}").touch()
    for name in ("m.txt", "m.npy", "absent.txt", "absent.xyz", "m.sdf", "m.x3p", "m.h5"):
        assert not holds_profile(tmp_path / name)
    assert holds_profile(tmp_path / "p.npy")
    assert read_profile(tmp_path / "p.npy", spacing=UM).heights[6] == 6 * UM
    for name, spacing, told in (
        ("p.npy", None, "give --pixel"),
        ("absent.txt", None, "no such file"),
        ("short.npy", UM, r"short\.npy: 7 points: a profile has 8 or more"),
    ):
        with pytest.raises(ValueError, match=told):
            read_profile(tmp_path / name, spacing=spacing)
    lines = [*["word"] * 500, *(f"{i * UM} {i % 3 * UM}" for i in range(9))]
    (tmp_path / "words.txt").write_text("\n".join(lines))
    assert read_profile(tmp_path / "words.txt").heights[5] == pytest.approx(2 * UM)


def test_the_limits_of_places_and_gaps():
    """A tenth of a step beside the grid, a tenth of the heights; at either end nothing is filled."""
    x, z = np.arange(40.0), np.arange(40.0) ** 2
    line = np.where((x == 0) | (x == 39), np.nan, 3 * x + 1)  # straight lines do not change it
    np.testing.assert_array_equal(profile_at(-x, line).heights, 3 * x[38:0:-1] + 1)
    uneven = x + 0.3 * np.sin(x)
    found = profile_at(uneven, 3 * uneven + 1)
    np.testing.assert_allclose(np.diff(found.heights), 3 * found.spacing, rtol=1e-12)
    with pytest.raises(ValueError, match="no heights"):
        profile_at(x, np.full(40, np.nan))
    for shift, resampled in ((0.099, False), (0.101, True)):
        moved = x.copy()
        moved[20] += shift
        found = profile_at(moved, z)
        assert found.resampled == resampled
        assert (found.heights[20] == 400.0) == (not resampled)
    for number, told in ((4, None), (5, "5 of the 40 heights are missing")):
        holed = z.copy()
        holed[3 : 3 + 2 * number : 2] = np.nan
        if told:
            with pytest.raises(ValueError, match=told):
                profile_at(x, holed)
        else:
            found = profile_at(x, holed, "um")
            assert (found.filled, found.assumed_unit) == (4, "um")
            assert found.heights[5] == (16 + 36) / 2
    with pytest.raises(ValueError, match=r"^7 points: a profile has 8 or more"):
        profile_at(x[:7], z[:7])
    assert profile_at(x[:8], z[:8]).length == 8.0
    assert profile_at(x, np.arange(40)).heights.dtype == np.float64
    with pytest.raises(ValueError, match="x = 5 m is followed by 5 m; give x in increasing or decreasing"):
        profile_at(np.array([0, 1, 2, 3, 4, 5, 5, 6, 7.0]), np.zeros(9))
    with pytest.raises(ValueError, match="1 points: a profile has"):
        profile_at(np.zeros(1), np.zeros(1))
    for heights, spacing, told in (
        (np.zeros((3, 9)), 1.0, "not 2 dimensions"),
        (z[:7], 1.0, "8 or more"),
        (np.append(z, np.nan), 1.0, "are missing"),
        (z, 0.0, "give a length > 0 m"),
    ):
        with pytest.raises(ValueError, match=told):
            Profile(heights, spacing)


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


def test_a_fit_of_profiles_shows_its_numbers_and_two_cautions():
    profiles = list(cut(Spectrum(UM, 60 * UM, 8 * UM), 900))[:2]
    fit = replace(fit_profiles(profiles, cutoff=10 * UM), cautions=("a: 1", "b: 2", "c: 3"))
    lines = str(fit).splitlines()
    assert lines[0] == "Fit of 2 profile(s), 0.0018 m together"
    q, sk = fit.roughness.q, fit.roughness.sk
    assert lines[1].split(maxsplit=1) == [
        "profiles", f"Pa = {fit.roughness.a:.4g} m, Pq = {q:.4g} m, Psk = {sk:.2f}",
    ]  # fmt: skip
    assert [line.split(maxsplit=1) for line in lines[2:4]] == [["caution", "a: 1"], ["caution", "b: 2"]]
    assert lines[4].split(maxsplit=2) == ["unit", "value", "95 %"]
    units = dict(zip(NAMES, ("m^2", "1", "1/m^2", "1", "1/m^2", "m", "m"), strict=True))
    for line, name in zip(lines[5:], NAMES, strict=True):
        number = fit.numbers[name]
        assert line.split() == [
            name, units[name], f"{number.value:.4g}", f"{number.low:.3g}", "to", f"{number.high:.3g}",
        ]  # fmt: skip
    assert fit.area == pytest.approx((0.9e-3) ** 2)
    filtered = np.concatenate(
        [smooth_profile(without_profile_form(p, "plane"), 10 * UM).heights for p in profiles]
    )
    assert q == pytest.approx(filtered.std(), rel=1e-12)
    moments = {"eta": fit.moments.eta, "radius": fit.moments.radius, "sigma": fit.moments.sigma}
    assert {k: x.value for k, x in vars(fit.estimates["moments"]).items()} == moments


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


def test_profiles_that_surface_topography_reads(tmp_path):
    """Its own file of a line scan, even and uneven."""
    library = pytest.importorskip("SurfaceTopography")
    z = np.cumsum(np.random.default_rng(1).normal(size=3000)) * 1e-3
    z -= np.linspace(z[0], z[-1], 3000)
    library.UniformLineScan(z, 1.5, unit="mm").to_netcdf(str(tmp_path / "even.nc"))
    assert holds_profile(tmp_path / "even.nc")
    found = read_profile(tmp_path / "even.nc")
    np.testing.assert_allclose(found.heights, z * MM, rtol=1e-12)
    assert found.spacing == pytest.approx(0.5 * UM, rel=1e-9)
    with pytest.raises(ValueError, match="gives x in mm; leave --pixel out"):
        read_profile(tmp_path / "even.nc", spacing=UM)
    fit = mcgw.fit(tmp_path / "even.nc", cutoff="10 um")
    assert fit.lengths == (pytest.approx(1.5 * MM),)


@pytest.mark.parametrize(("lines", "heights"), [
    ([f"{i},{i % 3}" for i in range(9)], [i % 3 for i in range(9)]),  # rising: places
    ([f"{8 - i},{i % 3}" for i in range(9)], [(8 - i) % 3 for i in range(9)]),  # falling
    (["0,25", "# so", *(f"0,{26 + i}" for i in range(7))], [0.25, *(0.26 + i / 100 for i in range(7))]),
    ([f"{i},0{i % 3}" for i in (0, 1, 1, 0, 2, 3, 1, 0)], [0, 1.01, 1.01, 0, 2.02, 3, 1.01, 0]),
    *(([f"{n},{25 + i}" for i, n in enumerate(whole)], [float(f"{n}.{25 + i}") for i, n in enumerate(whole)])
      for whole in (8 * (0,), 4 * (0,) + 4 * (1,), 2 * (2,) + 6 * (1,))),
])  # fmt: skip
def test_whole_numbers_that_rise_or_fall_before_a_comma_are_places(lines, heights, tmp_path):
    path, places = tmp_path / "p.csv", len(heights) == 9
    path.write_text(("x (um),z (um)\n" if places else "z (um)\n") + "\n".join(lines))
    found = read_profile(path, spacing=None if places else UM)
    np.testing.assert_allclose(found.heights / UM, heights, rtol=1e-12)
    assert found.spacing == pytest.approx(UM)
