"""F_n and F*_n for powers that are half-integers and others, against closed forms at 40 digits."""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from oracles.reference import F, F_star, error, exponential, graded, phi
from scipy.integrate import quad

import analytic
from analytic import Custom, MeasuredHeights, ScipyHeights, Weibull

# Promised: 1e-13. The quadrature itself is good to 1e-14; gamma = 2 loses a digit below h = -1.
TOLERANCE = 1e-13
FAR_H = np.random.default_rng(20240601).uniform(-40, 1000, 40)
# Half the interval means little physically: the same again where contacts are.
CLOSE_H = np.concatenate(
    [np.random.default_rng(20240602).uniform(-40, 40, 20), [-13, -1e-9, 0, 1e-9, 13, 37]]
)
PAIRS = [  # powers, and what the grading is: each of both, and neighbours of all
    *((n, None) for n in (0, 0.5, 1, 2, 2.5, 0.125, 1 / 3, 1.3, 2.2, 5.3)),
    *((n, 0.2) for n in (1, 4.5, 1.625)),
    *((n, 1.5) for n in (0.5, 3, 0.25)),
    *((n, 2.0) for n in (0, 1.5, 6, 0.75)),
]


def worst(found, truth, h):
    """Largest error of scaled integrals."""
    return max(
        error(v, truth(x) / phi(x) if x >= 0 else truth(x)) for v, x in zip(found, h.tolist(), strict=True)
    )


@pytest.mark.parametrize(("n", "gamma"), PAIRS)
def test_integrals_of_any_power_at_random_separations(n, gamma):
    h = np.concatenate([CLOSE_H, FAR_H])
    if gamma is None:
        assert worst(analytic.fn_scaled(n, h), lambda x: F(n, x), h) < TOLERANCE
    else:
        found = analytic.fn_scaled(n, h, analytic.Exponential(gamma))
        assert worst(found, lambda x: F_star(n, x, gamma), h) < TOLERANCE


@pytest.mark.parametrize("n", [0, 1.5, 6])
def test_unscaled_and_its_logarithm(n):
    values, logs = analytic.fn(n, CLOSE_H), analytic.fn(n, CLOSE_H, log=True)
    for h, value, log in zip(CLOSE_H, values, logs, strict=True):
        truth = F(n, h)
        if truth > 1e-290:  # below, doubles themselves lose digits
            assert error(value, truth) < TOLERANCE
        # A logarithm is rounded to its own last digit, here up to 2^-53 |ln F|, in two additions.
        assert abs(mp.log(truth) - float(log)) < TOLERANCE + 4 * 2.0**-53 * abs(float(log))


@pytest.mark.parametrize("n", [0, 1.5, 2.5])
def test_logarithm_far_beyond_underflow(n):
    h = FAR_H[FAR_H > 40][:20]
    assert np.all(analytic.fn(n, h) == 0)
    for x, log in zip(h, analytic.fn(n, h, analytic.Exponential(2.0), log=True), strict=True):
        truth = mp.log(F_star(n, x, 2))
        assert abs(truth - float(log)) < 4 * 2.0**-53 * abs(truth)


@pytest.mark.parametrize("n", [0, 0.5, 1.5, 2])
def test_closed_form_is_the_definition(n):
    """The oracle itself: the paper says that there is no closed form."""
    for h, gamma in ((-3, 0.2), (0.5, 1.5), (20, 0.2)):
        literal = graded(n, h, exponential(gamma))
        assert abs(literal / F_star(n, h, gamma) - 1) < 1e-20  # the digits of the quadrature


def test_shape_order_and_neighbours_do_not_matter():
    h = np.array([[3.0, -40.0, 0.0], [900.0, -0.0, 3.0]])
    together = analytic.fn_scaled(1.5, h)
    assert together.shape == h.shape
    assert together[0, 2] == together[1, 1]
    for index in np.ndindex(h.shape):
        # Alone and in company the sum over nodes may be blocked differently: its rounding only.
        assert float(analytic.fn_scaled(1.5, h[index])) == pytest.approx(together[index], rel=1e-14)
    assert analytic.fn(1.5, []).shape == (0,)


def test_what_is_no_power_or_separation_is_refused():
    for n in (-0.5, -1, math.inf, math.nan):
        with pytest.raises(ValueError, match=f"n = {n}: give a finite number that is not negative"):
            analytic.fn(n, 0.0)
    for h in (math.inf, -math.inf, math.nan):
        with pytest.raises(ValueError, match="must be finite"):
            analytic.fn(1.5, [0.0, h])


def test_logarithm_of_a_negative_integral_is_nan_without_warning():
    assert math.isnan(float(analytic.fn(1.5, 4.0, analytic.Exponential(-1.0), log=True)))


# Powers that are no half-integers


@pytest.mark.parametrize("gap", [1e-12, 1e-6, 0.3])
def test_a_break_close_above_the_separation(gap):
    """The range behind it begins where the power is steepest."""
    h, n = 0.4, 0.25
    grading = Custom(lambda s: np.where(s > h + gap, 2.0, 1.0), breaks=(h + gap,))
    gap = mp.mpf(h + gap) - mp.mpf(h)
    near = gap ** (mp.mpf(n) + 1) / (n + 1)  # of the homogeneous surface, next to h
    with mp.workdps(25):
        near = phi(h) * (
            near - h * gap ** (mp.mpf(n) + 2) / (n + 2) + (h * h - 1) * gap ** (mp.mpf(n) + 3) / (n + 3) / 2
        )
    if gap > 0.1:
        near = graded(n, h, lambda s: 1, high=mp.mpf(h) + gap)
    truth = 2 * F(n, h) - near
    assert error(float(analytic.fn(n, h, grading)), truth) < TOLERANCE


UNIFORM = ScipyHeights(scipy.stats.uniform())


@pytest.mark.parametrize(
    ("law", "h"), [(Weibull(2.0), -3.0), (Weibull(2.0), 0.4), (UNIFORM, -3.0), (UNIFORM, -0.9)]
)
def test_other_height_laws_in_another_variable(law, h):
    """With s - h = v^4 the power 0.25 is v, and nothing is singular at the separation."""
    n, low = 0.25, max(h, law.support[0])

    def term(v):
        return 4 * v**4 * float(law.pdf(np.array(h + v**4)))

    top = min(law.support[1], 20.0)
    truth = quad(term, (low - h) ** 0.25, (top - h) ** 0.25, epsabs=0, epsrel=1e-12, limit=400)[0]
    assert float(analytic.fn(n, h, heights=law)) == pytest.approx(truth, rel=1e-11)


def test_measured_heights_are_summed():
    heights = MeasuredHeights([-1.2, 0.1, 0.7, 2.0])
    s = np.array(heights.heights)
    truth = np.sum(np.where(s > 0.05, np.abs(s - 0.05) ** 1.7, 0.0)) / 4
    assert float(analytic.fn(1.7, 0.05, heights=heights)) == pytest.approx(truth, rel=1e-14)


def over_a_kink(x, kink):
    """F*_1.5 relative to the density at x, for 1 + |s - kink|, by mpmath between the kink and the mean."""

    def integrand(s):
        return (s - x) ** mp.mpf(1.5) * (1 + abs(s - kink)) * mp.exp((mp.mpf(max(x, 0.0)) ** 2 - s * s) / 2)

    ends = sorted({x, *(k for k in (kink, 0.0) if k > x), x + 1, x + 4, max(x, 0.0) + 14})
    with mp.workdps(25):
        return float(mp.quad(integrand, ends) / (1 if x >= 0 else mp.sqrt(2 * mp.pi)))


@pytest.mark.parametrize("kink", [24.5, -6.5, 0.3])
def test_kinks_that_only_one_of_several_separations_reaches(kink):
    """The lowest reaches up to 13, the highest from 24 on."""
    h = [-7.0, 0.0, 12.0, 24.0]
    found = analytic.fn_scaled(1.5, h, Custom(lambda s: 1 + np.abs(s - kink), (kink,)))
    np.testing.assert_allclose(found, [over_a_kink(x, kink) for x in h], rtol=1e-12)
