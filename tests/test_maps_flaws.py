"""What lies on a map and is no roughness is named with its size; clean maps are left in peace."""

import numpy as np
import pytest

import mcgw
import mcgw.maps.fit as fit_module
from mcgw.maps.edges import bad_edges
from mcgw.maps.estimates import moments_of
from mcgw.maps.fit import fit_map
from mcgw.maps.flaws import _waves
from mcgw.maps.levels import form_left, step_of
from mcgw.maps.spectrum import Spectrum, gaussian_map
from mcgw.maps.spikes import spikes_of
from mcgw.maps.summit_sums import summit_sums_of
from mcgw.maps.topography import Topography
from mcgw.maps.waves import waves_of

N, PIXEL = 320, (1e-6, 2e-6)
SIZE = (N * 1e-6, N * 2e-6)


def rng(seed):
    return np.random.default_rng(seed)


def rough(seed=1, long=40e-6, hurst=0.8):
    """1 um rms, waves from 40 um to 16 um on 320 um x 640 um."""
    return gaussian_map(Spectrum(1e-6, long, 16e-6, hurst), (N, N), PIXEL, rng(seed)).heights


@pytest.fixture
def grid():
    y, x = np.mgrid[0:N, 0:N] + 0.5
    return x * PIXEL[0], y * PIXEL[1]


def topography(z):
    return Topography(z, PIXEL)


def lines(z, **keywords):
    """Warnings by their first word."""
    return lines_of(topography(z), **keywords)


def lines_of(t, **keywords):
    found = mcgw.fit(t, **{"cutoff": None, **keywords}).cautions
    return {line.partition(":")[0]: line for line in found}


OF_THE_MAP = {"spikes", "sub-area", "step", "form", "waves", "slope"}


@pytest.mark.parametrize(
    "clean",
    [
        lambda g: rough(2),
        lambda g: rough(3, long=100e-6),
        lambda g: 1e-3 + rough(4) + 0.2 * g[0] - 0.1 * g[1],  # tilted, far from zero
        lambda g: 1e-6 * np.exp(rough(5) / 1e-6),  # skewed, with peaks
        lambda g: np.round(rough(6) / 2e-7) * 2e-7,  # few levels
        lambda g: rng(7).normal(size=(N, N)) * 1e-7,  # white
        lambda g: np.abs(rough(8)),  # valleys like knives
    ],
    ids=["rough", "long", "tilted", "skewed", "levels", "white", "valleys"],
)
def test_clean_maps_are_left_in_peace(clean, grid):
    assert not OF_THE_MAP & set(lines(clean(grid)))


def test_a_spike_of_a_millimetre_is_named(grid):
    """With its number, place and height; and the sub-area that carries all of m4."""
    z = rough()
    before = fit_map(topography(z), cutoff=None)
    z[101, 200] += 1e-3
    found = lines(z)
    assert fit_map(topography(z), cutoff=None).moments.radius < before.moments.radius / 50
    assert "1 place stands out" in found["spikes"]
    assert "x = 0.0002005 m, y = 0.000203 m, 0.000999 m high" in found["spikes"]
    assert "x = 0.00016 to 0.00024 m, y = 0.00016 to 0.00032 m m4" in found["sub-area"]
    assert "spikes" in lines(z, cutoff=20e-6)  # a filter smears it, but takes nothing of it away


@pytest.mark.parametrize(
    ("number", "height", "word"), [(1, -20e-6, "deep"), (40, 30e-6, "high"), (3, 8e-6, "high")]
)
def test_spikes_are_counted(number, height, word):
    z = rough()
    places = [(20 + 37 * (k % 8), 25 + 50 * (k // 8)) for k in range(number)]
    for j, i in places:
        z[j : j + 2, i : i + 3] += height  # narrower than five pixels
    spikes = spikes_of(topography(z))
    assert spikes.number == number
    assert spikes.height == pytest.approx(height, rel=0.4)  # above the highest point of its ring
    assert (round(spikes.y / PIXEL[1] - 0.5), round(spikes.x / PIXEL[0] - 0.5)) in [
        (j + b, i + a) for j, i in places for b in range(2) for a in range(3)
    ]
    assert word in lines(z)["spikes"]


def test_the_sub_area_that_carries_the_map_is_named(grid):
    """A patch ten times as rough, which no spike is."""
    x, y = grid
    z = rough() * np.where((x > 245e-6) & (y < 155e-6), 10, 1)
    assert "x = 0.00024 to 0.00032 m, y = 0 to 0.00016 m m4" in lines(z)["sub-area"]
    assert "sub-area" not in lines(rough())


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize(("place", "tilt"), [(0.37, 0.0), (0.6, 0.1)])
def test_two_terraces_are_named(axis, place, tilt, grid):
    along = grid["xy".index(axis)] / SIZE["xy".index(axis)]
    z = rough() + 10e-6 * (along > place) + tilt * grid[0]
    step = step_of(topography(z))
    assert step.axis == axis
    assert step.height == pytest.approx(10e-6, rel=0.1)
    assert step.place / SIZE["xy".index(axis)] == pytest.approx(place, abs=0.045)  # an area and a bit
    found = lines(z)
    assert "e-05 m apart" in found["step"] or "e-06 m apart" in found["step"]
    assert "form" not in found
    assert "waves" not in found


def test_an_oblique_step_is_named_and_a_ridge_is_none(grid):
    x, y = grid[0] / SIZE[0], grid[1] / SIZE[1]
    assert step_of(topography(rough() + 10e-6 * (x + 0.6 * y > 0.8))).height == pytest.approx(10e-6, rel=0.15)
    assert step_of(topography(rough() + 10e-6 * (np.abs(x - 0.5) < 0.1))) is None
    assert step_of(topography(rough() + 10e-6 * np.sin(7 * x))) is None
    assert step_of(topography(rough() + 0.3e-6 * (x > 0.5))) is None  # less than the roughness


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "saddle"])
def test_a_form_left_under_a_plane_is_named(kind, grid):
    x, y = 2 * grid[0] / SIZE[0] - 1, 2 * grid[1] / SIZE[1] - 1
    form = {"sphere": -(x * x + y * y), "cylinder": 2 * y * y, "saddle": 2 * x * y}[kind]
    z = rough() + 2e-6 * form
    found = lines(z)
    proposed = {"sphere": "quadratic", "cylinder": "cylinder", "saddle": "quadratic"}[kind]  # x is shorter
    assert f"--form {proposed}" in found["form"]
    assert "waves" not in found
    left = form_left(topography(z), "plane")
    assert left.height == pytest.approx(2e-6 * np.ptp(form), rel=0.15)
    assert left.share == pytest.approx((2e-6 * form).var() / z.var(), abs=0.05)
    assert not OF_THE_MAP & set(lines(z, form=proposed))
    assert "tilt" in lines(rough() + 0.05 * grid[0], form="none")["form"]


def test_a_form_that_leaves_no_summit_is_named(grid):
    x = 2 * grid[0] / SIZE[0] - 1
    with pytest.raises(ValueError, match=r"no summit; .* --form quadratic"):
        fit_map(topography(1e-3 * x * x), cutoff=None)


def test_absurd_slopes_and_pixels_are_named():
    assert "slope" in lines(1e6 * rough())
    assert "was um or mm meant" in lines_of(Topography(rough(), (1.0, 1.0)))["pixel"]


def test_errors_of_long_waves_against_a_literal_sum():
    """Waves of m0: twice the sum of squared powers, here as a mean of the squared autocorrelation.

    That is the share 1/(n + 1) of n equal waves, each with its conjugate.
    """
    t = gaussian_map(Spectrum(1e-6, 30e-6, 12e-6), (60, 80), (1e-6, 1.3e-6), rng(3))
    z = t.heights - t.heights.mean()
    squares = [np.mean(z * np.roll(z, (j, i), (0, 1))) ** 2 for j in range(60) for i in range(80)]
    share = np.mean(squares) / z.var() ** 2
    moments = moments_of(summit_sums_of(t))
    # the smooth part that makes edges fit takes a per cent or two
    assert waves_of(t, moments).independent == pytest.approx(2 * (1 / share - 1), rel=0.08)
    ramp = np.add.outer(np.arange(60.0), 2 * np.arange(80.0))
    with_edges = Topography(z + 1e-8 * ramp, t.pixel)
    found = (waves_of(x, moments).radius.error for x in (with_edges, t))
    assert next(found) == pytest.approx(next(found), rel=0.05)  # a ramp has no waves


def waves_named(long, short, number):
    maps = (
        gaussian_map(Spectrum(1e-6, long, short), (256, 256), (1e-6, 1e-6), rng(k)) for k in range(number)
    )
    return [bool(_waves(fit_map(Topography(m.heights, m.pixel), cutoff=None))) for m in maps]


def test_few_long_waves_are_named(monkeypatch):
    """One of the longest on the map: three of four maps say so. Ten of them: none does."""
    monkeypatch.setattr(fit_module, "by_caps", lambda *_: None)  # they take most of the time
    assert np.mean(waves_named(256e-6, 18e-6, 40)) > 0.75
    assert not any(waves_named(25.6e-6, 10e-6, 10))


def test_edges_that_jump_are_named():
    z = gaussian_map(Spectrum(1e-6, 40e-6, 16e-6), (200, 256), (1e-6, 1e-6), rng(1)).heights
    assert bad_edges(z) == 0
    assert bad_edges(rng(2).normal(size=(200, 256))) == 0
    for axis in (0, 1):
        for side in (0, -1):
            broken = np.moveaxis(z.copy(), axis, 0)
            broken[side] += 1e-5 * rng(3).normal(size=broken.shape[1])
            assert bad_edges(np.moveaxis(broken, 0, axis)) == 1
    broken = z.copy()
    broken[:3] += 1e-5
    found = lines_of(Topography(broken, (1e-6, 1e-6)))
    assert "--trim 3" in found["edge"]
    assert "edge" not in lines_of(Topography(broken, (1e-6, 1e-6)), trim=3)
