"""What no other test meets: mistakes that few make, facts that few scenes have, statistics of values."""

import pickle

import numpy as np
import pytest
from oracles.scenes import scene_by
from scipy import stats

import analytic
import mcgw
from analytic.laws import crowding_factor
from mcgw.scene.uncertainty import Uncertainty
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
PRESSED = analytic.InteractingModel.of(analytic.Model(SPECTRAL.surface), analytic.Interaction("body"))
LISTED = {"n_asperities": 3, "n_surfaces": 1, "sampler": "direct"}
LISTED["heights"] = analytic.MeasuredHeights([0.0, 1.0, 3.0])
BOTH = {"name": "kogut-etsion", "critical": 0.05, "hardness": 1e9}
OWN = {"surface": SPECTRAL.surface, "summits": RADII, "heights": analytic.Nayak(5.0)}
# Calls with a scene that are refused, by the word that names what is wrong.
REFUSED = {
    "nothing": lambda _: RADII.nothing,
    "thickness": lambda _: mcgw.Layer(0.0, 1.0),
    "conductivity": lambda _: mcgw.Layer(1.0, np.inf),
    "resistivity": lambda _: analytic.Film(),
    "conductivities": lambda _: analytic.Film(conductivities=(1.0,)),
    "temperature": lambda _: analytic.Joint("air", temperature=-1.0),
    "density": lambda _: analytic.MeasuredHeights([0.0, 1.0]).pdf(np.ones(2)),
    "n = 3": lambda _: analytic.MeasuredHeights([0.0, 1.0]).rvs(3, None),
    "a sum that decreases": lambda _: PRESSED.alone.separation_law(2.0, "contacts"),
    "joint = 3": lambda scene: scene.replace(joint=3),
    "joint.film_resistance": lambda scene: scene.replace(joint={"film_resistance": 1e-12}),
    "contact.law.critical": lambda scene: scene.replace(law={"critical": 0.05}),
    "one of them": lambda scene: scene.replace(law=BOTH),
    "one of them, in m": lambda scene: scene.replace(law={"name": "coated", "ratio": 2.0}),
    "contact.law.k: missing": lambda scene: scene.replace(law={"name": "power-law-graded", "c0": 1.0}),
    "conductance_si": lambda scene: scene.replace(quantities=["conductance_si"]),
    "no contact yields": lambda scene: scene.replace(quantities=["load", "yielded"]),
    "needs unloading": lambda scene: scene.replace(quantities=["load_unloading"]),
    "surface.m0 = -1": lambda _: mcgw.SpectralSurface(-1.0, 1e-3, 5e6, 1e-6, 1e11),
    "at most 100000": lambda scene: scene.replace(separations=np.zeros(100_001)),
    "threads = 0": lambda scene: mcgw.run(scene, "e.h5", threads=0),
    "threads = -1": lambda scene: mcgw.sweep(scene, {"grading.gamma": [1]}, path="s.h5", threads=-1),
    "ensemble.n_surfaces = 2": lambda scene: scene.replace(**LISTED | {"n_surfaces": 2}),
    "ensemble.count": lambda scene: scene.replace(**LISTED, count="poisson"),
    "ensemble.n_asperities = 4": lambda scene: scene.replace(**LISTED | {"n_asperities": 4}),
    "alpha = 5": lambda scene: scene.replace(**OWN | {"heights": analytic.Nayak(4.0)}),
    "is no axis": lambda scene: mcgw.sweep(scene, {"ensemble.seed": [1]}).slopes("load", "grading.gamma"),
    "ensemble.rel_err.lod": lambda scene: scene.replace(rel_err={"lod": 1e-3}),
    "ensemble.rel_err.load = inf": lambda scene: scene.replace(rel_err={"load": np.inf}),
    "give one for each": lambda scene: scene.replace(rel_err={"load": [1e-3, 1e-3]}),
    "value 2 is -1": lambda scene: scene.replace(rel_err={"load": [1e-3, -1.0, 1e-3]}),
    "ensemble.rel_err.load = True": lambda scene: scene.replace(rel_err={"load": True}),
    "relative standard errors": lambda scene: scene.replace(uncertainty={"sigma": "20"}),
    "not both": lambda scene: scene.replace(uncertainty={"sigma": 0.1, "m0": 0.2}),
    "need heights.law": lambda scene: scene.replace(uncertainty={"m0": 0.1}),
    "does not name": lambda scene: scene.replace(uncertainty={}),
    "rows of": lambda scene: scene.replace(uncertainty={"sigma": 0.1, "correlation": [[1, 0], [0, 1]]}),
    "symmetric": lambda scene: scene.replace(
        uncertainty={"sigma": 0.1, "eta": 0.1, "correlation": [[1, 0.5], [0, 1]]}
    ),
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
    "largest": (lambda x: analytic.RandomCurvature(5.0, x), [1e-300, np.inf], [0.0, np.nan]),
    "power": (lambda x: RADII.mean(x, np.zeros(1)), [0, 3.5], [-0.5, 4.0]),
    "power of bounded radii": (lambda x: analytic.RandomCurvature(5.0, 3.0).mean(x, np.zeros(1)), [4], [-1]),
    "shape": (analytic.Weibull, [1, 100], [0.999, 100.1, np.nan]),
    "alpha": (analytic.Nayak, [1.501, 1e12], [1.5009, 1.01e12]),
    "m0 m4/m2^2": (lambda x: analytic.SpectralMoments(x, 1, 1).surface(1, 1), [1.5], [1.499]),
    "E": (lambda x: analytic.Body(x, 0.3), [1e-300, np.inf], [0.0, np.nan]),
    "nu": (lambda x: analytic.Body(1e9, x), [-1, 0.5], [-1.001, 0.501]),
    "n": (lambda x: analytic.fn(x, 0.0), [0], [-1e-9, np.inf]),
    "n_asperities": (lambda x: analytic.Model(SURFACE, n_asperities=x), [1e-9], [0.0, np.inf]),
    "unload_from": (lambda x: analytic.Model(SURFACE, unload_from=x), [-9.0], [np.inf, np.nan]),
    "h": (lambda x: BACK.mean("load_unloading", x), [0.5], [0.4999]),
    "bulk_modulus": (lambda x: analytic.Interaction("body", bulk_modulus=x), [1e-300], [0.0, np.inf]),
    "rms": (lambda x: analytic.Joint("air", rms=x).gap(SURFACE, analytic.Gaussian()), [1.01 * SURFACE.sigma],
            [SURFACE.sigma]),
    "gas_pressure": (lambda x: analytic.Joint("air", gas_pressure=x), [1e-9], [0.0, np.inf]),
    "k": (lambda x: mcgw.PowerLawGraded(x, reduced_c0=1.0), [0, 0.999], [-1e-9, 1]),
    "film_resistance": (lambda x: analytic.Film(1.0, x), [0.0], [-1e-30, np.inf]),
    "area_fraction": (crowding_factor, [0.0, 0.999], [-1e-9, 1.0]),
    "terms": (lambda x: analytic.PiecewiseSeries([0, 1], [np.ones(x)]), [1, 64], [0, 65]),
    "pieces": (lambda x: analytic.PiecewiseSeries(range(x + 1), x * [[1.0]]), [1, 4096], [0, 4097]),
    "std_over_mean": (lambda x: analytic.Model(SURFACE).asperities_for("load", 1.0, x), [1e-9], [0, np.inf]),
    "heights": (lambda x: analytic.MeasuredHeights(np.arange(x)), [2], [1]),
}  # fmt: skip


@pytest.mark.parametrize("name", LIMITS)
def test_numbers_at_their_limits_are_taken_and_those_beyond_are_not(name):
    make, taken, refused = LIMITS[name]
    for x in taken:
        make(x)
    for x in refused:
        with pytest.raises(ValueError, match=r"give|must|smaller than"):
            make(x)


def with_radii(**changes):
    radii = mcgw.RandomCurvature(5.0)
    return lambda scene: scene_by(SPECTRAL, separations=[0, 1], summits=radii, **changes)


def listed(**changes):
    three = {"heights": analytic.MeasuredHeights([0.0, 1.0, 3.0]), "n_asperities": 3, "n_surfaces": 1}
    return lambda scene: scene.replace(sampler="direct", **(three | changes))


def test_statistics_of_values_are_those_of_numpy(make_scene):
    """Of an ensemble in memory, in one piece and in several, of one table and between two."""
    for n in (50, 9000):
        ensemble = mcgw.simulate(make_scene(n_surfaces=n, separations=(0.0, 2.0), n_asperities=300))
        load, area = ensemble.load, ensemble.area
        both = np.cov(np.hstack([load, area]).T)
        np.testing.assert_allclose(ensemble.covariance("load"), both[:2, :2], rtol=1e-11)
        np.testing.assert_allclose(ensemble.covariance("load", "area"), both[:2, 2:], rtol=1e-11)
    alone = mcgw.simulate(make_scene(n_surfaces=1, separations=(0.0, 2.0)))
    assert np.isnan(alone.covariance("load")).all()


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


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_the_interval_of_the_contacts_is_exact_for_each_count(count, make_scene):
    """Clopper and Pearson's where N is fixed, Garwood's where it is Poisson: half of all touch at h = 0."""
    scene = make_scene(count=count, separations=(0.0,), n_asperities=40, n_surfaces=5)
    ensemble = mcgw.simulate(scene)
    k = int(ensemble.contacts.sum())
    tails = {
        "fixed": np.array(stats.binomtest(k, 200).proportion_ci(method="exact")) * 200,
        "poisson": stats.chi2.ppf([0.025, 0.975], [2 * k, 2 * k + 2]) / 2,
    }
    np.testing.assert_allclose(np.ravel(ensemble.interval("contacts")), tails[count] / 5, rtol=1e-9)


def test_theory_of_summits_with_their_own_radii_is_the_same_in_another_process():
    """What is kept between questions stays behind."""
    scene = mcgw.Scene(SPECTRAL, separations=[0.0, 1.0], summits=mcgw.RandomCurvature(5.0))
    theory = scene.theory
    mean = theory.mean("load", [0.0, 1.0])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(theory)).mean("load", [0.0, 1.0]), mean)


@pytest.mark.parametrize("quantity", ["load", "stiffness"])
def test_means_under_an_interaction_fall_as_their_slopes_say(quantity, pressed):
    theory = pressed(3.0).theory
    h, step = np.array([0.3, 1.5]), 1e-3
    fall = (theory.mean(quantity, h - step) - theory.mean(quantity, h + step)) / (2 * step)
    np.testing.assert_allclose(theory.slope(quantity, h), fall, rtol=1e-4)
    with pytest.raises(ValueError, match="give a load, an area, or another sum of the asperities"):
        theory.separation_at("stiffness", 1.0)
    h = theory.separation_at("area", theory.mean("area", 0.7))
    assert h == pytest.approx(0.7, abs=1e-9)
