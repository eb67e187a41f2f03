"""A grading as Chebyshev series: next to every height as the function is, and the same bits everywhere."""

import dataclasses
import functools
import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats

import analytic
from analytic import Clipped, Custom, Exponential, PiecewiseSeries, Table, extent, resolved

SPIKE = 0.03
CURVES = {  # function of numpy, the same of mpmath, breaks that are told, kinks that are to be found
    "kink": (lambda s: 2 + np.abs(s - 0.777), lambda s: 2 + abs(s - mp.mpf(0.777)), (), [0.777]),
    "step": (lambda s: np.where(s > 1.234, 2.0, 0.5), lambda s: 2 if s > 1.234 else 0.5, (), [1.234]),
    "told": (
        lambda s: np.where(s > 1.1, 2.0, 1.0) + np.abs(s - 0.4),
        lambda s: (2 if s > 1.1 else 1) + abs(s - mp.mpf(0.4)),
        (0.4, 1.1),
        [0.4, 1.1],
    ),
    "exp(12 s)": (lambda s: np.exp(12 * s), lambda s: mp.exp(12 * s), (), []),
    "bump": (
        lambda s: 1 + np.exp(-(((s - 1.2) / SPIKE) ** 2)),
        lambda s: 1 + mp.exp(-(((s - mp.mpf(1.2)) / mp.mpf(SPIKE)) ** 2)),
        (),
        [],
    ),
}  # fmt: skip


def truth(curve, s):
    with mp.workdps(30):
        return np.array([float(curve(mp.mpf(float(x)))) for x in s])


def off(series, curve, s):
    """Error over the largest value within 1/64, less what the last digit of a height does."""
    exact = truth(curve, s)
    near = np.max([np.abs(truth(curve, np.clip(s + d, 0, 13))) for d in (-1 / 64, 1 / 64)], axis=0)
    slope = np.abs(truth(curve, s + 1e-7) - truth(curve, s - 1e-7)) / 2e-7
    return (np.abs(series(s) - exact) - 4 * np.spacing(s) * slope) / np.maximum(near, np.abs(exact))


@pytest.mark.parametrize("name", CURVES)
def test_the_curve_itself(name):
    function, exact, told, kinks = CURVES[name]
    series = resolved(Custom(function, told), 0.0, 13.0)
    rng = np.random.default_rng(20)
    s = np.concatenate([rng.uniform(0, 13, 300), rng.uniform(0, 3, 200), series.edges[1:-1]])
    s = s[np.min([np.abs(s - k) for k in (*kinks, math.inf)], axis=0) > 1e-9]
    assert off(series, exact, s).max() < 1e-13
    assert (series.edges[0], series.edges[-1]) == (0.0, 13.0)
    assert all(min(abs(k - found) for k in kinks) < 1e-10 for found in series.kinks)
    assert all(min(abs(k - found) for found in series.kinks) < 1e-10 for k in kinks)


def test_evaluation_is_literal_arithmetic():
    """Python's own floats, one by one, give the same bits: nothing is fused, reordered or called."""
    series = resolved(Custom(lambda s: 1 + 0.3 * np.tanh(s)), 0.0, 13.0)
    s = np.random.default_rng(20).uniform(-1, 14, 300)
    expected = []
    for x in s.tolist():
        x = min(max(x, series.edges[0]), series.edges[-1])
        k = sum(edge <= x for edge in series.edges[1:-1])
        a, b, c = series.edges[k], series.edges[k + 1], [*series.coefficients[k], 0.0, 0.0]
        u, last, value = ((x - a) - (b - x)) / (b - a), 0.0, 0.0
        for coefficient in c[::-1]:
            last, value = coefficient - value, last + 2 * u * value
        expected.append(last + u * value)
    np.testing.assert_array_equal(series(s), expected)


def test_zeros_are_found_where_the_sign_changes():
    roots = [0.3, 1.0, 1.0 + 1e-4, 7.7]

    def function(s):
        return np.prod([s - r for r in roots], axis=0)

    series = resolved(Custom(function), 0.0, 13.0)
    assert len(series.zeros) == len(roots)
    slope = np.array([np.prod([r - q for q in roots if q != r]) for r in roots])
    np.testing.assert_allclose(series.zeros, roots, rtol=0, atol=4e-16 * 100 / np.abs(slope).min())
    for zero in series.zeros:
        assert np.sign(series(np.array(zero))) != np.sign(series(np.nextafter(np.array(zero), -np.inf)))
    assert resolved(Custom(lambda s: (s - 1) ** 2), 0.0, 3.0).zeros == ()
    assert resolved(Custom(lambda s: np.where(s > 1, 1.0, -1.0), (1.0,)), 0.0, 3.0).zeros == (1.0,)
    assert PiecewiseSeries([0, 1, 2], [[0.0], [1.0, 1.0]]).zeros == ()
    there_and_back = PiecewiseSeries([0, 1, 2], [[0.25, -0.75], [1.0]])  # down to -1/2, and a jump to 1
    np.testing.assert_allclose(there_and_back.zeros, [2 / 3, 1.0], rtol=1e-15)


@pytest.mark.parametrize("function", [
    lambda s: (s - 1) ** 2, lambda s: np.abs(s - 1.3), lambda s: np.exp(-50 * (s - 1) ** 2),
    lambda s: 1.0 * (s > 0.3),
])  # fmt: skip
def test_what_is_never_negative_stays_so(function):
    series = resolved(Custom(function), -6.0, 13.0)
    assert analytic.first_negative(series, -6.0, 13.0) is None
    assert series(np.random.default_rng(20).uniform(-6, 13, 20_000)).min() >= 0


def test_it_is_a_value():
    assert analytic.is_data(Table([0.0, 1.0], [1.0, 2.0]))
    assert not analytic.is_data(Clipped(Exponential(2.0)))
    one, other = (resolved(Custom(np.cosh), 0.0, 13.0) for _ in range(2))
    assert one == other
    assert hash(one) == hash(other)
    assert one != dataclasses.replace(one, name="other")
    assert len(repr(one)) < 80


def test_two_resolutions_of_one_function_agree():
    """Whatever breaks beyond the ends were told; another function, or another range, does not."""
    one = resolved(Custom(lambda s: 1 + 0.3 * np.tanh(s)), 0.0, 13.0)
    other = Custom(lambda s: (1 + 0.3 * np.tanh(s)) * (1 + 1e-15), (-3.0, 1.0, 20.0))
    assert one.agrees(resolved(other, 0.0, 13.0))
    assert not one.agrees(resolved(Custom(lambda s: 1 + (0.3 + 1e-12) * np.tanh(s)), 0.0, 13.0))
    assert not one.agrees(resolved(Custom(lambda s: 1 + 0.3 * np.tanh(s)), 1.0, 13.0))


@pytest.mark.parametrize(("law", "h"), [
    (analytic.Gaussian(), (0.0, 4.0)), (analytic.ExponentialHeights(), (-30.0, 1.0)),
    (analytic.HeightTable.of([1.0, 2.0, 5.0, 9.0]), (-30.0, 1.0)),
    (analytic.ScipyHeights(scipy.stats.genextreme(-0.1)), (1.0,)),
])  # fmt: skip
def test_no_sample_leaves_the_range(law, h):
    """What the samplers ask a law for at most: a share of 2^-66 of what is above their highest cell."""
    low, high = extent(Custom(np.tanh), law, h)
    assert low == max(h[0], low)
    assert float(law.ppf(np.array(2.0**-66))) >= low or low == h[0]
    for start in (-math.inf, h[-1], float(law.isf(np.array(0.1 / 2**53)))):
        if float(law.sf(np.array(start))) > 0:
            assert float(law.isf(np.array(2.0**-66), start)) <= high


def test_first_negative_modulus():
    """Of a rising and of a falling one the next of 4001 heights; and on both sides of a break."""
    for gamma in (1.2, 2.0, 5.0):
        grading = Exponential(gamma)
        assert analytic.first_negative(grading, grading.zero + 1e-9, 10) is None
        assert analytic.first_negative(grading, grading.zero - 0.3, 10) == grading.zero - 0.3
    falling = Exponential(-0.2)
    assert 0 < analytic.first_negative(falling, 0, 8) - falling.zero <= 8 / 4000 + 1e-12
    third = 1 / 3
    spike, step = (lambda s: np.where(s == third, -1.0, 1.0)), (lambda s: np.where(s < third, -1.0, 1.0))
    assert analytic.first_negative(Custom(spike, (third,)), 0, 1) == third
    assert analytic.first_negative(Custom(step, (third,)), third, 1) is None


def named(s):
    return 1 + s * s


def test_names():
    """Of functions, and of what is made of them."""
    of = {
        functools.partial(named): "named",
        np.cosh: "cosh",
        Custom(lambda s: s): "<lambda>",
        Clipped(Custom(named)): "named, clipped",
        Exponential(2.0): "Exponential",
        PiecewiseSeries([0, 1], [[1]], "kept"): "kept",
    }
    assert [analytic.name_of(grading) for grading in of] == list(of.values())
