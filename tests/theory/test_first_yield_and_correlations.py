"""What asperities are past first yield under laws that stay elastic, and correlations for their spots."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

import analytic

_SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e11)
_H = np.array([-1.0, 0.0, 1.5, 4.0])


def _critical(hardness, poisson=0.3):
    """Over sigma, by hand."""
    return (pi * (0.454 + 0.41 * poisson) * hardness / 2e11) ** 2 * 10


def test_plasticity_index_is_that_of_the_laws_that_yield():
    """nu = 0.3: K = 0.577, H/E* = 0.01: (pi 0.577 0.01/2)^2 10 um = 0.8215 nm, psi = 34.89."""
    index = analytic.summit_plasticity_index(_SURFACE, 1e9)
    assert index == pytest.approx(34.890, rel=1e-4)
    law = analytic.KogutEtsion(hardness=1e9, poisson=0.4).on(_SURFACE)
    assert analytic.summit_plasticity_index(_SURFACE, 1e9, 0.4) ** -2 == pytest.approx(
        law.critical, rel=1e-14
    )
    strength = 1e9 * (0.454 + 0.41 * 0.3) / (1.295 * np.exp(0.736 * 0.3))  # K H = C S_y
    other = analytic.JacksonGreen(yield_strength=strength, poisson=0.3).on(_SURFACE)
    assert index**-2 == pytest.approx(other.critical, rel=1e-14)
    by_greenwood = 100 * sqrt(0.1)
    assert by_greenwood == pytest.approx(index * pi * 0.577 / 2, rel=1e-14)


@pytest.mark.parametrize("hardness", [1e9, 4e10])
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
    """A radius c R yields at c delta_c: counted in a list."""
    listed = analytic.MeasuredRadii(analytic.MeasuredHeights([0.0, 1.0, 2.0, 4.0]), (1.0, 0.5, 1.5, 1.0))
    of_list = analytic.Model(_SURFACE, heights=listed.heights, curvature=listed)
    s, c = np.array(listed.heights.heights), np.array(listed.ratios)
    s = (s - s.mean()) / s.std()
    share = np.sum(s > c * _critical(1e10)) / np.sum(s > 0)
    assert float(analytic.yielding_share(of_list, 0.0, 1e10)) == pytest.approx(share, abs=1e-12)


@pytest.mark.parametrize(
    "law", [analytic.Coated(ratio=2.0, reduced_thickness=0.5), analytic.JohnsonKendallRoberts(pull_off=0.01)]
)
def test_by_penetration_under_every_elastic_law(law):
    model = analytic.Model(_SURFACE, law=law, film=analytic.Film(resistivity=1e-7), unload_from=0.0)
    exact = norm.sf(1 + _critical(1e10)) / norm.sf(1)
    assert float(analytic.yielding_share(model, 1.0, 1e10)) == pytest.approx(exact, abs=1e-12)


def test_where_nothing_touches_there_is_no_share():
    model = analytic.Model(_SURFACE, heights=analytic.HeightTable.of(np.linspace(0, 1, 50)))
    assert np.isnan(analytic.yielding_share(model, 9.0, 1e9))


# Correlations for the conductance of spots

_JOINT = {"rms": 2e-6, "slope": 0.05, "conductivity": 75.0}


def test_spots_by_hand():
    """At P/H = 1e-4 and 1e-3; and E* chosen so that P sqrt(2)/(E* m) = 1e-4."""
    found = analytic.cooper_mikic_yovanovich([1e5, 1e6], hardness=1e9, **_JOINT)
    assert found == pytest.approx([2343750 * 10**-3.8, 2343750 * 10**-2.85], rel=1e-14)
    found = analytic.mikic_elastic(1e6, E_star=np.sqrt(2) * 2e11, **_JOINT)
    assert float(found) == pytest.approx(1.55 * 75 * 0.05 / 2e-6 * 10**-3.76, rel=1e-14)


def test_slope_of_the_pair():
    slopes = 2 * sqrt(0.03) * quad(lambda x: x * norm.pdf(x), 0, 9)[0]
    assert analytic.mean_absolute_slope(0.03) == pytest.approx(slopes, rel=1e-12)
