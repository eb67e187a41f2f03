"""What is done to a map before it is looked at: each step against a map that never needed it."""

import math

import numpy as np
import pytest

import mcgw
from mcgw.maps.fit import fit_map
from mcgw.maps.form import FORMS, without_form
from mcgw.maps.holes import filled
from mcgw.maps.preparation import Preparation, prepared
from mcgw.maps.spectrum import Spectrum, gaussian_map
from mcgw.maps.topography import Topography

PIXEL = (1e-6, 1.5e-6)


def rough(seed=1, n=320, long=40e-6):
    return gaussian_map(Spectrum(1e-6, long, 16e-6), (n, n), PIXEL, np.random.default_rng(seed)).heights


def grid(n=320):
    y, x = np.mgrid[0:n, 0:n] + 0.5
    return PIXEL[0] * (x - n / 2), PIXEL[1] * (y - n / 2)


def ready(z, cutoff=None, **steps):
    return prepared(Topography(z, PIXEL), Preparation(cutoff, **steps))


def test_holes_are_filled_with_harmonic_functions():
    """x^2 - y^2, xy and a plane solve the discrete equation too, so they come back exactly."""
    y, x = np.mgrid[0:60, 0:50] - 25.0
    holes = np.zeros(x.shape, dtype=bool)
    holes[10:30, 5:40] = True
    holes[45, 3:20] = holes[50:52, 50:] = True
    holes[20, 20] = False  # an island
    for z in (x * x - y * y, x * y, 3 * x - 2 * y + 1e6):
        with_holes = np.where(holes, np.nan, z)
        assert filled(with_holes) == pytest.approx(z, abs=1e-5 * np.ptp(z))
        assert np.array_equal(filled(with_holes)[~holes], z[~holes])
    assert np.ptp(filled(np.where(holes, np.nan, np.cos(x)))) <= 2  # no point beyond its edge: a soap film


def test_holes_at_the_edge_take_what_is_beside_them():
    z = np.full((20, 30), np.nan)
    z[5:, 10:] = 7.0
    assert np.array_equal(filled(z), np.full((20, 30), 7.0))


@pytest.mark.parametrize("cutoff", [None, 20e-6])
def test_few_missing_points_change_nothing_much(cutoff):
    """Of 100 000 points 116: estimates move by less than half of their errors, and nothing is refused."""
    z = rough()
    whole = fit_map(Topography(z, PIXEL), cutoff=cutoff)
    holes = z.copy()
    generator = np.random.default_rng(5)
    holes[generator.integers(0, 320, 100), generator.integers(0, 320, 100)] = np.nan
    holes[200:204, 100:104] = np.nan
    ways = ("auto", "mask", "fill")
    fits = {way: fit_map(Topography(holes, PIXEL), cutoff=cutoff, missing=way) for way in ways}
    number = np.count_nonzero(np.isnan(holes))
    for way, fit in fits.items():
        share = 0.8 if way == "fill" else 0.5  # a soap film has summits of its own beside a hole
        assert f"missing: {number} of 102400 points" in fit.notes[0]
        for name in ("eta", "radius", "sigma"):
            found, expected = (getattr(f.estimates["summits"], name) for f in (fit, whole))
            assert abs(found.value - expected.value) < share * expected.error
    assert fits["auto"].estimates == fits["mask"].estimates
    assert fits["mask"].area < fits["fill"].area == whole.area


def test_a_masked_hole_counts_as_if_the_map_ended_there():
    """Half of the map is missing: moments and summits are those of the other half."""
    z = rough(2)
    z -= z.mean()
    half = z.copy()
    half[:, 160:] = np.nan
    half[0, 319] = half[319, 319] = 0.0  # so that it is no edge
    masked = fit_map(Topography(half, PIXEL), cutoff=None, form="none", across=2)
    alone = fit_map(Topography(z[:, :164].copy(), PIXEL), cutoff=None, form="none", across=2)
    assert masked.area == pytest.approx(alone.area, rel=0.04)  # two points more at the edge
    assert masked.moments.m4 == pytest.approx(alone.moments.m4, rel=0.02)
    assert masked.summits.size == pytest.approx(alone.summits.size, abs=5)


def test_points_missing_everywhere_are_filled_where_a_mask_leaves_nothing():
    z = rough(3)
    z[np.random.default_rng(1).random(z.shape) < 0.2] = np.nan
    fit = mcgw.fit(Topography(z, PIXEL), cutoff=None)
    assert "counted like others: only" in fit.notes[0]
    z[::3, ::3] = np.nan
    with pytest.raises(ValueError, match="give --missing fill"):
        mcgw.fit(Topography(z, PIXEL), cutoff=None, missing="mask")


def test_edges_where_all_is_missing_are_cropped():
    z = np.full((400, 500), np.nan)
    z[30:350, 100:420] = rough(4)
    fit = fit_map(Topography(z, PIXEL), cutoff=None)
    assert fit.estimates == fit_map(Topography(rough(4), PIXEL), cutoff=None).estimates
    assert "320 x 320 points kept" in fit.notes[0]


def tilted_cylinder(radius, x, y):
    """Points whose distance from an axis is the radius: along the unit vector a, tilted by 0.2."""
    a = np.array([math.cos(0.3) * math.cos(0.2), math.sin(0.3) * math.cos(0.2), math.sin(0.2)])
    along = a[0] * x + a[1] * y
    square, linear, rest = 1 - a[2] ** 2, -along * a[2], x * x + y * y - along**2 - radius**2
    return (-linear + np.sqrt(linear**2 - square * rest)) / square


@pytest.mark.parametrize("kind", FORMS)
def test_a_form_comes_off_and_the_roughness_stays(kind):
    """Each form over the roughness, and nothing else: what is left is within what it takes of roughness."""
    x, y = grid()
    u, v = x / 1e-4, y / 1e-4
    shape = {
        "none": 0.0 * x, "plane": 0.2 * x - 0.1 * y, "quadratic": 1e-5 * (u * u + 3 * u * v),
        "cubic": 1e-5 * (u**3 - v * u), "quartic": 1e-5 * (u**4 - 3 * u * v**3),
        "sphere": np.sqrt(9e-8 - (x - 2e-5) ** 2 - y**2),
        "cylinder": tilted_cylinder(6e-4, x, y),
    }[kind]  # fmt: skip
    bare = without_form(Topography(shape, PIXEL), kind).heights
    assert np.abs(bare).max() < 1e-9 * max(np.ptp(shape), 1e-9)
    z = rough()
    left = without_form(Topography(shape + z, PIXEL), kind).heights
    assert (left - (z - z.mean())).std() < 0.1 * z.std()
    if kind != "none":
        holed = shape + z
        holed[40:60, 100:200] = np.nan
        rest = without_form(Topography(holed, PIXEL), kind).heights
        assert np.nanstd(rest - left) < 0.05 * z.std()


def test_spikes_are_taken_out():
    z = rough()
    spiked = z.copy()
    spiked[50::60, 40::70] += 3e-5
    spiked[101, 101] -= 5e-5
    plain, kept, clean = (
        mcgw.fit(Topography(h, PIXEL), cutoff=None, spikes=way)
        for h, way in ((z, "keep"), (spiked, "keep"), (spiked, "remove"))
    )
    assert kept.moments.m4 > 10 * plain.moments.m4
    assert clean.moments.m4 == pytest.approx(plain.moments.m4, rel=0.03)
    assert clean.estimates["summits"].sigma.value == pytest.approx(
        plain.estimates["summits"].sigma.value, rel=0.03
    )
    assert "spikes" in {line.partition(":")[0] for line in kept.cautions}
    assert "spikes" not in {line.partition(":")[0] for line in clean.cautions}
    assert clean.notes[0].startswith("spikes: 21 places taken out, up to 4.")


@pytest.mark.parametrize("axis", [0, 1])
def test_the_larger_terrace_is_kept(axis):
    z = rough(6)
    x = grid()[0] if axis == 0 else grid()[1]
    stepped = z + 2e-5 * (x > 0.3 * x.max())
    found = ready(stepped, step="crop")
    size = found.used.heights.shape[1 - axis] / 320
    assert 0.5 < size < 0.65
    assert found.used.heights.std() < 1.1 * z.std()
    assert "step" in found.notes[0]
    assert ready(z, step="crop").notes == ("step: none was found, nothing cropped",)


def test_a_long_cutoff_leaves_short_waves():
    """1 - 2^(-(cutoff/wavelength)^2): half the amplitude at the cutoff."""
    x = grid(640)[0]
    for wavelength, left in ((40e-6, 0.5), (20e-6, 0.9375), (320e-6, 0.01077)):
        wave = Topography(np.sin(2 * np.pi * x / wavelength), PIXEL, periodic=True)
        used = prepared(wave, Preparation(None, form="none", long_cutoff=40e-6)).used
        assert used.heights.std() / wave.heights.std() == pytest.approx(left, abs=2e-3)


def test_edges_are_trimmed():
    z = rough()
    z[0] += 1.0
    z[:, -1] = np.nan
    assert fit_map(Topography(z, PIXEL), cutoff=None, trim=1).estimates == (
        fit_map(Topography(rough()[1:-1, 1:-1], PIXEL), cutoff=None).estimates
    )
    with pytest.raises(ValueError, match="leaves nothing"):
        ready(z, trim=160)


@pytest.mark.parametrize("key", ["missing", "spikes", "step", "form"])
def test_words_that_are_none_are_refused_in_one_line(key):
    with pytest.raises(mcgw.SceneError, match=f"{key} = 'x'.*choose one of"):
        mcgw.fit(Topography(rough(), PIXEL), cutoff=None, **{key: "x"})


def test_the_best_estimate_is_that_of_the_kind_of_summits():
    """Caps of one radius: those hidden are added. A Gaussian surface: none is."""
    from test_maps_fit import caps

    topography, _, (eta, _, _) = caps(0.05)
    fit = fit_map(topography, cutoff=None)
    assert fit.best == "caps"
    assert fit.estimates["caps"].eta.value == pytest.approx(eta, rel=0.03)
    assert fit.estimates["summits"].eta.value < 0.88 * eta
    assert mcgw.fitted_scene(fit).surface.eta == fit.estimates["caps"].eta.value
    fit = fit_map(Topography(rough(), PIXEL), cutoff=None)
    assert fit.best == "summits"
    assert 0.3 < fit.spread_of_curvatures < 0.45
    assert mcgw.fitted_scene(fit).surface.eta == fit.estimates["summits"].eta.value
