"""Maps that no instrument gives: heights that overflow, bombs, and words in place of numbers."""

import numpy as np
import pytest
from oracles.inside import summit_sums_of

import mcgw
from mcgw.maps import Topography, summit_sums

UNITS = 1e-6 * np.random.default_rng(1).normal(size=(8, 9))
HEIGHTS = {
    "missing": np.full((12, 12), np.nan),
    "some missing": np.where(np.random.default_rng(2).random((12, 12)) < 0.3, np.nan, 1.0),
    "equal": np.zeros((12, 12)),
    "infinite": np.random.default_rng(3).choice([-np.inf, np.inf, np.nan], size=(12, 12)),
    "two heights": np.random.default_rng(4).choice([-1e150, 1e150], size=(12, 12)),
}


@pytest.mark.parametrize("z", HEIGHTS.values(), ids=HEIGHTS)
def test_no_two_neighbours_are_summits_whatever_a_map_holds(z):
    """So that one in every square of two by two is the most there can be, for which room is made."""
    found = np.zeros(z.shape, dtype=int)
    for j, i in np.ndindex(10, 10):
        found[j + 1, i + 1] = summit_sums._is_summit(z, j + 1, i + 1)
    squares = found[:-1, :-1] + found[1:, :-1] + found[:-1, 1:] + found[1:, 1:]
    assert squares.max() <= 1
    assert found.sum() <= summit_sums._most_summits(10, 10)


def test_the_pass_writes_nothing_beyond_the_room_it_is_given():
    """Of whatever size: the lists are the first half of arrays here, whose other half must stay."""
    z = np.zeros((32, 32))
    z[::2, ::2] = 1.0
    lists, part = np.full(800, -7.0), np.full(200, -7)
    none, sums = np.empty((0, 0), dtype=np.bool_), np.zeros((9, 4))
    assert summit_sums._pass(z, 0.0, none, 1.0, 1.0, 2, sums, lists[:400].reshape(4, 100), part[:100]) == 100
    assert np.all(lists[400:] == -7)
    assert np.all(part[100:] == -7)
    odd = np.pad(z, ((0, 1), (0, 1)))
    odd[::2, ::2] = 1.0
    assert summit_sums_of(Topography(odd, (1e-6, 1e-6))).heights.size == 13 * 13


NO_SURFACE = r"m2 = .* no surface has these; give the right unit, or take bad points .* out by --spikes"
NO_NUMBERS = "squares of their derivatives overflow, or points are missing"


def test_moments_that_no_surface_has_are_refused_in_one_line():
    """Slopes on the margin count and heights do not; squares of sums overflow or vanish, sums do not."""
    once = 1e-6 * np.random.default_rng(1).normal(size=(64, 66))
    assert mcgw.fit(Topography(once, (1e-6, 1e-6)), cutoff=None).numbers["alpha"].value > 1
    for factor, place, height, told in (
        (1.0, (3, 30), -0.016, NO_SURFACE),
        (1e-90, (0, 0), 0.0, NO_SURFACE),
        (1.0, (30, 30), 1e80, NO_NUMBERS),
    ):
        z = factor * once
        z[place] = height
        with pytest.raises(ValueError, match=told):
            mcgw.fit(Topography(z, (1e-6, 1e-6)), cutoff=None)
    steep, missing = 1e146 * once, once.copy()
    missing[16, 16] = np.nan
    for z in (steep, missing):
        with pytest.raises(ValueError, match=NO_NUMBERS):
            summit_sums_of(Topography(z, (1e-6, 1e-6)))
