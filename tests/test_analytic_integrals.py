"""F_n and F*_n of the homogeneous and the exponential grading, against closed forms at 40 digits."""

import math

import mpmath as mp
import numpy as np
import pytest
from reference import F, F_star, error, exponential, graded, phi

import analytic

# Promised: 1e-13. The quadrature itself is good to 1e-14; gamma = 2 loses a digit below h = -1.
TOLERANCE = 1e-13
ORDERS = (0, 0.5, 1, 1.5, 2, 2.5)
RANDOM_H = np.random.default_rng(20240601).uniform(-40, 1000, 500)
# Half the interval means little physically: the same again where contacts are.
CLOSE_H = np.concatenate(
    [np.random.default_rng(20240602).uniform(-40, 40, 60), [-13, -1e-9, 0, 1e-9, 13, 37]]
)


def scaled(truth: mp.mpf, h: float) -> mp.mpf:
    return truth / phi(h) if h >= 0 else truth


@pytest.mark.parametrize("n", ORDERS)
def test_homogeneous_at_500_random_separations(n):
    values = analytic.fn_scaled(n, RANDOM_H)
    assert max(error(v, scaled(F(n, h), h)) for v, h in zip(values, RANDOM_H, strict=True)) < TOLERANCE


@pytest.mark.parametrize("gamma", [0.2, 1.5, 2.0])
@pytest.mark.parametrize("n", [*ORDERS, 3, 4.5, 6])
def test_exponential(n, gamma):
    h = np.concatenate([CLOSE_H, RANDOM_H[:20]])
    values = analytic.fn_scaled(n, h, analytic.Exponential(gamma))
    assert max(error(v, scaled(F_star(n, x, gamma), x)) for v, x in zip(values, h, strict=True)) < TOLERANCE


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
    h = RANDOM_H[(RANDOM_H > 40)][:40]
    assert np.all(analytic.fn(n, h) == 0)
    for x, log in zip(h, analytic.fn(n, h, analytic.Exponential(2.0), log=True), strict=True):
        truth = mp.log(F_star(n, x, 2))
        assert abs(truth - float(log)) < 4 * 2.0**-53 * abs(truth)


@pytest.mark.parametrize("n", [0, 0.5, 1.5, 2])
def test_closed_form_is_the_definition(n):
    """The oracle itself: the paper says that there is no closed form."""
    for h in (-3, 0.5, 4, 20):
        for gamma in (0.2, 1.5):
            literal = graded(n, h, exponential(gamma))
            assert abs(literal / F_star(n, h, gamma) - 1) < 1e-20  # the digits of the quadrature


def test_plain_cases_known_by_heart():
    assert float(analytic.fn(0, 0.0)) == pytest.approx(0.5, rel=1e-15)
    assert float(analytic.fn(1, 0.0)) == pytest.approx(1 / math.sqrt(2 * math.pi), rel=1e-15)
    assert float(analytic.fn(2, 0.0)) == pytest.approx(0.5, rel=1e-15)
    # Everything touches: mean of (s - h)^2 is 1 + h^2.
    assert float(analytic.fn(2, -40.0)) == pytest.approx(1601, rel=1e-14)


@pytest.mark.parametrize(
    "grading", [None, analytic.Exponential(1.5), analytic.Custom(lambda s: 2 + np.sin(s))]
)
@pytest.mark.parametrize("n", [1, 1.5, 2.5])
def test_derivative_is_minus_n_times_the_order_below(n, grading):
    h, step = np.linspace(-6, 6, 25), 1e-2
    f = {k: analytic.fn(n, h + k * step, grading) for k in (-3, -2, -1, 1, 2, 3)}
    slope = (45 * (f[1] - f[-1]) - 9 * (f[2] - f[-2]) + f[3] - f[-3]) / (60 * step)
    # Sixth order: (step^6/140) F^(7) is 1e-14 of it (times 7th powers of h <= 6), rounding 1e-16/step.
    np.testing.assert_allclose(slope, -n * analytic.fn(n - 1, h, grading), rtol=2e-9)


@pytest.mark.parametrize("n", [1, 1.5, 2])
def test_recurrence(n):
    h = np.linspace(-8, 0.5, 18)  # above, n F_{n-1} - h F_n is a difference of nearly equal numbers
    right = n * analytic.fn(n - 1, h) - h * analytic.fn(n, h)
    np.testing.assert_allclose(analytic.fn(n + 1, h), right, rtol=1e-13)


def test_gamma_one_is_homogeneous():
    h = np.linspace(-10, 30, 41)
    for n in (0, 0.5, 1.5):
        np.testing.assert_array_equal(analytic.fn(n, h, analytic.Exponential(1.0)), analytic.fn(n, h))


def test_shape_order_and_neighbours_do_not_matter():
    h = np.array([[3.0, -40.0, 0.0], [900.0, -0.0, 3.0]])
    together = analytic.fn_scaled(1.5, h)
    assert together.shape == h.shape
    assert together[0, 2] == together[1, 1]
    for index in np.ndindex(h.shape):
        # Alone and in company the sum over nodes may be blocked differently: its rounding only.
        assert float(analytic.fn_scaled(1.5, h[index])) == pytest.approx(together[index], rel=1e-14)
    assert analytic.fn(1.5, []).shape == (0,)


@pytest.mark.parametrize("n", [-0.5, -1, math.inf, math.nan])
def test_wrong_order_is_refused(n):
    with pytest.raises(ValueError, match=f"n = {n}: give a finite number that is not negative"):
        analytic.fn(n, 0.0)


@pytest.mark.parametrize("h", [math.inf, -math.inf, math.nan])
def test_wrong_separation_is_refused(h):
    with pytest.raises(ValueError, match="must be finite"):
        analytic.fn(1.5, [0.0, h])


@pytest.mark.parametrize(("h", "low", "high"), [(0, 1, 3), (-2, -5, 0.5), (1, 11, math.inf), (-40, -3, -1)])
def test_share_between_two_heights(h, low, high):
    for n in (0, 1.5):
        f = {"low": max(h, low), "high": None if math.isinf(high) else high}
        part = graded(n, h, lambda s: 2 - mp.exp(-s), **f)
        share = analytic.fn_between(n, h, low, high, analytic.Exponential(2.0))
        assert error(share, part / F_star(n, h, 2)) < TOLERANCE


def test_shares_add_up():
    h = np.linspace(-5, 5, 11)
    parts = [analytic.fn_between(1.5, h, a, b) for a, b in [(-math.inf, 0), (0, 2), (2, math.inf)]]
    np.testing.assert_allclose(sum(parts), 1, rtol=1e-14)


def test_logarithm_of_a_negative_integral_is_nan_without_warning():
    assert math.isnan(float(analytic.fn(1.5, 4.0, analytic.Exponential(-1.0), log=True)))
