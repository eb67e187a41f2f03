"""A lay is doubted along either axis, and told by the ratio of its mean square slopes."""

import re

import numpy as np
import pytest

import mcgw
from mcgw.maps.form import smooth
from mcgw.maps.topography import Topography

PIXEL = (1e-6, 1e-6)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_lay_along_either_axis(axis):
    """A map drawn out fourfold along one axis has slopes a quarter as large along it."""
    noise = np.random.default_rng(1).normal(size=(300, 300))
    plain = smooth(Topography(noise, PIXEL, periodic=True), 12e-6).heights
    drawn_out = Topography(np.repeat(plain, 4, axis=axis), PIXEL)
    (line,) = (x for x in mcgw.fit(drawn_out, cutoff=None).cautions if x.startswith("lay:"))
    ratio = float(re.search(r"ratio (\S+);", line)[1])
    expected = 1 / 8 if axis else 8  # of squares; steps between equal pixels make it less
    assert 0.4 < ratio / expected < 2.5
