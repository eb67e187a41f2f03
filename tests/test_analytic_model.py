"""The model of a surface: its own number, count and height law in everything it says."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import analytic
from analytic import Exponential, ExponentialHeights, Gaussian, Model, Weibull

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
H = np.array([-0.5, 0.0, 1.5])


@pytest.fixture
def model():
    return Model(
        SURFACE, grading=Exponential(0.5), heights=ExponentialHeights(), n_asperities=70.0, count="poisson"
    )


def test_means_and_variances_are_sums_of_independent_terms(model):
    """By literal quadrature over the density exp(-1 - s); a Poisson number has E f^2 for a variance."""
    for name, q in analytic.QUANTITIES.items():
        scale = q.scale(SURFACE)
        for k, h in enumerate(H):

            def moment(power, q=q, h=h):
                def term(v):  # s = h + v^2
                    s = h + v * v
                    e = 0.5 + 0.5 * math.exp(-s)
                    return 2 * v * (v ** (2 * q.exponent) * e**q.modulus) ** power * math.exp(-1 - s)

                return quad(term, 0, 7, epsrel=1e-12)[0]

            assert model.mean(name, H)[k] == pytest.approx(70 * scale * moment(1), rel=1e-10)
            assert model.std(name, H)[k] ** 2 == pytest.approx(70 * scale**2 * moment(2), rel=1e-10)
            fixed = replace(model, count="fixed").std(name, H)[k] ** 2
            assert fixed == pytest.approx(70 * scale**2 * (moment(2) - moment(1) ** 2), rel=1e-9)


def test_covariance_has_the_variances_on_its_diagonal(model):
    matrix = model.covariance(["load", "contacts"], H)
    for i, name in enumerate(("load", "contacts")):
        np.testing.assert_allclose(np.diag(matrix[i, :, i, :]), model.std(name, H) ** 2, rtol=1e-12)


def test_separations_belong_to_the_number_of_asperities(model):
    for name in ("load", "area"):
        np.testing.assert_allclose(model.separation_at(name, model.mean(name, H)), H, atol=1e-12)
        slope = (model.mean(name, H - 1e-5) - model.mean(name, H + 1e-5)) / 2e-5
        np.testing.assert_allclose(model.slope(name, H[1:]), slope[1:], rtol=1e-8)


def test_the_number_is_that_of_the_surface_unless_given():
    left_out = Model(SURFACE)
    assert left_out.number == 1000
    assert replace(left_out, surface=replace(SURFACE, nominal_area=3e-6)).number == 3000
    assert (left_out.heights, left_out.count) == (Gaussian(), "fixed")
    np.testing.assert_array_equal(left_out.mean("load", H), analytic.load(SURFACE, H))


@pytest.mark.parametrize(
    ("given", "told"),
    [({"n_asperities": 0.0}, "n_asperities = 0.0"), ({"count": "random"}, "count = 'random'")],
)
def test_mistakes_are_named(given, told):
    with pytest.raises(ValueError, match=told):
        Model(SURFACE, **given)


CALLS = {
    "mean": (SURFACE, "load", 1.0),
    "load": (SURFACE, 1.0),
    "area": (SURFACE, 1.0),
    "contacts": (SURFACE, 1.0),
    "stiffness": (SURFACE, 1.0),
    "conductance": (SURFACE, 1.0),
    "barber_conductance": (SURFACE, 1.0),
    "area_per_load": (SURFACE, 1.0),
    "area_per_load_ratio": (1.0, Exponential(2.0)),
    "stiffness_ratio": (1.0, Exponential(2.0)),
    "separation_at": (SURFACE, "load", 1e-3),
    "covariance": (SURFACE, ["load"], [1.0]),
    "fn": (1.5, 1.0),
    "fn_scaled": (1.5, 1.0),
    "fn_between": (1.5, 1.0, 1.0, 2.0),
    "mean_modulus": (1.0, Exponential(2.0)),
}


@pytest.mark.parametrize("name", CALLS)
def test_the_old_keyword_of_the_height_law_warns_and_works(name):
    function, law = getattr(analytic, name), Weibull(1.7)
    with pytest.warns(DeprecationWarning, match=rf"{name}: the law of the heights is now heights="):
        old = function(*CALLS[name], law=law)
    np.testing.assert_array_equal(old, function(*CALLS[name], heights=law))
    assert not np.array_equal(old, function(*CALLS[name]))


def test_the_old_keyword_of_rules_and_cumulants():
    with pytest.warns(DeprecationWarning, match="heights="):
        old = analytic.cumulants(SURFACE, "load", 1.0, law=Weibull(1.7))
    assert old == analytic.cumulants(SURFACE, "load", 1.0, heights=Weibull(1.7))
    with pytest.warns(DeprecationWarning, match="heights="):
        rule = analytic.HeightRule.over([1.0], Exponential(2.0), law=Weibull(1.7))
    new = analytic.HeightRule.over([1.0], Exponential(2.0), Weibull(1.7))
    np.testing.assert_array_equal(rule.heights, new.heights)
