"""Gradings and height laws that rise or fall as fast as the integrals reach: right, or refused in a line."""

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from oracles.reference import F

import analytic
from analytic import Clipped, Custom, Exponential, ExponentialHeights, ScipyHeights, Weibull

H = (-20.0, -3.0, 0.0, 2.0, 5.0, 20.0)
TOO_STEEP = "^grading: (up to s = .* increases too steeply|E.* is not finite at s = )"


def raised(k):
    return Custom(lambda s: np.exp(k * s))


def tilted(n, h, k):
    """``E (s-h)_+^n exp(k s)``, exactly."""
    return mp.exp(mp.mpf(k) ** 2 / 2) * F(n, mp.mpf(h) - k)


def off(value, truth):
    return abs(float(mp.mpf(float(value)) / truth - 1))


@pytest.mark.parametrize(
    ("n", "k"), [(0, -3.0), (6, 3.0), (0.5, 4.0), (0.5, 12.0), (1.5, 20.0), (1.5, -12.0)]
)
def test_means_of_steep_gradings(n, k):
    for h in (-40.0, *H) if k < 4 else H:
        if h < 5 or k > -4:
            assert off(analytic.fn(n, h, raised(k)), tilted(n, h, k)) < (1e-13 if abs(k) == 3 else 1e-12)


UNIT = analytic.Surface(1.0, 1.0, 1.0, 1.0, 0.75)  # load of one asperity at unit approach: 1


@pytest.mark.parametrize("k", [2.0, 4.0])
def test_variances_and_skewness_of_steep_gradings(k):
    one = analytic.Model(UNIT, grading=raised(k), n_asperities=1.0)
    for h in (-2.0, 3.0):
        m1, m2, m3 = (tilted(1.5 * r, h, r * k) for r in (1, 2, 3))
        variance = m2 - m1**2
        exact = one.cumulants("load", h)
        assert off(exact.mean, m1) < 1e-12
        assert off(exact.variance, variance) < 1e-12
        assert off(exact.skewness, (m3 - 3 * m2 * m1 + 2 * m1**3) / mp.sqrt(variance) ** 3) < 1e-11


def test_what_is_beyond_double_precision_is_refused():
    for k in (30.0, 60.0):
        for h in (-3.0, 20.0):
            with pytest.raises(ValueError, match=TOO_STEEP):
                analytic.fn(1.5, h, raised(k))
    with pytest.raises(ValueError, match=TOO_STEEP):
        analytic.fn(1.5, 0.0, Custom(lambda s: np.exp(0.51 * s * s)))  # there is no mean at all
    with pytest.raises(ValueError, match=TOO_STEEP):
        analytic.fn(1.5, 0.0, raised(1.01), heights=ExponentialHeights())
    for k in (8.0, 20.0):
        model = analytic.Model(UNIT, grading=raised(k))
        with pytest.raises(ValueError, match=TOO_STEEP):
            model.cumulants("load", 0.0)  # but the mean there is
        assert off(model.mean("load", 0.0), tilted(1.5, 0.0, k)) < 1e-12
    with pytest.raises(ValueError, match="tail of the heights is too heavy"):
        analytic.fn(3, 0.0, heights=ScipyHeights(scipy.stats.t(2.1)))


@pytest.mark.parametrize("rate", [0.5, 0.9])
def test_steep_gradings_under_exponential_heights(rate):
    """``E (s-h)_+^n exp(k s) = Gamma(n+1) (1-k)^(-n-1) exp(k h - h - 1)``; at k = 1 there is no mean."""
    for h in (-1.0, 0.0, 3.0):
        found = analytic.fn(1.5, h, raised(rate), heights=ExponentialHeights())
        k = mp.mpf(rate)
        assert off(found, mp.gamma(2.5) * (1 - k) ** -2.5 * mp.exp(k * h - h - 1)) < 1e-12


def test_heavy_tails_reach_as_far_as_they_carry():
    """Student's t of few degrees: the mean load to 1e-10 by mpmath, where the old end lost 1e-9."""
    degrees = mp.mpf("2.1")
    law = ScipyHeights(scipy.stats.t(2.1))
    std = mp.sqrt(degrees / (degrees - 2))
    constant = mp.gamma((degrees + 1) / 2) / mp.sqrt(degrees * mp.pi) / mp.gamma(degrees / 2)

    def integrand(w):  # x = std s = w/(1-w)
        x = w / (1 - w)
        density = constant * (1 + x * x / degrees) ** (-(degrees + 1) / 2)
        return (x / std) ** mp.mpf("1.5") * density / (1 - w) ** 2

    # over the tail by its power: x^(1.5-3.1) is w -> 1 like (1-w)^(-0.4), which tanh-sinh takes
    truth = mp.quad(integrand, [0, 0.5, 0.9, 1])
    assert off(analytic.fn(1.5, 0.0, heights=law), truth) < 1e-10


def soft(n, h, gamma):
    """Logarithm of F*_n for a grading ``gamma - (gamma - 1) exp(-s)``."""
    gamma, h = mp.mpf(gamma), mp.mpf(h)
    return mp.log(gamma * F(n, h) - (gamma - 1) * mp.exp(mp.mpf(1) / 2) * F(n, h + 1))


@pytest.mark.parametrize(("gamma", "n"), [(0.0, 1.5), (1e-250, 0), (1e-9, 1.5)])
def test_logarithms_far_out_where_the_grading_nearly_vanishes(n, gamma):
    h = np.array([300.0, 600.0, 680.0])
    found = analytic.fn(n, h, Exponential(gamma), log=True)
    truth = [float(soft(n, x, gamma)) for x in h]
    np.testing.assert_allclose(found, truth, rtol=1e-14)
    np.testing.assert_array_equal(analytic.fn(n, h, Clipped(Exponential(gamma)), log=True), found)


def test_ratios_of_soft_tips_far_out():
    """gamma = 0 at h = 700: every quotient is a number, though its integrals are not."""
    grading, h = Exponential(0.0), 700.0
    for weight, n in (("number", 0), ("area", 1)):  # the modulus next to h, less by 1/h or so
        expected = float(mp.exp(soft(n, h, 0) - mp.log(F(n, mp.mpf(h)))))
        assert float(analytic.mean_modulus(h, grading, weight=weight)) == pytest.approx(expected, rel=1e-12)
    ratio = float(mp.exp(mp.log(F(1.5, mp.mpf(h))) - soft(1.5, h, 0)))
    assert float(analytic.area_per_load_ratio(h, grading)) == pytest.approx(ratio, rel=1e-12)
    found = analytic.ratio_at_equal_load("conductance", 600.0, grading)
    other = mp.findroot(lambda x: soft(1.5, x, 0) - mp.log(F(1.5, mp.mpf(600))), (mp.mpf(598), mp.mpf(600)))
    assert float(found) == pytest.approx(float(F(0.5, other) / F(0.5, mp.mpf(600))), rel=1e-9)


@pytest.mark.parametrize(("shape", "h"), [(1.5, -3.0), (3.9, 0.0), (100.0, 2.0)])
def test_weibull_integrals_of_any_shape(shape, h):
    with mp.workdps(40):
        k = mp.mpf(shape)
        mean = mp.gamma(1 + 1 / k)
        std = mp.sqrt(mp.gamma(1 + 2 / k) - mean**2)
        low = max(mp.mpf(0), mean + std * h) ** k

        def integrand(y):
            return abs((y ** (1 / k) - mean) / std - h) ** mp.mpf("1.5") * mp.exp(low - y)

        marks = ("0", "1e-6", "1e-3", "0.03", "0.3", "1", "2", "4", "9", "20", "40", "80", "150")
        truth = mp.quad(integrand, [low + mp.mpf(c) for c in marks]) * mp.exp(-low)
        share = mp.exp(-low)
    assert off(analytic.fn(1.5, h, heights=Weibull(shape)), truth) < 1e-11
    assert off(Weibull(shape).sf(np.array(h)), share) < 1e-11


def test_a_mean_reaches_as_far_as_its_separation_and_its_tail():
    """Of separations that differ by 1e-26 of the touching heights, and of heights without a third moment."""
    h, heavy = np.array([0.0, 60.0, 3.0]), ScipyHeights(scipy.stats.t(2.1))
    found = analytic.Model(UNIT, heights=ExponentialHeights(), n_asperities=1.0).mean("load", h)
    np.testing.assert_allclose(found, float(mp.gamma(2.5)) * np.exp(-1 - h), rtol=1e-12)
    mean = analytic.Model(UNIT, heights=heavy, n_asperities=1.0).mean("load", 0.0)
    assert off(mean, analytic.fn(1.5, 0.0, heights=heavy)) < 1e-12
