"""Bridges over the jumps of fitted laws: continuous, rising, and only where they should be."""

from dataclasses import replace

import numpy as np
import pytest
from law_means import BRIDGED, FOUR, ONE, name, term

from analytic.laws import piece_of


@pytest.mark.parametrize("law", BRIDGED, ids=name)
@pytest.mark.parametrize("modulus", [0.8, 1.0, 2.0])
def test_bridges_join_load_area_and_slopes(law, modulus):
    e = np.array(modulus)
    for j, limit in enumerate(law.limits(e)):
        y = np.sqrt(limit)
        assert law.load(j, y, e) == pytest.approx(law.load(j + 1, y, e), rel=1e-13)
        assert law.radius(j, y, e) == pytest.approx(law.radius(j + 1, y, e), rel=1e-13)
        assert law.slope(j, y, e) == pytest.approx(law.slope(j + 1, y, e), rel=1e-12)


@pytest.mark.parametrize("law", BRIDGED, ids=name)
def test_with_bridges_load_and_area_always_rise(law):
    """Without them Kogut and Etsion's area does not: the test can fail."""
    delta = np.unique([*np.geomspace(1e-4, 20, 20001), *np.nextafter(law.limits(ONE), 0)])
    for quantity in ("load", "area"):
        assert np.all(np.diff(term(quantity, law, delta, ONE)) > 0)
        assert np.all(np.diff(term(quantity, law, delta, np.array(0.9))) > 0)
    assert np.any(np.diff(term("area", FOUR[2], delta, ONE)) < 0)


@pytest.mark.parametrize("law", BRIDGED, ids=name)
def test_away_from_bridges_the_law_is_the_published_one(law):
    bare = replace(law, bridge=None)
    delta = np.geomspace(1e-4, 20, 2001)
    between = piece_of(law, delta, ONE) % 2 == 0
    for quantity in ("load", "area", "load_slope"):
        a, b = term(quantity, law, delta, ONE), term(quantity, bare, delta, ONE)
        assert np.array_equal(a[between], b[between])
        assert not np.array_equal(a, b)
