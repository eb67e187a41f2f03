"""What a fit knew goes with its scene, and figures are stated on maps of the kind that was solved alone."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mcgw
from mcgw import SceneError
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


def sinh(base):
    """Symmetric heights with long tails both ways."""
    z = base.heights()
    return fitted_maps.smooth(np.sinh(0.6 * z / z.std()), base.shortest)


def diagonal(base):
    """A lay along a diagonal, which slopes along x and y do not tell: every second wave is left out."""
    series = np.fft.fft2(base.heights())
    k = np.fft.fftfreq(len(series))
    return np.fft.ifft2(np.where(np.outer(k, k) > 0, series, 0.3 * series)).real


NOT_GAUSSIAN = {
    "lay 4 : 1": (fitted_maps.with_lay, "lay, mean square slopes"),
    "lay along a diagonal": (diagonal, "lay, mean square slopes"),
    "plateau-honed": (fitted_maps.honed, "skewness -"),
    "lognormal": (fitted_maps.lognormal, "skewness "),
    "mirrored Weibull": (fitted_maps.weibull, "skewness -"),
    "symmetric": (sinh, "kurtosis "),
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


# Of many independent heights and of few, so that chance allows 0.1 of skewness and 0.2 of kurtosis.
MANY, FEW = {"independent": 1e9, "skewness": 0.0, "kurtosis": 3.0}, {"independent": 2400.0, "kurtosis": 3.0}
LIMITS = {
    "lay": lambda f: MANY | {"lay": 1.5 * f},
    "agreement": lambda f: MANY | {"agreement": 1.1 * f},
    "skewness": lambda f: MANY | {"skewness": -0.05 * f},
    "skewness by chance": lambda f: FEW | {"skewness": 0.1 * f},
    "skewness whatever the chance": lambda f: FEW | {"independent": 100.0, "skewness": 0.15 * f},
    "kurtosis": lambda f: MANY | {"kurtosis": 3 + 0.1 * f},
    "kurtosis by chance": lambda f: FEW | {"skewness": 0.0, "kurtosis": 3 - 0.2 * f},
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
    fitted = scene.fitted
    assert fitted.moments.alpha == pytest.approx(fit.numbers["alpha"].value, rel=1e-12)
    assert fitted.agreement == fit.agreement
    assert 1.0 < fitted.agreement < 1.1
    few = scene.replace(fitted=replace(fitted, agreement=None)).validity()
    assert "too few summits" in few.verdict
    where, guessed = (s.validity().where for s in (scene, scene.replace(fitted=None)))
    assert f"alpha = {fit.numbers['alpha'].value:.3g} from the fit" in where
    assert "as eta R sigma" in guessed
    assert f"alpha = {fit.numbers['alpha'].value:.3g} " not in guessed


def test_the_same_figures_where_the_guess_is_right(fit):
    """By moments eta R sigma is that of the map's alpha: what a scene of the same numbers says is said."""
    scene = mcgw.fitted_scene(fit, use="moments", separations=[1.0, 1.5])
    fitted = replace(scene.fitted, area=None)
    for name in COLUMNS:
        ours, plain = (scene.replace(fitted=x).validity() for x in (fitted, None))
        np.testing.assert_allclose(ours.error[name], plain.error[name], rtol=1e-9)
        np.testing.assert_allclose(ours.bias[name], plain.bias[name], rtol=1e-9)


def test_few_waves_widen_all_but_areas(scene):
    fewer = scene.replace(fitted=replace(scene.fitted, independent=scene.fitted.independent / 20))
    once, more = scene.validity(), fewer.validity()
    np.testing.assert_array_equal(once.error["area"], more.error["area"])
    for name in COLUMNS[1:]:
        assert (more.error[name] > 1.5 * (once.error[name] - np.abs(once.bias[name]))).all()
    larger = scene.replace(nominal_area=100 * scene.surface.nominal_area).validity()
    for name in COLUMNS:
        assert (larger.error[name] < once.error[name]).all()


@pytest.mark.usefixtures("blank_figures", "one_pressure")
def test_cautions_of_a_fit_travel_the_gravest_first(fit, tmp_path, capsys):
    """Of five that were found three are shown, wherever the scene of the fit comes to light."""
    lines = tuple(f"{word}: told" for word in ("spikes", "lay", "skewness", "overlap", "waves"))
    scene = mcgw.fitted_scene(replace(fit, cautions=lines), separations=[1.0], n_surfaces=3, grading=None)
    assert mcgw.scene_from(mcgw.scene_text(scene)).fitted.cautions == lines
    mcgw.save(mcgw.simulate(scene), tmp_path / "s.h5")
    kept = mcgw.open_ensemble(tmp_path / "s.h5").scene
    assert kept.fitted == scene.fitted
    assert kept.validity().verdict == scene.validity().verdict
    (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
    for command in ("show s.h5", "solve s.toml --pressure 1MPa", "report s.h5 -o s.html"):
        words = [str(tmp_path / word) if word.startswith("s.") else word for word in command.split()]
        assert main([*words, *["-v"] * (words[0] in ("report", "solve"))]) == 0, command
        out, err = capsys.readouterr()
        for line in lines[:3]:
            assert (out + err).count(f"fit: {line}") == 1, command
        assert "(and 2 more under [fitted] in the scene)" in out + err
    assert "fit: skewness: told (and 2 more" in (tmp_path / "s.html").read_text()


def test_python_takes_the_keys_of_the_file(scene):
    table = {key: value for key, value in vars(scene.fitted).items() if value is not None}
    assert scene.replace(fitted=table).fitted == scene.fitted
    with pytest.raises(SceneError, match=r"fitted\.m4: missing"):
        scene.replace(fitted={key: value for key, value in table.items() if key != "m4"})
    with pytest.raises(SceneError, match="fitted = 3: give the `fitted`"):
        scene.replace(fitted=3)


def test_profiles_tell_what_they_saw():
    z = 1e-6 * np.random.default_rng(5).standard_normal(4096)
    z = np.convolve(z, np.hanning(41), mode="same")
    fit = mcgw.fit(mcgw.maps.profile.Profile(z, 1e-6), cutoff=None)
    fitted = mcgw.fitted_scene(fit).fitted
    assert (fitted.lay, fitted.area) == (None, None)
    assert fitted.moments == fit.moments
    assert fitted.agreement == pytest.approx(max(fit.peaks) / min(fit.peaks))


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


@pytest.mark.site
def test_a_fresh_map_is_solved_anew():
    pytest.importorskip("tamaas")
    sys.path.insert(0, str(FOLDER))
    try:
        from boundary_elements import Solver
    finally:
        sys.path.remove(str(FOLDER))
    first = fitted_maps.MAPS[0]
    found, stored = Solver(first.heights()).at(fitted_maps.LOADS[0]), SOLVES[first.name][0]
    for key in ("area", "stiffness", "gap"):
        assert getattr(found, key) == pytest.approx(stored[key], rel=1e-3)
