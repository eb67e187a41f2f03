"""A law of contact of one's own: against the same law built in, as formulas and as series."""

import numpy as np
import pytest
from oracles.law_means import term
from oracles.laws_by_hand import OWN

from analytic.laws import CustomLaw, KogutEtsion
from mcgw import SceneError

KOGUT = KogutEtsion(critical=0.05)
QUANTITIES = ("load", "area", "stiffness", "conductance", "load_slope", "contacts", "yielded")


def film_like(u):
    """Odd and even powers: it is no function of the penetration below first touch."""
    return u**3 + 0.5 * u**4


@pytest.mark.parametrize("law", [OWN, OWN.as_data(150.0)], ids=["formulas", "series"])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_kogut_and_etsion_written_by_a_user(law, quantity):
    delta, e = np.geomspace(1e-7, 30, 1001), np.array([[0.0], [0.3], [1.0], [2.0]])
    found, built_in = term(quantity, law, delta, e), term(quantity, KOGUT, delta, e)
    # The slope of a series of n = 31 terms magnifies rounding at its ends by up to n^2.
    allowed = 4e-12 if quantity == "load_slope" and law is not OWN else 1e-12
    np.testing.assert_allclose(found, built_in, rtol=allowed)
    assert np.array_equal(law.limits(e), KOGUT.limits(e))


def test_series_go_on_below_first_touch():
    law = CustomLaw((film_like,), (lambda u: u**2 / (1 + u * u / 20),), (), 0.3)
    series = law.as_data(0.6)
    y, e = np.linspace(-0.7, 0.7, 29), np.array(1.0)
    np.testing.assert_allclose(series.load(0, y, e), law.load(0, y, e), rtol=0, atol=1e-14)
    np.testing.assert_allclose(series.radius(0, y, e), law.radius(0, y, e), rtol=0, atol=1e-14)
    assert np.any(law.load(0, -y, e) != -law.load(0, y, e))
    np.testing.assert_allclose(law.radius(0, -y, e), -law.radius(0, y, e), rtol=1e-15)


def test_pieces_out_of_reach_are_left_out():
    series = OWN.as_data(0.25)
    assert series.beginnings == (1.0,)
    assert len(series.load_of) == len(series.area_of) == 2
    assert all(len(formula.coefficients) < 33 for formula in series.load_of)
    assert not any(series.load_of[0].coefficients[::2])  # odd, as u^3/u^2 is
    np.testing.assert_allclose(series.load(1, 0.4, 1.0), OWN.load(1, 0.4, 1.0), rtol=1e-14)


def test_another_law_does_not_agree():
    series = OWN.as_data(1.5)
    given = {"load": series.load_of, "area": series.area_of, "limits": (1.0, 6.0), "critical": 0.05}
    assert series.agrees(CustomLaw(**given))
    for other in ({"critical": 0.06}, {"limits": (1.0, 7.0)}, {"load": series.load_of[::-1]}):
        assert not series.agrees(CustomLaw(**given | other)), other


def test_a_kink_inside_a_piece_is_seen():
    law = CustomLaw(
        (lambda u: u**3, lambda u: u**2 * (2 + np.sqrt((u - 2) ** 2))), (lambda u: u**2,) * 2, (1,), 0.1
    )
    with pytest.raises(
        ValueError, match=r"load\[1\]: a series of 256 terms .* x = 1 and 50: give the penetration"
    ):
        law.as_data(5.0)


@pytest.mark.parametrize(("arguments", "words"), [
    (((film_like,), (film_like,), (1.0,), 0.1), "load: give 2 formulas, one more than limits, not 1"),
    (((film_like,) * 2, (film_like,), (1.0,), 0.1), "area: give 2 formulas"),
    (((film_like,) * 3, (film_like,) * 3, (2.0, 1.0), 0.1), r"limits = \[2.0, 1.0\]: give"),
    (((film_like,), (film_like,), (), 0.0), "critical = 0.0: give"),
    (((lambda u: u**2.5,), (film_like,), (), 0.1), r"load\[0\]: .*also negative ones"),
    (((film_like,), (lambda u: np.interp(u, [0, 1], [0, 1]),), (), 0.1), r"area\[0\]: .*complex u"),
    (((film_like, lambda u: np.log(1 - u)), (film_like,) * 2, (1.0,), 0.1), r"load\[1\]: .*finite"),
])  # fmt: skip
def test_errors_name_the_formula_and_what_would_do(arguments, words):
    with pytest.raises(ValueError, match=words) as caught:
        CustomLaw(*arguments)
    assert "\n" not in str(caught.value)


def test_a_law_of_the_penetration_itself_is_told_from_a_kink():
    """(u*u)**1.5 is |u|^3: no series of u begins so, and the advice on kinks alone would lead nowhere."""
    law = CustomLaw(load=(lambda u: (u * u) ** 1.5,), area=(lambda u: u**2,), limits=(), critical=0.05)
    with pytest.raises(
        ValueError, match=r"load\[0\]: .* write u\*\*3 for \(u\*u\)\*\*1.5: it is also evaluated at -u"
    ):
        law.as_data(0.2)
    whole = CustomLaw(load=(lambda u: u**3,), area=(lambda u: u**2,), limits=(), critical=0.05)
    assert whole.as_data(0.2).is_data


def test_a_plain_function_is_sent_to_custom_laws(make_scene):
    with pytest.raises(SceneError, match="your own law is mcgw"):
        make_scene(law=lambda penetration: penetration**1.5)
    with pytest.raises(SceneError, match=r"contact\.unload_from = 0: law = 'custom'"):
        make_scene(law=OWN, unload_from=0.0)
