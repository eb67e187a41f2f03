"""Equations 1 to 15 of the paper, each against a literal quadrature of its corrected definition."""

import mpmath as mp
import numpy as np
import pytest
from reference import F_star, error, exponential, graded, integral

import analytic
from analytic import Custom, Exponential

TOLERANCE = 2e-13  # 1e-13 for each integral in the formula; ratios have two
SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
SIGMA, R, ETA, A_N, E_STAR = (
    mp.mpf(x) for x in (SURFACE.sigma, SURFACE.radius, SURFACE.eta, SURFACE.nominal_area, SURFACE.E_star)
)
GAMMAS = (0.2, 1.5, 2.0)
H = (-3.0, 0.0, 1.0, 4.0)


def one(_):
    return mp.mpf(1)


def worst(function, truth):
    return max(error(function(h), truth(mp.mpf(h))) for h in H)


def test_eq_1a_area():
    truth = lambda h: mp.pi * A_N * ETA * SIGMA * R * graded(1, h, one)  # noqa: E731
    assert worst(lambda h: analytic.area(SURFACE, h), truth) < TOLERANCE


def load_factor():
    return mp.mpf(4) / 3 * A_N * ETA * E_STAR * mp.sqrt(R) * SIGMA ** mp.mpf(1.5)


def test_eq_1b_load():
    truth = lambda h: load_factor() * graded(1.5, h, one)  # noqa: E731
    assert worst(lambda h: analytic.load(SURFACE, h), truth) < TOLERANCE


@pytest.mark.parametrize("n", [0, 0.5, 1, 1.5])
def test_eq_2_integral(n):
    assert worst(lambda h: analytic.fn(n, h), lambda h: graded(n, h, one)) < TOLERANCE


def test_eq_3_load_of_any_grading():
    truth = lambda h: load_factor() * graded(1.5, h, lambda s: 1 + s * s / 4)  # noqa: E731
    assert worst(lambda h: analytic.load(SURFACE, h, Custom(lambda s: 1 + s * s / 4)), truth) < TOLERANCE


@pytest.mark.parametrize("gamma", GAMMAS)
def test_eq_4_exponential_grading(gamma):
    for s in (-2.0, 0.0, 0.7, 4.0):
        assert error(Exponential(gamma)(np.array(s)), exponential(gamma)(mp.mpf(s))) < 1e-14


@pytest.mark.parametrize("gamma", GAMMAS)
def test_eqs_5_and_6_load_of_the_exponential_grading(gamma):
    truth = lambda h: load_factor() * graded(1.5, h, exponential(gamma))  # noqa: E731
    assert worst(lambda h: analytic.load(SURFACE, h, Exponential(gamma)), truth) < TOLERANCE


@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("n", [0.5, 1.5])
def test_eq_7_graded_integral(n, gamma):
    f = lambda h: analytic.fn(n, h, Exponential(gamma))  # noqa: E731
    assert worst(f, lambda h: graded(n, h, exponential(gamma))) < TOLERANCE


def eq_8(n, h, gamma, sign, lowest):
    """Eq. (8) with the sign of its exponent as an argument, from t = `lowest`."""
    n, h, gamma = mp.mpf(n), mp.mpf(h), mp.mpf(gamma)
    f = lambda t: (-mp.log(t) - h) ** n * mp.exp(sign * mp.log(t) ** 2 / 2) * (gamma - (gamma - 1) * t) / t  # noqa: E731
    cuts = [mp.mpf(10) ** -k for k in range(60) if lowest < mp.mpf(10) ** -k < mp.exp(-h)]
    return mp.quad(f, sorted([mp.mpf(lowest), *cuts, mp.exp(-h)])) / mp.sqrt(2 * mp.pi)


def test_eq_8_corrected_sign():
    assert abs(eq_8(1.5, 1, 1.5, -1, mp.mpf(10) ** -8) / F_star(1.5, 1, 1.5) - 1) < 1e-20
    assert float(F_star(1.5, 1, 1.5)) == pytest.approx(0.108021770156762, rel=1e-14)


@pytest.mark.parametrize(("lowest", "value"), [("1e-4", 4.0e18), ("1e-8", 1.14e74), ("1e-16", 1.9e295)])
def test_eq_8_as_printed_diverges(lowest, value):
    assert float(eq_8(1.5, 1, 1.5, +1, mp.mpf(lowest))) == pytest.approx(value, rel=0.02)  # two digits


def eq_9(n, h, gamma, ngp, *, printed):
    """Eq. (9), word for word: abscissae and weights with exp(-h/2) as printed, or exp(-h)."""
    x, b = np.polynomial.legendre.leggauss(ngp)
    c = np.exp(-h / 2) if printed else np.exp(-h)
    x, b = c * (1 + x) / 2, c * b / 2
    with np.errstate(invalid="ignore"):  # a negative base to a half-integer power
        terms = (-np.log(x) - h) ** n * np.exp(-(np.log(x) ** 2) / 2) * (gamma - (gamma - 1) * x) / x
    return b * terms / np.sqrt(2 * np.pi)


@pytest.mark.parametrize("gamma", [1.0, 1.5])
@pytest.mark.parametrize("h", [-1.5, 0.0, 2.0])
def test_eq_9_corrected_is_the_papers_sum(h, gamma):
    literal = eq_9(1.5, h, gamma, 64, printed=False).sum()
    # The same sum in another order of operations: log and exp of numbers up to 20 lose 1e-14.
    assert float(analytic.fn_paper(1.5, h, gamma, 64)) == pytest.approx(literal, rel=1e-12)


def test_eq_9_converges_algebraically():
    h = np.linspace(0.5, 4, 8)
    exact = analytic.fn(1.5, h, Exponential(1.5))
    wrong = [np.abs(analytic.fn_paper(1.5, h, 1.5, ngp) / exact - 1).max() for ngp in (16, 64)]
    # theory.md: 2e-9 at 64 points, N^(-2n-2) = N^-5 asymptotically
    assert 1e-10 < wrong[1] < 5e-9
    assert 4**4 < wrong[0] / wrong[1] < 4**7
    assert analytic.fn_paper(1.5, [[0.0, 1000.0]], 1.5, 64).shape == (1, 2)


def test_eq_9_as_printed_fails_away_from_zero():
    exact = float(F_star(1.5, -2, 1.5))
    assert abs(eq_9(1.5, -2, 1.5, 64, printed=True).sum() / exact - 1) == pytest.approx(0.0050, abs=5e-5)
    shares = [np.isnan(eq_9(1.5, h, 1.5, 64, printed=True)).mean() for h in (0.5, 4.0)]
    assert shares == pytest.approx([0.31, 0.77], abs=0.02)  # nodes of 64: steps of 0.016
    same = eq_9(1.5, 0.0, 1.5, 64, printed=True).sum()
    assert same == eq_9(1.5, 0.0, 1.5, 64, printed=False).sum()


def a_over_p(h, grading):
    return 3 * mp.pi / 4 * mp.sqrt(R / SIGMA) / E_STAR * graded(1, h, one) / graded(1.5, h, grading)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_eqs_10_to_12_area_per_load(gamma):
    g = Exponential(gamma)
    graded_one = lambda h: a_over_p(h, exponential(gamma))  # noqa: E731
    assert worst(lambda h: analytic.area_per_load(SURFACE, h, g), graded_one) < TOLERANCE
    assert worst(lambda h: analytic.area_per_load(SURFACE, h), lambda h: a_over_p(h, one)) < TOLERANCE
    ratio = lambda h: graded(1.5, h, one) / graded(1.5, h, exponential(gamma))  # noqa: E731
    assert worst(lambda h: analytic.area_per_load_ratio(h, g), ratio) < TOLERANCE


def test_eqs_10_to_12_are_the_ratio_of_area_and_load():
    h, g = np.linspace(-5, 30, 36), Exponential(2.0)
    quotient = analytic.area(SURFACE, h) / analytic.load(SURFACE, h, g)
    np.testing.assert_allclose(analytic.area_per_load(SURFACE, h, g), quotient, rtol=TOLERANCE)
    far = analytic.area_per_load_ratio(1000.0, g)
    assert float(far) == pytest.approx(0.5, rel=1e-15)  # exp(-1000) is nothing: 1/gamma
    assert float(analytic.area_per_load_ratio(0.0, Exponential(0.5))) == pytest.approx(1.550, abs=5e-4)


def test_eq_13_plasticity_index():
    psi = analytic.plasticity_index(Exponential(2.0)(np.array(1.0)), E_star=1e11, slope=0.1, hardness=5e9)
    truth = mp.mpf(10) ** 11 * exponential(2)(mp.mpf(1)) * mp.mpf("0.1") / (mp.sqrt(2) * 5 * mp.mpf(10) ** 9)
    assert error(psi, truth) < 1e-14


def eq_14(h, gamma):
    """Barber's relation C = 2/(E* rho) |dP/dd| with the derivative taken numerically, rho = 1."""
    load = lambda x: load_factor() * F_star(1.5, x, gamma)  # noqa: E731
    return -2 / (E_STAR * SIGMA) * mp.diff(load, h)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_eq_14_by_the_derivative_of_the_load(gamma):
    f = lambda h: analytic.barber_conductance(SURFACE, h, Exponential(gamma))  # noqa: E731
    assert worst(f, lambda h: eq_14(h, gamma)) < TOLERANCE
    half = analytic.barber_conductance(SURFACE, 1.0, Exponential(gamma), rho=2.0)
    assert float(half) == float(f(1.0)) / 2


def test_eq_14_as_printed():
    """The three lines, all meant to be -2 dP/d(d/sigma), by the factors that they are wrong."""
    h, gamma = mp.mpf(1), mp.mpf("1.5")
    true = eq_14(h, gamma) * E_STAR * SIGMA  # -2 dP/d(d/sigma), a force
    k = A_N * ETA * mp.sqrt(R) * SIGMA ** mp.mpf(1.5) * E_STAR
    line_1 = -mp.mpf(8) / 3 * k / mp.sqrt(2 * mp.pi) * mp.diff(lambda x: F_star(1.5, x, gamma), h)
    line_2 = -4 * k * integral(lambda s: mp.sqrt(s - h) * exponential(gamma)(s), h)
    line_3 = -mp.mpf(8) / 3 * k * F_star(0.5, h, gamma)
    factors = [float(line / true) for line in (line_1, line_2, line_3)]
    assert factors == pytest.approx([0.3989422804, -1, -2 / 3], rel=1e-9)


@pytest.mark.parametrize("gamma", GAMMAS)
def test_eq_15_ratio(gamma):
    truth = lambda h: graded(0.5, h, exponential(gamma)) / graded(0.5, h, one)  # noqa: E731
    assert worst(lambda h: analytic.stiffness_ratio(h, Exponential(gamma)), truth) < TOLERANCE


def test_eq_15_is_no_ratio_of_conductances():
    # theory.md: h = 1, the paper's over the true one
    ratios = [float(analytic.stiffness_ratio(1.0, Exponential(g))) for g in (0.2, 2.0)]
    assert ratios == pytest.approx([0.358, 1.802], abs=5e-4)
    truth = lambda h: 4 * A_N * ETA * mp.sqrt(R * SIGMA) * graded(0.5, h, one)  # noqa: E731
    assert worst(lambda h: analytic.conductance(SURFACE, h), truth) < TOLERANCE
    assert float(analytic.conductance(SURFACE, 1.0, rho=4.0)) == float(analytic.conductance(SURFACE, 1.0)) / 4


@pytest.mark.parametrize("grading", [None, Exponential(2.0), Custom(lambda s: 1 + 0.5 * np.tanh(s))])
def test_stiffness_is_minus_the_slope_of_the_load(grading):
    h, step = np.linspace(-2, 4, 13), 1e-2
    p = {k: analytic.load(SURFACE, h + k * step, grading) for k in (-3, -2, -1, 1, 2, 3)}
    slope = (45 * (p[1] - p[-1]) - 9 * (p[2] - p[-2]) + p[3] - p[-3]) / (60 * step * SURFACE.sigma)
    # Sixth order: (step^6/140) f^(7)/f' with derivatives growing like h^6 at h = 4: 1e-14 * 4e4.
    np.testing.assert_allclose(-slope, analytic.stiffness(SURFACE, h, grading), rtol=2e-9)


def test_number_of_contacts():
    truth = lambda h: A_N * ETA * graded(0, h, one)  # noqa: E731
    assert worst(lambda h: analytic.contacts(SURFACE, h), truth) < TOLERANCE


@pytest.mark.parametrize("quantity", ["load", "area", "stiffness", "contacts", "conductance"])
def test_mean_by_name_is_the_function(quantity):
    h = [0.0, 2.0]
    np.testing.assert_array_equal(
        analytic.mean(SURFACE, quantity, h), getattr(analytic, quantity)(SURFACE, h)
    )


def test_unknown_quantity():
    with pytest.raises(KeyError, match="torque"):
        analytic.mean(SURFACE, "torque", 0.0)


@pytest.mark.parametrize(
    ("n", "h"),
    [(0, -1.04039), (0.5, -1.69662), (1, -2.46416), (1.5, -3.32752), (2, -4.24968), (2.5, -5.20176)],
)
def test_more_gamma_means_more_only_above_a_separation(n, h):
    """theory.md: the zero of F_n(h) - sqrt(e) F_n(h+1), where F*_n does not depend on gamma."""
    soft, stiff = (analytic.fn(n, [h - 1e-4, h + 1e-4], Exponential(g)) for g in (0.5, 2.0))
    assert stiff[0] < soft[0]
    assert stiff[1] > soft[1]
