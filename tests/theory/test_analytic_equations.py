"""Equations 1 to 15 of the paper, each against its corrected definition at 40 digits.

`test_analytic_integrals` holds the closed forms that stand for the integrals here to a literal quadrature.
"""

import re

import mpmath as mp
import numpy as np
import pytest
from oracles.reference import F, F_power, F_star, error

import analytic
from analytic import Exponential

TOLERANCE = 2e-13  # 1e-13 for each integral in the formula; ratios have two
SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
SIGMA, R, ETA, A_N, E_STAR = (
    mp.mpf(x) for x in (SURFACE.sigma, SURFACE.radius, SURFACE.eta, SURFACE.nominal_area, SURFACE.E_star)
)
LOAD = mp.mpf(4) / 3 * A_N * ETA * E_STAR * mp.sqrt(R) * SIGMA ** mp.mpf(1.5)
AREA_PER_LOAD = 3 * mp.pi / 4 * mp.sqrt(R / SIGMA) / E_STAR
H = (-3.0, 0.0, 1.0, 4.0)


def worst(function, truth):
    return max(error(function(h), truth(mp.mpf(h))) for h in H)


def conducted(h, gamma):
    """Barber's relation C = 2/(E* rho) |dP/dd|, Eq. (14), by a numerical derivative; rho = 4."""
    return -2 / (4 * E_STAR * SIGMA) * mp.diff(lambda x: LOAD * F_star(1.5, x, gamma), h)


EQUATIONS = {  # the function of the package, and the definition; g is the grading of a gamma
    "1a, area": (
        lambda h, g: analytic.area(SURFACE, h), lambda h, y: mp.pi * A_N * ETA * SIGMA * R * F(1, h),
    ),
    "1b, load": (lambda h, g: analytic.load(SURFACE, h), lambda h, y: LOAD * F(1.5, h)),
    "2, n = 1/2": (lambda h, g: analytic.fn(0.5, h), lambda h, y: F(0.5, h)),
    "5 and 6, load": (lambda h, g: analytic.load(SURFACE, h, g), lambda h, y: LOAD * F_star(1.5, h, y)),
    "7, n = 1/2": (lambda h, g: analytic.fn(0.5, h, g), lambda h, y: F_star(0.5, h, y)),
    "7, n = 3/2": (lambda h, g: analytic.fn(1.5, h, g), lambda h, y: F_star(1.5, h, y)),
    "10, area per load": (
        lambda h, g: analytic.area_per_load(SURFACE, h, g),
        lambda h, y: AREA_PER_LOAD * F(1, h) / F_star(1.5, h, y),
    ),
    "11, homogeneous": (
        lambda h, g: analytic.area_per_load(SURFACE, h), lambda h, y: AREA_PER_LOAD * F(1, h) / F(1.5, h),
    ),
    "12, their ratio": (
        lambda h, g: analytic.area_per_load_ratio(h, g), lambda h, y: F(1.5, h) / F_star(1.5, h, y),
    ),
    "14, Barber": (lambda h, g: analytic.barber_conductance(SURFACE, h, g, rho=4.0), conducted),
    "15, stiffness": (
        lambda h, g: analytic.stiffness_ratio(h, g), lambda h, y: F_star(0.5, h, y) / F(0.5, h),
    ),
    "conductance": (
        lambda h, g: analytic.conductance(SURFACE, h, rho=4.0),
        lambda h, y: A_N * ETA * mp.sqrt(R * SIGMA) * F(0.5, h),
    ),
    "stiffness": (
        lambda h, g: analytic.stiffness(SURFACE, h, g),
        lambda h, y: 2 * A_N * ETA * E_STAR * mp.sqrt(R * SIGMA) * F_star(0.5, h, y),
    ),
    "contacts": (lambda h, g: analytic.contacts(SURFACE, h), lambda h, y: A_N * ETA * F(0, h)),
    "mean modulus of contacts": (
        lambda h, g: analytic.mean_modulus(h, g, weight="number"), lambda h, y: F_star(0, h, y) / F(0, h),
    ),
    "mean modulus of the area": (
        lambda h, g: analytic.mean_modulus(h, g, weight="area"), lambda h, y: F_star(1, h, y) / F(1, h),
    ),
    "mean modulus of the load": (
        lambda h, g: analytic.mean_modulus(h, g), lambda h, y: F_power(1.5, 2, h, y) / F_star(1.5, h, y),
    ),
}  # fmt: skip


@pytest.mark.parametrize("gamma", [0.2, 2.0])
@pytest.mark.parametrize("name", EQUATIONS)
def test_equation(name, gamma):
    function, truth = EQUATIONS[name]
    assert worst(lambda h: function(h, Exponential(gamma)), lambda h: truth(h, gamma)) < TOLERANCE


def test_eq_8_with_the_sign_corrected():
    """In t = exp(-s), as printed but for the sign of the exponent."""
    h, gamma = mp.mpf(1), mp.mpf("1.5")
    f = lambda t: (-mp.log(t) - h) ** 1.5 * mp.exp(-(mp.log(t) ** 2) / 2) * (gamma - (gamma - 1) * t) / t  # noqa: E731
    cuts = [mp.mpf(10) ** -k for k in (8, 6, 4, 3, 2, 1)]
    value = mp.quad(f, [*cuts, mp.exp(-h)]) / mp.sqrt(2 * mp.pi)
    assert error(analytic.fn(1.5, 1.0, Exponential(1.5)), value) < TOLERANCE
    assert float(value) == pytest.approx(0.108021770156762, rel=1e-14)


def test_eq_9_converges_algebraically():
    h = np.linspace(0.5, 4, 8)
    exact = analytic.fn(1.5, h, Exponential(1.5))
    wrong = [np.abs(analytic.fn_paper(1.5, h, 1.5, ngp) / exact - 1).max() for ngp in (16, 64)]
    # theory.md: 2e-9 at 64 points, N^(-2n-2) = N^-5 asymptotically
    assert 1e-10 < wrong[1] < 5e-9
    assert 4**4 < wrong[0] / wrong[1] < 4**7
    assert analytic.fn_paper(1.5, [[0.0, 1000.0]], 1.5, 64).shape == (1, 2)


def test_eq_13_plasticity_index():
    """And the paper's Zircaloy 4, psi = 0.86, whose "2 psi = 1.8" is 1.704 at h = 4."""
    moduli = Exponential(2.0)(np.linspace(0, 4, 6).reshape(2, 3))
    psi = analytic.plasticity_index(moduli, E_star=1e11, slope=0.1, hardness=5e9)
    np.testing.assert_allclose(psi, moduli * 1e11 * 0.1 / (np.sqrt(2) * 5e9), rtol=1e-15)
    homogeneous = {"E_star": 0.86 * np.sqrt(2) * 1e9, "slope": 1.0, "hardness": 1e9}
    assert float(analytic.plasticity_index(1.0, **homogeneous)) == pytest.approx(0.86, rel=1e-15)
    at_four = analytic.plasticity_index(Exponential(2.0)(np.array(4.0)), **homogeneous)
    assert float(at_four) == pytest.approx(1.704, abs=5e-4)


def test_every_equation_has_its_function_in_the_package():
    row = re.compile(r"^Eq\. \((\d+)\)\s+((?:`analytic\.\w+`(?:, )?)+)\s+\S", re.MULTILINE)
    rows = {
        int(number): re.findall(r"`analytic\.(\w+)`", names)
        for number, names in row.findall(analytic.__doc__)
    }
    assert sorted(rows) == list(range(1, 16))
    for name in (name for names in rows.values() for name in names):
        assert name in analytic.__all__
        assert callable(getattr(analytic, name))
    assert all(getattr(analytic, name).__doc__ for name in analytic.__all__)
