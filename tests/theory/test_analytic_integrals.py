"""F_n and F*_n for powers that are half-integers and others, against closed forms at 40 digits."""

import math

import mpmath as mp
import numpy as np
import pytest
from oracles.reference import F, F_star, error, exponential, graded, phi

import analytic
from analytic import Custom

# Promised: 1e-13. The quadrature itself is good to 1e-14; gamma = 2 loses a digit below h = -1.
TOLERANCE = 1e-13
FAR_H = np.random.default_rng(20240601).uniform(40, 1000, 20)
CLOSE_H = np.concatenate(
    [np.random.default_rng(20240602).uniform(-40, 40, 12), [-13, -1e-9, 0, 1e-9, 13, 37]]
)
PAIRS = [  # powers, half-integers and others, and gammas
    *((n, None) for n in (0, 1, 2.5, 0.125, 1 / 3, 5.3)),
    *((n, 0.2) for n in (0.5, 1.625)),
    *((n, 2.0) for n in (1.5, 6, 0.75)),
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


@pytest.mark.parametrize("n", [0, 1.5])
def test_unscaled_and_its_logarithm(n):
    values, logs = analytic.fn(n, CLOSE_H), analytic.fn(n, CLOSE_H, log=True)
    for h, value, log in zip(CLOSE_H, values, logs, strict=True):
        truth = F(n, h)
        if truth > 1e-290:  # below, doubles themselves lose digits
            assert error(value, truth) < TOLERANCE
        # A logarithm is rounded to its own last digit, here up to 2^-53 |ln F|, in two additions.
        assert abs(mp.log(truth) - float(log)) < TOLERANCE + 4 * 2.0**-53 * abs(float(log))


def test_logarithm_far_beyond_underflow():
    assert np.all(analytic.fn(1.5, FAR_H) == 0)
    for x, log in zip(FAR_H, analytic.fn(1.5, FAR_H, analytic.Exponential(2.0), log=True), strict=True):
        truth = mp.log(F_star(1.5, x, 2))
        assert abs(truth - float(log)) < 4 * 2.0**-53 * abs(truth)
    assert math.isnan(float(analytic.fn(1.5, 4.0, analytic.Exponential(-1.0), log=True)))


def test_closed_form_is_the_definition():
    """The oracle itself: the paper says that there is no closed form."""
    for n, h, gamma in ((1.5, -3, 0.2), (0.5, 0.5, 1.5)):
        literal = graded(n, h, exponential(gamma))
        assert abs(literal / F_star(n, h, gamma) - 1) < 1e-20  # the digits of the quadrature


def test_shape_order_and_neighbours_do_not_matter():
    """Though a rule reaches only so far above a separation: kinks are near the highest, and the lowest."""
    h, grading = (
        np.array([[12.0, -7.0, 0.0], [24.0, -0.0, 12.0]]),
        Custom(lambda s: 1 + abs(abs(s - 9) - 15.5)),
    )
    together = analytic.fn_scaled(1.5, h, grading)
    assert together.shape == h.shape
    assert together[0, 2] == together[1, 1]
    for index in np.ndindex(h.shape):
        # Alone and in company the sum over nodes may be blocked differently: its rounding only.
        assert float(analytic.fn_scaled(1.5, h[index], grading)) == pytest.approx(together[index], rel=1e-13)
    assert analytic.fn(1.5, []).shape == (0,)


# Powers that are no half-integers


@pytest.mark.parametrize("gap", [1e-12, 1e-6])
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
    truth = 2 * F(n, h) - near
    assert error(float(analytic.fn(n, h, grading)), truth) < TOLERANCE
