"""The door: what a person types in a notebook works, is found by completion, and wrong words are told."""

import ast
import doctest
import pkgutil
import pydoc
import re
import rlcompleter
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import scipy.stats
from oracles.scenes import scene_by

import analytic
import mcgw
from mcgw.maps import gaussian_map, spectrum_from, write_map
from mcgw.statistics import tradeoff

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")

# What the design promises, word for word.
NOTEBOOK = """
import mcgw, numpy as np
surface = mcgw.Surface(sigma="1.37 um", radius="13 um", eta=3e8, nominal_area="1 cm^2", E_star="78.6 GPa")   # floats are SI
scene = mcgw.Scene(surface, separations=np.linspace(0, 4, 41), grading=mcgw.Exponential(2.0), seed=1)        # any array; a number is one separation
e = mcgw.simulate(scene, n_surfaces=1000)                 # in memory; keywords replace fields of the scene
e = mcgw.run(scene, "demo.h5")                            # in a file: goes on, extends, honours rel_err, executor=, shard="2/8"
e                                                         # at most a dozen lines; a table in a notebook
e["load"], e.load, e.mean("pressure"), e.interval("area_fraction")
e.to_xarray(), e.to_dataframe()
mcgw.compare(e), mcgw.solve(scene, pressure="1 MPa"), mcgw.converge(scene), mcgw.tradeoff(scene), mcgw.fit("map.h5", cutoff="5 um")
scene.replace(nominal_area="10 cm^2")                     # N follows, unless it was given
mcgw.Scene(surface, separations=2.0, grading=lambda s: 1 + 0.3*np.tanh(s), heights=scipy.stats.lognorm(0.3))  # any callable, any frozen scipy law; files hold it too
scene.theory.mean("load", h)                              # the exact model of this very scene
"""  # noqa: E501


@pytest.fixture
def map_file(tmp_path, monkeypatch):
    """A folder with ``map.h5``, and a study that takes a second, of two ways."""
    spectrum = spectrum_from("rms=1um,long=100um,short=8um")
    z = gaussian_map(spectrum, (256, 256), (1e-6, 1e-6), np.random.default_rng(1))
    write_map(z, tmp_path / "map.h5")
    monkeypatch.setattr(tradeoff, "SECONDS", 0.1)
    monkeypatch.setattr(tradeoff, "sampled_ways", lambda scene: ["tail"])


STUDIES = ', mcgw.converge(scene), mcgw.tradeoff(scene), mcgw.fit("map.h5", cutoff="5 um")'
SMALL = NOTEBOOK.replace(STUDIES, "").replace("4, 41", "4, 5").replace("=1000", "=100")
SMALL = SMALL.replace("seed=1)", "seed=1, n_surfaces=100)")


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_the_notebook_runs(whole, capsys, tmp_path, in_tmp_path, request):
    """Every line as in an interpreter that shows what it is given; the numbers against each other.

    Word for word in the slow tier; else of fewer surfaces and separations, and without studies and maps.
    """
    for package in ("xarray", "pandas"):
        pytest.importorskip(package)
    if whole:
        request.getfixturevalue("map_file")
    names = {"scipy": scipy, "h": [0.0, 2.0]}
    shown = []
    for line in ast.parse(NOTEBOOK if whole else SMALL).body:
        if isinstance(line, ast.Expr):
            shown.append(eval(compile(ast.Expression(line.value), "notebook", "eval"), names))
        else:
            exec(compile(ast.Module([line], []), "notebook", "exec"), names)
    scene, e = names["scene"], names["e"]
    ensemble, values, _, results, larger, custom, theory = shown
    assert ensemble is e
    np.testing.assert_array_equal(e.load, mcgw.simulate(scene, n_surfaces=1000 if whole else 100).load)
    np.testing.assert_array_equal(values[0], values[1])
    np.testing.assert_array_equal(values[2], e.mean("load") / 1e-4)
    assert np.all(values[3][0] <= e.mean("area") / 1e-4)
    comparison, solution, *studies = results
    assert comparison.verdict.agrees
    assert solution.amount == pytest.approx(100, rel=1e-15)
    if whole:
        convergence, study, fit = studies
        assert convergence.passed
        assert {"theory", "exact law"} < {way.name for way in study.ways}
        assert set(fit.estimates) >= {"moments", "summits"}
    assert (scene.n_asperities, larger.n_asperities) == (30_000, 300_000)
    assert custom.separations == (2.0,)
    assert mcgw.compare(mcgw.simulate(custom, n_surfaces=200, seed=3)).verdict.agrees
    np.testing.assert_array_equal(theory, scene.theory.mean("load", [0.0, 2.0]))
    np.testing.assert_allclose(theory, analytic.load(scene.surface, [0.0, 2.0], scene.grading), rtol=1e-14)
    for result in (e, *results):
        assert len(repr(result).splitlines()) <= 12
        assert "<table>" in result._repr_html_()
    assert capsys.readouterr() == ("", "")  # nothing is printed that was not asked for


# --- what is found --------------------------------------------------------------------------------------


def test_the_public_names_are_what_completion_shows():
    """Whatever was imported of the packages inside, and without importing anything by looking."""
    names = dir(mcgw)
    for module in pkgutil.walk_packages(mcgw.__path__, "mcgw."):
        if not module.name.endswith("__main__"):
            import_module(module.name)
    assert dir(mcgw) == names
    found = rlcompleter.Completer({"mcgw": mcgw}).attr_matches("mcgw.Sc")
    assert found[:2] == ["mcgw.Scene(", "mcgw.SceneError("]
    assert not [name for name in names if type(getattr(mcgw, name)) is type(mcgw)]
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        mcgw.simulat  # noqa: B018 - it is not there


def test_help_is_a_map_of_the_names():
    named = set(re.findall(r"`(\w+)`", mcgw.__doc__))
    assert named == set(dir(mcgw))
    page = pydoc.plain(pydoc.render_doc(mcgw))
    assert all(name in page for name in dir(mcgw))
    assert "Draw surfaces:" in page
    assert len(page.splitlines()) < 150  # the help of each name is that of the name


@pytest.mark.parametrize("name", dir(mcgw))
def test_help_of_every_name_has_an_example(name):
    """That names it; that it runs is what the doctests of its module are for."""
    thing = getattr(mcgw, name)
    examples = doctest.DocTestParser().get_examples(thing.__doc__ or "")
    assert any(name in f"{x.source}{x.want}{x.exc_msg}" for x in examples)
    module = sys.modules[thing.__module__]
    assert Path(module.__file__).is_relative_to(Path(mcgw.__file__).parent.parent)


# --- arguments --------------------------------------------------------------------------------------------


def problems(call):
    with pytest.raises(mcgw.SceneError) as caught:
        call()
    assert isinstance(caught.value, ValueError)
    assert all("\n" not in line and len(line) < 300 for line in caught.value.problems)
    return caught.value.problems


def scene(**changes):
    return scene_by(**({"surface": SURFACE, "separations": [0.0, 1.0], "seed": 1} | changes))


def test_all_mistakes_are_told_at_once():
    said = problems(lambda: scene(separations="x", grading=3, n_surfaces=0, sampler="cell"))
    assert [line.split(" = ")[0] for line in said] == [
        "grading.law", "contact.separations", "ensemble.n_surfaces", "ensemble.sampler",
    ]  # fmt: skip
    said = problems(lambda: mcgw.Surface(-1, "13 N", 3e8, 1e-6, 1e9))
    assert [line.split(" = ")[0] for line in said] == ["surface.sigma", "surface.radius"]


def test_separations_in_any_clothes():
    pandas = pytest.importorskip("pandas")
    for given in (
        np.array([0.0, 1.0]), [0, 1], (0.0, 1.0), range(2), [np.float64(0), np.int32(1)],
        pandas.Series([0.0, 1.0]), {"start": 0.0, "stop": 1.0, "num": 2}, np.arange(2),
        np.array([0, 1], dtype=np.float32),
    ):  # fmt: skip
        assert scene(separations=given) == scene()
        assert scene().replace(separations=given) == scene()
    for one in (1, 1.0, np.float64(1), np.array(1.0), np.int64(1)):
        assert scene(separations=one).separations == (1.0,)
    assert scene(n_surfaces=np.int64(7), seed=np.uint64(2**63)).seed == 2**63
    assert scene(rel_err="1 %", max_seconds="2 min").max_seconds == 120
    assert scene(quantities=np.array(["load"])).quantities == ("load",)


def test_a_seed_that_nobody_gives_is_drawn_and_recorded(tmp_path):
    one, other = (mcgw.Scene(SURFACE, separations=1.0, n_surfaces=8) for _ in range(2))
    assert one.seed != other.seed
    assert one.replace(title="t").seed == one.seed
    assert one.replace(seed=None).seed != one.seed
    first = mcgw.run(one, tmp_path / "e.h5")
    load = first.load
    again = mcgw.run(other, tmp_path / "e.h5", n_surfaces=16)  # goes on with the seed that is there
    assert again.scene.seed == first.scene.seed == one.seed
    np.testing.assert_array_equal(again.load[:8], load)
    with pytest.raises(mcgw.StoreError, match="seed"):
        mcgw.run(other.replace(seed=other.seed), tmp_path / "e.h5")


def test_none_leaves_a_field_out():
    fixed = scene(n_asperities=7, n_surfaces=3, grading=mcgw.Exponential(2.0), heights=mcgw.Weibull(2.0))
    assert fixed.replace(nominal_area="2 mm^2").n_asperities == 7
    free = fixed.replace(n_asperities=None, n_surfaces=None, grading=None, heights=None)
    assert free == scene()
    assert free.replace(nominal_area="2 mm^2").n_asperities == 600


def test_a_frozen_law_is_that_of_the_file():
    """Location and scale drop out; shapes by place or by name."""
    text = mcgw.scene_text(scene()).replace(
        '[heights]\nlaw = "gaussian"', '[heights]\nlaw = "scipy"\nname = "lognorm"\nshapes = {s = 0.3}'
    )
    wanted = mcgw.scene_from(text)
    for law in (
        scipy.stats.lognorm(0.3), scipy.stats.lognorm(0.3, 1.0),
        scipy.stats.lognorm(s=0.3, loc=2.0, scale=3e-6),
        mcgw.ScipyHeights(scipy.stats.lognorm(0.3, scale=7.0)),
    ):  # fmt: skip
        given = scene(heights=law)
        assert given == wanted
        assert mcgw.scene_from(mcgw.scene_text(given)) == given
        assert given.replace(title="t").heights is given.heights  # what it has found out is not lost
    np.testing.assert_array_equal(
        mcgw.simulate(given, n_surfaces=5).load, mcgw.simulate(wanted, n_surfaces=5).load
    )


def test_a_plain_function_is_custom():
    def tips(s):
        return np.where(s > 1.25, 1.5, 1.0)

    plain, told = scene(grading=tips), scene(grading=mcgw.Custom(tips, breaks=(1.25,)))
    assert plain.grading == mcgw.Custom(tips)
    for x in (plain, told):
        assert mcgw.compare(mcgw.simulate(x, n_surfaces=200)).verdict.agrees
    means = [x.theory.mean("load", [0.0, 1.0, 2.0]) for x in (plain, told)]
    np.testing.assert_allclose(*means, rtol=1e-11)
    swept = mcgw.sweep(scene(n_surfaces=50), {"grading": [mcgw.Homogeneous(), tips]})
    assert swept.scene(1).grading.name == "tips"  # the series of it
