"""Laws of contact that stay elastic, unload, stick, are one's own, or have a radius for each summit.

`test_laws_that_yield` holds loads and areas of all of them to formulas typed in.
"""

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from oracles.law_means import term
from oracles.laws_by_hand import OWN

import analytic
from analytic import laws, quantity_of
from analytic.laws import (
    Coated,
    CustomLaw,
    DerjaguinMullerToporov,
    Film,
    Hertz,
    JohnsonKendallRoberts,
    KogutEtsion,
    PowerLawGraded,
    crowding_factor,
)  # fmt: skip
from analytic.laws.law import slope_in_root

ONE = np.array(1.0)
SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
KOGUT = KogutEtsion(critical=0.05)


def slope_of(law, y, e):
    """Derivative of the load of the first piece."""
    return slope_in_root(lambda v: law.load(0, v, e), y)


def exact_share(w, nu):
    """I0 as it is printed, of ``x = 1/w``."""
    x = 1 / w
    second = (1 - 2 * nu) * x * mpmath.log(1 + x**-2) - x / (1 + x * x)
    return 2 / mpmath.pi * mpmath.atan(x) + second / (2 * mpmath.pi * (1 - nu))


@pytest.mark.parametrize(("poisson", "t"), [(0.0, 0.5), (0.3, 0.003)])
@mpmath.workdps(30)
def test_coatings_formulas_are_the_printed_ones(poisson, t):
    """Against the printed I0 at 30 digits, and the load as its integral: differences of terms in (y/t)^2."""
    law = Coated(ratio=5.0, poisson=poisson, reduced_thickness=t)
    for y in (1e-9, 0.02, 0.49, 4.0):

        def stiffness(v):
            return v * (1 + 4 * exact_share(mpf(v) / mpf(t), mpf(poisson)))

        cuts = [0, *(mpf(10) ** -k for k in range(6, -1, -1))]  # of y, as mpmath's tolerance is absolute
        load = 3 * mpf(y) ** 2 * mpmath.quad(lambda x, y=y: x * stiffness(x * mpf(y)), cuts)
        v, within = np.array(y), 2e-15 + np.finfo(float).eps * t / y
        assert float(law.stiffness(0, v, ONE) / stiffness(y) - 1) == pytest.approx(0, abs=2e-15)
        assert float(law.load(0, v, ONE) / load - 1) == pytest.approx(0, abs=within)
        assert float(slope_of(law, v, ONE) * 2 / 3 / stiffness(y) - 1) == pytest.approx(0, abs=within)


def test_coating_goes_on_below_first_touch():
    """Its even and odd parts: along a polynomial through both sides, as analytic functions must."""
    law = Coated(ratio=3.0, reduced_thickness=0.5)
    y = np.polynomial.chebyshev.chebpts1(40) * 0.2
    check = np.linspace(-0.19, 0.19, 77)
    for formula in (law.load, law.stiffness, law.radius):
        c = np.polynomial.chebyshev.chebfit(y / 0.2, formula(0, y, ONE), 39)
        fit = np.polynomial.chebyshev.chebval(check / 0.2, c)
        np.testing.assert_allclose(fit, formula(0, check, ONE), rtol=0, atol=2e-14)
    assert np.all(law.load(0, np.zeros(2), ONE) == 0)


@pytest.mark.parametrize(
    "law", [Hertz(), PowerLawGraded(0.4, reduced_c0=0.7), Coated(ratio=0.2, reduced_thickness=0.5)]
)
def test_stiffness_of_elastic_laws_is_the_slope_of_their_load(law):
    y, e, step = np.geomspace(1e-2, 4, 40), np.array(1.7), 1e-3
    loads = [law.load(0, y * np.sqrt(1 + k * step), e) for k in (-2, -1, 1, 2)]
    slope = (loads[0] - 8 * loads[1] + 8 * loads[2] - loads[3]) / (12 * step * y**2)
    np.testing.assert_allclose(1.5 * law.stiffness(0, y, e), slope, rtol=1e-9)
    np.testing.assert_allclose(slope_of(law, y, e), 1.5 * law.stiffness(0, y, e), rtol=1e-13)
    assert slope_of(law, np.zeros(1), e) == pytest.approx(0, abs=1e-30)


def test_film_and_constriction_are_in_series_and_spots_crowd_by_their_area():
    """Holm's formula in ohm, for one spot."""
    film, rho, a = 2e-13, 3.5e-8, 1.7e-6
    unit = np.sqrt(SURFACE.radius * SURFACE.sigma)
    conductance = 4 * unit * Film(rho, film).on(SURFACE).conductance(np.array(a / unit))
    assert 1 / conductance == pytest.approx(rho / (4 * a) + film / (np.pi * a**2), rel=1e-14)
    assert Film(1.0).on(SURFACE).conductance(np.array(0.3)) == 0.3
    np.testing.assert_allclose(crowding_factor([0.0, 0.01, 0.25]), [1.0, 0.9**1.5, 0.5**1.5], rtol=1e-15)


# There and back


def test_stiffness_after_the_turn_is_not_the_slope():
    """A spot of radius a is stiff by 2 E* a; the fit's own slope there differs by some per cent."""
    d = np.array([0.3])
    back = KOGUT.unloading(d)
    y = np.sqrt(back.left(d, ONE))
    assert KogutEtsion(critical=3e-60).unloading(d).left(d, ONE) == pytest.approx(0.3 * 1e59**-0.28, rel=1e-9)
    slope = slope_in_root(lambda v: back.load(1, v, ONE), y)
    assert back.stiffness(1, y, ONE) == pytest.approx(KOGUT.radius(1, np.sqrt(d), ONE), rel=1e-14)
    assert slope / 1.5 != pytest.approx(back.stiffness(1, y, ONE), rel=0.01)


def test_without_stiffness_nothing_is_left_and_nothing_warns():
    back, e = KOGUT.unloading(0.3), np.array([0.0, 1.0])
    for piece in (0, 1, 2, 3):
        assert np.all(np.isfinite(back.left(0.3, e)))
        assert back.load(piece, np.array(0.2), e)[0] == 0
        assert np.all(np.isfinite(back.radius(piece, np.array(0.2), e)))


def test_forces_in_newton():
    """First touch at -(4/3) pi w R, break-off at -(5/6) pi w R, and a pull of 2 pi w R, of the work w."""
    work = 0.05
    unit = analytic.QUANTITIES["load"].scale(SURFACE)
    johnson = JohnsonKendallRoberts(work=work).on(SURFACE)
    back = johnson.unloading(np.array(1.0))
    pull = np.pi * work * SURFACE.radius
    assert unit * float(johnson.load(0, 0.0, ONE)) == pytest.approx(-4 / 3 * pull, rel=1e-13)
    assert unit * float(back.load(0, 0.0, ONE)) == pytest.approx(-5 / 6 * pull, rel=1e-13)
    derjaguin = DerjaguinMullerToporov(work=work).on(SURFACE)
    assert unit * float(derjaguin.load(0, 0.0, ONE)) == pytest.approx(-2 * pull, rel=1e-13)


def test_both_ways_meet_and_stiffness_is_the_slope():
    law, e = JohnsonKendallRoberts(pull_off=0.2), np.array(0.3)
    delta = np.linspace(0.01, 3, 50)
    y, stretch = np.sqrt(delta), float(law.stretch(e))
    back = law.unloading(np.array(9.0)).load(0, np.sqrt(delta + stretch), e)
    np.testing.assert_allclose(back, law.load(0, y, e), rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(2 / 3 * slope_of(law, y, e), law.stiffness(0, y, e), rtol=1e-12)


# Each summit with a radius of its own

RNG = np.random.default_rng(0)
S, RATIOS = RNG.normal(size=20), RNG.gamma(3, size=20) / 2
MODULI = np.exp(0.3 * S)
FILM = laws.Film(1e-7, 1e-12)
LAWS = {
    "hertz": laws.Hertz(),
    "kogut-etsion": laws.KogutEtsion(hardness=1.2e9),
    "chang-etsion-bogy": laws.ChangEtsionBogy(hardness=1.2e9),
    "zhao-maietta-chang": laws.ZhaoMaiettaChang(hardness=1.2e9),
    "jackson-green": laws.JacksonGreen(yield_strength=4e8),
    "graded in depth": laws.PowerLawGraded(k=0.3, c0=1e-6),
    "coated": laws.Coated(thickness=1e-7, ratio=2.0),
    "johnson-kendall-roberts": laws.JohnsonKendallRoberts(work=0.05),
    "derjaguin-muller-toporov": laws.DerjaguinMullerToporov(work=0.05),
}
NO_WAY_BACK = ("chang-etsion-bogy", "zhao-maietta-chang", "jackson-green")


def literal(law, name, unload_from, h):
    """Summit by summit, in SI units."""
    q, terms = quantity_of(name), []
    for s, c, e in zip(S, RATIOS, MODULI, strict=True):
        own = replace(SURFACE, radius=SURFACE.radius * c)
        branch = laws.Branch(law.on(own), unload_from, FILM.on(own)).of(name)
        terms.append(float(q.scale(own) * branch.terms([q.base], h, s, e)[0]))
    return np.array(terms)


@pytest.mark.parametrize("law", LAWS)
def test_each_summit_is_one_of_a_surface_of_its_radius(law):
    names, unload_from = ["load", "area", "stiffness", "conductance", "conductance_si", "contacts"], None
    if law not in NO_WAY_BACK:
        names, unload_from = [*names, "load_unloading", "area_unloading", "contacts_unloading"], -1.0
    ways = laws.Branch(LAWS[law].on(SURFACE), unload_from, FILM.on(SURFACE))
    for name in names:
        for h in (-0.5, 0.2):
            (found,) = quantity_of(name).scale(SURFACE) * ways.of(name).with_radii(RATIOS).terms(
                [name], h, S, MODULI
            )
            wanted = literal(LAWS[law], name, unload_from, h)
            assert np.abs(found - wanted).max() <= 1e-13 * max(np.abs(wanted).max(), 1e-300), (name, h)


# A law of one's own


def film_like(u):
    """Odd and even powers: it is no function of the penetration below first touch."""
    return u**3 + 0.5 * u**4


@pytest.mark.parametrize("law", [OWN, OWN.as_data(150.0)], ids=["formulas", "series"])
def test_kogut_and_etsion_written_by_a_user(law):
    delta, e = np.geomspace(1e-7, 30, 1001), np.array([[0.0], [0.3], [1.0], [2.0]])
    for quantity in ("load", "area", "stiffness", "conductance", "load_slope", "contacts", "yielded"):
        found, built_in = term(quantity, law, delta, e), term(quantity, KOGUT, delta, e)
        # The slope of a series of n = 31 terms magnifies rounding at its ends by up to n^2.
        allowed = 4e-12 if quantity == "load_slope" else 1e-12
        np.testing.assert_allclose(found, built_in, rtol=allowed, err_msg=quantity)
    assert np.array_equal(law.limits(e), KOGUT.limits(e))


def test_series_go_on_below_first_touch():
    law = CustomLaw((film_like,), (lambda u: u**2 / (1 + u * u / 20),), (), 0.3)
    series = law.as_data(0.6)
    y, e = np.linspace(-0.7, 0.7, 29), np.array(1.0)
    np.testing.assert_allclose(series.load(0, y, e), law.load(0, y, e), rtol=0, atol=1e-14)
    np.testing.assert_allclose(series.radius(0, y, e), law.radius(0, y, e), rtol=0, atol=1e-14)
    assert np.any(law.load(0, -y, e) != -law.load(0, y, e))
    np.testing.assert_allclose(law.radius(0, -y, e), -law.radius(0, y, e), rtol=1e-15)


def test_another_law_does_not_agree():
    series = OWN.as_data(1.5)
    given = {"load": series.load_of, "area": series.area_of, "limits": (1.0, 6.0), "critical": 0.05}
    assert series.agrees(CustomLaw(**given))
    for other in ({"critical": 0.06}, {"limits": (1.0, 7.0)}, {"load": series.area_of}):
        assert not series.agrees(CustomLaw(**given | other)), other
