"""Where a grading is cut: jumps that were not declared are found, and noise is refused."""

import math

import numpy as np
import pytest
import scipy.stats

import analytic
from analytic import Custom, Exponential, resolved_breaks


def near(cuts, place, distance):
    return any(abs(c - place) <= distance for c in cuts)


def test_declared_breaks_in_the_range_are_kept_and_sorted():
    grading = Custom(np.ones_like, breaks=(2.0, -1.0, 0.5, 99.0))
    assert resolved_breaks(grading, -5, 5) == (-1.0, 0.5, 2.0)
    assert resolved_breaks(grading, 5, 5) == ()


def test_smooth_gradings_are_not_looked_at():
    def fail(s):
        raise AssertionError("a smooth grading was evaluated")

    assert resolved_breaks(Custom(fail, breaks=(1.0,), smooth=True), -5, 5) == (1.0,)


@pytest.mark.parametrize("place", [0.3, -7.77, 4.0, 0.5, math.pi])
@pytest.mark.parametrize("function", [np.sign, np.abs, lambda x: np.maximum(x, 0)])
def test_undeclared_jump_or_kink_is_enclosed(place, function):
    cuts = resolved_breaks(Custom(lambda s: 3 + function(s - place)), -13, 13)
    # A jump in a piece 1e-14 wide is worth 1e-14. Kinks: the product of slope and width is.
    assert near(cuts, place, 1e-11)
    assert len(cuts) <= 4


@pytest.mark.parametrize("function", [np.square, np.ones_like, lambda s: 1 + s**3 / 100])
def test_polynomials_are_never_cut(function):
    assert resolved_breaks(Custom(function), -13, 13) == ()


def test_a_bump_is_cut_where_it_is():
    cuts = np.array(resolved_breaks(Custom(lambda s: 1 + np.exp(-(((s - 1.2) / 0.03) ** 2))), -13, 13))
    assert np.sum((cuts > 0.5) & (cuts < 2)) >= 4
    assert cuts.size <= 12


@pytest.mark.parametrize("sign", [1, -1])
def test_rounding_noise_of_the_function_is_not_chased(sign):
    cuts = resolved_breaks(Custom(lambda s: 1 + sign * np.tanh(s / 0.1)), -13, 13)
    assert len(cuts) < 20


@pytest.mark.parametrize("amplitude", [1.0, 1e-3, 1e-9])
def test_noise_is_refused(amplitude):
    def noisy(s):
        return 1 + amplitude * np.modf(np.sin(1e9 * s) * 1e5)[0]

    with pytest.raises(ValueError, match=r"not resolved by 4096 pieces near s = .*noisy"):
        resolved_breaks(Custom(noisy), 0, 4)


@pytest.mark.parametrize("gamma", [1.2, 2.0, 5.0])
def test_first_negative_above_a_range_of_negative_moduli(gamma):
    grading = Exponential(gamma)
    assert analytic.first_negative(grading, grading.zero + 1e-9, 10) is None
    assert analytic.first_negative(grading, grading.zero - 0.3, 10) == grading.zero - 0.3


def test_first_negative_of_a_falling_modulus():
    grading = Exponential(-0.2)
    found = analytic.first_negative(grading, 0, 8)
    assert 0 < found - grading.zero <= 8 / 4000 + 1e-12  # the next of 4001 heights


def test_first_negative_looks_on_both_sides_of_a_break():
    def spike(s):
        return np.where(s == 1 / 3, -1.0, 1.0)

    assert analytic.first_negative(Custom(spike, breaks=(1 / 3,)), 0, 1) == 1 / 3
    assert (
        analytic.first_negative(Custom(lambda s: np.where(s < 1 / 3, -1.0, 1.0), (1 / 3,)), 1 / 3, 1) is None
    )


@pytest.mark.parametrize("sign", [1, -1])
def test_heavy_tails_reach_far_in_few_pieces(sign):
    """A t law of 5 degrees has heights of a million deviations: that is no reason for a million pieces."""
    seen = []
    step = sign * 1234.5

    def grading(s):
        seen.append(s.size)
        return np.where(s > step, 2.0, 1.0)

    ends = sorted((sign * 0.3, sign * 4e6))
    breaks = resolved_breaks(Custom(grading), *ends)
    assert min(abs(b - step) for b in breaks) < 1e-9
    assert sum(seen) < 10**6


def test_an_untold_grading_under_a_heavy_tail():
    law = analytic.ScipyHeights(scipy.stats.t(5))
    told, untold = (Custom(lambda s: 2 + np.tanh(s), smooth=smooth) for smooth in (True, False))
    expected, found = (analytic.fn(1.5, [-0.5, 0.3, 2.0], g, heights=law) for g in (told, untold))
    np.testing.assert_allclose(found, expected, rtol=1e-12)
