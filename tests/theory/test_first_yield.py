"""Share of contacts past first yield under laws that stay elastic, and the index that tells it."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from scipy.stats import norm

import analytic
from analytic.laws import by_name

_SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
_H = np.array([-1.0, 0.0, 1.5, 4.0])


def _critical(hardness, poisson=0.3):
    """Over sigma, by hand."""
    return (pi * (0.454 + 0.41 * poisson) * hardness / 2e11) ** 2 * 10


def test_critical_penetration_is_that_of_the_laws_that_yield():
    """nu = 0.3: K = 0.577, H/E* = 0.01: (pi 0.577 0.01/2)^2 10 um = 0.8215 nm, psi = 34.89."""
    assert analytic.critical_penetration(_SURFACE, 1e9) == pytest.approx(8.2147e-10, rel=1e-4)
    assert analytic.summit_plasticity_index(_SURFACE, 1e9) == pytest.approx(34.890, rel=1e-4)
    law = analytic.KogutEtsion(hardness=1e9, poisson=0.4).on(_SURFACE)
    assert analytic.critical_penetration(_SURFACE, 1e9, 0.4) == pytest.approx(law.critical * 1e-6, rel=1e-14)
    strength = 1e9 * (0.454 + 0.41 * 0.3) / (1.295 * np.exp(0.736 * 0.3))  # K H = C S_y
    other = analytic.JacksonGreen(yield_strength=strength, poisson=0.3).on(_SURFACE)
    assert analytic.critical_penetration(_SURFACE, 1e9) == pytest.approx(other.critical * 1e-6, rel=1e-14)
    by_greenwood = 100 * sqrt(0.1)
    index = analytic.summit_plasticity_index(_SURFACE, 1e9)
    assert by_greenwood == pytest.approx(index * pi * 0.577 / 2, rel=1e-14)


@pytest.mark.parametrize("hardness", [1e9, 1e10, 4e10])
def test_share_of_one_radius(hardness):
    exact = norm.sf(_H + _critical(hardness)) / norm.sf(_H)
    assert analytic.yielding_share(analytic.Model(_SURFACE), _H, hardness) == pytest.approx(exact, abs=1e-12)


def test_a_stiffer_asperity_of_the_same_hardness_yields_earlier():
    """delta_c/e^2 at the height s of the summit itself: the lowest that yields by bisection."""
    model = analytic.Model(_SURFACE, grading=analytic.Exponential(2.0))
    for h in (0.0, 1.5):
        low, high = h, h + 10.0
        for _ in range(60):
            s = (low + high) / 2
            yields = (s - h) * (2 - np.exp(-s)) ** 2 > _critical(1e10)
            low, high = (low, s) if yields else (s, high)
        exact = norm.sf(high) / norm.sf(h)
        assert float(analytic.yielding_share(model, h, 1e10)) == pytest.approx(exact, abs=1e-12)


def test_summits_of_their_own_radius():
    """A radius c R yields at c delta_c: counted in a list, and another share than of one radius."""
    heights = analytic.Nayak(5.0)
    model = analytic.Model(_SURFACE, heights=heights, curvature=analytic.RandomCurvature(5.0))
    listed = analytic.MeasuredRadii(analytic.MeasuredHeights([0.0, 1.0, 2.0, 4.0]), (1.0, 0.5, 1.5, 1.0))
    of_list = analytic.Model(_SURFACE, heights=listed.heights, curvature=listed)
    s, c = np.array(listed.heights.heights), np.array(listed.ratios)
    s = (s - s.mean()) / s.std()
    share = np.sum(s > c * _critical(1e10)) / np.sum(s > 0)
    assert float(analytic.yielding_share(of_list, 0.0, 1e10)) == pytest.approx(share, abs=1e-12)
    one = float(analytic.yielding_share(replace(model, curvature=None), 1.0, 2e10))
    own = float(analytic.yielding_share(model, 1.0, 2e10))
    assert 0 < own < 1
    assert own != pytest.approx(one, abs=1e-3)


@pytest.mark.parametrize("name", [name for name, law in by_name.items() if not law.yields])
def test_by_penetration_under_every_elastic_law(name):
    constants = {
        "power-law-graded": {"k": 0.3, "reduced_c0": 1.0},
        "coated": {"ratio": 2.0, "reduced_thickness": 0.5},
    }
    made = by_name[name](**constants.get(name, {} if name == "hertz" else {"pull_off": 0.01}))
    model = analytic.Model(_SURFACE, law=made, film=analytic.Film(resistivity=1e-7), unload_from=0.0)
    exact = norm.sf(1 + _critical(1e10)) / norm.sf(1)
    assert float(analytic.yielding_share(model, 1.0, 1e10)) == pytest.approx(exact, abs=1e-12)


def test_neighbours_that_press_down_are_felt():
    model = analytic.Model(_SURFACE)
    together = analytic.InteractingModel.of(model, analytic.Interaction("body"))
    share = analytic.yielding_share(model, 0.5, 1e10)
    assert float(analytic.yielding_share(together, 0.5, 1e10)) == pytest.approx(float(share), abs=1e-12)


def test_nothing_touches_and_numbers_out_of_range():
    model = analytic.Model(_SURFACE, heights=analytic.HeightTable.of(np.linspace(0, 1, 50)))
    assert np.isnan(analytic.yielding_share(model, 9.0, 1e9))
    with pytest.raises(ValueError, match=r"hardness = -1.0: give a finite number > 0"):
        analytic.critical_penetration(_SURFACE, -1.0)
    with pytest.raises(ValueError, match=r"poisson = 0.7: give a Poisson's ratio"):
        analytic.yielding_share(model, 0.0, 1e9, 0.7)
