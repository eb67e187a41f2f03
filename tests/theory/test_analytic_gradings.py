"""F*_n for any grading: closed forms, and quadrature of the definition at 40 digits."""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from oracles.reference import F, error, graded, integral, pchip

import analytic
from analytic import Clipped, Custom, Exponential, Table

TOLERANCE = 1e-13  # promised for every grading that is resolved
S, RATIO = (-2.0, -0.7, 0.1, 0.4, 1.5, 3.0), (0.3, 0.6, 0.6, 1.4, 1.1, 2.0)
JUMP, KINK, ZERO = mp.mpf(1.1), mp.mpf(0.4), mp.mpf(0.3)


def jump_and_kink(s):
    return np.where(s > 1.1, 2.0, 1.0) + np.abs(s - 0.4)


def ramp(centre):
    """Of a millionth of sigma; the function, the same of mpmath, and cuts."""
    steps = (-600, -200, -80, -40, -20, -10, -2, -1, 0, 1, 2, 4, 8, 16, 32, 64, 128, 256, 600)
    cuts = [mp.mpf(centre) + k * mp.mpf(10) ** -7 for k in steps]
    return (
        Custom(lambda s: 2 + np.tanh(1e6 * (s - centre))),
        lambda s: 2 + mp.tanh(10**6 * (s - centre)),
        cuts,
    )


def fading(width, sign):
    """1 +- tanh(s/w) has lost its relative digits where it is small: no reason to give up."""
    w = mp.mpf(width)
    cuts = [k * w for k in (-20, -10, -5, -2, -1, 1, 2, 5, 10, 20)]
    return Custom(lambda s: 1 + sign * np.tanh(s / width)), lambda s: 1 + sign * mp.tanh(s / w), cuts


def both_ways(s):
    return (2 if s > JUMP else 1) + abs(s - KINK)


LITERAL = {  # grading, the same of mpmath, cuts of its quadrature, powers and separations
    "jump and kink": (Custom(jump_and_kink), both_ways, [KINK, JUMP], (0, 1.5), (-9.0, 0.3)),
    "told": (Custom(jump_and_kink, (0.4, 1.1)), both_ways, [KINK, JUMP], (0.5, 1.5), (-0.5, 0.3, 4.0)),
    "ramp": (*ramp(1.7), (1.5,), (-2.5, 1.69999)),
    "ramp below": (*ramp(-0.4), (1.5,), (-2.5, -0.41)),
    "inside the ramp": (*ramp(1.7), (0,), (1.7 - 3e-7,)),
    "fades": (*fading(1.0, 1), (1.5,), (-3.0, -1.0)),
    "fades upwards": (*fading(0.1, -1), (1.5,), (-3.0, -0.1)),
    "fades fast": (*fading(0.01, 1), (1.5,), (-3.0,)),
    "fades fast upwards": (*fading(0.01, -1), (1.5,), (-0.01,)),
    "both sides": (
        Custom(lambda s: np.exp(3 * np.abs(s))), lambda s: mp.exp(3 * abs(s)), [0], (0, 1.5), (-9.0, -0.5),
    ),
    "table": (Table(S, RATIO), pchip(S, RATIO), S, (1.5,), (-1.0, 0.1, 2.9)),
    "clipped": (
        Clipped.of(Custom(lambda s: s - 0.3)), lambda s: max(s - ZERO, 0), [ZERO], (1.5,), (-2.0, 0.5),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", LITERAL)
def test_any_grading_against_the_definition(name):
    grading, exact, cuts, powers, separations = LITERAL[name]
    for n in powers:
        for h, value in zip(separations, analytic.fn(n, separations, grading), strict=True):
            assert error(value, graded(n, h, exact, breaks=cuts)) < TOLERANCE


def bump(n, h, b, c):
    """Closed form of exp(-b (s - c)^2/2)."""
    b, c, h = mp.mpf(b), mp.mpf(c), mp.mpf(h)
    root = mp.sqrt(1 + b)
    return mp.exp(-b * c**2 / (2 * (1 + b))) * root ** (-n - 1) * F(n, root * (h - b * c / (1 + b)))


@pytest.mark.parametrize(
    ("n", "b", "c"), [(0, 4.0, 1.0), (1.5, 400.0, 0.62), (0, 400.0, 0.62), (1.5, 0.5, -2.0)]
)
def test_gaussian_bump(n, b, c):
    h = (-3.0, 0.0, 0.5, 0.62, 1.0)
    found = analytic.fn(n, h, Custom(lambda s: np.exp(-b * (s - c) ** 2 / 2)))
    assert max(error(value, bump(n, x, b, c)) for x, value in zip(h, found, strict=True)) < TOLERANCE


def test_waves():
    """By 200 panels of a rule of its own."""
    x, w = np.polynomial.legendre.leggauss(40)
    for h in (-4.0, 3.3):
        edges = np.linspace(0, math.sqrt(13 - h), 200)
        v = edges[:-1, None] + np.diff(edges)[:, None] * (1 + x) / 2
        terms = 2 * v**4 * (2 + np.sin(20 * (h + v * v))) * np.exp(-((h + v * v) ** 2) / 2)
        truth = float(np.sum(np.diff(edges)[:, None] / 2 * w * terms)) / math.sqrt(2 * math.pi)
        found = float(analytic.fn(1.5, h, Custom(lambda s: 2 + np.sin(20 * s))))
        assert found == pytest.approx(truth, rel=TOLERANCE)


KNOTS = (-1.0, 0.3, 0.30001, 0.30003, 0.3001, 2.0)
MODULI = (0.5, 0.6, 2.0, 0.8, 1.7, 1.9)
UNDER = {
    "gaussian": (analytic.Gaussian(), lambda s: np.exp(-s * s / 2) / math.sqrt(2 * math.pi), 13.0),
    "exponential": (analytic.ExponentialHeights(), lambda s: np.exp(-1 - s), 60.0),
}


@pytest.mark.parametrize("law", UNDER)
@pytest.mark.parametrize("h", [-0.9, 0.29999, 0.30002, 1.0])
def test_knots_nearer_than_the_points_of_a_rule(h, law):
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


@pytest.mark.parametrize(("gamma", "n"), [(1.5, 0), (1.5, 1.5), (3.0, 0.5), (-0.2, 0), (-0.2, 1.5)])
def test_clipped_exponential(n, gamma):
    law = Clipped.of(Exponential(gamma))
    assert (law.smooth, law.breaks) == (True, (Exponential(gamma).zero,))
    assert not Clipped(Exponential(2.0)).smooth  # its zero not given
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


def test_zero_of_the_exponential_grading():
    # theory.md, section 1
    assert [round(Exponential(g).zero, 4) for g in (1.2, 1.5, 2, 3)] == [-1.7918, -1.0986, -0.6931, -0.4055]
    assert all(math.isnan(Exponential(g).zero) for g in (0, 0.5, 1))


def test_bad_functions_are_named_and_numbers_will_do():
    with pytest.raises(ValueError, match="not finite at s = 1"):
        analytic.fn(1.5, 0.0, Custom(lambda s: np.where(s > 1, np.nan, 1.0)))
    with pytest.raises(ValueError, match=r"gave shape \(3,\)"):
        analytic.fn(1.5, 0.0, Custom(lambda _: np.ones(3)))
    doubled = float(analytic.fn(1.5, 0.3, Custom(lambda _: 2.0)))
    assert doubled == pytest.approx(2 * float(analytic.fn(1.5, 0.3)), rel=1e-15)


@pytest.mark.parametrize("gamma", [math.inf, math.nan])
def test_gamma_must_be_finite(gamma):
    with pytest.raises(ValueError, match=r"gamma = .*finite"):
        Exponential(gamma)


# Measured gradings: interpolation and the CSV files they come from


@pytest.mark.parametrize(
    ("s", "ratio"), [(S, RATIO), ((0, 1), (1, 3)), ((0, 1, 2), (5, 1, 1.5)), (S, RATIO[::-1])]
)
def test_interpolant_against_its_definition(s, ratio):
    """To some ten roundings of a cubic."""
    heights, truth = np.concatenate([np.linspace(-4, 5, 91), s]), pchip(s, ratio)
    np.testing.assert_allclose(Table(s, ratio)(heights), [float(truth(x)) for x in heights], rtol=1e-14)


def test_clamped_outside_and_monotone_inside():
    table = Table((0.0, 1.0, 1.1, 4.0), (0.2, 0.3, 1.9, 2.0))
    assert table(np.array([-9.0, 9.0])).tolist() == [0.2, 2.0]
    assert np.all(np.diff(table(np.linspace(0, 4, 401))) > 0)
    assert table.breaks == (0.0, 1.0, 1.1, 4.0)
    assert table.smooth


@pytest.mark.parametrize(("s", "ratio", "message"), [
    ((0,), (1,), "two or more points, as many s as ratio, not 1 and 1"),
    ((0, 1), (1, 2, 3), "not 2 and 3"),
    ((0, math.nan), (1, 2), "must be finite"),
    ((0, 1), (1, math.inf), "must be finite"),
    ((0, 0), (1, 2), "must increase"),
    ((1, 0), (1, 2), "must increase"),
])  # fmt: skip
def test_points_that_make_no_curve(s, ratio, message):
    with pytest.raises(ValueError, match=message):
        Table(s, ratio)
