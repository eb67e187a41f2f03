"""The exact law of a finite surface against other ways to it, and the faults that these must see."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.laws_of_one_depth import johnson_kendall_roberts
from scipy import stats
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import binom, gammaln

import analytic
from analytic.curvature import MEAN_CURVATURE

GRADED = analytic.Exponential(2.0)


def model(n, area=1.0, **more):
    surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=n / area, nominal_area=area, E_star=1e9)
    return analytic.Model(surface, **{"grading": GRADED, **more})


def unit(of, quantity):
    return analytic.quantity_of(quantity).scale(of.surface)


# By mpmath: a Bromwich line with Euler's summation, two settings that agree to these digits.
AT = (0.25, 0.8, 1.0, 1.5)
BY_MPMATH = [
    ("load", 3, "fixed", (7.987558487518e-5, 0.241859635747704, 0.53163709288702, 0.955227311677027)),
    ("load", 2, "poisson", (0, 5.43992551445528e-4, 0.507240957263101, 0.999999999996989)),
    ("area", 3, "poisson", (3.389666402617e-6, 0.178153292295308, 0.520409433554682, 0.983936962879777)),
]


@pytest.mark.parametrize(("quantity", "h", "count", "known"), BY_MPMATH)
def test_the_cdf_is_that_of_another_inversion(quantity, h, count, known):
    law = model(30_000, count=count).distribution(quantity, h)
    np.testing.assert_allclose(law.cdf(np.array(AT) * law.mean()), known, atol=law.error)
    assert law.error < 1e-6


def hertz(d, e):
    return e * d**1.5, d


STICKY = {"law": analytic.JohnsonKendallRoberts(pull_off=0.3), "grading": analytic.Homogeneous()}
ONE = [  # the load and area that one asperity adds, typed in; those that stick snap into contact
    ("load", {}, hertz),
    ("conductance", {}, hertz),
    ("area", STICKY, johnson_kendall_roberts),
    ("conductance", STICKY, johnson_kendall_roberts),
]


@pytest.mark.parametrize(("quantity", "more", "typed"), ONE)
def test_one_asperity_by_its_height(quantity, more, typed):
    h, grading = 1.3, more.get("grading", GRADED)

    def added(s):
        load, area = typed(s - h, float(grading(np.array(s))))
        return {"load": load, "area": area, "conductance": np.sqrt(area)}[quantity]

    law = model(1, **more).distribution(quantity, h)
    for x in (1e-3, 0.1, 3.0):
        s = h if added(h + 1e-13) > x else brentq(lambda s, x=x: added(s) - x, h + 1e-13, 40, xtol=1e-14)
        assert law.sf(x * unit(model(1), quantity)) == pytest.approx(stats.norm.sf(s), abs=1e-6)


def binomial_gamma(n, share, x, count):
    k = np.arange(1, 200)
    ways = stats.poisson(n * share).pmf(k) if count == "poisson" else stats.binom(n, share).pmf(k)
    return float(ways @ stats.gamma(k).sf(x))


@pytest.mark.parametrize(
    ("n", "h", "count"),
    [(30, 2.0, "fixed"), (30, 7.0, "poisson"), (1000, 10.0, "fixed"), (2000, 3.0, "poisson")],
)
def test_areas_of_exponential_heights_are_gamma_sums(n, h, count):
    of = model(n, heights=analytic.ExponentialHeights(), grading=analytic.Homogeneous(), count=count)
    law, share = of.distribution("area", h), np.exp(-1 - h)
    for x in (0.1, 1.0, 10.0, 40.0):
        known = binomial_gamma(n, share, x, count)
        assert law.sf(x * unit(of, "area")) == pytest.approx(known, rel=1e-4, abs=1e-10)


@pytest.mark.parametrize(
    ("quantity", "count"), [("load", "fixed"), ("stiffness", "poisson"), ("pressure", "fixed")]
)
def test_its_first_three_moments_are_the_cumulants(quantity, count):
    """Sums of a smooth density at equal steps are exact beyond all powers of the step."""
    of = model(3000, count=count)
    law, known, z = of.distribution(quantity, 0.5), of.cumulants(quantity, 0.5), np.linspace(-10, 14, 201)
    assert (law.mean(), law.var()) == pytest.approx((float(known.mean), float(known.variance)), rel=1e-12)
    share = law.pdf(law.mean() + z * law.std()) * law.std() * (z[1] - z[0])
    assert share.sum() == pytest.approx(1, abs=1e-7)
    assert share @ z**3 == pytest.approx(float(known.skewness), abs=1e-6)


@pytest.mark.parametrize("n", [1e4, 1e9])
def test_tails_have_digits_as_far_as_lattices_resolve_them(n):
    law = model(n).distribution("load", 2.0)
    shares = np.array([1e-10, 1e-6, 1e-3, 0.5])
    resolved = (shares > law.sf(law.x[-1])) & (shares > law.cdf(law.x[0]))
    np.testing.assert_allclose(law.sf(law.isf(shares))[resolved], shares[resolved], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(law.cdf(law.ppf(shares))[resolved], shares[resolved], rtol=1e-9)
    x, step = law.isf(shares[1:]), 0.01 * law.std()
    by_hand = (law.sf(x - step) - law.sf(x + step)) / (2 * step)
    np.testing.assert_allclose(law.pdf(x), by_hand, rtol=2e-3)
    np.testing.assert_array_equal(law.isf([1e-30, 0, 2]), [np.nan, np.inf, np.nan])
    far = law.mean() + np.array([15, 30, 1e7]) * law.std()  # beyond what lattices resolve: a bound says so
    assert np.all((law.sf(far) > 0) & (law.sf(far) < 1e-7))
    z, skewness = np.array([-3.0, 0.5, 4.0]), float(model(n).cumulants("load", 2.0).skewness)
    known = stats.norm.cdf(z) - skewness / 6 * (z**2 - 1) * stats.norm.pdf(z)  # of very many: Gaussian
    np.testing.assert_allclose(law.cdf(law.mean() + z * law.std()), known, atol=1e-6 + skewness**2)


def test_a_wrong_value_is_seen_by_the_error():
    """A table in which a millionth of the surfaces lies elsewhere."""
    law = model(1e6).distribution("load", 2.0)
    moved = 1e-5 * stats.norm.pdf(law.x, law.mean() + law.std(), law.std() / 4) * law.std()
    wrong = replace(law, upto=law.upto - moved)
    x = law.mean() + law.std()
    assert law.error < 1e-6 < 1e-5 < wrong.error
    assert 1e-6 < abs(wrong.sf(x) - law.sf(x)) < wrong.error


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_contacts_are_counted(count):
    law, share = model(3000, count=count).distribution("contacts", 2.0), stats.norm.sf(2.0)
    known = stats.poisson(3000 * share) if count == "poisson" else stats.binom(3000, share)
    np.testing.assert_allclose(law.cdf([40, 68, 90]), known.cdf([40, 68, 90]), rtol=1e-11)
    found = law.atom, law.ppf(0.5), law.mean(), law.var()
    assert found == pytest.approx((known.pmf(0), known.ppf(0.5), known.mean(), known.var()), rel=1e-11)
    assert 0 < law.error < 1e-12


def test_shapes_ends_and_the_atom():
    law = model(300).distribution("load", 2.5)
    np.testing.assert_array_equal(law.cdf([-1.0, np.inf, np.nan]), [0, 1, np.nan])
    np.testing.assert_array_equal(law.sf([-1.0, np.inf, np.nan]), [1, 0, np.nan])
    np.testing.assert_array_equal(law.ppf([0, law.atom / 2, 1, -1, 2]), [0, 0, np.inf, np.nan, np.nan])
    assert law.cdf(0.0) == law.atom == pytest.approx(stats.norm.cdf(2.5) ** 300, rel=1e-12)
    assert law.cdf(np.full((2, 3), law.mean())).shape == (2, 3)
    assert np.ndim(law.cdf(law.mean())) == 0
    drawn = law.rvs(4000, random_state=3)
    assert np.mean(drawn == 0) == pytest.approx(law.atom, abs=0.03)
    assert stats.kstest(drawn[drawn > 0], lambda x: (law.cdf(x) - law.atom) / (1 - law.atom)).pvalue > 1e-3


@pytest.mark.parametrize("reference", ["body", "mean-plane"])
def test_what_is_in_series_and_the_nominal_separation(reference):
    """By quantiles of independent asperities: k/(1 + c k), also with c < 0, whose pole no surface reaches."""
    of = model(3000)
    pressed = replace(of, interaction=analytic.Interaction(reference, bulk_modulus=3e9))
    alone, stiff = of.distribution("stiffness", 1.0), pressed.distribution("stiffness", 1.0)
    k, c = alone.ppf([0.01, 0.3, 0.9]), pressed.compliance * of.surface.sigma
    series = k / (1 + c * k)
    np.testing.assert_allclose(stiff.ppf([0.01, 0.3, 0.9]), series, rtol=1e-12)
    np.testing.assert_allclose(stiff.pdf(series), alone.pdf(k) * (1 + c * k) ** 2, rtol=1e-5)
    assert stiff.error == pytest.approx(alone.error, rel=1.0)
    p, nominal = of.distribution("load", 1.0).ppf([0.3, 0.8]), pressed.distribution("nominal_separation", 1.0)
    shares = [0.7, 0.2] if c > 0 else [0.3, 0.8]
    np.testing.assert_allclose(nominal.ppf(shares), 1.0 - pressed.compliance * p, rtol=1e-12)
    assert nominal.mean() == pytest.approx(float(pressed.mean("nominal_separation", 1.0)), rel=1e-9)


def test_the_separation_at_a_load():
    """Known values: Gil-Pelaez on a rule of its own, and 8000 drawn surfaces of 19 contacts."""
    of = model(3000, grading=analytic.Homogeneous(), count="poisson")
    law = of.separation_law(float(of.mean("load", 2.5)))
    np.testing.assert_allclose(law.cdf([2.3, 2.5, 2.7]), [0.04017, 0.54496, 0.94262], atol=6e-6)
    assert law.cdf(law.ppf(0.05)) == pytest.approx(0.05, rel=1e-9)
    np.testing.assert_array_equal(law.ppf([0, 1]), [-np.inf, np.inf])  # no separation is the last
    assert law.mean() - 2.5 == pytest.approx(-4.477e-3, abs=6e-4)
    assert law.var() == pytest.approx(1.5e-2, rel=0.03)
    for h in law.ppf([0.2, 1 - 1e-4]):
        assert law.cdf(h) == pytest.approx(
            float(of.distribution("load", h).cdf(of.mean("load", 2.5))), abs=1e-6
        )
    assert law.error < 1e-5


def test_a_share_of_the_surfaces_without_any_asperity_reaches_a_load_nowhere():
    """exp(-3) of them, by Poisson: where more do, what is solved for is at that share."""
    of = model(3, grading=analytic.Homogeneous(), count="poisson")
    load, empty = float(of.mean("load", 0.5)), np.exp(-3)
    law = of.separation_law(load)
    np.testing.assert_array_equal(law.ppf([0.01, empty * (1 - 1e-9)]), np.nan)
    share = 1.001 * empty
    assert of.distribution("load", law.ppf(share)).cdf(load) == pytest.approx(share, abs=1e-6)


def test_so_many_asperities_scatter_as_wanted():
    of = model(3000)
    for h, n in zip((0.0, 2.5), of.asperities_for("load", [0.0, 2.5], 0.01).tolist(), strict=True):
        large = model(n).distribution("load", h)
        assert large.std() / large.mean() == pytest.approx(0.01, rel=1e-9)


def test_few_contacts_of_radii_of_their_own():
    radii, h, x = analytic.RandomCurvature(5.0), 1.0, 0.7
    of = model(1, curvature=radii, heights=radii.heights, grading=analytic.Homogeneous())

    def larger(s):
        return float(radii.heights.pdf(np.array(s)) * radii.cdf(MEAN_CURVATURE * (s - h) / x, s))

    known = quad(larger, h, 9, epsabs=1e-13, limit=200)[0]
    assert of.distribution("area", h).sf(x * unit(of, "area")) == pytest.approx(known, abs=1e-6)


def test_between_loads_of_both_signs_no_load_has_a_probability():
    law = model(30_000, law=analytic.DerjaguinMullerToporov(pull_off=0.01), grading=analytic.Homogeneous())
    law = law.distribution("load", 4.0)
    below, upto = float(law.cdf(-1e-9 * law.std())), float(law.cdf(0.0))
    assert upto - below == pytest.approx(law.atom, abs=1e-4)
    np.testing.assert_array_equal(law.ppf([(below + upto) / 2, upto - 1e-6]), 0)
    np.testing.assert_array_equal(law.isf([1 - (below + upto) / 2, 1 - upto + 1e-6]), 0)


def test_where_digits_end_is_said():
    """Steps of listed summits are smoothed, which the error says where they are few."""
    heights = np.random.default_rng(1).normal(size=400)
    listed = analytic.MeasuredHeights(heights)
    of = model(400, heights=listed, grading=analytic.Homogeneous())
    for h, most in ((1.0, 1e-6), (2.5, 0.05)):
        law, s = of.distribution("area", h), (heights - heights.mean()) / heights.std()
        drawn = np.random.default_rng(2).choice(s, (20_000, 400))
        areas = np.maximum(drawn - h, 0).sum(axis=1) * unit(of, "area")
        places = law.ppf([0.2, 0.5, 0.9])
        shares = [np.mean(areas <= x) for x in places]
        assert 0 < law.error < most
        np.testing.assert_allclose(shares, law.cdf(places), atol=4.5 * 0.5 / np.sqrt(20_000) + law.error)


def test_all_asperities_touch_and_none_has_less():
    """Uniform heights from -sqrt(3) on: the law of Irwin and Hall, shifted by the least area there is."""
    of = model(40, heights=analytic.ScipyHeights(stats.uniform()), grading=analytic.Homogeneous())
    law, least = of.distribution("area", -3.0), 40 * (3 - np.sqrt(3)) * unit(of, "area")
    assert np.all(law.cdf(least * np.array([0.0, 0.5, 1 - 1e-9])) < 1e-10)
    k, span = np.arange(8), 2 * np.sqrt(3) * unit(of, "area")
    hall = float(np.sum((-1.0) ** k * binom(40, k) * np.exp(40 * np.log(7.5 - k) - gammaln(41))))
    np.testing.assert_allclose(law.cdf(least + np.array([7.5, 20]) * span), [hall, 0.5], atol=1e-9)


RADII = analytic.RandomCurvature(5.0)
PULLS = {"law": analytic.JohnsonKendallRoberts(pull_off=2e-3), "grading": analytic.Homogeneous()}
YIELDS = {"law": analytic.KogutEtsion(critical=0.05)}
CURVED = {"curvature": RADII, "heights": RADII.heights}
UNIFORM = {"heights": analytic.ScipyHeights(stats.uniform()), "grading": analytic.Homogeneous()}
KINDS = {
    "0.06 contacts that pull": (100, PULLS, "load", 3.24, 2e-4),
    "8 contacts that pull": (3000, PULLS, "load", 2.787, 2e-4),
    "100 contacts that pull much": (3000, STICKY, "load", 1.834, 2e-6),
    "no contact": (100, UNIFORM, "load", 5.0, 1e-6),
    "all touch": (50, {}, "area", -9.0, 1e-6),
    "unloading": (3000, YIELDS | {"unload_from": 1.0}, "load_unloading", 1.2, 1e-6),
    "own radii that pull": (300, CURVED | PULLS, "load", 2.5, 1e-3),
    "films": (3000, {"film": analytic.Film(conductivities=(16.0, 16.0))}, "conductance_si", 2.0, 1e-6),
}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_contact_has_a_law_with_its_moments(kind):
    n, more, quantity, h, error = KINDS[kind]
    of = model(n, **more)
    law, known, rule = of.distribution(quantity, h), of.cumulants(quantity, h), of.rule(h, ())
    assert law.error < error
    middle, weights = (law.x[1:] + law.x[:-1]) / 2, np.diff(law.upto)
    mean, std = float(weights @ middle), float(np.sqrt(known.variance))
    assert mean == pytest.approx(float(known.mean), abs=2e-4 * std + 1e-90)
    assert float(np.sqrt(weights @ (middle - mean) ** 2)) == pytest.approx(std, rel=2e-3)
    assert np.all(weights >= 0)
    assert law.atom == pytest.approx(float(1 - rule.probabilities.sum()) ** n, abs=1e-6) or "un" in kind


def test_sums_of_few_that_pull_by_plain_convolutions():
    """Of 300 asperities, below no load: what k of them add above k times the least, by steps of its 1/200."""
    n, h, pulls = 300, 2.5, {**PULLS, "count": "fixed"}
    of = model(n, **pulls)
    s = h + np.linspace(1e-6, 1.0, 200_000) ** 2
    values = of.ways.of("load").terms(["load"], h, s, of.grading(s))[0]
    assert np.all(np.diff(values) > 0)
    least, x = values[0], 1.2 * values[0]
    step = -least / 200
    edges = stats.norm.cdf(np.interp(least + step * np.arange(2401), values, s)) - stats.norm.cdf(h)
    one = np.diff(edges) / stats.norm.sf(h)
    known, sums = 0.0, np.ones(1)
    for k in range(1, 13):
        sums = np.convolve(sums, one)[: one.size]
        upto = np.interp(
            (x - k * least) / step - k / 2 + 0.5, np.arange(sums.size + 1), np.append(0, sums.cumsum())
        )
        known += stats.binom(n, stats.norm.sf(h)).pmf(k) * upto
    assert of.distribution("load", h).cdf(x * unit(of, "load")) == pytest.approx(known, abs=1e-6)
