"""Surfaces out: the asperities whose loads are in the file, their envelope, and what hides."""

import math

import h5py
import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from oracles.inside import envelope, hidden_summits
from scipy.integrate import quad

import analytic
import mcgw
from mcgw import scene_text
from mcgw.cli import main
from mcgw.maps import Asperities, Spectrum, asperities_of, gaussian_map, moments_on_grid, spectrum_from


def random_field(number, size, radius, sigma, seed=1):
    rng = np.random.default_rng(seed)
    x, y = rng.random((2, number)) * np.array(size)[:, None]
    return Asperities(x, y, sigma * rng.normal(size=number), np.full(number, radius), radius, size)


def offsets(a, b, length, periodic):
    """Differences of all pairs, the shortest ones on a periodic cell."""
    d = np.subtract.outer(a, b)
    return d - length * np.round(d / length) if periodic else d


@settings(max_examples=30, deadline=None)
@given(
    number=st.integers(1, 120), width=st.floats(0.2, 5.0), radius=st.floats(0.02, 3.0),
    sigma=st.floats(0.0, 0.5), periodic=st.booleans(), seed=st.integers(0, 2**32)
)  # fmt: skip
def test_envelope_and_hidden_summits_against_all_pairs(number, width, radius, sigma, periodic, seed):
    field = random_field(number, (width, 1.0), radius, sigma, seed)
    found = envelope(field, (9, 13), periodic=periodic)
    assert found.periodic == periodic
    x, y = (np.arange(13) + 0.5) * width / 13, (np.arange(9) + 0.5) / 9
    dx, dy = offsets(x, field.x, width, periodic), offsets(y, field.y, 1.0, periodic)
    caps = field.z - (dx[None, :, :] ** 2 + dy[:, None, :] ** 2) / (2 * radius)
    # heights are differences of numbers up to r^2/(2R)
    assert found.heights == pytest.approx(caps.max(axis=2), abs=1e-15 * (1 + (width**2 + 1) / radius))
    d2 = offsets(field.x, field.x, width, periodic) ** 2 + offsets(field.y, field.y, 1.0, periodic) ** 2
    above = (field.z[None, :] - d2 / (2 * radius)).max(axis=1) - field.z
    told = np.abs(above) > 1e-14 * (1 + width**2 / radius)
    assert np.array_equal(hidden_summits(field, periodic=periodic)[told], (above > 0)[told])


def test_a_width_maps_a_corner_with_square_pixels():
    """The same caps as on the whole map, up to its edges; those beyond its own edges reach into it."""
    field = random_field(80, (2.0, 1.0), 0.5, 0.05)
    whole = envelope(field, (40, 80), periodic=True)
    part = envelope(field, (10, 20), width=0.5, periodic=True)
    assert part.heights == pytest.approx(whole.heights[:10, :20], abs=1e-14)
    assert (part.pixel, part.periodic) == ((0.025, 0.025), False)
    assert envelope(field, (40, 80), width=2.0).heights == pytest.approx(envelope(field, (40, 80)).heights)
    for width, shape in ((0.0, (4, 4)), (-1.0, (4, 4)), (math.nan, (4, 4)), (1.01, (4, 4)), (2.01, (1, 80))):
        with pytest.raises(ValueError, match=r"width = .*: give a length > 0, up to the nominal area's \d"):
            envelope(field, shape, width=width)


@pytest.mark.parametrize("count", ["fixed", "poisson"])
def test_loads_of_the_listed_asperities_are_those_in_the_file(count, make_scene, tmp_path):
    """Hertz's sums by NumPy over the asperities in the exported file, against the ensemble's row."""
    scene = make_scene(sampler="cells", count=count, separations=(0.0, 0.5, 1.7), n_surfaces=4)
    ensemble, surface = mcgw.simulate(scene), scene.surface
    path, out = tmp_path / "scene.toml", tmp_path / "map.h5"
    path.write_text(scene_text(scene))
    assert main(["surface", str(path), "--surface", "3", "--shape", "64", "-o", str(out)]) == 0
    with h5py.File(out) as file:
        z, radius = file["asperities/z"][:], file["asperities"].attrs["radius"]
        assert mcgw.scene_from(file["scene"][()].decode()) == scene
    assert (z.size == scene.n_asperities) == (count == "fixed")
    for k, h in enumerate(scene.separations):
        delta = z[z > h * surface.sigma] - h * surface.sigma
        modulus = surface.E_star * (2 - np.exp(-z[z > h * surface.sigma] / surface.sigma))
        load = np.sum(4 / 3 * modulus * math.sqrt(radius) * delta**1.5)
        # h sigma is subtracted again from s sigma: a last digit of both, summed over 1000 spots
        assert ensemble.load[3, k] == pytest.approx(load, rel=1e-12)
        assert ensemble.area[3, k] == pytest.approx(np.sum(np.pi * radius * delta), rel=1e-12)
        assert ensemble.contacts[3, k] == delta.size


def test_positions_are_uniform_and_belong_to_their_surface(make_scene):
    """Mean and variance of 40000 uniforms, |z| < 5: a false alarm in 2e6 each; and no two fields alike."""
    scene = make_scene(n_asperities=40000, sampler="cells")
    field = asperities_of(scene, 5)
    for values, length in zip((field.x, field.y), field.size, strict=True):
        u = values / length
        assert 0 < u.min() < u.max() < 1
        assert abs(u.mean() - 0.5) * math.sqrt(12 * u.size) < 5
        assert abs(np.var(u) - 1 / 12) * math.sqrt(180 * u.size) < 5
    assert np.abs(np.corrcoef([field.x, field.y, field.z]) - np.eye(3)).max() * 200 < 5
    again, other = asperities_of(scene, 5), asperities_of(scene, 6)
    assert np.array_equal(again.x, field.x)
    assert not np.any(np.isin(other.x, field.x[:1000]))
    for surface in (-1, scene.n_surfaces):
        with pytest.raises(ValueError, match=f"surface = {surface}: the scene has surfaces 0 to "):
            asperities_of(scene, surface)


@pytest.mark.parametrize("shape", [(60, 48), (61, 47)])
def test_a_gaussian_map_is_noise_with_the_power_of_its_spectrum(shape):
    """Mode by mode of the whole plane, on pixels that are not square; moments are sums over all of it."""
    spectrum, pixel = Spectrum(1e-6, 40e-6, 5.1e-6, 0.5), (1e-6, 1.5e-6)
    qx, qy = np.meshgrid(*(2 * np.pi * np.fft.fftfreq(n, p) for n, p in zip(shape[::-1], pixel, strict=True)))
    q = np.hypot(qx, qy)
    inside = (q > 2 * np.pi / 40e-6) & (q < 2 * np.pi / 5.1e-6)
    power = np.where(inside, np.where(inside, q, 1.0) ** -3.0, 0.0)
    power *= 1e-12 / power.sum()
    noise = np.random.default_rng(3).standard_normal(shape)
    drawn = gaussian_map(spectrum, shape, pixel, np.random.default_rng(3))
    seen = np.abs(np.fft.fft2(drawn.heights))
    expected = np.abs(np.fft.fft2(noise)) * np.sqrt(power * noise.size)
    np.testing.assert_allclose(seen, expected, atol=1e-12 * expected.max())
    assert drawn.pixel == pixel
    assert drawn.periodic
    m = moments_on_grid(spectrum, shape, pixel)
    assert m.m0 == pytest.approx(1e-12, rel=1e-14)
    assert m.m2 == pytest.approx((power * (qx**2 + qy**2)).sum() / 2, rel=1e-12)
    assert m.m4 == pytest.approx((power * (qx**4 + qy**4)).sum() / 2, rel=1e-12)


@pytest.mark.parametrize(("alpha", "hurst"), [(1.6, 0.8), (1.9, -1.0), (40.0, 0.5)])
def test_a_spectrum_has_the_moments_that_were_asked_for(alpha, hurst):
    """By integrals over its ring: m2 is half, m4 three eighths of the means of q^2 and q^4."""
    asked = analytic.SpectralMoments(1e-12, 1e-3, alpha * 1e6)
    spectrum = Spectrum.with_moments(asked, hurst)
    ends = 1.0, spectrum.long / spectrum.short
    mean = [quad(lambda q, k=k: q ** (k - 1 - 2 * hurst), *ends, epsrel=1e-12)[0] for k in (0, 2, 4)]
    unit = 2 * np.pi / spectrum.long
    assert spectrum.rms**2 == pytest.approx(asked.m0, rel=1e-12)
    assert asked.m0 * unit**2 * mean[1] / mean[0] / 2 == pytest.approx(asked.m2, rel=1e-9)
    assert asked.m0 * unit**4 * mean[2] / mean[0] * 3 / 8 == pytest.approx(asked.m4, rel=1e-9)


@pytest.mark.parametrize("hurst", [0.5, 1.0])
def test_the_bandwidths_of_a_spectrum_have_ends(hurst):
    """Of the narrowest one 1.5, of the widest a number that is told, up to which there is one."""

    def spectrum(alpha):
        return Spectrum.with_moments(analytic.SpectralMoments(1.0, 1.0, alpha), hurst)

    refused = pytest.raises(ValueError, match=r"give a ratio above 1[.]5 and below ")
    with refused as told:
        spectrum(1e30)
    highest = float(str(told.value).rpartition(" ")[2])
    mean = [quad(lambda t, k=k: math.exp((k - 2 * hurst) * t), 0, math.log(1e6))[0] for k in (0, 2, 4)]
    assert highest == pytest.approx(1.5 * mean[2] * mean[0] / mean[1] ** 2, rel=1e-3)
    spectrum(0.99 * highest)
    for alpha in (1.01 * highest, 1.5):
        with refused:
            spectrum(alpha)
    narrow = spectrum(1.5001)
    assert 1 < narrow.long / narrow.short < 1.05


def test_a_spectrum_fills_its_grid_to_two_pixels_and_to_its_edge():
    """As long as the map and as short as two pixels, along the axis where that is least."""
    one = np.random.default_rng(1)
    drawn = gaussian_map(Spectrum(1e-6, 30e-6, 4e-6), (15, 40), (1e-6, 2e-6), one)
    assert drawn.heights.shape == (15, 40)
    for shape, pixel in (((14, 40), (1e-6, 2e-6)), ((15, 29), (1e-6, 2e-6))):
        with pytest.raises(ValueError, match="longer than the map"):
            gaussian_map(Spectrum(1e-6, 30e-6, 4e-6), shape, pixel, one)
    for pixel in ((2.01e-6, 2e-6), (2e-6, 2.01e-6)):
        with pytest.raises(ValueError, match="shows 2 pixels or more"):
            gaussian_map(Spectrum(1e-6, 30e-6, 4e-6), (40, 40), pixel, one)


def test_a_spectrum_is_read_key_by_key():
    of_moments = spectrum_from("m0=1e-12, m2=1e-3,m4=5e6")
    assert of_moments == Spectrum.with_moments(analytic.SpectralMoments(1e-12, 1e-3, 5e6))
    assert spectrum_from("m0=1e-12,m2=1e-3,m4=5e6,hurst=0.3").hurst == 0.3
    assert spectrum_from("rms=2um, long=100um, short=5um, hurst=0.5") == Spectrum(2e-6, 1e-4, 5e-6, 0.5)
    assert spectrum_from("rms=2um,long=100um,short=5um").hurst == of_moments.hurst == 0.8
    with pytest.raises(ValueError, match="each once"):
        spectrum_from("rms=2um,long=100um,short=5um,hurst=0.5,hurst=0.6")
