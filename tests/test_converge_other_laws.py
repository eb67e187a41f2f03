"""Exponential and Weibull heights pass the convergence test, too."""

import pytest

import analytic
from mcgw.statistics.convergence import converge


@pytest.mark.slow
@pytest.mark.parametrize("law", [analytic.ExponentialHeights(), analytic.Weibull(1.564)])
def test_other_laws_pass(make_scene, law):
    scene = make_scene(heights=law, separations=(0.0, 0.5, 1.0, 2.0), seed=7)
    assert converge(scene).passed
