"""F_n and F*_n for any power and grading: closed forms, and quadrature of the definition, at 40 digits."""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from oracles.inside import fn_scaled
from oracles.reference import F, F_star, error, exponential, graded, integral, pchip, phi

import analytic
from analytic import Clipped, Custom, Exponential, Table

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
        assert worst(fn_scaled(n, h), lambda x: F(n, x), h) < TOLERANCE
    else:
        found = fn_scaled(n, h, Exponential(gamma))
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
    for x, log in zip(FAR_H, analytic.fn(1.5, FAR_H, Exponential(2.0), log=True), strict=True):
        truth = mp.log(F_star(1.5, x, 2))
        assert abs(truth - float(log)) < 4 * 2.0**-53 * abs(truth)
    assert math.isnan(float(analytic.fn(1.5, 4.0, Exponential(-1.0), log=True)))


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
    together = fn_scaled(1.5, h, grading)
    assert together.shape == h.shape
    assert together[0, 2] == together[1, 1]
    for index in np.ndindex(h.shape):
        # Alone and in company the sum over nodes may be blocked differently: its rounding only.
        assert float(fn_scaled(1.5, h[index], grading)) == pytest.approx(together[index], rel=1e-13)
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


# Any grading

S, RATIO = (-2.0, -0.7, 0.1, 0.4, 1.5, 3.0), (0.3, 0.6, 0.6, 1.4, 1.1, 2.0)
JUMP, KINK, ZERO = mp.mpf(1.1), mp.mpf(0.4), mp.mpf(0.3)


def jump_and_kink(s):
    return np.where(s > 1.1, 2.0, 1.0) + np.abs(s - 0.4)


def fading(width, sign):
    """1 +- tanh(s/w) has lost its relative digits where it is small: no reason to give up."""
    w = mp.mpf(width)
    cuts = [k * w for k in (-20, -10, -5, -2, -1, 1, 2, 5, 10, 20)]
    return Custom(lambda s: 1 + sign * np.tanh(s / width)), lambda s: 1 + sign * mp.tanh(s / w), cuts


def both_ways(s):
    return (2 if s > JUMP else 1) + abs(s - KINK)


LITERAL = {  # grading, the same of mpmath, cuts of its quadrature, powers and separations
    "jump and kink": (Custom(jump_and_kink), both_ways, [KINK, JUMP], (0,), (-9.0, 0.3)),
    "told": (Custom(jump_and_kink, (0.4, 1.1)), both_ways, [KINK, JUMP], (1.5,), (-0.5, 4.0)),
    "fades": (*fading(0.1, 1), (1.5,), (-3.0,)),
    "fades fast upwards": (*fading(0.01, -1), (1.5,), (-0.01,)),
    "waves": (
        Custom(lambda s: 2 + np.sin(20 * s)), lambda s: 2 + mp.sin(20 * s), [3.3 + k / 4 for k in range(20)],
        (1.5,), (3.3,),
    ),
    "both sides": (
        Custom(lambda s: np.exp(3 * np.abs(s))), lambda s: mp.exp(3 * abs(s)), [0], (1.5,), (-9.0, -0.5),
    ),
    "table": (Table(S, RATIO), pchip(S, RATIO), S, (1.5,), (-1.0, 2.9)),
    "clipped": (
        Clipped(Custom(lambda s: s - 0.3)), lambda s: max(s - ZERO, 0), [ZERO], (1.5,), (-2.0, 0.5),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LITERAL)
def test_any_grading_against_the_definition(name):
    grading, exact, cuts, powers, separations = LITERAL[name]
    for n in powers:
        for h, value in zip(separations, analytic.fn(n, separations, grading), strict=True):
            assert error(value, graded(n, h, exact, breaks=cuts)) < TOLERANCE


KNOTS = (-1.0, 0.3, 0.30001, 0.30003, 0.3001, 2.0)
MODULI = (0.5, 0.6, 2.0, 0.8, 1.7, 1.9)
UNDER = {
    "gaussian": (analytic.Gaussian(), lambda s: np.exp(-s * s / 2) / math.sqrt(2 * math.pi), 13.0),
    "exponential": (analytic.ExponentialHeights(), lambda s: np.exp(-1 - s), 60.0),
}


@pytest.mark.parametrize(("law", "h"), [("gaussian", -0.9), ("gaussian", 0.30002), ("exponential", 0.29999)])
def test_knots_nearer_than_the_points_of_a_rule(law, h):
    """Means, variances and covariances of a load against literal sums piece by piece."""
    heights, density, top = UNDER[law]
    table, upper = Table(KNOTS, MODULI), h + 0.5
    x, w = np.polynomial.legendre.leggauss(40)

    def literal(f, low):
        marks = [low, *(k for k in (*KNOTS, *np.arange(0.5, top, 0.5), top) if k > low)]
        v = np.sqrt(np.array(marks) - low)  # s = low + v^2
        v, dv = v[:-1, None] + np.diff(v)[:, None] * (1 + x) / 2, np.diff(v)[:, None] / 2 * w
        s = low + v * v
        return float(np.sum(2 * v * dv * density(s) * f(s)))

    def load(s, h):
        return np.maximum(s - h, 0) ** 1.5 * table(s)

    first, second = literal(lambda s: load(s, h), h), literal(lambda s: load(s, h) ** 2, h)
    assert float(analytic.fn(1.5, h, table, heights=heights)) == pytest.approx(first, rel=1e-13)
    unit = analytic.Surface(1.0, 1.0, 1.0, 1.0, 0.75)
    model = analytic.Model(unit, grading=table, heights=heights, n_asperities=1.0)
    assert float(model.std("load", h)) ** 2 == pytest.approx(second - first**2, rel=1e-12)
    both = replace(model, count="poisson").covariance(["load"], [h, upper])[0, 0, 0, 1]
    assert both == pytest.approx(literal(lambda s: load(s, h) * load(s, upper), upper), rel=1e-12)


@pytest.mark.parametrize(("gamma", "n"), [(1.5, 1.5), (-0.2, 0)])
def test_clipped_exponential(n, gamma):
    law = Clipped(Exponential(gamma))
    assert (law.smooth, law.breaks) == (True, (Exponential(gamma).zero,))
    assert not Clipped(Custom(np.tanh, smooth=True)).smooth  # its zero not given
    g = mp.mpf(gamma)
    zero = -mp.log(g / (g - 1))
    low, high = (None, zero) if gamma < 0 else (zero, None)
    for h in (-8.0, -0.3, 0.9):
        if gamma < 0 and h >= zero:
            continue
        f = lambda s, h=h: (s - mp.mpf(h)) ** n * (g - (g - 1) * mp.exp(-s))  # noqa: E731
        truth = integral(f, h, low=low if low is not None and low > h else None, high=high)
        # The zero is where float arithmetic puts it; the modulus vanishes there, so it does not count.
        assert error(analytic.fn(n, h, law), truth) < TOLERANCE


@pytest.mark.parametrize(
    ("s", "ratio"), [(S, RATIO), ((0, 1), (1, 3)), ((0, 1, 2), (5, 1, 1.5)), (S, RATIO[::-1])]
)
def test_interpolant_against_its_definition(s, ratio):
    """To some ten roundings of a cubic."""
    heights, truth = np.concatenate([np.linspace(-4, 5, 91), s]), pchip(s, ratio)
    assert Table(s, ratio).breaks == tuple(s)
    np.testing.assert_allclose(Table(s, ratio)(heights), [float(truth(x)) for x in heights], rtol=1e-14)
