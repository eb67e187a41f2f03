"""The apex of a summit, and Nayak's numbers, each against something slow and literal."""

import math

import numpy as np
import pytest
from scipy import fft
from scipy.integrate import quad
from scipy.special import ndtr

import mcgw.maps.fit as fit_module
from analytic import SpectralMoments
from mcgw.maps.fit import fit_map
from mcgw.maps.spectrum import Spectrum, gaussian_map, moments_on_grid
from mcgw.maps.summit_sums import _apex, summit_sums_of
from mcgw.maps.topography import Topography

PARAMETERS = ("eta", "radius", "sigma")


def on_the_pixel(z, points=401):
    """The paraboloid of differences on a fine grid over the middle pixel: a literal maximum."""
    v, u = np.meshgrid(*2 * [np.linspace(-0.5, 0.5, points)], indexing="ij")
    gx, gy = (z[1, 2] - z[1, 0]) / 2, (z[2, 1] - z[0, 1]) / 2
    xx, yy = z[1, 2] - 2 * z[1, 1] + z[1, 0], z[2, 1] - 2 * z[1, 1] + z[0, 1]
    xy = (z[2, 2] - z[2, 0] - z[0, 2] + z[0, 0]) / 4
    return (z[1, 1] + gx * u + gy * v + xx * u * u / 2 + yy * v * v / 2 + xy * u * v).max()


def test_the_apex_is_the_highest_point_of_the_paraboloid_on_its_pixel():
    """400 summits at random, and ridges whose determinant is next to nothing."""
    generator = np.random.default_rng(1)
    cases = [generator.random((3, 3)) ** power for power in (1, 4) for _ in range(200)]
    y, x = np.mgrid[-1:2, -1:2]
    for slope in (0.0, 0.5, 1.0, -1.0):
        cases += [-((x + slope * y - 0.1) ** 2) + 1e-9 * generator.random((3, 3)) for _ in range(50)]
    for z in cases:
        z[1, 1] = z.max()
        found = _apex(z, 1, 1)
        dense = on_the_pixel(z)
        # 401 points: the maximum lies 1/800 pixel away at most, where curvatures are below 8 ranges; the
        # vertex of a ridge whose determinant is 1e-10 is rounded to 1e-6 pixels, its height to 1e-12
        assert dense - 1e-11 <= found <= dense + 8 * np.ptp(z) / 800**2 + 1e-12
        assert z[1, 1] <= found <= z[1, 1] + np.ptp(z)


def test_apexes_of_a_smooth_map_are_its_own():
    """Against the same waves summed on a grid sixteen times as fine, pixels not square."""
    pixel, n, finer = (1e-6, 1.3e-6), (96, 128), 16
    topography = gaussian_map(Spectrum(1e-6, 30e-6, 12e-6), n, pixel, np.random.default_rng(2))
    counted = summit_sums_of(topography)
    wide = np.zeros((n[0] * finer, n[1] * finer // 2 + 1), dtype=complex)
    waves = fft.rfft2(topography.heights)
    half = n[0] // 2
    wide[:half, : waves.shape[1]], wide[-half:, : waves.shape[1]] = waves[:half], waves[half:]
    fine = fft.irfft2(wide, s=(n[0] * finer, n[1] * finer)) * finer**2
    assert fine[::finer, ::finer] == pytest.approx(topography.heights, abs=1e-12)
    i, j = (np.rint(counted.places[axis] * n[1 - axis] - 0.5).astype(int) for axis in (0, 1))
    assert i.size > 50
    around = np.arange(-finer, finer + 1)
    truth = np.array(
        [fine.take(around + b * finer, 0, mode="wrap").take(around + a * finer, 1, mode="wrap").max()
         for a, b in zip(i, j, strict=True)]
    )  # fmt: skip
    lift = (truth - topography.heights[j, i]).mean()
    # twelve pixels a wave: what the fourth order takes from the second is a twentieth
    assert abs((counted.heights - truth).mean()) < 0.1 * lift
    assert np.abs(counted.heights - truth).max() < 0.1 * topography.heights.std()


def test_no_summit_rises_above_the_map():
    """Of 30 000 summits of white noise some are all but ridges: these rose far above peak to valley."""
    z = 18e-9 * np.random.default_rng(3).normal(size=(512, 512))
    fit = fit_map(Topography(z, (1e-6, 1e-6)), cutoff=None)
    assert np.ptp(fit.summits) < np.ptp(z)
    assert fit.estimates["summits"].sigma[0] < z.std()


def test_a_sigma_above_peak_to_valley_is_refused(monkeypatch):
    topography = gaussian_map(Spectrum(1e-6, 16e-6, 8e-6), (128, 128), (1e-6, 1e-6), np.random.default_rng(1))
    absurd = [(1e10, 1e8), (1e-5, 1e-7), (94e-3, 1e-3)]
    monkeypatch.setattr(fit_module, "by_caps", lambda *_: absurd)
    assert "caps" not in fit_map(topography, cutoff=None).estimates
    monkeypatch.setattr(fit_module, "by_moments", lambda *_: absurd)
    with pytest.raises(ValueError, match=r"sigma of .* 0.094 m, more than the peak to valley"):
        fit_map(topography, cutoff=None)


@pytest.mark.parametrize("cutoff", [None, 20e-6])
def test_pixels_that_are_not_square(cutoff):
    """x finer than y by 2: the truth is found; and the transposed map with swapped pixels is the same."""
    pixel = (0.8e-6, 1.6e-6)
    spectrum = Spectrum(1e-6, 80e-6, 20e-6, -0.5)
    topography = gaussian_map(spectrum, (480, 960), pixel, np.random.default_rng(4))
    turned = Topography(np.ascontiguousarray(topography.heights.T), pixel[::-1], periodic=True)
    fits = [fit_map(t, cutoff=cutoff, form="none") for t in (topography, turned)]
    for name in ("moments", "summits"):
        for parameter in PARAMETERS:
            this, other = (getattr(f.estimates[name], parameter) for f in fits)
            assert this == pytest.approx(other, rel=1e-9)
    assert fits[0].mean_squares["slope_x"] == pytest.approx(fits[1].mean_squares["slope_y"], rel=1e-12)
    assert 0.9 < fits[0].mean_squares["slope_x"] / fits[0].mean_squares["slope_y"] < 1.1
    if cutoff is None:
        truth = moments_on_grid(spectrum, topography.heights.shape, pixel)
        assert fits[0].moments.m4 == pytest.approx(truth.m4, rel=0.03)
        for name in ("moments", "summits"):
            for parameter in PARAMETERS:
                value, error, *_ = getattr(fits[0].estimates[name], parameter)
                assert abs(value - getattr(truth, parameter)) < 4 * error < 0.2 * value


def summit_density(xi, alpha):
    """Nayak's distribution of summit heights over sqrt(m0), as Greenwood (1984) writes it."""
    rho2 = 1.5 / alpha
    mu, v = math.sqrt(2 * rho2) * xi, 2 * (1 - rho2)
    a, phi = mu / math.sqrt(v), math.exp(-xi * xi / 2) / math.sqrt(2 * math.pi)
    normal = math.exp(-a * a / 2) / math.sqrt(2 * math.pi)
    tail = 2 / math.sqrt(1 + v) * math.exp(-mu * mu / (2 * (1 + v))) * ndtr(a / math.sqrt(1 + v))
    return math.sqrt(3) * phi * ((mu * mu + v - 2) * ndtr(a) + mu * math.sqrt(v) * normal + tail)


@pytest.mark.parametrize("alpha", [1.6, 2.0, 10.0, 100.0])
def test_summit_heights_are_those_of_nayaks_distribution(alpha):
    moments = SpectralMoments(1.0, 1.0, alpha)
    whole, mean, square = (
        quad(lambda x, k=k: x**k * summit_density(x, alpha), -12, 12, epsabs=1e-13, limit=200)[0]
        for k in range(3)
    )
    assert whole == pytest.approx(1, abs=1e-11)
    assert mean == pytest.approx(moments.mean_height, abs=1e-10)
    assert math.sqrt(square - mean**2) == pytest.approx(moments.sigma, abs=1e-10)


def test_constants_of_the_spectral_moments():
    """Nayak (1971): density 1/(6 sqrt 3 pi); mean curvature 8/(3 sqrt pi); Bush et al. (1975): 0.8968."""
    unit = SpectralMoments(1.0, 1.0, 1.0)
    assert unit.eta == pytest.approx(0.030629383079, rel=1e-10)
    assert 1 / unit.radius == pytest.approx(1.50450555613, rel=1e-10)
    assert 1 - unit.sigma**2 == pytest.approx(0.8968057562340189, rel=1e-14)
    assert unit.mean_height == pytest.approx(2.25675833419, rel=1e-10)
    other = SpectralMoments(4.0, 9.0, 25.0)  # powers: 25/9, 1/5, (1 - 0.8968 81/100) 4, sqrt(4 81/100)
    assert other.eta == pytest.approx(unit.eta * 25 / 9, rel=1e-14)
    assert other.radius == pytest.approx(unit.radius / 5, rel=1e-14)
    assert other.sigma**2 == pytest.approx(4 * (1 - 0.8968057562340189 * 0.81), rel=1e-13)
    assert other.mean_height == pytest.approx(unit.mean_height * 1.8, rel=1e-14)
