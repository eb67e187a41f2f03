"""F*_n for any grading: closed forms, and quadrature of the definition at 40 digits."""

import math

import mpmath as mp
import numpy as np
import pytest
from reference import F, error, graded, integral, pchip, phi

import analytic
from analytic import Clipped, Custom, Exponential, Table

TOLERANCE = 1e-13  # promised for every grading that is resolved; below: where the data do not allow it
H = (-40.0, -9.0, -2.5, -0.5, 0.0, 0.3, 1.7, 4.0, 11.0, 35.0)


def worst(grading, truth, n, h=H):
    values = analytic.fn_scaled(n, h, grading)  # fn itself is subnormal for exp(-3s) at h = 35
    return max(error(v, truth(x) / (phi(x) if x >= 0 else 1)) for v, x in zip(values, h, strict=True))


@pytest.mark.parametrize("n", [0, 0.5, 1.5, 6])
@pytest.mark.parametrize("decay", [3.0, 1.0, -3.0])
def test_pure_exponential(n, decay):
    grading = Custom(lambda s: np.exp(-decay * s))
    closed = mp.exp(mp.mpf(decay) ** 2 / 2)
    assert worst(grading, lambda h: closed * F(n, mp.mpf(h) + decay), n) < TOLERANCE


@pytest.mark.parametrize("n", [0, 0.5, 1.5])
def test_steep_growth_on_both_sides(n):
    truth = {h: graded(n, h, lambda s: mp.exp(3 * abs(s)), breaks=[0]) for h in H[1:]}
    assert worst(Custom(lambda s: np.exp(3 * np.abs(s))), truth.get, n, H[1:]) < TOLERANCE


@pytest.mark.parametrize("n", [0, 0.5, 1, 1.5])
def test_square(n):
    def closed(h):
        return F(n + 2, h) + 2 * h * F(n + 1, h) + mp.mpf(h) ** 2 * F(n, h)

    assert worst(Custom(np.square), closed, n) < TOLERANCE


@pytest.mark.parametrize(("b", "c"), [(4.0, 1.0), (400.0, 0.62), (0.5, -2.0)])
@pytest.mark.parametrize("n", [0, 1.5])
def test_gaussian_bump(n, b, c):
    def closed(h):
        root, h = mp.sqrt(1 + mp.mpf(b)), mp.mpf(h)
        inside = F(n, root * (h - b * mp.mpf(c) / (1 + mp.mpf(b))))
        return mp.exp(-b * mp.mpf(c) ** 2 / (2 * (1 + mp.mpf(b)))) * root ** (-n - 1) * inside

    bump = Custom(lambda s: np.exp(-b * (s - c) ** 2 / 2))
    assert worst(bump, closed, n, [-3.0, 0.0, 0.5, 0.62, 1.0]) < TOLERANCE


@pytest.mark.parametrize("n", [0, 1, 2])
@pytest.mark.parametrize("declared", [True, False])
def test_step_with_integer_order(n, declared):
    c = 0.7123

    def closed(h):
        top = mp.mpf(max(h, c))
        above = mp.fsum(mp.binomial(n, k) * (top - h) ** (n - k) * F(k, top) for k in range(n + 1))
        return F(n, h) + 2 * above

    grading = Custom(lambda s: np.where(s > c, 3.0, 1.0), breaks=(c,) if declared else ())
    assert worst(grading, closed, n) < TOLERANCE


@pytest.mark.parametrize("declared", [True, False])
@pytest.mark.parametrize("n", [0.5, 1.5])
def test_jump_and_kink_with_half_integer_order(n, declared):
    grading = Custom(
        lambda s: np.where(s > 1.1, 2.0, 1.0) + np.abs(s - 0.4), breaks=(0.4, 1.1) if declared else ()
    )
    jump, kink = mp.mpf(1.1), mp.mpf(0.4)
    truth = {
        h: graded(n, h, lambda s: (2 if s > jump else 1) + abs(s - kink), breaks=[kink, jump])
        for h in H[1:-1]
    }
    assert worst(grading, truth.get, n, H[1:-1]) < TOLERANCE


@pytest.mark.parametrize("centre", [0.0, 1.7, -0.4])
def test_ramp_of_a_millionth_of_sigma(centre):
    cuts = [mp.mpf(centre) + k * mp.mpf(10) ** -6 for k in (-60, -20, -8, -4, -2, -1, 0, 1, 2, 4, 8, 20, 60)]
    grading = Custom(lambda s: 2 + np.tanh(1e6 * (s - centre)))
    for h in (-2.5, -0.41, 0.0, 1.69999):
        truth = graded(1.5, h, lambda s: 2 + mp.tanh(10**6 * (s - mp.mpf(centre))), breaks=cuts)
        assert error(analytic.fn(1.5, h, grading), truth) < TOLERANCE


def test_separation_inside_the_ramp():
    """There the modulus itself is known to 1e6 times the last digit of s only: 2e-16 * 1e6 / 1.7."""
    centre = 1.7
    h = centre - 3e-7
    cuts = [mp.mpf(centre) + k * mp.mpf(10) ** -7 for k in (-2, -1, 0, 1, 2, 4, 8, 16, 32, 64, 128, 256)]
    truth = graded(0, h, lambda s: 2 + mp.tanh(10**6 * (s - mp.mpf(centre))), breaks=cuts)
    grading = Custom(lambda s: 2 + np.tanh(1e6 * (s - centre)))
    assert error(analytic.fn(0, h, grading), truth) < TOLERANCE  # the ramp is a small part of the integral


@pytest.mark.parametrize("width", [1.0, 0.1, 0.01])
@pytest.mark.parametrize("sign", [1, -1])
def test_modulus_that_fades_into_rounding_noise(width, sign):
    """1 +- tanh(s/w) has lost its relative digits where it is small: no reason to give up."""
    w = mp.mpf(width)
    cuts = [k * w for k in (-20, -10, -5, -2, -1, 1, 2, 5, 10, 20)]
    grading = Custom(lambda s: 1 + sign * np.tanh(s / width))
    for h in (-3.0, -width, 0.0):
        truth = graded(1.5, h, lambda s: 1 + sign * mp.tanh(s / w), breaks=cuts)
        assert error(analytic.fn(1.5, h, grading), truth) < TOLERANCE


def test_waves():
    grading = Custom(lambda s: 2 + np.sin(20 * s))
    for h in (-4.0, 0.0, 3.3):
        truth = graded(1.5, h, lambda s: 2 + mp.sin(20 * s), breaks=[k / mp.mpf(4) for k in range(-64, 64)])
        assert error(analytic.fn(1.5, h, grading), truth) < TOLERANCE


HEIGHTS = (-2.0, -0.7, 0.1, 0.4, 1.5, 3.0)
RATIOS = (0.3, 0.6, 0.6, 1.4, 1.1, 2.0)


@pytest.mark.parametrize("n", [0, 1.5])
def test_table(n):
    truth = pchip(HEIGHTS, RATIOS)
    h = (-9.0, -1.0, 0.1, 0.2, 2.9, 5.0)
    values = analytic.fn(n, h, Table(HEIGHTS, RATIOS))
    for x, value in zip(h, values, strict=True):
        assert error(value, graded(n, x, truth, breaks=HEIGHTS)) < TOLERANCE


@pytest.mark.parametrize("gamma", [1.5, 3.0, -0.2])
@pytest.mark.parametrize("n", [0, 0.5, 1.5])
def test_clipped_exponential(n, gamma):
    law = Clipped.of(Exponential(gamma))
    g = mp.mpf(gamma)
    zero = -mp.log(g / (g - 1))
    low, high = (None, zero) if gamma < 0 else (zero, None)
    for h in (-8.0, -1.2, -0.3, 0.9):
        if gamma < 0 and h >= zero:
            continue
        f = lambda s, h=h: (s - mp.mpf(h)) ** n * (g - (g - 1) * mp.exp(-s))  # noqa: E731
        truth = integral(f, h, low=low if low is not None and low > h else None, high=high)
        # The zero is where float arithmetic puts it; the modulus vanishes there, so it does not count.
        assert error(analytic.fn(n, h, law), truth) < TOLERANCE


def test_clipped_custom_finds_its_own_zero():
    law = Clipped.of(Custom(lambda s: s - 0.3))
    assert not law.smooth
    for h in (-2.0, 0.0, 0.5):
        truth = graded(1.5, h, lambda s: max(s - mp.mpf(0.3), mp.mpf(0)), breaks=[mp.mpf(0.3)])
        assert error(analytic.fn(1.5, h, law), truth) < TOLERANCE


def test_clipped_leaves_a_positive_modulus_alone():
    h = np.linspace(0, 5, 11)
    np.testing.assert_allclose(
        analytic.fn(1.5, h, Clipped.of(Exponential(2.0))), analytic.fn(1.5, h, Exponential(2.0)), rtol=1e-14
    )


def test_zero_of_the_exponential_grading():
    # theory.md, section 1
    assert [round(Exponential(g).zero, 4) for g in (1.2, 1.5, 2, 3)] == [-1.7918, -1.0986, -0.6931, -0.4055]
    assert all(math.isnan(Exponential(g).zero) for g in (0, 0.5, 1))


def test_always_positive_up_to_gamma_star():
    """F*_n/|h|^n tends to gamma - (gamma-1) sqrt(e) far down: its zero is gamma* = 2.5415."""
    star = math.exp(0.5) / (math.exp(0.5) - 1)
    assert star == pytest.approx(2.541494082536798, rel=1e-15)
    h = -1000.0
    deep = [
        float(analytic.fn(1.5, h, Exponential(g))) / abs(h) ** 1.5 for g in (star - 0.1, star, star + 0.1)
    ]
    # The shift by 1 leaves (3/2)(gamma-1) sqrt(e)/|h| = 0.004; 0.1 in gamma is worth 0.065.
    assert deep[0] > 0.05
    assert deep[1] == pytest.approx(1.5 * (star - 1) * math.exp(0.5) / 1000, rel=0.01)
    assert deep[2] < -0.05


@pytest.mark.parametrize(
    ("gamma", "n", "zero"),
    [
        (3, 1.5, -16.34), (5, 1.5, -5.84), (10, 1.5, -4.18), (3, 0.5, -5.904), (5, 0.5, -2.637),
        (-0.05, 1.5, 2.3776), (-0.2, 1.5, 0.81086), (-0.5, 1.5, -0.22604), (-1, 1.5, -0.98001),
    ],
)  # fmt: skip
def test_zeros_listed_in_the_theory(gamma, n, zero):
    half_a_digit = 0.5 * 10.0 ** -len(str(zero).split(".")[1])
    below, above = analytic.fn(n, [zero - half_a_digit, zero + half_a_digit], Exponential(gamma))
    assert below * above < 0


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda s: np.where(s > 1, np.nan, 1.0), "not finite at s = 1"),
        (lambda _: np.ones(3), r"gave shape \(3,\)"),
    ],
)
def test_bad_functions_are_named(function, message):
    with pytest.raises(ValueError, match=message):
        analytic.fn(1.5, 0.0, Custom(function))


def test_a_number_will_do_as_a_function():
    assert float(analytic.fn(1.5, 0.3, Custom(lambda _: 2.0))) == pytest.approx(
        2 * float(analytic.fn(1.5, 0.3)), rel=1e-15
    )


@pytest.mark.parametrize("gamma", [math.inf, math.nan])
def test_gamma_must_be_finite(gamma):
    with pytest.raises(ValueError, match=r"gamma = .*finite"):
        Exponential(gamma)
