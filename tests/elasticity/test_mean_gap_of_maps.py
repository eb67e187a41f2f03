"""The mean gap of a fitted map is that of boundary elements, within its stated 95 %."""

import math

import numpy as np
import pytest
from oracles.inside import LEVELS, Pressed

import mcgw
from analytic import SpectralMoments
from mcgw.maps import Spectrum, Topography, gaussian_map

_E_STAR, _M0, _M2 = 1e11, 2.5e-13, 2.5e-3


@pytest.mark.site
@pytest.mark.parametrize(("alpha", "seed", "waves"), [(5.3, 11, 24), (10.0, 12, 32), (20.0, 13, 32)])
def test_three_maps_at_three_loads(alpha, seed, waves):
    """Tamaas between the mean planes; off by less than a third of what the summits rise above them."""
    pytest.importorskip("tamaas")
    spectrum = Spectrum.with_moments(SpectralMoments(_M0, _M2, alpha * _M2**2 / _M0))
    points, side = 8 * waves, waves * spectrum.short
    pixel = (side / points, side / points)
    heights = gaussian_map(spectrum, (points, points), pixel, np.random.default_rng([seed, 0])).heights
    plane = Topography(heights, pixel=pixel, periodic=True)
    fit = mcgw.fit(plane, cutoff=None, form="none")
    scene = mcgw.fitted_scene(fit, E_star=_E_STAR, n_surfaces=100, seed=1)
    assert scene.gap == "mean_gap"
    for share in (0.002, 0.01, 0.05):
        pressure = share * _E_STAR * math.sqrt(2 * _M2)
        exact = LEVELS[-1].solve(Pressed(heights, (side, side), _E_STAR, pressure))["mean_gap"]
        best = mcgw.solve(scene, pressure=pressure).corrected("mean_gap")
        assert best.low <= exact <= best.high
        assert abs(exact - best.value) < scene.rise * scene.surface.sigma / 3
