"""From maps to surfaces and scenes: known fields of caps and known spectra are found again."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import SUMMITS, envelope, hidden_summits, visible, write_scene
from oracles.rough import fit_map
from oracles.summits_by_hand import summit_contact

import analytic
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


def test_a_sparse_field_is_found_again():
    topography, field, truth = caps(0.005, 400, 512)
    fit = mcgw.fit(topography, cutoff=None)
    is_found(fit.estimates["caps"], field, truth)
    assert fit.best == "caps"
    assert "overlap" not in words(fit)


def test_where_summits_hide_the_bias_is_stated():
    """eta R sigma = 0.08: a fifth hides. What is counted is off by what the fit says; the rest is found."""
    topography, field, truth = caps(0.08, 900, 640)
    fit, hidden = mcgw.fit(topography, cutoff=None), hidden_summits(field).mean()
    assert hidden > 0.18
    counted = fit.estimates["summits"].eta
    assert counted.value < (1 - hidden + 0.03) * truth[0]
    assert counted.value / fit.visible.share == pytest.approx(truth[0], rel=0.06)
    is_found(fit.estimates["caps"], field, truth)
    assert {"overlap", "skewness"} <= words(fit)


@pytest.mark.parametrize(("heights", "cutoff", "told"), [
    (np.full((90, 90), np.nan), None, "all 8100 points of the map are missing"),
    (np.ones((90, 90)), None, "flat"),
    (1e-9 * np.arange(8100.0).reshape(90, 90), None, "flat after removing its form"),
    (1e-6 * rng(1).normal(size=(90, 90)), 1e-3, "leaves nothing"),
    (1e-6 * rng(1).normal(size=(12, 12)), None, "too few for 4 x 4"),
    (1e-6 * rng(1).normal(size=(3, 3)), None, "too few"),
    (1e-6 * rng(1).normal(size=(64, 3)), None, "m.npy: three numbers a line, 64 lines: single points"),
])  # fmt: skip
def test_maps_that_cannot_be_fitted_are_refused(heights, cutoff, told, tmp_path):
    np.save(tmp_path / "m.npy", heights)
    with pytest.raises(ValueError, match=told):
        mcgw.fit(tmp_path / "m.npy", cutoff=cutoff, pixel="1 um")


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
    absurd = dict(zip(SUMMITS, [(1e10, 1e8), (1e-5, 1e-7), (94e-3, 1e-3)], strict=True))
    monkeypatch.setattr("mcgw.maps.fit.by_moments", lambda *_: absurd)
    with pytest.raises(ValueError, match=r"sigma of .* 0.094 m, more than the peak to valley"):
        fit_map(topography, cutoff=None)


def waves(along, down, n=160):
    """A map of so many equal summits, each in the middle of its cell."""
    x, y = (2 * math.pi * k * (np.arange(n) + 0.5) / n for k in (along, down))
    return Topography(1e-7 * -(np.cos(x) + np.cos(y)[:, None]), PIXEL, periodic=True)


@pytest.mark.parametrize(("shape", "parts", "tiles", "counted"), [
    ((7, 1), 4, 9, False), ((4, 2), 4, 9, True), ((6, 5), 4, 9, True), ((8, 4), 6, 16, True),
    ((8, 4), 2, 4, True),
])  # fmt: skip
def test_few_summits_have_few_sub_areas(shape, parts, tiles, counted, without_caps):
    """Two summits in each on average, but three of them along each axis; fewer than eight are not counted."""
    fit = fit_map(waves(*shape), cutoff=None, form="none", parts=parts)
    assert fit.summits.size == math.prod(shape)
    assert len(fit.tiles) == tiles
    assert ("summits" in fit.estimates) == counted


@pytest.mark.parametrize(("cutoff", "blur"), [(None, 1.5e-6), (10e-6, math.hypot(1.5e-6, 3e-6))])
def test_a_field_of_caps_is_blurred_by_a_pixel_and_three_tenths_of_a_cutoff(cutoff, blur, monkeypatch):
    told = [(2e9, 1e7), (1e-5, 1e-7), (1e-6, 1e-8)]
    monkeypatch.setattr("mcgw.maps.fit.by_caps", lambda counted, asked: told if asked == blur else None)
    drawn = gaussian_map(Spectrum(1e-6, 40e-6, 14e-6), (100, 100), (1e-6, 1.5e-6), rng(1))
    fit = fit_map(drawn, cutoff=cutoff, form="none")
    assert fit.estimates["caps"].overlap == pytest.approx(0.02, rel=1e-12)
    assert fit.visible.share == pytest.approx(visible(0.02, blur / math.sqrt(2e-11)).share, rel=1e-9)


def test_one_radius_is_one_to_a_sixth(rough):
    """Quartiles of a Gaussian are 1.349 deviations apart."""
    both = replace(rough, estimates={**rough.estimates, "caps": rough.estimates["summits"]})
    for spread, best in ((0.1692, "caps"), (0.1708, "summits")):
        bends = 1e5 * (1 + spread * 1.349 / 2 * np.array([-9, -1, -1, 0, 1, 1, 9.0]))
        fit = replace(both, listed=replace(rough.listed, curvatures=np.array([1.5 * bends, 0.5 * bends])))
        assert fit.spread_of_curvatures == pytest.approx(spread, rel=1e-9)
        assert fit.best == best


def test_what_a_file_does_not_tell_is_given_to_a_fit(tmp_path, without_caps):
    """Pixel, unit and mark of missing points."""
    z = gaussian_map(Spectrum(1e-6, 40e-6, 14e-6), (100, 100), PIXEL, rng(1)).heights
    z[50, 50] = np.nan
    np.save(tmp_path / "m.npy", np.where(np.isnan(z), -7.0, z * 1e6))
    same = mcgw.fit(Topography(z, (2e-6, 2e-6)), cutoff="20 um")
    found = mcgw.fit(tmp_path / "m.npy", cutoff="20 um", pixel="2 um", unit="um", missing_value=-7.0)
    assert found.moments.m4 == pytest.approx(same.moments.m4, rel=1e-9)
    assert found.notes == same.notes


def test_each_kind_of_heights_has_the_estimate_it_names(rough):
    """A table of heights has its radius and density; a list has one surface."""
    for use in ("moments", "summits"):
        scene, told = mcgw.fitted_scene(rough, heights="table", use=use), rough.estimates[use]
        assert (scene.surface.radius, scene.surface.eta) == (told.radius.value, told.eta.value)
        assert scene.surface.sigma == pytest.approx(rough.summits.std())
        by = scene.uncertainty
        assert (by.eta, by.radius, by.sigma) == tuple(getattr(told, x).relative for x in SUMMITS)
    for heights in ("measured", "summits"):
        one = mcgw.fitted_scene(rough, heights=heights, E_star="70 GPa")
        assert (one.n_surfaces, one.n_asperities, one.sampler) == (1, rough.summits.size, "direct")
        assert one.uncertainty is None
        own = one.surface
        assert (own.eta, own.sigma) == pytest.approx((rough.summits.size / rough.area, rough.summits.std()))
        assert (own.E_star, own.nominal_area) == (70e9, rough.area)
    assert mcgw.fitted_scene(rough, heights="measured").surface.radius == told.radius.value
    plain = mcgw.fitted_scene(rough).surface
    assert (plain.radius, plain.eta, plain.sigma) == (told.radius.value, told.eta.value, told.sigma.value)
    nayak = mcgw.fitted_scene(rough, heights="nayak").uncertainty
    assert (nayak.m0, nayak.m2, nayak.m4) == tuple(rough.numbers[x].relative for x in ("m0", "m2", "m4"))


def test_overlap_is_that_of_the_estimate_that_is_used(tmp_path, capsys):
    """Counted summits of a Gaussian surface of alpha = 6 are apart; caps, added, would not be."""
    write_map(gaussian_map(Spectrum(1e-6, 80e-6, 8e-6), (240, 240), PIXEL, rng(1)), tmp_path / "m.h5")
    for use, number, named in (("auto", 1, False), ("caps", 2, True)):
        words_of = ["fit", *number * [str(tmp_path / "m.h5")], "--cutoff", "none", "--use", use]
        assert main([*words_of, "-o", str(tmp_path / "s.toml")]) == 0
        assert ("overlap:" in capsys.readouterr().err) == named


def test_a_scene_of_a_fit_takes_what_scenes_have(rough):
    """The same as afterwards; what is wrong is told as it is there."""
    plain = mcgw.fitted_scene(rough, heights="nayak", E_star="70 GPa")
    changes = {
        "grading": mcgw.Exponential(2.0),
        "nominal_area": "4 mm^2",
        "joint": mcgw.Joint(resistivity=0.1),
    }
    made = mcgw.fitted_scene(rough, heights="nayak", E_star="70 GPa", **changes)
    assert made == plain.replace(**changes) != plain
    assert made.heights == analytic.Nayak(rough.moments.alpha)
    assert made.surface.nominal_area == 4e-6
    assert made.n_asperities == round(made.surface.eta * 4e-6)
    with pytest.raises(mcgw.SceneError, match="n_surfaces = -1"):
        mcgw.fitted_scene(rough, n_surfaces=-1)
    with pytest.raises(TypeError, match="gradient"):
        mcgw.fitted_scene(rough, gradient=2.0)


@pytest.mark.parametrize(("asked", "told"), [
    ({"heights": "nayak", "use": "summits"}, 'use = "summits": heights = "nayak" follow from the "moments"'),
    ({"heights": "measured", "use": "moments"}, "measured heights as they are need use = .summits"),
    ({"heights": "measured", "nominal_area": 1}, 'nominal_area = 1: heights = "measured" uses the measured'),
    ({"heights": "summits", "nominal_area": 1}, 'nominal_area = 1: heights = "summits" uses the measured'),
])  # fmt: skip
def test_estimates_that_do_not_suit_the_heights_are_refused(asked, told, rough):
    with pytest.raises(ValueError, match=told):
        mcgw.fitted_scene(rough, **asked)


def test_the_very_summits_carry_what_they_carry_literally(rough, tmp_path):
    scene = mcgw.fitted_scene(rough, heights="summits", E_star=70e9)
    ensemble = mcgw.run(mcgw.scene_from(mcgw.scene_text(scene)), tmp_path / "summits.h5")
    assert scene.surface.radius == pytest.approx(1 / np.mean(1 / rough.listed.radii), rel=1e-12)
    d = scene.surface.sigma * np.array(scene.separations)
    exact = summit_contact(rough.summits, rough.listed.radii, 70e9, d)
    for name in ("load", "area", "stiffness", "contacts"):
        np.testing.assert_allclose(ensemble[name], getattr(exact, name), rtol=1e-11)
    assert exact.load[0, 0] > 0


@pytest.mark.parametrize("law", ["gaussian", "nayak", "table"])
def test_a_larger_area_has_more_summits(law, rough, tmp_path):
    """In a file that is changed by hand, and as an argument."""
    before, path = mcgw.fitted_scene(rough, heights=law), tmp_path / "f.toml"
    write_scene(before, path, None, [])
    (line,) = [line for line in path.read_text().splitlines() if line.startswith("nominal_area =")]
    path.write_text(path.read_text().replace(line, 'nominal_area = "1 cm^2"'))
    for after in (mcgw.load_scene(path), mcgw.fitted_scene(rough, heights=law, nominal_area="1 cm^2")):
        assert after.surface.nominal_area == 1e-4
        assert after.n_asperities == pytest.approx(before.surface.eta * 1e-4, rel=1e-3)
        assert after.n_asperities > 1000 * before.n_asperities
        assert type(after.heights) is type(before.heights)
