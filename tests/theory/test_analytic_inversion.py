"""From a load, an area, ... back to the separation; and comparisons at equal load."""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from oracles.reference import F, F_star

import analytic
from analytic import Custom, Exponential, inversion

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
H = np.array([-30.0, -8.0, -1.0, 0.0, 0.1, 2.0, 9.9, 10.2, 25.0, 36.0])


@pytest.mark.parametrize(
    ("quantity", "grading", "above"),  # below, a quantity need not fall with h, or everything touches
    [
        ("load", None, -40),
        ("load", Exponential(0.2), -3),
        ("area", Exponential(2.0), -40),
        ("stiffness", None, -40),
        ("stiffness", Custom(lambda s: 2 + np.tanh(s)), -1.6),
        ("contacts", Exponential(0.2), -5),
        ("conductance", None, -40),
    ],
)
def test_separation_at_inverts_the_mean(quantity, grading, above):
    h = H[above < H]
    means = analytic.mean(SURFACE, quantity, h, grading)
    model = analytic.Model(SURFACE, grading=grading or analytic.Homogeneous())
    found = model.separation_at(quantity, means.reshape(1, -1))[0]
    # The mean has 1e-14 of error; h^2/2 turns it into less where h is large, d ln F/dh ~ 1e-2 into more.
    np.testing.assert_allclose(found, h, rtol=1e-12, atol=2e-13)


def test_largest_of_several_separations():
    """gamma = 5: the load rises, falls and turns negative as the surfaces approach."""
    grading = Exponential(5.0)
    peak = -2.637  # theory.md: where the stiffness changes sign
    value = float(analytic.load(SURFACE, -4.0, grading))
    found = float(analytic.Model(SURFACE, grading=grading).separation_at("load", value))
    assert found > peak
    assert float(analytic.load(SURFACE, found, grading)) == pytest.approx(value, rel=1e-12)


def test_values_that_no_separation_has():
    for value in (0.0, -1.0, math.nan, math.inf, [1.0, -1.0]):
        with pytest.raises(ValueError, match=r"load = .*finite values > 0 N"):
            analytic.Model(SURFACE).separation_at("load", value)
    with pytest.raises(ValueError, match="contacts: not reached for h from -40 to 37"):
        analytic.Model(SURFACE).separation_at("contacts", 2 * SURFACE.n_asperities)
    with pytest.raises(ValueError, match="load: not reached"):
        analytic.Model(SURFACE, grading=Custom(lambda s: -np.ones_like(s))).separation_at("load", 1.0)


def test_a_target_beyond_the_end_of_its_bracket_by_a_last_digit_is_that_end():
    """A mean whose values one by one are a little more, or less, than all at once; what is known is wrong."""
    grid = np.array([0.0, 1.0, 2.0, 3.0])
    for more, target, h in ((-1e-9, -1.0, 1.0), (1e-9, -2.0 + 5e-10, 2.0)):

        def log_mean(x, more=more):
            return -np.asarray(x) + (0.0 if np.ndim(x) else more)

        found = inversion.last_separations(log_mean, np.array([[target]]), grid, np.full(4, -9.0), "load")
        np.testing.assert_array_equal(found, [[h]])


def test_target_right_before_the_load_turns_negative():
    """gamma = -0.2: positive up to h = 0.81086, so the larger of two separations is next to it."""
    grading = Exponential(-0.2)
    tiny = 1e-6 * float(analytic.load(SURFACE, 0.0, grading))
    found = float(analytic.Model(SURFACE, grading=grading).separation_at("load", tiny))
    assert 0.8108 < found < 0.81087
    assert float(analytic.load(SURFACE, found, grading)) == pytest.approx(tiny, rel=1e-8)  # 1e-14/1e-6


@pytest.mark.parametrize(("h", "gamma"), [(-2.0, 0.2), (2.0, 2.0), (60.0, 0.2)])
def test_equal_load_by_a_root_at_forty_digits(h, gamma):
    """Also at h = 60, where the loads themselves underflow."""
    target = mp.log(F(1.5, h))
    other = mp.findroot(lambda x: mp.log(F_star(1.5, x, gamma)) - target, h)
    for quantity, n in (("area", 1), ("contacts", 0), ("conductance", 0.5)):
        truth = F(n, other) / F(n, h)
        found = float(analytic.ratio_at_equal_load(quantity, h, Exponential(gamma)))
        # ln F = -1800 at h = 60 is known to its last digit, 2e-13, four times over.
        assert found == pytest.approx(float(truth), rel=1e-12)
    stiffness = float(analytic.ratio_at_equal_load("stiffness", h, Exponential(gamma)))
    assert stiffness == pytest.approx(float(F_star(0.5, other, gamma) / F(0.5, h)), rel=1e-12)


LAWS = {
    "exponential": analytic.ExponentialHeights(),
    "weibull": analytic.Weibull(1.5),
    "table": analytic.HeightTable.of(np.random.default_rng(1).normal(size=300)),
    "measured": analytic.MeasuredHeights(np.random.default_rng(2).normal(size=300)),
    "uniform": analytic.ScipyHeights(scipy.stats.uniform()),
    "lognormal": analytic.ScipyHeights(scipy.stats.lognorm(0.3)),
    "t": analytic.ScipyHeights(scipy.stats.t(5)),
}


@pytest.mark.parametrize(
    ("law", "grading"),
    [(law, (None, Exponential(1.8), Custom(lambda s: 2 + np.tanh(s)))[k % 3]) for k, law in enumerate(LAWS)],
)
def test_any_law_is_inverted(law, grading):
    model = analytic.Model(SURFACE, grading=grading or analytic.Homogeneous(), heights=LAWS[law])
    h = np.array([-0.7, 0.31, 12.0 if np.isinf(LAWS[law].support[1]) else 1.2])
    values = model.mean("load", h)
    np.testing.assert_allclose(model.separation_at("load", values), h, rtol=1e-12, atol=2e-13)


def test_where_theory_only_knows_the_last_of_several_it_is_found_for_any_law():
    """gamma = 5 under exponential heights: the load turns round and is negative where much touches."""
    model = analytic.Model(SURFACE, grading=Exponential(5.0), heights=LAWS["exponential"])
    h = np.linspace(-6, 4, 101)
    load = model.mean("load", h)
    peak = h[np.argmax(load)]
    value = float(load.max() * 0.9)
    found = float(model.separation_at("load", value))
    assert found > peak
    assert float(model.mean("load", found)) == pytest.approx(value, rel=1e-12)
