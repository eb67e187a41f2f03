"""Asperities there and back: unloading as it is printed, contacts that stick, and limits."""

import mpmath
import numpy as np
import pytest
from oracles.scenes import scene_by

import analytic
import mcgw
from analytic.laws import (
    ChangEtsionBogy,
    DerjaguinMullerToporov,
    Hertz,
    JacksonGreen,
    JohnsonKendallRoberts,
    KogutEtsion,
    PowerLawGraded,
    ZhaoMaiettaChang,
    piece_of,
)

ONE = np.array(1.0)
LAW = KogutEtsion(critical=0.05)
BRIDGED = KogutEtsion(critical=0.05, bridge="hermite")


@pytest.mark.parametrize("law", [LAW, BRIDGED, Hertz(), PowerLawGraded(0.4, reduced_c0=1.0)])
@pytest.mark.parametrize("modulus", [0.6, 1.0, 3.0])
def test_at_the_turn_unloading_is_loading(law, modulus):
    e, back = np.array(modulus), law.unloading()
    deepest = np.geomspace(1e-6, 60, 400)
    piece_at = piece_of(law, deepest, e)
    for piece in np.unique(piece_at):
        d = deepest[piece_at == piece]
        y = np.sqrt(d - back.residual(d, e))
        for formula in ("load", "radius", "stiffness"):
            found = getattr(back, formula)(piece, y, d, e)
            np.testing.assert_allclose(found, getattr(law, formula)(piece, np.sqrt(d), e), rtol=1e-13)


@pytest.mark.parametrize("x", [1.01, 3.0, 20.0, 150.0])
def test_the_fit_as_it_is_printed(x):
    """At 30 digits; next to lift-off and to the turn; of a stiff asperity as of any."""
    with mpmath.workdps(30):
        m = mpmath.mpf(x)
        res = (1 - m ** mpmath.mpf("-0.28")) * (1 - m ** mpmath.mpf("-0.69"))  # over deepest
        for e in (1.0, 2.0):
            dc = 0.05 / e**2
            deepest, modulus = x * dc, np.array(e)
            piece, back = int(piece_of(LAW, np.array(deepest), modulus)), LAW.unloading()
            assert back.residual(deepest, modulus) == pytest.approx(float(res) * deepest, rel=2e-13)
            for share in (1e-9, 0.01, 0.5, 1.0):
                y = np.sqrt(share * (deepest - float(res) * deepest))
                power = mpmath.mpf("1.5") * m ** mpmath.mpf("-0.0331")
                load = float(LAW.load(piece, np.sqrt(deepest), modulus)) * float(mpmath.mpf(share) ** power)
                assert back.load(piece, y, deepest, modulus) == pytest.approx(load, rel=1e-12)
                area = float(LAW.radius(piece, np.sqrt(deepest), modulus)) ** 2
                area *= float(mpmath.mpf(share) ** (m ** mpmath.mpf("-0.12")))
                assert back.radius(piece, y, deepest, modulus) ** 2 == pytest.approx(area, rel=1e-12)


def test_slope_of_unloading_is_that_of_a_difference():
    back, deepest = LAW.unloading(), np.array([0.2, 1.0, 4.0])
    for piece, d in ((1, deepest[:1]), (2, deepest[1:])):
        left = (d - back.residual(d, ONE)) * 0.6
        step = 1e-3 * left
        loads = [back.load(piece, np.sqrt(left + k * step), d, ONE) for k in (-2, -1, 1, 2)]
        difference = (loads[0] - 8 * loads[1] + 8 * loads[2] - loads[3]) / (12 * step)
        np.testing.assert_allclose(back.slope(piece, np.sqrt(left), d, ONE), difference, rtol=1e-10)


def test_stiffness_after_the_turn_is_not_the_slope():
    """A spot of radius a is stiff by 2 E* a; the fit's own slope there differs by some per cent."""
    back, d = LAW.unloading(), np.array([0.3])
    y = np.sqrt(d - back.residual(d, ONE))
    assert back.stiffness(1, y, d, ONE) == pytest.approx(LAW.radius(1, np.sqrt(d), ONE), rel=1e-14)
    assert back.slope(1, y, d, ONE) / 1.5 != pytest.approx(back.stiffness(1, y, d, ONE), rel=0.01)


def test_without_stiffness_nothing_is_left_and_nothing_warns():
    back, e = LAW.unloading(), np.array([0.0, 1.0])
    for piece in (0, 1, 2, 3):
        assert np.all(np.isfinite(back.residual(0.3, e)))
        assert back.load(piece, np.array(0.2), 0.3, e)[0] == 0
        assert np.all(np.isfinite(back.radius(piece, np.array(0.2), 0.3, e)))


@pytest.mark.parametrize(
    "law", [ChangEtsionBogy(critical=0.1), ZhaoMaiettaChang(critical=0.1), JacksonGreen(yield_strength=1e9)]
)
def test_laws_whose_unloading_is_not_known_refuse(law):
    words = f"law = '{law.name}': no unloading is known for it; use 'kogut-etsion'"
    with pytest.raises(ValueError, match=words) as caught:
        law.unloading()
    assert "\n" not in str(caught.value)


SURFACE = analytic.Surface(sigma=1e-6, radius=1e-4, eta=1e9, nominal_area=1e-6, E_star=1e6)


def test_forces_in_newton():
    """First touch at -(4/3) pi w R, break-off at -(5/6) pi w R, and a pull of 2 pi w R, of the work w."""
    work = 0.05
    unit = analytic.QUANTITIES["load"].scale(SURFACE)
    johnson = JohnsonKendallRoberts(work=work).on(SURFACE)
    back = johnson.unloading()
    pull = np.pi * work * SURFACE.radius
    assert unit * float(johnson.load(0, 0.0, ONE)) == pytest.approx(-4 / 3 * pull, rel=1e-13)
    assert unit * float(back.load(0, 0.0, np.array(1.0), ONE)) == pytest.approx(-5 / 6 * pull, rel=1e-13)
    derjaguin = DerjaguinMullerToporov(work=work).on(SURFACE)
    assert unit * float(derjaguin.load(0, 0.0, ONE)) == pytest.approx(-2 * pull, rel=1e-13)


@pytest.mark.parametrize("e", [0.3, 1.0, 2.0])
def test_both_ways_meet_and_stiffness_is_the_slope(e):
    law, e = JohnsonKendallRoberts(pull_off=0.2), np.array(e)
    delta = np.linspace(0.01, 3, 50)
    y, stretch = np.sqrt(delta), float(law.stretch(e))
    back = law.unloading().load(0, np.sqrt(delta + stretch), np.array(9.0), e)
    np.testing.assert_allclose(back, law.load(0, y, e), rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(law.stiffness(0, y, e), 2 / 3 * law.slope(0, y, e), rtol=1e-12)


def test_without_adhesion_it_is_hertz():
    y = np.linspace(0.1, 2, 20)
    for law in (JohnsonKendallRoberts(pull_off=1e-12), DerjaguinMullerToporov(pull_off=1e-12)):
        np.testing.assert_allclose(law.load(0, y, ONE), y**3, rtol=1e-6)
        np.testing.assert_allclose(law.radius(0, y, ONE), y, rtol=1e-6)


@pytest.mark.parametrize(("changes", "said"), [
    ({"unload_from": 0.0}, "contact.quantities: 'stiffness' has no variance if contacts break off"),
    ({"negative": "allow"}, 'grading.negative = "allow"'),
])  # fmt: skip
def test_what_means_nothing_is_refused(changes, said):
    with pytest.raises(mcgw.SceneError) as caught:
        scene_by(SURFACE, separations=[0, 1], law=JohnsonKendallRoberts(pull_off=0.1), **changes)
    assert caught.value.problems[0].startswith(said)


@pytest.mark.parametrize("given", [{}, {"work": 1.0, "pull_off": 1.0}, {"work": -1.0}, {"pull_off": np.inf}])
def test_constants_are_checked(given):
    with pytest.raises(ValueError, match="give"):
        JohnsonKendallRoberts(**given)
