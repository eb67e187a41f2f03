"""What a fit knew goes with its scene, and figures are stated on maps of the kind that was solved alone."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest

import mcgw
from mcgw.cli import main
from mcgw.maps import Topography

FOLDER = Path(__file__).parents[2] / "runs" / "validation"
sys.path.insert(0, str(FOLDER))

import fitted_maps  # noqa: E402
import rough_maps  # noqa: E402

sys.path.remove(str(FOLDER))

COLUMNS = ("area", "stiffness", "separation", "load")


def fit_of(make, seed=1, shortest=32):
    """A map of 256 x 256 points, alpha about 4, a millimetre wide."""
    base = rough_maps.GaussianMap(0.8, 4, seed, shortest)
    z = make(base)
    n = len(z)
    return mcgw.fit(Topography(1e-6 * (z - z.mean()) / z.std(), (1e-3 / n,) * 2, periodic=True), cutoff=None)


@pytest.fixture(scope="module")
def fit():
    return fit_of(fitted_maps.plain)


@pytest.fixture(scope="module")
def scene(fit):
    return mcgw.fitted_scene(fit, E_star="1 GPa", separations=[1.0, 1.5], n_surfaces=3)


NOT_GAUSSIAN = {
    "lay 4 : 1": (fitted_maps.with_lay, "lay, mean square slopes"),
    "plateau-honed": (fitted_maps.honed, "skewness -"),
    "lognormal": (fitted_maps.lognormal, "skewness "),
}


@pytest.mark.parametrize("name", NOT_GAUSSIAN)
def test_nothing_is_stated_on_maps_of_another_kind(name):
    """And something was, while the scene did not know of its map."""
    make, word = NOT_GAUSSIAN[name]
    fit = fit_of(make)
    for heights in ("gaussian", "nayak"):
        scene = mcgw.fitted_scene(fit, heights=heights, E_star="1 GPa")
        found = scene.validity()
        assert not found.measured.any()
        assert found.unknown.startswith(f"not measured: the map is not isotropic and Gaussian ({word}")
        assert "%" not in found.verdict + found.brief
    if not name.startswith("lay"):
        assert mcgw.fitted_scene(fit, E_star="1 GPa", fitted=None).validity().measured.any()


# Of many independent heights; of few, chance allows 0.2 of kurtosis.
MANY = {"independent": 1e9, "skewness": 0.0, "kurtosis": 3.0}
LIMITS = {
    "lay": lambda f: MANY | {"lay": 1.5 * f},
    "agreement": lambda f: MANY | {"agreement": 1.1 * f},
    "skewness": lambda f: MANY | {"skewness": -0.05 * f},
    "kurtosis": lambda f: MANY | {"kurtosis": 3 + 0.1 * f},
    "kurtosis by chance": lambda f: MANY | {"independent": 2400.0, "kurtosis": 3 - 0.2 * f},
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_map_is_like_those_that_were_solved_up_to_a_limit(scene, name):
    for f, known in ((0.995, True), (1.005, False)):
        fitted = replace(scene.fitted, lay=None, agreement=1.0)
        found = scene.replace(fitted=replace(fitted, **LIMITS[name](f))).validity()
        assert found.measured.any() == known
        assert (name.split()[0] in found.unknown.replace("moments and counts", "agreement")) != known


def test_a_surface_is_that_of_its_map_up_to_a_tenth(scene):
    sigma = scene.fitted.moments.sigma
    fitted = replace(scene.fitted, **MANY, lay=None, agreement=1.0)
    plain = scene.replace(fitted=fitted, eta=fitted.moments.eta, radius=fitted.moments.radius)
    for ratio, known in ((1.0995, True), (1.1005, False), (1 / 1.0995, True), (1 / 1.1005, False)):
        found = plain.replace(sigma=ratio * sigma).validity()
        assert ("differs from that of the map by a factor of 1.1" in found.unknown) != known


def test_alpha_is_the_maps_own(fit, scene):
    """Of counted summits eta R sigma would guess another one."""
    told = f"alpha = {fit.numbers['alpha'].value:.3g} "
    assert scene.fitted.moments.alpha == pytest.approx(fit.numbers["alpha"].value, rel=1e-12)
    assert 1.0 < scene.fitted.agreement == fit.agreement < 1.1
    few = scene.replace(fitted=replace(scene.fitted, agreement=None)).validity()
    assert "too few summits" in few.verdict
    where, guessed = (s.validity().where for s in (scene, scene.replace(fitted=None)))
    assert f"{told}from the fit" in where
    assert "as eta R sigma" in guessed
    assert told not in guessed


@pytest.mark.usefixtures("blank_figures", "one_pressure")
def test_cautions_of_a_fit_travel_the_gravest_first(fit, tmp_path, capsys):
    """Of five that were found three are shown, wherever the scene of the fit comes to light."""
    lines = tuple(f"{word}: told" for word in ("spikes", "lay", "skewness", "overlap", "waves"))
    scene = mcgw.fitted_scene(replace(fit, cautions=lines), separations=[1.0], n_surfaces=3, grading=None)
    text = mcgw.scene_text(scene)
    source, file, page = (str(tmp_path / name) for name in ("s.toml", "s.h5", "s.html"))
    assert mcgw.scene_from(text).fitted.cautions == lines
    (tmp_path / "s.toml").write_text(text)
    mcgw.save(mcgw.simulate(scene), file)
    kept = mcgw.open_ensemble(file).scene
    assert kept.fitted == scene.fitted
    assert kept.validity().verdict == scene.validity().verdict
    for words in (
        ["show", file], ["solve", source, "--pressure", "1MPa", "-v"], ["report", file, "-o", page, "-v"],
    ):  # fmt: skip
        assert main(words) == 0, words
        told = "".join(capsys.readouterr())
        for line in lines[:3]:
            assert told.count(f"fit: {line}") == 1, words
        assert "(and 2 more under [fitted] in the scene)" in told
    assert "fit: skewness: told (and 2 more" in (tmp_path / "s.html").read_text()


SOLVES = fitted_maps.read()


@pytest.mark.slow
def test_of_the_figures_of_all_fresh_maps_one_in_twenty_is_false_at_most():
    found = [
        one
        for each in fitted_maps.MAPS
        for one in fitted_maps.stated(each.name, each.heights(), SOLVES[each.name])
    ]
    assert {one.map.partition(",")[0] for one in found} == {"isotropic"}
    assert len(found) >= 144
    assert sum(one.false for one in found) <= 0.05 * len(found)
    halved = [replace(one, said=one.said / 2) for one in found]  # as one standard deviation was
    assert sum(one.false for one in halved) > 0.05 * len(found)
