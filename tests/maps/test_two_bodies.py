"""Two rough bodies as one, against a drawn sum of two maps."""

import numpy as np
import pytest

import mcgw
from analytic import SpectralMoments
from mcgw.maps import Spectrum, Topography, gaussian_map

SPECTRA = (Spectrum(1e-6, 80e-6, 10e-6), Spectrum(0.2e-6, 40e-6, 8e-6))
PIXEL = (1e-6, 1e-6)


@pytest.fixture(scope="module")
def maps():
    """Two maps of different spectra."""
    return [gaussian_map(s, (512, 512), PIXEL, np.random.default_rng(k)) for k, s in enumerate(SPECTRA)]


def test_two_fits_give_the_fit_of_the_drawn_sum(maps):
    """Sigma, R and eta within 2 %, load at three separations within 4 %."""
    total = Topography(maps[0].heights - maps[1].heights, PIXEL, periodic=True)
    a, b, both = (mcgw.fit(z, cutoff=None, form="none") for z in (*maps, total))
    pair = mcgw.combine(a, b, nominal_area=both.area, E_star=1e11)
    for name in ("sigma", "radius", "eta"):
        assert getattr(pair.surface, name) == pytest.approx(getattr(both.moments, name), rel=0.02)
    h = [0.0, 1.0, 2.0]
    drawn = mcgw.fitted_scene(both, heights="nayak", E_star=1e11)
    loads = mcgw.Scene(pair, separations=h).theory.mean("load", h)
    assert loads == pytest.approx(drawn.theory.mean("load", h), rel=0.04)
    assert pair.surface.sigma > 1.01 * a.moments.sigma


def test_sums_and_the_modulus_of_the_pair():
    """By hand: moments are sums, moduli lie in series; what is given counts."""
    a = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", 3e11)
    b = mcgw.SpectralSurface(2e-12, 3e-3, 9e7, "1 mm^2", 6e11)
    pair = mcgw.combine(a, b)
    m = pair.moments
    assert (m.m0, m.m2, m.m4) == pytest.approx((3e-12, 4e-3, 9.5e7), rel=1e-14)
    assert pair.surface.E_star == pytest.approx(2e11, rel=1e-14)
    assert pair.surface.nominal_area == 1e-6
    given = mcgw.combine(a.moments, b, nominal_area="2 mm^2", E_star="5 GPa").surface
    assert (given.nominal_area, given.E_star) == (2e-6, 5e9)


@pytest.mark.parametrize(
    ("keys", "told"), [({"E_star": 1e9}, "nominal_area: "), ({"nominal_area": 1e-6}, "E_star: ")]
)
def test_what_is_not_known_of_both_is_asked_for(keys, told):
    a = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", 3e11)
    with pytest.raises(mcgw.SceneError, match=told):
        mcgw.combine(a, SpectralMoments(1e-12, 1e-3, 5e6), **keys)


def test_areas_that_differ_and_wrong_objects_are_refused():
    a, b = (mcgw.SpectralSurface(1e-12, 1e-3, 5e6, area, 3e11) for area in ("1 mm^2", "2 mm^2"))
    with pytest.raises(mcgw.SceneError, match="nominal_area: is not the same"):
        mcgw.combine(a, b)
    with pytest.raises(TypeError, match=r"combine: give surfaces.*not str"):
        mcgw.combine("a.toml", a)
