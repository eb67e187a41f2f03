"""From a map or profiles to a scene whose summits have radii of their own."""

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.summits_by_hand import summit_contact

import analytic
import mcgw
from mcgw.cli import main
from mcgw.maps import Spectrum, gaussian_map

PIXEL, RNG = (1e-6, 1e-6), np.random.default_rng


@pytest.fixture(scope="module")
def fit():
    drawn = gaussian_map(Spectrum(1e-6, 80e-6, 12e-6), (256, 256), PIXEL, RNG(3))
    return fit_map(drawn, cutoff=None)


def test_a_scene_of_a_fit_takes_what_scenes_have(fit):
    """The same as afterwards; what is wrong is told as it is there."""
    plain = mcgw.fitted_scene(fit, heights="nayak", E_star="70 GPa")
    changes = {
        "grading": mcgw.Exponential(2.0),
        "nominal_area": "4 mm^2",
        "joint": mcgw.Joint(resistivity=0.1),
    }
    made = mcgw.fitted_scene(fit, heights="nayak", E_star="70 GPa", **changes)
    assert made == plain.replace(**changes) != plain
    assert made.heights == analytic.Nayak(fit.moments.alpha)
    assert made.surface.nominal_area == 4e-6
    assert made.n_asperities == round(made.surface.eta * 4e-6)
    with pytest.raises(mcgw.SceneError, match="n_surfaces = -1"):
        mcgw.fitted_scene(fit, n_surfaces=-1)
    with pytest.raises(TypeError, match="gradient"):
        mcgw.fitted_scene(fit, gradient=2.0)


@pytest.mark.parametrize(("asked", "told"), [
    ({"heights": "nayak", "use": "summits"}, 'use = "summits": heights = "nayak" follow from the "moments"'),
    ({"heights": "measured", "use": "moments"}, "measured heights as they are need use = .summits"),
    ({"heights": "measured", "nominal_area": 1}, 'nominal_area = 1: heights = "measured" uses the measured'),
    ({"heights": "summits", "nominal_area": 1}, 'nominal_area = 1: heights = "summits" uses the measured'),
])  # fmt: skip
def test_estimates_that_do_not_suit_the_heights_are_refused(asked, told, fit):
    with pytest.raises(ValueError, match=told):
        mcgw.fitted_scene(fit, **asked)


def test_the_very_summits_carry_what_they_carry_literally(fit, tmp_path):
    scene = mcgw.fitted_scene(fit, heights="summits", E_star=70e9)
    ensemble = mcgw.run(mcgw.scene_from(mcgw.scene_text(scene)), tmp_path / "summits.h5")
    assert scene.surface.radius == pytest.approx(1 / np.mean(1 / fit.listed.radii), rel=1e-12)
    d = scene.surface.sigma * np.array(scene.separations)
    exact = summit_contact(fit.listed.heights, fit.listed.radii, 70e9, d)
    for name in ("load", "area", "stiffness", "contacts"):
        np.testing.assert_allclose(ensemble[name], getattr(exact, name), rtol=1e-11)
    assert exact.load[0, 0] > 0


@pytest.mark.parametrize("law", ["gaussian", "nayak", "table"])
def test_a_larger_area_has_more_summits(law, tmp_path, in_tmp_path):
    """In a file that is changed by hand, as an option and as an argument."""
    np.save("map.npy", gaussian_map(Spectrum(1e-6, 40e-6, 12e-6), (96, 96), PIXEL, RNG(1)).heights)
    command = ["fit", "map.npy", "--pixel", "1um", "--cutoff", "none", "--heights", law, "-o"]
    assert main([*command, "f.toml"]) == 0
    before, text = mcgw.load_scene("f.toml"), (tmp_path / "f.toml").read_text()
    (line,) = [line for line in text.splitlines() if line.startswith("nominal_area =")]
    (tmp_path / "f.toml").write_text(text.replace(line, 'nominal_area = "1 cm^2"'))
    after = mcgw.load_scene("f.toml")
    assert after.surface.nominal_area == 1e-4
    assert after.n_asperities == round(before.surface.eta * 1e-4) > 1000 * before.n_asperities
    assert after.replace(nominal_area=before.surface.nominal_area) == before
    assert main([*command, "g.toml", "--nominal-area", "0.5 mm^2"]) == 0
    found = mcgw.fitted_scene(mcgw.fit("map.npy", cutoff=None, pixel="1 um"), heights=law, nominal_area=5e-7)
    for one in (mcgw.load_scene("g.toml"), found):
        assert one.surface.nominal_area == 5e-7
        assert one.n_asperities == pytest.approx(before.surface.eta * 5e-7, rel=1e-3)
        assert type(one.heights) is type(found.heights)
