"""Elastic laws that are not Hertz's, and films: published values, identities, limits."""

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from oracles.law_means import mean

import analytic
from analytic.laws import Coated, Film, Hertz, PowerLawGraded, crowding_factor

ONE = np.array(1.0)
SURFACE = analytic.Surface(sigma=1e-6, radius=4e-4, eta=1e9, nominal_area=1e-6, E_star=100e9)
COATED = Coated(ratio=3.0, reduced_thickness=0.5)
UNIT = 2e-5  # sqrt(R sigma), m


def test_graded_half_space_has_the_published_factor():
    assert pytest.approx(1.141408652076834, rel=1e-14) == PowerLawGraded(0.5, reduced_c0=1.0).H
    assert pytest.approx(1.0, rel=1e-15) == PowerLawGraded(0.0, reduced_c0=1.0, poisson=0.2).H
    gibson = PowerLawGraded(1 - 1e-6, reduced_c0=1.0, poisson=0.5)
    assert pytest.approx(np.pi / 2, rel=1e-5) == gibson.H


def exact_share(w, nu):
    """I0 as it is printed, of ``x = 1/w``."""
    x = 1 / w
    second = (1 - 2 * nu) * x * mpmath.log(1 + x**-2) - x / (1 + x * x)
    return 2 / mpmath.pi * mpmath.atan(x) + second / (2 * mpmath.pi * (1 - nu))


@pytest.mark.parametrize(("poisson", "t"), [(0.0, 0.5), (0.3, 0.003), (0.5, 40.0)])
@mpmath.workdps(30)
def test_coatings_formulas_lose_no_digits(poisson, t):
    """Against the printed I0 at 30 digits, and the load as its integral."""
    law = Coated(ratio=5.0, poisson=poisson, reduced_thickness=t)
    for y in (1e-9, 1e-4, 0.02, 0.49, 0.51, 4.0):

        def stiffness(v):
            return v * (1 + 4 * exact_share(mpf(v) / mpf(t), mpf(poisson)))

        cuts = [0, *(mpf(10) ** -k for k in range(6, -1, -1))]  # of y, as mpmath's tolerance is absolute
        load = 3 * mpf(y) ** 2 * mpmath.quad(lambda x, y=y: x * stiffness(x * mpf(y)), cuts)
        v = np.array(y)
        assert float(law.stiffness(0, v, ONE) / stiffness(y) - 1) == pytest.approx(0, abs=2e-15)
        assert float(law.load(0, v, ONE) / load - 1) == pytest.approx(0, abs=2e-15)
        assert float(law.slope(0, v, ONE) * 2 / 3 / stiffness(y) - 1) == pytest.approx(0, abs=2e-15)


def test_coating_goes_on_below_first_touch():
    """Its even and odd parts: along a polynomial through both sides, as analytic functions must."""
    law = Coated(ratio=3.0, reduced_thickness=0.5)
    assert law.finest == 0.25
    y = np.polynomial.chebyshev.chebpts1(40) * 0.2
    check = np.linspace(-0.19, 0.19, 77)
    for formula in (law.load, law.stiffness, law.radius):
        c = np.polynomial.chebyshev.chebfit(y / 0.2, formula(0, y, ONE), 39)
        fit = np.polynomial.chebyshev.chebval(check / 0.2, c)
        np.testing.assert_allclose(fit, formula(0, check, ONE), rtol=0, atol=2e-14)
    assert np.all(law.load(0, np.zeros(2), ONE) == 0)


def test_thin_thick_and_no_coating():
    y = np.linspace(0.01, 3, 50)
    hertz = Hertz().load(0, y, ONE)
    layer = {"ratio": 4.0, "poisson": 0.2}
    np.testing.assert_allclose(Coated(**layer, reduced_thickness=1e-14).load(0, y, ONE), hertz, rtol=1e-10)
    np.testing.assert_allclose(Coated(**layer, reduced_thickness=1e14).load(0, y, ONE), 4 * hertz, rtol=1e-13)
    np.testing.assert_allclose(Coated(ratio=1.0, reduced_thickness=0.1).load(0, y, ONE), hertz, rtol=1e-15)


@pytest.mark.parametrize(
    "law", [Hertz(), PowerLawGraded(0.4, reduced_c0=0.7), COATED, Coated(ratio=0.2, reduced_thickness=0.5)]
)
def test_stiffness_of_elastic_laws_is_the_slope_of_their_load(law):
    """So the mean of one is what differences of the mean of the other say."""
    step = 1e-3
    loads = [mean(law, "load", 1 + k * step) for k in (-2, -1, 1, 2)]
    slope = (-loads[0] + 8 * loads[1] - 8 * loads[2] + loads[3]) / (12 * step)
    assert 1.5 * mean(law, "stiffness") == pytest.approx(slope, rel=1e-10)
    y, e = np.geomspace(1e-6, 4, 40), np.array(1.7)
    np.testing.assert_allclose(law.slope(0, y, e), 1.5 * law.stiffness(0, y, e), rtol=1e-13)
    assert law.slope(0, np.zeros(1), e) == pytest.approx(0, abs=1e-30)


@pytest.mark.parametrize("law", [Hertz(), PowerLawGraded(0.4, reduced_c0=0.7), COATED])
def test_elastic_laws_without_stiffness_carry_nothing(law):
    y, e = np.linspace(0.1, 2, 5), np.zeros(5)
    assert np.all(law.load(0, y, e) == 0)
    assert np.all(law.stiffness(0, y, e) == 0)
    assert np.all(np.isfinite(law.radius(0, y, e)))
    assert law.limits(e).shape == (0, 5)


def test_film_and_constriction_are_in_series():
    """Holm's formula in ohm, for one spot."""
    film, rho, a = 2e-13, 3.5e-8, 1.7e-6
    conductance = 4 * UNIT * Film(rho, film).on(SURFACE)(np.array(a / UNIT))
    assert 1 / conductance == pytest.approx(rho / (4 * a) + film / (np.pi * a**2), rel=1e-14)
    assert Film(1.0).on(SURFACE)(np.array(0.3)) == 0.3


def test_spots_crowd_by_their_area():
    np.testing.assert_allclose(crowding_factor([0.0, 0.01, 0.25]), [1.0, 0.9**1.5, 0.5**1.5], rtol=1e-15)


@pytest.mark.parametrize(("make", "words"), [
    (lambda: PowerLawGraded(1.0, 1e-6), "k = 1.0: give"),
    (lambda: PowerLawGraded(0.5), "c0 = None, reduced_c0 = None: give one"),
    (lambda: PowerLawGraded(0.5, 0.0), "c0 = 0.0: give a finite number > 0"),
    (lambda: PowerLawGraded(0.5, 1e-6, 0.6), "poisson = 0.6: give"),
    (lambda: PowerLawGraded(0.5, 1e-6).load(0, ONE, ONE), "c0=1e-06.*law.on"),
    (lambda: Coated(ratio=2.0), "thickness = None, reduced_thickness = None: give one"),
    (lambda: Coated(ratio=0.0, thickness=1e-6), "ratio = 0.0: give"),
    (lambda: Coated(ratio=2.0, thickness=1e-6).finest, "thickness=1e-06.*law.on"),
    (lambda: Film(1.0, film_resistance=-1.0), "film_resistance = -1.0"),
    (lambda: Film(0.0, film_resistance=1.0), "resistivity = 0.0"),
    (lambda: crowding_factor([0.2, 1.5]), "area_fraction = 1.5: "),
])  # fmt: skip
def test_errors_name_the_key_the_value_and_what_would_do(make, words):
    with pytest.raises(ValueError, match=words) as caught:
        make()
    assert "\n" not in str(caught.value)
