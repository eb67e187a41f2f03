"""Correlations for the conductance of spots against numbers by hand and the theory that they fit."""

import numpy as np
import pytest
from scipy.special import erfcinv

import analytic

_JOINT = {"rms": 2e-6, "slope": 0.05, "conductivity": 75.0}


def test_yielding_spots_by_hand():
    """At P/H = 1e-4: 1.25 * 75 * 0.05/2e-6 * 10^-3.8."""
    found = analytic.cooper_mikic_yovanovich([1e5, 1e6], hardness=1e9, **_JOINT)
    assert found == pytest.approx([2343750 * 10**-3.8, 2343750 * 10**-2.85], rel=1e-14)


def test_elastic_spots_by_hand():
    """E* chosen so that P sqrt(2)/(E* m) = 1e-4."""
    found = analytic.mikic_elastic(1e6, E_star=np.sqrt(2) * 2e11, **_JOINT)
    assert float(found) == pytest.approx(1.55 * 75 * 0.05 / 2e-6 * 10**-3.76, rel=1e-14)


@pytest.mark.parametrize(("share", "within"), [(1.0, 0.0155), (0.5, 0.03)], ids=["yielding", "elastic"])
def test_constants_are_those_that_fit_the_theory(share, within):
    """Spots of the bearing area, which elastic contact halves, each of 2 k a/(1 - sqrt(A))^1.5."""
    real = np.geomspace(3e-6, 0.023, 40)
    theory = np.sqrt(share) * np.exp(-(erfcinv(2 * real / share) ** 2)) / (1 - np.sqrt(real)) ** 1.5
    theory *= _JOINT["conductivity"] * _JOINT["slope"] / _JOINT["rms"] / (2 * np.sqrt(2 * np.pi))
    if share == 1:
        found = analytic.cooper_mikic_yovanovich(real * 1e9, hardness=1e9, **_JOINT)
    else:
        found = analytic.mikic_elastic(real * 1e9 * 0.05 / np.sqrt(2), E_star=1e9, **_JOINT)
    off = np.abs(found / theory - 1)
    assert off.max() < within
    assert off.max() > within / 2  # a constant off by that much would be seen


def test_slope_and_conductivity_of_the_pair():
    rng = np.random.default_rng(1)
    slopes = rng.normal(scale=np.sqrt(0.03), size=400_000)
    assert analytic.mean_absolute_slope(0.03) == pytest.approx(np.mean(np.abs(slopes)), rel=5e-3)
    assert analytic.harmonic_conductivity(150.0, 50.0) == pytest.approx(2 * 150 * 50 / 200, rel=1e-15)
    film = analytic.Film(conductivities=(150.0, 50.0))
    assert analytic.harmonic_conductivity(150.0, 50.0) == pytest.approx(2 / film.rho, rel=1e-15)
