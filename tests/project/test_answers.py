"""Whole results in Python, held to what they were when they were recorded; `--record` writes them anew.

Other tests hold numbers to what is true. This one sees that nothing else moves: each number and field of
scenes, ensembles, comparisons, theory and fits, as lines of `tests/answers/`. Numbers may differ in their
last digit, nothing else may. Whoever means a change records it, and reads the difference.
"""

import numpy as np
import pytest
from oracles.told import ANSWERS, answers, lines
from scipy import stats

import analytic
import mcgw
from mcgw.maps import Topography, gaussian_map, spectrum_from

SCENES = {path.stem: path.read_text() for path in sorted((ANSWERS / "scenes").glob("*.toml"))}
# --- results in Python ------------------------------------------------------------------------------------


# Long, or said elsewhere in the record.
APART = {"ensemble", "labelled", "plot", "replace", "scene", "series", "sheet", "surfaces_of"}
APART |= {"alone", "area", "conductance", "contacts", "interval", "load", "mean", "stiffness"}
APART |= {"sums", "tables", "theory"}


@pytest.mark.parametrize("name", SCENES)
def test_results_in_python(name, recorded):
    scene = mcgw.scene_from(SCENES[name])
    ensemble = mcgw.simulate(scene)
    asked = {"quantity": scene.quantities, "share": [0.1]}
    things = [scene, ensemble, mcgw.compare(ensemble)]
    told = (line for thing in things for line in (*answers(thing, APART, **asked), *str(thing).splitlines()))
    recorded(f"{name}.results", told)


@pytest.mark.parametrize("name", SCENES)
def test_theory(name, recorded):
    scene = mcgw.scene_from(SCENES[name])
    asked = {"quantity": scene.quantities, "h": [np.array(scene.separations)], "piece": [0, 1]}
    recorded(f"{name}.theory", answers(scene.theory, {"asperities", "distribution", "cumulants"}, **asked))


# --- parts of the theory ----------------------------------------------------------------------------------

PARTS = {
    "gaussian": analytic.Gaussian(),
    "exponential": analytic.ExponentialHeights(),
    "weibull": analytic.Weibull(5.0),
    "nayak": analytic.Nayak(4.0),
    "table of heights": analytic.HeightTable([-1.0, 0.0, 0.5, 2.0], [0.0, 0.4, 0.7, 1.0]),
    "measured heights": analytic.MeasuredHeights([0.0, 1.0, 1.5, 4.0]),
    "gamma": analytic.ScipyHeights(stats.gamma(4.0)),
    "own radii": analytic.RandomCurvature(4.0),
    "graded": analytic.Exponential(2.0),
    "table of moduli": analytic.Table([0.0, 1.0, 2.0], [1.0, 3.0, 2.0]),
    "kogut-etsion": analytic.KogutEtsion(critical=0.05),
    "chang-etsion-bogy": analytic.ChangEtsionBogy(critical=0.05),
    "zhao-maietta-chang": analytic.ZhaoMaiettaChang(critical=0.05),
    "jackson-green": analytic.JacksonGreen(critical=0.05, yield_strain=0.004),
    "coated": analytic.Coated(reduced_thickness=0.5, ratio=3.0),
    "power-law-graded": analytic.PowerLawGraded(k=0.5, reduced_c0=1.0),
    "jkr": analytic.JohnsonKendallRoberts(pull_off=0.3),
    "dmt": analytic.DerjaguinMullerToporov(pull_off=0.3),
}


@pytest.mark.parametrize("name", PARTS)
def test_parts_of_the_theory(name, recorded):
    s, y, e = np.linspace(-2.0, 3.5, 12), np.linspace(0.05, 1.5, 12), np.linspace(0.5, 2.0, 12)
    asked = {"s": [s], "t": [s + 0.7], "g": [y + 0.1], "y": [y], "e": [e], "power": [1.5], "piece": [0, 1]}
    asked |= {"p": [np.array([1e-9, 0.01, 0.4, 0.9])], "deepest": [2.0]}
    part = PARTS[name]
    called = lines(part(s)) if callable(part) else ()
    recorded(f"theory.{name.replace(' ', '-')}", [*answers(part, **asked), *called])


# --- maps -------------------------------------------------------------------------------------------------

STEPS = {
    "plain": {"cutoff": "3 um"},
    "uncut": {"cutoff": None, "form": "none"},
    "cubic": {"cutoff": "3 um", "form": "cubic", "trim": 3},
    "quadratic": {"cutoff": "3 um", "form": "quadratic"},
    "holes": {"cutoff": "3 um", "missing": "fill"},
    "masked": {"cutoff": "3 um", "missing": "mask", "parts": 3},
    "spikes": {"cutoff": "3 um", "spikes": "remove"},
    "lines": {"cutoff": "3 um", "lines": "rows"},
}


@pytest.fixture(scope="module")
def heights():
    """A map that is not square, of pixels that are not: flawed where a step asks for it."""
    spectrum = spectrum_from("rms=0.3um,long=25um,short=3um")
    return gaussian_map(spectrum, (96, 128), (1e-6, 0.8e-6), np.random.default_rng(7))


@pytest.mark.parametrize("name", STEPS)
def test_fits_of_maps(name, heights, recorded):
    z, size, rng = heights.heights.copy(), heights.size, np.random.default_rng(3)
    if name in ("holes", "masked"):
        z[20:26, 40:50] = np.nan
    elif name == "spikes":
        z[10::30, 15::40] += 2e-5
    elif name == "lines":
        z += 1e-7 * rng.normal(size=(len(z), 1))
    fit = mcgw.fit(Topography(z, size), **STEPS[name])
    text = [mcgw.scene_text(mcgw.fitted_scene(fit))] if name == "plain" else []
    recorded(f"fit.{name}", [*answers(fit, {"plot", "sheet", "curvatures", "summits"}), str(fit), *text])
