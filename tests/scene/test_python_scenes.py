"""What Python gives beyond files: gradings and height laws as functions, objects, texts with units, seeds."""

import re

import numpy as np
import pytest
import scipy.stats
from oracles.begun_runs import SIZE, digest, halted, in_small_blocks
from oracles.inside import storable
from oracles.scenes import scene_by
from scipy.integrate import quad

import analytic
import mcgw

SURFACE = mcgw.Surface("1 um", "10 um", "1000/mm^2", "1 mm^2", "100 GPa")


def bent(s):
    """A kink that nobody tells of."""
    return 1 + 0.3 * np.abs(s - 0.777)


def smooth(s):
    return 1 + 0.3 * np.tanh(s)


@pytest.fixture
def make(make_scene):
    def of(grading=smooth, **changes):
        values = {"separations": (2.0, 0.5, 3.0), "n_surfaces": 60, "sampler": "cells", "grading": grading}
        return make_scene(**(values | changes))

    return of


# --- functions --------------------------------------------------------------------------------------------


def test_other_last_digits_go_on_and_another_function_does_not(make, tmp_path, monkeypatch):
    """As where another processor evaluates the function: the run keeps the series that it began with."""
    in_small_blocks(monkeypatch)
    path = tmp_path / "e.h5"
    mcgw.run(make(), tmp_path / "whole.h5")
    halted(make(), path, SIZE)

    def elsewhere(s):
        return smooth(s) * (1 + 4e-16 * np.sign(np.sin(1e3 * s)))

    assert storable(make(elsewhere)).grading != storable(make()).grading
    with pytest.raises(mcgw.StoreError, match=r"holds a different run: grading\.coefficients is "):
        mcgw.run(make(lambda s: 1 + (0.3 + 1e-11) * np.tanh(s)), path)
    mcgw.run(make(elsewhere), path)
    assert digest(path) == digest(tmp_path / "whole.h5")
    mcgw.run(make(elsewhere, n_surfaces=70), path)
    with pytest.raises(mcgw.StoreError, match="holds a different ensemble: grading"):
        mcgw.run(make(np.cosh, n_surfaces=80), path)


def test_laws_of_python_are_shown_and_written_by_name(make):
    scene = make(bent, heights=scipy.stats.lognorm(0.3), quantities=("load",))
    shown = repr(mcgw.simulate(scene))
    assert re.search(r"grading +PiecewiseSeries\('bent', \d+ pieces from s = 0.5 to ", shown)
    assert "scipy.stats.lognorm(s=0.3)" in shown
    assert 'law = "scipy"\nname = "lognorm"' in mcgw.scene_text(scene)


def test_series_are_taken_where_they_reach_and_noise_is_none(make):
    with pytest.raises(mcgw.SceneError, match=r"^grading: not resolved by .* pieces near s = [^\n]*$"):
        make(lambda s: 1 + 1e-3 * np.modf(np.sin(1e9 * s) * 1e5)[0])
    known = storable(make())
    assert known.replace(separations=(1.0, 3.0)).grading == known.grading
    with pytest.raises(mcgw.SceneError, match=r"^grading\.edges: the series reach from s = 0\.5 .*give the"):
        known.replace(separations=(-1.0, 3.0))
    with pytest.raises(mcgw.SceneError, match=r"^grading\.edges: "):
        known.replace(heights=scipy.stats.lognorm(0.9))


@pytest.mark.parametrize(
    ("given", "end"), [(scipy.stats.pearson3(-1.2), 2 / 1.2), (scipy.stats.triang(0.0), 2 * np.sqrt(2))]
)
def test_a_density_ends_where_scipy_does_not_say(given, end):
    heights = analytic.ScipyHeights(given)
    assert heights.support[1] == pytest.approx(end, rel=1e-9)
    h = end - 0.047
    exact = quad(lambda t: t**1.5 * float(heights.pdf(np.array(h + t))), 0, end - h, epsrel=1e-11, epsabs=0)
    unit = 1000 * 4 / 3 * 1e11 * 1e-5**0.5 * 1e-6**1.5
    load = analytic.Model(SURFACE, heights=heights).mean("load", h)
    assert float(load) == pytest.approx(unit * exact[0], rel=1e-9)
    assert analytic.ScipyHeights(scipy.stats.pearson3(0.8)).support == pytest.approx((-2.5, np.inf))
    assert analytic.ScipyHeights(scipy.stats.gumbel_l()).support[1] == np.inf


def test_shares_next_to_the_end_of_heights_are_found_where_scipy_has_none():
    """Of beta(2, 5), ``sf`` is 6 x^5 - 5 x^6 at x from the end; SciPy's ``isf(1e-290)`` is not a number."""
    heights, shares = analytic.ScipyHeights(scipy.stats.beta(2, 5)), np.array([1e-290, 1e-30, 1e-3])
    low, high = heights.support
    left = (high - heights.isf(shares)) / (high - low)
    np.testing.assert_allclose(6 * left**5 - 5 * left**6, shares, rtol=1e-8, atol=1e-70)
    surface = mcgw.Surface("1 um", "10 um", "3e10/m^2", "1 mm^2", "70 GPa")
    found = mcgw.solve(
        mcgw.Scene(surface, separations=1.0, heights=scipy.stats.beta(2, 5), n_surfaces=20), load=1e-6
    )
    assert found.value["load"] == pytest.approx(1e-6)
    assert high > found.theory["separation"] > 4.0


# --- objects, texts and seeds -----------------------------------------------------------------------------


def test_a_body_with_units():
    assert mcgw.Body("70 GPa", 0.33) == analytic.Body(70e9, 0.33) == mcgw.Body(70e9, nu=0.33)
    assert mcgw.composite_modulus([mcgw.Body("70 GPa", 0.5), mcgw.Body(np.inf)]) == pytest.approx(70e9 / 0.75)


COATED = analytic.Coated(ratio=2.0, thickness=1e-6, poisson=0.25)  # has a Poisson's ratio already


@pytest.mark.parametrize(
    ("law", "beside", "softer"),
    [
        ("hertz", {"hardness": "2 GPa", "poisson": 0.4}, (2e9, 0.4)),
        ("hertz", {"hardness": "2 GPa"}, (2e9, 0.3)),
        ({"name": "johnson-kendall-roberts", "pull_off": 0.01}, {"hardness": 2e9}, (2e9, 0.3)),
        (COATED, {"hardness": 2e9}, (2e9, 0.25)),
        ("kogut-etsion", {"hardness": "2 GPa", "poisson": 0.33}, None),  # its own
    ],
)
def test_a_hardness_beside_an_elastic_law_tells_whether_contacts_yield(law, beside, softer):
    found = scene_by(SURFACE, separations=[0.0, 1.0], law=law, seed=1, **beside)
    assert found.softer == softer
    assert mcgw.scene_from(mcgw.scene_text(found)) == found
    assert softer or found.law == analytic.KogutEtsion(hardness=2e9, poisson=0.33)


SOURCES = {
    "generator": np.random.default_rng,
    "old bits": lambda seed: np.random.Generator(np.random.MT19937(seed)),
    "bits": np.random.PCG64,
    "sequence": np.random.SeedSequence,
}


@pytest.mark.parametrize("name", SOURCES)
def test_a_seed_from_numpy(name, tmp_path):
    """It is drawn once and recorded; the next of a generator is another one, of a sequence the same."""
    source = SOURCES[name](7)
    scene = mcgw.Scene(SURFACE, separations=[1.0], n_surfaces=3, seed=source)
    assert type(scene.seed) is int
    assert scene.seed == scene.replace(seed=SOURCES[name](7)).seed
    (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
    assert scene == mcgw.load_scene(tmp_path / "s.toml", changes={"ensemble.seed": SOURCES[name](7)})
    assert (scene.replace(seed=source).seed == scene.seed) == (name == "sequence")


def test_a_part_may_be_given_by_its_keys():
    """Also by one that is called as its table, and a hardness that stands beside its law."""
    by_keys = {"heights": {"law": "table", "heights": [0.0, 1.0, 3.0]}, "contact": {"hardness": "2 GPa"}}
    found = mcgw.Scene(SURFACE, separations=1.0, seed=1, **by_keys)
    assert found.heights == analytic.HeightTable.of([0.0, 1.0, 3.0])
    assert found == mcgw.Scene(
        SURFACE, separations=1.0, seed=1, heights=found.heights, contact=mcgw.Contact(hardness=2e9)
    )


def test_a_spectral_surface_brings_its_summits_to_any_scene():
    spectral = mcgw.SpectralSurface(m0=1e-12, m2=1e-3, m4=5e6, nominal_area="1 mm^2", E_star="100 GPa")
    made, plain = (mcgw.Scene(surface, separations=1.0, seed=1) for surface in (spectral, SURFACE))
    assert plain.replace(surface=spectral) == made
    written = {"m0": 1e-12, "m2": 1e-3, "m4": 5e6, "nominal_area": "1 mm^2", "E_star": "100 GPa"}
    assert plain.replace(surface=written) == made
    other = plain.replace(surface=spectral, heights=analytic.Gaussian(), summits="mean")
    assert (other.heights, other.summits) == (plain.heights, plain.summits)
