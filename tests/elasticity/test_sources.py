"""What maps are taken of a source, and what is said of them."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.inside import maps_of
from oracles.rough import SPECTRUM, rough
from scipy.signal import get_window

import mcgw
from analytic import SpectralMoments
from mcgw.maps import Spectrum, Topography, gaussian_map, moments_on_grid, write_map


@pytest.mark.parametrize("periodic", [True, False])
def test_surrogates_have_the_spectrum_of_the_map(periodic, rng):
    """Each wave's mean square over 2000 of them, within five standard errors; one that is off is seen."""
    z = rng.standard_normal((8, 12)) + 3.0
    window = np.ones(z.shape)
    if not periodic:
        window = np.sqrt(np.outer(*(get_window("hann", n) for n in z.shape)))
        window /= np.sqrt((window**2).mean())
    power = np.abs(np.fft.rfft2((z - z.mean()) * window)) ** 2
    maps = maps_of(Topography(z, (1e-6, 2e-6), periodic))
    drawn = np.array([maps.heights(i, 5) for i in range(2000)])
    seen = np.abs(np.fft.rfft2(drawn)) ** 2
    error = seen.std(axis=0) / math.sqrt(len(seen))
    assert maps.number is None
    assert maps.size == pytest.approx((12e-6, 16e-6))
    assert_allclose(drawn.mean(axis=(1, 2)), 0, atol=1e-14)
    off = np.abs(seen - power).mean(axis=(1, 2))  # not the map itself
    assert off.min() > 0.1 * power.mean()
    z_scores = ((seen.mean(axis=0) - power) / np.where(error > 0, error, 1)).ravel()[1:]
    assert np.abs(z_scores).max() < 5
    assert np.abs((seen.mean(axis=0) - 1.2 * power) / np.where(error > 0, error, 1)).max() > 5


def test_a_map_with_holes_is_refused(rng):
    whole = rough(rng)
    holed = whole.heights.copy()
    holed[3, 4:6] = np.nan
    with pytest.raises(ValueError, match=r"^2 points are missing; fill them first"):
        maps_of(replace(whole, heights=holed))


def test_maps_of_a_scene_have_its_moments_and_area(tmp_path):
    """Eight points to the shortest wave; the scene may have them from its surface, its law or a fit."""
    spectral = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "0.16 mm^2", "78.6 GPa")
    scene = mcgw.Scene(spectral, separations=0.0, n_surfaces=2, seed=1)
    spectrum = Spectrum.with_moments(SpectralMoments(1e-12, 1e-3, 5e6))
    found = maps_of(scene)
    points = found.heights(3, 7).shape[0]
    assert 8 <= points * spectrum.short / 4e-4 < 8.8
    expected = gaussian_map(spectrum, (points,) * 2, (4e-4 / points,) * 2, np.random.default_rng([7, 3]))
    assert_allclose(found.heights(3, 7), expected.heights, rtol=1e-6, atol=1e-12)
    assert found.size == pytest.approx((4e-4, 4e-4))
    assert found.number is None
    drawn = gaussian_map(SPECTRUM, (96, 96), (1e-6, 1e-6), np.random.default_rng(1))
    fit = mcgw.fit(drawn, cutoff=None, form="none")
    fitted = maps_of(mcgw.fitted_scene(fit, nominal_area="0.04 mm^2"))
    assert fitted.heights(0, 1).std() == pytest.approx(math.sqrt(fit.moments.m0), rel=0.2)
    write_map(drawn, tmp_path / "map.npy")
    source = tmp_path / "map.npy"
    assert np.array_equal(maps_of(source).heights(2, 1), maps_of(drawn).heights(2, 1))
    assert np.array_equal(maps_of([str(source)]).heights(0, 1), drawn.heights - drawn.heights.mean())


@pytest.mark.parametrize("over", [1, -1])
def test_an_area_that_is_proposed_will_do(over):
    """As wide as the longest wave, or as 2048 points, eight of which are the shortest."""
    moments = moments_on_grid(SPECTRUM, (512, 512), (1e-6, 1e-6))
    surface = mcgw.SpectralSurface(moments.m0, moments.m2, moments.m4, 1e-8, 1e11)
    scene = mcgw.Scene(surface, separations=0.0, n_surfaces=2, seed=1)
    spectrum = Spectrum.with_moments(moments)
    limit = spectrum.long if over > 0 else 256 * spectrum.short
    factor = (1 - over * 1e-3) * limit
    with pytest.raises(ValueError, match="give nominal_area = ") as told:
        maps_of(scene.replace(nominal_area=factor**2))
    proposed = float(re.search(r"nominal_area = (\S+) m\^2 or (?:more|less)", str(told.value))[1])
    assert maps_of(scene.replace(nominal_area=proposed)).number is None
    assert proposed == pytest.approx(limit**2, rel=0.015)
    maps_of(scene.replace(nominal_area=((1 + over * 1e-3) * limit) ** 2))


@pytest.mark.parametrize(("size", "periodic"), [(1e-6, False), (2e-6, True), (None, True)])
def test_maps_of_a_list_are_alike_and_periodic(size, periodic):
    flat = Topography(np.arange(12.0).reshape(3, 4), (1e-6, 1e-6), True)
    with pytest.raises(ValueError, match="maps: give one or more periodic maps, all of one"):
        maps_of([flat, Topography(flat.heights, (size, size), periodic)] if size else [])
    assert_allclose(maps_of([flat, flat]).heights(1, 0).ravel(), np.arange(12) - 5.5)
