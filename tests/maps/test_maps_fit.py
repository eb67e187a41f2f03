"""From maps to surfaces and scenes: known fields of caps and known spectra are found again."""

import math
import tomllib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.inside import (
    SUMMITS,
    Estimate,
    Preparation,
    by_summits,
    coarse_sums_of,
    envelope,
    fit_prepared,
    hidden_summits,
    prepared,
    roughness_of,
    summit_sums_of,
    visible,
    write_scene,
)
from scipy.stats import kurtosis, skew

import mcgw
from mcgw.cli import main
from mcgw.maps import Asperities, Spectrum, Topography, gaussian_map, write_map

PIXEL = (1e-6, 1e-6)


def rng(seed=1):
    return np.random.default_rng(seed)


def caps(overlap, number, pixels, seed=2):
    """A map of caps of one radius on a square of 1 mm, their field, and eta, R and sigma."""
    radius, side = 13e-6, 1e-3
    eta = number / side**2
    sigma = overlap / eta / radius
    generator = rng(seed)
    field = Asperities(
        side * generator.random(number), side * generator.random(number),
        sigma * generator.normal(size=number), np.full(number, radius), radius, (side, side),
    )  # fmt: skip
    return envelope(field, (pixels, pixels)), field, (eta, radius, sigma)


def fitted(*arguments):
    topography, field, truth = caps(*arguments)
    return SimpleNamespace(field=field, truth=truth, fit=mcgw.fit(topography, cutoff=None))


@pytest.fixture(scope="module")
def sparse():
    return fitted(0.005, 400, 512)


@pytest.fixture(scope="module")
def crowded():
    return fitted(0.08, 900, 640)


@pytest.fixture(scope="module")
def rough():
    """A fit of a Gaussian map, whose summits have all radii."""
    drawn = gaussian_map(Spectrum(1e-6, 40e-6, 14e-6), (200, 200), PIXEL, rng(1))
    return mcgw.fit(drawn, cutoff=None, form="none")


def words(fit):
    return {line.partition(":")[0] for line in fit.cautions}


def is_found(estimate, field, truth):
    """|z| < 3.5 against stated errors with 15 degrees of freedom: a false alarm in 300 each, seed fixed.

    The truth is the field itself: its own number, and the deviation of its own heights.
    """
    for found, expected in zip(
        (estimate.eta, estimate.radius, estimate.sigma), (*truth[:2], field.z.std()), strict=True
    ):
        assert abs(found.value - expected) < 3.5 * found.error + 1e-12 * expected
        assert found.error < 0.12 * expected


def test_a_sparse_field_is_found_again(sparse):
    is_found(sparse.fit.estimates["caps"], sparse.field, sparse.truth)
    assert sparse.fit.best == "caps"
    assert "overlap" not in words(sparse.fit)


def test_where_summits_hide_the_bias_is_stated(crowded):
    """eta R sigma = 0.08: a fifth hides. What is counted is off by what the fit says; the rest is found."""
    fit, (eta, _, _) = crowded.fit, crowded.truth
    hidden = hidden_summits(crowded.field).mean()
    assert hidden > 0.18
    counted = fit.estimates["summits"].eta
    assert counted.value < (1 - hidden + 0.03) * eta
    assert counted.value / fit.visible.share == pytest.approx(eta, rel=0.06)
    is_found(fit.estimates["caps"], crowded.field, crowded.truth)
    assert {"overlap", "skewness"} <= words(fit)


def test_a_lay_along_the_diagonal_is_seen(without_caps):
    """Slopes along x and y are alike there; of two waves one has three times the mean square of the other."""
    y, x = np.mgrid[0:200, 0:200] * 1e-6
    q = 2 * math.pi / 20e-6
    z = 1e-7 * (3**0.5 * np.cos(q * (x + y)) + np.cos(q * (x - y)))
    fit = mcgw.fit(Topography(z, (1e-6, 1e-6), periodic=True), cutoff=None, form="none")
    assert fit.mean_squares["slope_x"] == pytest.approx(fit.mean_squares["slope_y"], rel=1e-9)
    assert fit.lay == pytest.approx(3, rel=1e-9)
    assert [line for line in fit.cautions if line.startswith("lay:")]


@pytest.mark.parametrize(("heights", "cutoff", "told"), [
    (np.full((90, 90), np.nan), None, "all 8100 points of the map are missing"),
    (np.ones((90, 90)), None, "flat"),
    (np.arange(8100.0).reshape(90, 90), None, "flat after removing its form"),
    (rng(1).normal(size=(90, 90)), 1e-3, "leaves nothing"),
    (rng(1).normal(size=(12, 12)), None, "too few for 4 x 4"),
])  # fmt: skip
def test_maps_that_cannot_be_fitted_are_refused(heights, cutoff, told):
    with pytest.raises(ValueError, match=told):
        fit_map(Topography(heights, PIXEL), cutoff=cutoff)


def test_an_array_of_points_is_taken_for_no_map(tmp_path):
    for size, told in ((64, r"points.npy: three numbers a line, 64 lines: single points"), (3, "too few")):
        np.save(tmp_path / "points.npy", rng().normal(size=(size, 3)) * 1e-6)
        with pytest.raises(ValueError, match=told):
            mcgw.fit(tmp_path / "points.npy", cutoff=None, pixel="1 um")


def test_a_map_of_few_summits_has_moments_alone(without_caps):
    drawn = gaussian_map(Spectrum(1e-6, 40e-6, 30e-6), (64, 64), PIXEL, rng(1))
    fit = mcgw.fit(drawn, cutoff=None, form="none")
    assert fit.best == "moments"
    assert list(fit.estimates) == ["moments"]
    assert "summits" in words(fit)
    with pytest.raises(ValueError, match="this map has no such estimate; give one of moments"):
        mcgw.fitted_scene(fit, use="caps")


def test_a_sigma_above_peak_to_valley_is_refused(monkeypatch):
    topography = gaussian_map(Spectrum(1e-6, 16e-6, 8e-6), (64, 64), PIXEL, rng(1))
    absurd = [(1e10, 1e8), (1e-5, 1e-7), (94e-3, 1e-3)]
    monkeypatch.setattr("mcgw.maps.fit.by_caps", lambda *_: absurd)
    assert "caps" not in fit_map(topography, cutoff=None).estimates
    monkeypatch.setattr("mcgw.maps.fit.by_moments", lambda *_: dict(zip(SUMMITS, absurd, strict=True)))
    with pytest.raises(ValueError, match=r"sigma of .* 0.094 m, more than the peak to valley"):
        fit_map(topography, cutoff=None)


def waves(along, down, n=160):
    """A map of so many equal summits, each in the middle of its cell."""
    x, y = (2 * math.pi * k * (np.arange(n) + 0.5) / n for k in (along, down))
    return Topography(1e-7 * -(np.cos(x) + np.cos(y)[:, None]), PIXEL, periodic=True)


@pytest.mark.parametrize(("shape", "parts", "tiles", "counted"), [
    ((7, 1), 4, 9, False), ((4, 2), 4, 9, True), ((6, 5), 4, 9, True), ((8, 4), 4, 16, True),
    ((8, 4), 6, 16, True), ((8, 4), 2, 4, True),
])  # fmt: skip
def test_few_summits_have_few_sub_areas(shape, parts, tiles, counted, without_caps):
    """Two summits in each on average, but three of them along each axis; fewer than eight are not counted."""
    fit = fit_map(waves(*shape), cutoff=None, form="none", across=parts)
    assert fit.summits.size == math.prod(shape)
    assert len(fit.tiles) == tiles
    assert ("summits" in fit.estimates) == counted


@pytest.mark.parametrize("size", [72, 100, 130, 200])
def test_errors_of_counted_summits_are_those_over_sub_areas_of_four(size, without_caps):
    """As many along each axis as that makes, from two to four."""
    drawn = gaussian_map(Spectrum(1e-6, 30e-6, 14e-6), (size, size), PIXEL, rng(2))
    ready = prepared(drawn, Preparation(None, form="none"))
    fit = fit_prepared(ready)
    across = max(min(4, int(math.sqrt(fit.summits.size / 4))), 2)
    pairs = by_summits(summit_sums_of(drawn, across=across), coarse_sums_of(drawn, across=across))
    assert fit.estimates["summits"] == Estimate.of(pairs, fit.waves)


@pytest.mark.parametrize("form", ["none", "plane", "quadratic", "cubic"])
def test_heights_of_summits_are_about_their_own_plane_or_paraboloid(form, without_caps):
    """Of the form that was taken off the map, but of second order at most; their mean stays."""
    tilt = np.add.outer(np.arange(120.0) ** 2, 90 * np.arange(140.0)) * 1e-10
    drawn = gaussian_map(Spectrum(1e-6, 30e-6, 14e-6), (120, 140), PIXEL, rng(3)).heights
    ready = prepared(Topography(np.exp(drawn * 1e6) * 1e-6 + tilt, PIXEL), Preparation(None, form=form))
    found, counted = fit_prepared(ready), summit_sums_of(ready.used)
    x, y = counted.places
    columns = {"none": [], "plane": [x, y]}.get(form, [x, y, x * x, x * y, y * y])
    basis = np.column_stack([np.ones_like(x), *(c - c.mean() for c in columns)])
    left = counted.heights - basis[:, 1:] @ np.linalg.lstsq(basis, counted.heights, rcond=None)[0][1:]
    np.testing.assert_allclose(found.summits, left - left.mean(), atol=1e-9 * np.ptp(left))


@pytest.mark.parametrize(("periodic", "masked"), [(False, False), (True, False), (False, True)])
def test_roughness_is_that_of_the_points_that_count(periodic, masked, without_caps):
    """Four points at each edge do not; all moments by NumPy, of more points than are summed at once."""
    z = np.exp(gaussian_map(Spectrum(1e-6, 30e-6, 14e-6), (120, 140), PIXEL, rng(3)).heights * 1e6) * 1e-6
    if masked:
        z[50:53, 60:64] = np.nan
    ready = prepared(Topography(z, PIXEL, periodic), Preparation(None, form="none", missing="mask"))
    found = fit_prepared(ready).roughness
    counts = slice(None) if periodic else slice(4, -4)
    some = z[counts, counts][np.isfinite(z[counts, counts])]
    expected = np.abs(some - some.mean()).mean(), some.std(), skew(some), kurtosis(some, fisher=False)
    assert (found.a, found.q, found.sk, found.ku) == pytest.approx(expected, rel=1e-9)
    flat = roughness_of(np.full(9, 2.0))
    assert (flat.a, flat.q, flat.sk, flat.ku) == (0, 0, 0, 0)


def test_a_field_of_caps_is_blurred_by_a_pixel_and_a_cutoff(monkeypatch):
    """Three tenths of that; it is one only if it spreads no more than the map from peak to valley."""
    drawn = gaussian_map(Spectrum(1e-6, 40e-6, 14e-6), (100, 100), (1e-6, 1.5e-6), rng(1))
    asked, told = [], [(2e9, 1e7), (1e-5, 1e-7), (1e-6, 1e-8)]
    monkeypatch.setattr("mcgw.maps.fit.by_caps", lambda counted, blur: asked.append(blur) or told)
    for cutoff, blur in ((None, 1.5e-6), (10e-6, math.hypot(1.5e-6, 3e-6))):
        fit = fit_map(drawn, cutoff=cutoff, form="none")
        assert asked[-1] == pytest.approx(blur, rel=1e-12)
        assert fit.estimates["caps"].overlap == pytest.approx(0.02, rel=1e-12)
        expected = visible(0.02, blur / math.sqrt(2 * 1e-5 * 1e-6))
        found = fit.visible
        assert (found.share, found.mean, found.std) == pytest.approx(
            (expected.share, expected.mean, expected.std), rel=1e-9
        )
    whole = float(np.ptp(drawn.heights))
    for sigma, there in ((whole, True), (1.001 * whole, False)):
        told[2] = (sigma, 1e-8)
        fit = fit_map(drawn, cutoff=None, form="none")
        assert ("caps" in fit.estimates) == there
        assert (fit.visible is not None) == there


def test_one_radius_is_one_to_a_sixth(rough):
    """Quartiles of a Gaussian are 1.349 deviations apart."""
    both = replace(rough, estimates={**rough.estimates, "caps": rough.estimates["summits"]})
    for spread, best in ((0.1692, "caps"), (0.1708, "summits")):
        bends = 1e5 * (1 + spread * 1.349 / 2 * np.array([-9, -1, -1, 0, 1, 1, 9.0]))
        fit = replace(both, listed=replace(rough.listed, curvatures=np.array([1.5 * bends, 0.5 * bends])))
        assert fit.spread_of_curvatures == pytest.approx(spread, rel=1e-9)
        assert fit.best == best


def test_a_lay_of_nothing_across_is_a_number():
    """Grooves that do not change along themselves: two in a million millions, and not infinitely many."""
    z = 1e-7 * np.sin(2 * math.pi * np.arange(160) / 20)[:, None] + np.zeros(160)
    z += 1e-15 * rng(1).normal(size=z.shape)
    fit = fit_map(Topography(z, PIXEL, periodic=True), cutoff=None, form="none")
    assert fit.lay == pytest.approx(2e12, rel=1e-6)


def test_what_a_file_does_not_tell_is_given_to_a_fit(tmp_path, without_caps):
    """Pixel and unit of an array; spacing and unit of a column, which `profile` makes of any file."""
    z = gaussian_map(Spectrum(1e-6, 40e-6, 14e-6), (100, 100), PIXEL, rng(1)).heights
    np.save(tmp_path / "m.npy", z * 1e6)
    same = mcgw.fit(Topography(z, (2e-6, 2e-6)), cutoff="20 um")
    found = mcgw.fit(tmp_path / "m.npy", cutoff="20 um", pixel="2 um", unit="um")
    assert found.moments.m4 == pytest.approx(same.moments.m4, rel=1e-9)
    marked = z.copy()
    marked[50, 50] = np.nan
    np.save(tmp_path / "n.npy", np.where(np.isnan(marked), -7.0, marked * 1e6))
    given = {"pixel": "2 um", "unit": "um", "missing_value": -7.0}
    found = mcgw.fit(tmp_path / "n.npy", cutoff="20 um", **given)
    assert found.notes == mcgw.fit(Topography(marked, (2e-6, 2e-6)), cutoff="20 um").notes
    np.savetxt(tmp_path / "p.txt", z[:20].ravel() * 1e9)
    same = mcgw.fit(mcgw.maps.profile.Profile(z[:20].ravel(), 2e-6), cutoff="20 um")
    found = mcgw.fit(tmp_path / "p.txt", cutoff="20 um", pixel="2 um", unit="nm")
    assert found.moments.m4 == pytest.approx(same.moments.m4, rel=1e-6)


def test_each_kind_of_heights_has_the_estimate_it_names(rough):
    """A table of heights has its radius and density; a list has one surface."""
    table = mcgw.fitted_scene(rough, heights="table", use="moments").surface
    told = rough.estimates["moments"]
    assert (table.radius, table.eta) == (told.radius.value, told.eta.value)
    assert table.sigma == pytest.approx(rough.summits.std())
    for heights in ("measured", "summits"):
        one = mcgw.fitted_scene(rough, heights=heights)
        assert (one.n_surfaces, one.n_asperities, one.sampler) == (1, rough.summits.size, "direct")
        assert one.uncertainty is None
        with pytest.raises(ValueError, match=f'nominal_area = 1: heights = "{heights}" uses the measured'):
            mcgw.fitted_scene(rough, heights=heights, nominal_area=1)
    own = mcgw.fitted_scene(rough, heights="measured", E_star="70 GPa").surface
    assert own.radius == rough.estimates["summits"].radius.value
    assert own.eta == pytest.approx(rough.summits.size / rough.area, rel=1e-12)
    assert own.sigma == pytest.approx(rough.summits.std(), rel=1e-12)
    assert (own.E_star, own.nominal_area) == (70e9, rough.area)
    plain = mcgw.fitted_scene(rough).surface
    found = rough.estimates["summits"]
    assert (plain.radius, plain.eta, plain.sigma) == (found.radius.value, found.eta.value, found.sigma.value)
    with pytest.raises(
        ValueError, match='use = "moments": measured heights as they are need use = "summits"'
    ):
        mcgw.fitted_scene(rough, heights="measured", use="moments")
    by = mcgw.fitted_scene(rough, heights="table").uncertainty
    told = rough.estimates["summits"]
    assert (by.eta, by.radius, by.sigma) == (told.eta.relative, told.radius.relative, told.sigma.relative)
    nayak = mcgw.fitted_scene(rough, heights="nayak").uncertainty
    assert (nayak.m0, nayak.m2, nayak.m4) == tuple(x.relative for x in list(rough.numbers.values())[:3])


def test_a_written_scene_of_a_fit_leaves_out_what_follows(rough, tmp_path):
    """The number of asperities follows from the area; comments stand above; heights lie beside it."""
    scene = mcgw.fitted_scene(rough)
    assert write_scene(scene, tmp_path / "f.toml", None, ["one", "two"]) == [tmp_path / "f.toml"]
    text = (tmp_path / "f.toml").read_text()
    assert text.startswith("# one\n# two\n\ntitle")
    assert not {"n_asperities", "left_out"} & set(tomllib.loads(text)["ensemble"])
    listed, beside = mcgw.fitted_scene(rough, heights="measured"), tmp_path / "m.heights.npy"
    assert write_scene(listed, tmp_path / "m.toml", rough, []) == [tmp_path / "m.toml", beside]
    assert np.array_equal(np.load(beside), rough.summits)
    read = mcgw.load_scene(tmp_path / "m.toml")
    assert read.heights.heights == pytest.approx(listed.heights.heights, rel=1e-9, abs=1e-9)
    assert len((tmp_path / "m.toml").read_text()) < 1500


def test_a_fit_shows_the_first_of_its_cautions(rough):
    """And how many there are; agreement is the largest ratio of two of its estimates."""
    for number in (0, 1, 6):
        text = str(replace(rough, cautions=tuple(f"word: {k}" for k in range(number))))
        assert (f"{number} in .cautions; word: 0" in text) == (number > 0)
        assert ("caution" in text) == (number > 0)
    pairs = [[getattr(rough.estimates[x], y).value for x in ("moments", "summits")] for y in SUMMITS]
    assert rough.agreement == pytest.approx(max(max(pair) / min(pair) for pair in pairs))


def test_overlap_is_that_of_the_estimate_that_is_used(tmp_path, capsys):
    """Counted summits of a Gaussian surface of alpha = 6 are apart; caps, added, would not be."""
    write_map(gaussian_map(Spectrum(1e-6, 80e-6, 8e-6), (240, 240), PIXEL, rng(1)), tmp_path / "m.h5")
    for use, number, named in (("auto", 1, False), ("caps", 1, True), ("caps", 2, True)):
        words_of = ["fit", *number * [str(tmp_path / "m.h5")], "--cutoff", "none", "--use", use]
        assert main([*words_of, "-o", str(tmp_path / "s.toml")]) == 0
        assert ("overlap:" in capsys.readouterr().err) == named
