"""Values of single surfaces against exact sums over their very heights: no error above what is promised.

At all separations, from hardly a contact to many, for gradings, laws of heights and of contact, films, ways
back and individual summit radii. Nothing here is statistical: bounds hold.
"""

import pytest
from conftest import SURFACE
from oracles.accurately import worst_error
from oracles.scenes import scene_by
from tables.drawn_scenes import BASIC, HERTZ, LAWS, H

import analytic


def asked(row):
    """A scene, and how many of its surfaces are looked at."""
    values = {"separations": H, "grading": analytic.Exponential(2.0), "n_asperities": 600, "n_surfaces": 3}
    values |= {"sampler": "cells", "quantities": BASIC, "seed": 3, "negative": "clip", **row}
    surfaces = values.pop("surfaces", 3)
    return scene_by(SURFACE, **values), surfaces


@pytest.mark.parametrize("name", HERTZ)
def test_hertz_to_the_last_digits(name):
    """A lone contact may be off twice, as it is itself and as part of a larger node."""
    assert worst_error(*asked(HERTZ[name])) <= 3e-13


@pytest.mark.parametrize("name", LAWS)
def test_other_laws(name):
    assert worst_error(*asked(LAWS[name])) <= 1e-12


@pytest.mark.slow
def test_a_million_asperities():
    """Where many touch, series are held against the sum of a surface, which is sure to be large."""
    assert worst_error(*asked({"n_asperities": 10**6})) <= 3e-13
