"""What no other test meets: mistakes that few make, facts that few scenes have, statistics of values."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import law_text
from oracles.scenes import scene_by
from scipy import stats

import analytic
import mcgw
from analytic.laws import crowding_factor
from mcgw.scene.in_words import contact_facts
from mcgw.scene.uncertainty import Uncertainty
from mcgw.statistics.comparison import verdict
from mcgw.validity.fitted_map import Fitted

SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
FILE = """
surface = {{sigma = 1e-6, radius = 1e-5, eta = 1e9, nominal_area = 1e-6, E_star = 1e11{surface}}}
contact = {{separations = [0.0, 1.0]{contact}}}
ensemble = {{n_surfaces = 10, n_asperities = 100, seed = 1{ensemble}}}
joint = {{{joint}}}
"""

NONE = {"surface": "", "contact": "", "ensemble": "", "joint": ""}
# Of a scene file: what is added to a table, and the line that names it with what would do.
ADDED = [
    ("surface", ", bodies = [{E = 7e10}, {E = inf}]",
     "give it or E_star, not both"),
    ("joint", "resistivity = 1e-7, conductivities = [1.0, 2.0]",
     "joint.resistivity = 1e-07: give it or conductivities, not both"),
    ("joint", "film_resistance = 1e-12",
     "joint.film_resistance = 1e-12: give resistivity or conductivities too, or leave it out"),
    ("contact", ', law = {name = "power-law-graded", c0 = "10 um"}',
     'contact.law.k: missing; name = "power-law-graded" needs it'),
    ("contact", ', law = {name = "kogut-etsion", critical = 0.05, hardness = 1e9}', "give one of them"),
    ("contact", ', law = {name = "coated", ratio = 2.0}', "give one of them, in m or over sqrt(R sigma)"),
    ("contact", ', quantities = ["conductance_si"]',
     '"conductance_si" needs joint.resistivity, or joint.conductivities = [k1, k2]'),
    ("contact", ', quantities = ["load", "yielded"]', 'no contact yields with law = "hertz"; leave it out'),
    ("contact", ', quantities = ["load_unloading"]', "'load_unloading' needs unloading; give"),
    ("contact", ", yield_index = 3", "unknown key"),
    ("contact", f", datum = '{58 * 'x'}'", f"contact.datum = '{58 * 'x'}': "),  # 60 characters as they are
    ("contact", f", datum = '{59 * 'x'}'", f"contact.datum = '{56 * 'x'}...: "),
]  # fmt: skip


@pytest.mark.parametrize(("table", "more", "told"), ADDED)
def test_a_mistake_is_one_line(table, more, told):
    mcgw.scene_from(FILE.format(**NONE))
    with pytest.raises(mcgw.SceneError) as caught:
        mcgw.scene_from(FILE.format(**NONE | {table: more}))
    assert any(told in line for line in caught.value.problems), caught.value.problems
    assert len(caught.value.problems) == 1


def test_of_many_unknown_keys_twenty_are_named():
    for number, more in ((20, []), (23, ["[contact]: 3 more unknown keys"])):
        keys = "".join(f", key_{k} = 1" for k in range(number))
        with pytest.raises(mcgw.SceneError) as caught:
            mcgw.scene_from(FILE.format(**NONE | {"contact": keys}))
        named, rest = caught.value.problems[:20], caught.value.problems[20:]
        assert [line.partition(":")[0] for line in named] == [f"contact.key_{k}" for k in range(20)]
        assert rest == more


def test_errors_of_a_fit_have_the_correlation_of_its_covariance():
    """0.006/(0.1 0.2) = 0.3 whatever the errors are; one of a factor of 7 says that nothing is known."""
    found = Uncertainty.correlated(
        ("sigma", "eta"), [0.25, 2.5], np.array([[0.01, 0.00600001], [0.00600001, 0.04]])
    )
    assert (found.names, found.sigma, found.eta) == (("sigma", "eta"), 0.25, 2.0)
    assert found.correlation == ((1.0, 0.3), (0.3, 1.0))
    np.testing.assert_allclose(found.covariance, [[0.0625, 0.15], [0.15, 4.0]], rtol=1e-15)


def test_what_a_fit_did_not_see_is_not_shown():
    known = Fitted(1e-12, 1e-3, 5e6, skewness=-0.123, kurtosis=3.456, independent=100.0)
    first, second = "alpha = 5, rms slope 0.0447", "skewness -0.12, kurtosis 3.46"
    assert known.lines() == (first, second)
    assert replace(known, lay=1.2345).lines() == (f"{first}, lay 1.23", second)
    apart = f"{second}, estimates differ by a factor of 1.5"
    assert replace(known, agreement=1.5).lines() == (first, apart)
    for number, more in ((0, ""), (3, ""), (5, " (and 2 more under [fitted] in the scene)")):
        shown = [f"fit: {'abcde'[k]}" for k in range(min(number, 3))]
        told = replace(known, cautions=tuple("abcde"[:number])).gravest
        assert told == [*shown[:-1], *(f"{line}{more}" for line in shown[-1:])]


RADII = analytic.RandomCurvature(5.0)
PRESSED = analytic.InteractingModel.of(analytic.Model(SPECTRAL.surface), analytic.Interaction("body"))
REFUSED = [
    (lambda: RADII.mean(0.3, np.ones(1)), "power = 0.3: give a multiple of 1/2"),
    (lambda: RADII.nothing, "nothing"),
    (lambda: analytic.Weibull(101), "shape = 101: give a number from 1 to 100"),
    (lambda: mcgw.Layer(0.0, 1.0), "thickness = 0.0: give a finite number > 0, in m"),
    (lambda: mcgw.Layer(1.0, np.inf), r"conductivity = inf: give a finite number > 0, in W/\(m K\)"),
    (lambda: analytic.Film(), r"resistivity: give it in ohm m, or conductivities = \(k1, k2\)"),
    (lambda: analytic.Film(conductivities=(1.0,)), "give two numbers > 0"),
    (lambda: analytic.Film(conductivities=(1.0, 0.0)), "give two numbers > 0"),
    (lambda: analytic.Joint("air", temperature=-1.0), "temperature = -1.0: give a finite number > 0, in K"),
    (lambda: analytic.MeasuredHeights([0.0, 1.0]).pdf(np.ones(2)), "no density at s = 1;"),
    (lambda: analytic.MeasuredHeights([0.0, 1.0]).rvs(3, None), "n = 3: give 2, the number"),
    (lambda: PRESSED.alone.separation_law(2.0, "contacts"), "give a sum that decreases with the separation"),
]


@pytest.mark.parametrize(("call", "told"), REFUSED)
def test_what_objects_refuse(call, told):
    with pytest.raises((ValueError, KeyError, AttributeError), match=told):
        call()


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


# In Python: a call with a scene, and what its line says.
CALLS = [
    (lambda scene: scene.replace(joint=3), "joint = 3: give mcgw.Joint"),
    (lambda scene: scene.replace(law={"critical": 0.05}), "contact.law.critical: unknown key"),
    (lambda scene: mcgw.SpectralSurface(-1.0, 1e-3, 5e6, 1e-6, 1e11), "surface.m0 = -1"),
    (lambda scene: scene.replace(separations=np.zeros(100_001)), "at most 100000 of them"),
    (lambda scene: mcgw.run(scene, "e.h5", threads=0), "threads = 0: give a whole number >= 1"),
    (lambda scene: mcgw.sweep(scene, {"grading.gamma": [1, 2]}, path="s.h5", threads=-1),
     "threads = -1: give a whole number >= 1"),
    (listed(n_surfaces=2), "ensemble.n_surfaces = 2: measured heights as they are need 1; or set resample"),
    (listed(count="poisson"), "ensemble.count = 'poisson': measured heights as they are need 'fixed'; or"),
    (listed(n_asperities=4), "ensemble.n_asperities = 4: there are 3 measured heights; give that number, or"),
    (with_radii(heights=analytic.Gaussian()), 'it needs heights.law = "nayak", alpha = 5;'),
    (with_radii(heights=analytic.Nayak(4.0)), 'it needs heights.law = "nayak", alpha = 5;'),
    (lambda scene: mcgw.sweep(scene, over={"ensemble.seed": [1, 2]}).slopes("load", "grading.gamma"),
     "'grading.gamma' is no axis of this sweep; it has ensemble.seed"),
]  # fmt: skip


@pytest.mark.parametrize(("call", "told"), CALLS)
def test_a_mistake_in_python_is_one_line(call, told, make_scene):
    with pytest.raises(ValueError) as caught:  # noqa: PT011
        call(make_scene(n_surfaces=3))
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "fact"),
    [
        ({"joint": mcgw.Joint(resistivity=1e-7)}, ("bodies", "resistivity 1e-07 ohm m")),
        ({"interaction": "body"}, ("interaction", "from the undeformed body, separations effective")),
    ],
)
def test_a_scene_says_what_it_has_and_nothing_else(changes, fact, make_scene):
    """The others are recorded."""
    assert contact_facts(make_scene()) == []
    assert contact_facts(make_scene(**changes)) == [fact]
    assert law_text(analytic.MeasuredHeights([0.0, 1.0, 3.0])) == "3 measured ones, as they are"
    assert law_text(analytic.Custom(np.exp)) == "Custom(exp)"


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
