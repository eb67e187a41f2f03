"""Contacts that stick: published means, the way back, energy, limits."""

import numpy as np
import pytest
from scipy.integrate import quad

import analytic
import mcgw
from analytic.laws import DerjaguinMullerToporov, JohnsonKendallRoberts

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-4, eta=1e9, nominal_area=1e-6, E_star=1e6)
ONE = np.array(1.0)


def density(s):
    return np.exp(-s * s / 2) / np.sqrt(2 * np.pi)


def mean(f, low):
    """Over Gaussian heights from `low` on, in the root of the distance from there."""
    rules = (
        quad(lambda v: 2 * v * f(v) * density(low + v * v), a, b, epsrel=1e-13) for a, b in ((0, 1), (1, 4))
    )
    return sum(found[0] for found in rules)


@pytest.mark.parametrize(
    ("stretch", "load", "area"),
    [(0.05, 0.07347199399110158, 0.1089474218832419), (0.5, -0.001395827560214945, 0.2710312896208413)],
)
def test_means_of_loading(stretch, load, area):
    law = JohnsonKendallRoberts(pull_off=stretch)
    assert mean(lambda y: float(law.load(0, y, ONE)), 1.0) == pytest.approx(load, rel=1e-12, abs=1e-14)
    assert mean(lambda y: float(law.radius(0, y, ONE)) ** 2, 1.0) == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize(
    ("stretch", "load", "area"),
    [(0.05, 0.07324746648337926, 0.1097973547290834), (0.5, -0.08691870486353161, 0.370556433499445)],
)
def test_means_of_unloading(stretch, load, area):
    back = JohnsonKendallRoberts(pull_off=stretch).unloading()
    deepest = np.array(9.0)
    assert float(back.residual(0, deepest, ONE)) == -stretch
    assert mean(lambda y: float(back.load(0, y, deepest, ONE)), 1 - stretch) == pytest.approx(load, rel=1e-12)
    found = mean(lambda y: float(back.radius(0, y, deepest, ONE)) ** 2, 1 - stretch)
    assert found == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize(("stretch", "load"), [(0.05, 0.07157171634920946), (0.5, -0.05387329499027977)])
def test_means_after_derjaguin(stretch, load):
    law = DerjaguinMullerToporov(pull_off=stretch)
    assert mean(lambda y: float(law.load(0, y, ONE)), 1.0) == pytest.approx(load, rel=1e-12)


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


def test_surfaces_stick():
    """An ensemble both ways: the mean of theory, more contacts on the way back, and work that is lost."""
    h = np.linspace(-0.5, 1.5, 9)
    scene = mcgw.Scene(
        SURFACE,
        separations=h,
        law=JohnsonKendallRoberts(pull_off=0.5),
        unload_from="loop",
        quantities=["load", "area", "contacts"],
        n_asperities=3000,
        n_surfaces=500,
        seed=2,
    )
    drawn = mcgw.simulate(scene)
    assert np.all(drawn["contacts_unloading"][:, 1:] > drawn.contacts[:, 1:])
    np.testing.assert_array_equal(drawn["contacts_unloading"][:, 0], drawn.contacts[:, 0])
    np.testing.assert_allclose(drawn["load_unloading"][:, 0], drawn.load[:, 0], rtol=1e-12)
    assert np.all(np.trapezoid(drawn.load - drawn["load_unloading"], h, axis=1) > 0)
    law, unit = scene.contact, 3000 * analytic.QUANTITIES["load"].scale(SURFACE)
    expected = unit * mean(lambda y: float(law.load(0, y, ONE)), 1.0)
    assert abs(drawn.mean("load")[6] - expected) < 5 * drawn.stderr("load")[6]


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"unload_from": 0.0}, "contact.quantities: 'stiffness' of contacts that break off has no variance"),
        ({"negative": "allow"}, 'grading.negative = "allow"'),
    ],
)
def test_what_means_nothing_is_refused(changes, said):
    with pytest.raises(mcgw.SceneError) as caught:
        mcgw.Scene(SURFACE, separations=[0, 1], law=JohnsonKendallRoberts(pull_off=0.1), **changes)
    assert caught.value.problems[0].startswith(said)


@pytest.mark.parametrize("given", [{}, {"work": 1.0, "pull_off": 1.0}, {"work": -1.0}, {"pull_off": np.inf}])
def test_constants_are_checked(given):
    with pytest.raises(ValueError, match="give"):
        JohnsonKendallRoberts(**given)
