"""What no other test meets: mistakes that few make, facts that few scenes have, statistics of values."""

import pickle

import numpy as np
import pytest

import analytic
import mcgw
from analytic.laws import crowding_factor
from mcgw.scene.measured import Uncertainty
from mcgw.statistics.comparison import verdict

SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")


def test_errors_of_a_fit_have_the_correlation_of_its_covariance():
    """0.006/(0.1 0.2) = 0.3 whatever the errors are; one of a factor of 7 says that nothing is known."""
    found = Uncertainty.correlated(
        ("sigma", "eta"), [0.25, 2.5], np.array([[0.01, 0.00600001], [0.00600001, 0.04]])
    )
    assert (found.names, found.sigma, found.eta) == (("sigma", "eta"), 0.25, 2.0)
    assert found.correlation == ((1.0, 0.3), (0.3, 1.0))
    np.testing.assert_allclose(found.covariance, [[0.0625, 0.15], [0.15, 4.0]], rtol=1e-15)


RADII = analytic.RandomCurvature(5.0)
PRESSED = analytic.Model(SPECTRAL.surface, interaction=analytic.Interaction("body"))
LISTED = {"n_asperities": 3, "n_surfaces": 1, "sampler": "direct"}
LISTED["heights"] = analytic.MeasuredHeights([0.0, 1.0, 3.0])
HEAT = {"conductivities": (200.0, 16.0)}
FILLED = {**HEAT, "gas": "air", "rms": "2 um"}
NAYAK = analytic.Nayak(5.0)
OWN = {"surface": SPECTRAL.surface, "summits": RADII, "heights": NAYAK}


def filled(scene):
    return scene.replace(joint=FILLED).theory


# Calls with a scene that are refused, by the word that names what is wrong.
REFUSED = {
    "nothing": lambda _: RADII.nothing,
    "density": lambda _: analytic.MeasuredHeights([0.0, 1.0]).pdf(np.ones(2)),
    "a sum that decreases": lambda _: PRESSED.alone.separation_law(2.0, "contacts"),
    "joint.film_resistance": lambda scene: scene.replace(joint={"film_resistance": 1e-12}),
    "one of them, in m": lambda scene: scene.replace(law={"name": "coated", "ratio": 2.0}),
    "contact.law.k: missing": lambda scene: scene.replace(law={"name": "power-law-graded", "c0": 1.0}),
    "conductance_si": lambda scene: scene.replace(quantities=["conductance_si"]),
    "no contact yields": lambda scene: scene.replace(quantities=["load", "yielded"]),
    "needs unloading": lambda scene: scene.replace(quantities=["load_unloading"]),
    "at most 100000": lambda scene: scene.replace(separations=np.zeros(100_001)),
    "threads = 0": lambda scene: mcgw.run(scene, "e.h5", threads=0),
    "threads = -1": lambda scene: mcgw.sweep(scene, {"grading.gamma": [1]}, path="s.h5", threads=-1),
    "ensemble.n_surfaces = 2": lambda scene: scene.replace(**LISTED | {"n_surfaces": 2}),
    "ensemble.count": lambda scene: scene.replace(**LISTED, count="poisson"),
    "ensemble.n_asperities = 4": lambda scene: scene.replace(**LISTED | {"n_asperities": 4}),
    "alpha = 5": lambda scene: scene.replace(**OWN | {"heights": analytic.Nayak(4.0)}),
    "is no axis": lambda scene: mcgw.sweep(scene, {"ensemble.seed": [1]}).slopes("load", "grading.gamma"),
    "give one for each": lambda scene: scene.replace(rel_err={"load": [1e-3, 1e-3]}),
    "value 2 is -1": lambda scene: scene.replace(rel_err={"load": [1e-3, -1.0, 1e-3]}),
    "need heights.law": lambda scene: scene.replace(uncertainty={"m0": 0.1}),
    "rows of": lambda scene: scene.replace(uncertainty={"sigma": 0.1, "correlation": [[1, 0], [0, 1]]}),
    "joint.gas = 'air': give conductivities too": lambda scene: scene.replace(joint={"gas": "air"}),
    "joint.rms: give the root mean square": lambda scene: scene.replace(joint={**HEAT, "gas": "air"}),
    "joint.rms = 1e-06: give more than sigma": lambda scene: scene.replace(joint={**FILLED, "rms": "1 um"}),
    "joint.rms = 2e-06: it follows from": lambda scene: scene.replace(heights=NAYAK, joint=FILLED),
    "joint.layer": lambda scene: scene.replace(layer=analytic.Layer(1e-5, 1.3)),
    "this model has no gas": lambda scene: scene.replace(joint=HEAT).theory.mean("thermal_resistance", 1.0),
    "only 'joint_conductance' is": lambda scene: filled(scene).distribution("gap_conductance", 1.5),
    "give a load, an area or another": lambda _: PRESSED.separation_at("stiffness", 1.0),
    "another sum of asperities": lambda scene: filled(scene).separation_at("gap_conductance", 1.0),
    "'nominal_separation': this model has": lambda scene: scene.theory.std("nominal_separation", 1.0),
    "a number from 0 to 2": lambda scene: mcgw.solve(scene, load=1.0).heights(3),
    "it needs [interaction] reference = ": lambda scene: mcgw.solve(scene, nominal_separation=1.0),
    "surface = -1: give": lambda scene: mcgw.solve(scene, load=1.0).heights(-1),
    "progress = 'bar': give True, or a function": lambda scene: mcgw.simulate(scene, progress="bar"),
    "mean load at d/sigma = 60 is 0": lambda scene: mcgw.tradeoff(scene.replace(separations=60.0)),
    "measured heights are summed exactly": lambda scene: mcgw.tradeoff(scene.replace(**LISTED)),
    "'torque' is not a quantity; give one of load": lambda scene: scene.theory.mean("torque", 1.0),
    "'area_fraction' is not in this ensemble; it has load": lambda scene: mcgw.simulate(
        scene, quantities=["load"]
    ).interval("area_fraction"),
    "eigenvalue": lambda scene: scene.replace(
        uncertainty=dict.fromkeys(("sigma", "eta", "radius"), 0.1)
        | {"correlation": [[1, 1, -1], [1, 1, 1], [-1, 1, 1]]}
    ),
}


@pytest.mark.parametrize("word", REFUSED)
def test_what_is_refused_is_named_in_one_line(word, make_scene):
    with pytest.raises((ValueError, KeyError, AttributeError)) as caught:
        REFUSED[word](make_scene(n_surfaces=3, separations=(0.0, 1.0, 2.0)))
    assert word in str(caught.value)
    assert "\n" not in str(caught.value)


SURFACE = SPECTRAL.surface
BACK = analytic.Model(SURFACE, law=mcgw.KogutEtsion(critical=0.05), unload_from=0.5)
# What is made of a number, those at either end that it may be, and what it may not be.
LIMITS = {
    "power": (lambda x: RADII.mean(x, np.zeros(1)), [0, 3.5], [-0.5, 4.0]),
    "power of bounded radii": (lambda x: analytic.RandomCurvature(5.0, 3.0).mean(x, np.zeros(1)), [4], [-1]),
    "shape": (analytic.Weibull, [1, 100], [0.999, 100.1, np.nan]),
    "alpha": (analytic.Nayak, [1.501, 1e12], [1.5009, 1.01e12]),
    "E": (lambda x: analytic.Body(x, 0.3), [1e-300, np.inf], [0.0, np.nan]),
    "nu": (lambda x: analytic.Body(1e9, x), [-1, 0.5], [-1.001, 0.501]),
    "n": (lambda x: analytic.fn(x, 0.0), [0], [-1e-9, np.inf]),
    "n_asperities": (lambda x: analytic.Model(SURFACE, n_asperities=x), [1e-9], [0.0, np.inf]),
    "h": (lambda x: BACK.mean("load_unloading", x), [0.5], [0.4999]),
    "bulk_modulus": (lambda x: analytic.Interaction("body", bulk_modulus=x), [1e-300], [0.0, np.inf]),
    "rms": (lambda x: analytic.Joint("air", rms=x).gap(SURFACE, analytic.Gaussian()), [1.01 * SURFACE.sigma],
            [SURFACE.sigma]),
    "k": (lambda x: mcgw.PowerLawGraded(x, reduced_c0=1.0), [0, 0.999], [-1e-9, 1]),
    "film_resistance": (lambda x: analytic.Film(1.0, x), [0.0], [-1e-30, np.inf]),
    "area_fraction": (crowding_factor, [0.0, 0.999], [-1e-9, 1.0]),
    "terms": (lambda x: analytic.PiecewiseSeries([0, 1], [np.ones(x)]), [1, 64], [0, 65]),
    "pieces": (lambda x: analytic.PiecewiseSeries(range(x + 1), x * [[1.0]]), [1, 4096], [0, 4097]),
    "std_over_mean": (lambda x: analytic.Model(SURFACE).asperities_for("load", 1.0, x), [1e-9], [0, np.inf]),
}  # fmt: skip


@pytest.mark.parametrize("name", LIMITS)
def test_numbers_at_their_limits_are_taken_and_those_beyond_are_not(name):
    make, taken, refused = LIMITS[name]
    for x in taken:
        make(x)
    for x in refused:
        with pytest.raises(ValueError, match=r"give|must|smaller than"):
            make(x)


def test_the_other_separation_is_as_sure_as_the_load(pressed):
    """Where asperities feel the separations of the scene, nominal ones differ by a multiple of the load."""
    ensemble = mcgw.simulate(pressed(3.0, n_surfaces=30))
    h = ensemble.separations
    low, high = ensemble.interval("nominal_separation")
    sunk = h - ensemble.mean("nominal_separation")
    ends = [h - sunk * end / ensemble.mean("load") for end in ensemble.interval("load")]
    np.testing.assert_allclose([low, high], [np.minimum(*ends), np.maximum(*ends)], rtol=1e-12)
    assert np.all(low < high)


def test_a_half_space_at_effective_separations_changes_no_verdict(pressed):
    """The sums are those of the same asperities without it, which theory knows."""
    scene = pressed(3.0, n_surfaces=30)
    with_it, without = (verdict(mcgw.simulate(x)) for x in (scene, scene.replace(interaction=None)))
    assert with_it.p == pytest.approx(without.p, rel=1e-6)
    assert with_it.agrees
    kept = scene.replace(keep="statistics", quantities=("load", "stiffness", "area"))
    rest = kept.replace(interaction=None, quantities=("load", "area"))  # no surface's stiffness is there
    assert verdict(mcgw.simulate(kept)).p == pytest.approx(verdict(mcgw.simulate(rest)).p, rel=1e-6)


def test_theory_of_summits_with_their_own_radii_is_the_same_in_another_process():
    """What is kept between questions stays behind."""
    scene = mcgw.Scene(SPECTRAL, separations=[0.0, 1.0], summits=mcgw.RandomCurvature(5.0))
    theory = scene.theory
    mean = theory.mean("load", [0.0, 1.0])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(theory)).mean("load", [0.0, 1.0]), mean)


def test_means_under_an_interaction_fall_as_their_slopes_say(pressed):
    theory, h, step = pressed(3.0).theory, np.array([0.3, 1.5]), 1e-3
    for name in ("load", "stiffness"):
        fall = (theory.mean(name, h - step) - theory.mean(name, h + step)) / (2 * step)
        np.testing.assert_allclose(theory.slope(name, h), fall, rtol=1e-4)
    h = theory.separation_at("area", theory.mean("area", 0.7))
    assert h == pytest.approx(0.7, abs=1e-9)
