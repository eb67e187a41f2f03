"""From a map or profiles to a scene whose summits have radii of their own."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.summits_by_hand import summit_contact

import analytic
import mcgw
from mcgw.maps import Spectrum, gaussian_map


@pytest.fixture(scope="module")
def drawn():
    return gaussian_map(Spectrum(1e-6, 80e-6, 12e-6), (512, 512), (1e-6, 1e-6), np.random.default_rng(3))


@pytest.fixture(scope="module")
def fit(drawn):
    return fit_map(drawn, cutoff=None)


def test_scene_has_the_moments_of_the_map(fit):
    scene = mcgw.fitted_scene(fit, heights="nayak", E_star="70 GPa")
    m = fit.moments
    assert scene.heights == analytic.Nayak(m.alpha)
    assert scene.surface.radius == pytest.approx(3 * math.sqrt(math.pi / m.m4) / 8, rel=1e-12)
    assert scene.surface.eta == pytest.approx(m.m4 / (6 * math.sqrt(3) * math.pi * m.m2), rel=1e-12)
    assert scene.surface.sigma == pytest.approx(
        math.sqrt((1 - 0.8968057562340189 / m.alpha) * m.m0), rel=1e-12
    )
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene


def test_a_map_stretched_upwards_bears_as_much_on_the_same_area(drawn):
    """What half-spaces obey: heights by c, loads by c. Radii of a polished map may be longer than the map."""
    areas, c = [], 1e-3
    for stretch in (1.0, c):
        fit = fit_map(replace(drawn, heights=stretch * drawn.heights), cutoff=None)
        scene = mcgw.fitted_scene(fit, heights="nayak", n_surfaces=2)
        areas.append(mcgw.solve(scene, pressure=stretch * 2e8).theory["area"])
    assert scene.surface.radius > math.sqrt(fit.area)
    assert areas[1] == pytest.approx(areas[0], rel=1e-5)


def test_a_scene_of_a_fit_takes_what_scenes_have(fit):
    """The same as afterwards; what is wrong is told as it is there."""
    plain = mcgw.fitted_scene(fit, heights="nayak", E_star="70 GPa")
    changes = {
        "grading": mcgw.Exponential(2.0), "nominal_area": "4 mm^2", "n_surfaces": 7,
        "joint": mcgw.Joint(resistivity=0.1),
    }  # fmt: skip
    made = mcgw.fitted_scene(fit, heights="nayak", E_star="70 GPa", **changes)
    assert made == plain.replace(**changes) != plain
    assert made.surface.nominal_area == 4e-6
    assert made.n_asperities == round(made.surface.eta * 4e-6)
    with pytest.raises(mcgw.SceneError, match="n_surfaces = -1"):
        mcgw.fitted_scene(fit, n_surfaces=-1)
    with pytest.raises(TypeError, match="gradient"):
        mcgw.fitted_scene(fit, gradient=2.0)


def test_other_estimates_know_no_such_heights(fit):
    with pytest.raises(ValueError, match='use = "summits": heights = "nayak" follow from the "moments"'):
        mcgw.fitted_scene(fit, heights="nayak", use="summits")


def test_summits_of_the_map_have_the_heights_and_curvatures_of_the_scene(fit):
    """Density, spread, curvature, and that high summits are sharper: the law is that of such maps."""
    scene = mcgw.fitted_scene(fit, heights="nayak")
    counted = fit.summits.size / fit.area
    assert counted == pytest.approx(scene.surface.eta, rel=0.15)
    assert fit.summits.std() == pytest.approx(scene.surface.sigma, rel=0.15)
    curvatures = 1 / fit.radii
    geometric = 2.34902690068464 / 2.60588006348224 / scene.surface.radius
    assert curvatures.mean() == pytest.approx(geometric, rel=0.1)
    # High summits are sharper, as the joint law has it.
    high = fit.summits > np.quantile(fit.summits, 0.75)
    found = curvatures[high].mean() / curvatures.mean()
    s, ratios = scene.curvature.summits(np.random.default_rng(1), 200_000)
    expected = (1 / ratios[s > np.quantile(s, 0.75)]).mean() / (1 / ratios).mean()
    assert found == pytest.approx(expected, rel=0.05)
    assert expected > 1.1


def test_the_very_summits_carry_what_they_carry_literally(fit, tmp_path):
    scene = mcgw.fitted_scene(fit, heights="summits", E_star=70e9)
    ensemble = mcgw.run(mcgw.scene_from(mcgw.scene_text(scene)), tmp_path / "summits.h5")
    assert scene.surface.radius == pytest.approx(1 / np.mean(1 / fit.listed.radii), rel=1e-12)
    d = scene.surface.sigma * np.array(scene.separations)
    exact = summit_contact(fit.listed.heights, fit.listed.radii, 70e9, d)
    for name in ("load", "area", "stiffness", "contacts"):
        np.testing.assert_allclose(ensemble[name], getattr(exact, name), rtol=1e-11)
    assert exact.load[0, 0] > 0
