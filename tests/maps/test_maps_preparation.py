"""What is done to a map before it is looked at: each step against a map that never needed it."""

import math

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyvander2d
from oracles.inside import (
    Preparation,
    filled,
    gaussian_transmission,
    lowpass,
    prepared,
    smooth,
    without_form,
    without_offsets,
)
from scipy.ndimage import gaussian_filter1d, minimum_filter

import mcgw
from mcgw.maps import Spectrum, Topography, gaussian_map

N, PIXEL = 200, (1e-6, 1.5e-6)

pytestmark = pytest.mark.usefixtures("without_caps")


def rough(seed=1, n=N):
    return gaussian_map(Spectrum(1e-6, 40e-6, 16e-6), (n, n), PIXEL, np.random.default_rng(seed)).heights


def ready(z, cutoff=None, **steps):
    return prepared(Topography(z, PIXEL), Preparation(cutoff, **steps))


def fitted(z, **steps):
    return mcgw.fit(Topography(z, PIXEL), **{"cutoff": None, **steps})


def test_the_filter_halves_a_wave_at_its_cutoff():
    """ISO 16610-61."""
    for wavelength in (20e-6, 40e-6, 80e-6):
        left = float(gaussian_transmission(np.array(2 * np.pi / wavelength), 40e-6))
        assert left == pytest.approx(0.5 ** ((40e-6 / wavelength) ** 2), rel=1e-12)


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
    corner = np.full((20, 30), np.nan)
    corner[5:, 10:] = 7.0
    assert np.array_equal(filled(corner), np.full((20, 30), 7.0))


def test_the_filter_is_a_sum_over_its_window():
    """Literal, on a map of many bands of rows, mirrored beyond its edges or periodic."""
    z, pixel, cutoff = np.random.default_rng(1).normal(size=(150, 20)), (2e-6, 1e-6), 3.98e-6
    weights = []
    for p in pixel[::-1]:
        t = np.arange(-math.ceil(cutoff / p), math.ceil(cutoff / p) + 1) * p
        w = np.exp(-math.pi * (t / (math.sqrt(math.log(2) / math.pi) * cutoff)) ** 2)
        weights.append(w / w.sum())
    assert [w.size for w in weights] == [9, 5]
    for periodic, mode in ((False, "symmetric"), (True, "wrap")):
        padded = np.pad(z, ((4, 4), (2, 2)), mode=mode)
        expected = sum(
            v * w * padded[j : j + 150, i : i + 20]
            for j, v in enumerate(weights[0])
            for i, w in enumerate(weights[1])
        )
        map_ = Topography(z, pixel, periodic)
        np.testing.assert_allclose(lowpass(map_, cutoff), expected, atol=1e-12)
        left = smooth(map_, cutoff).heights
        np.testing.assert_allclose(left, expected if periodic else expected[4:-4, 2:-2], atol=1e-12)


def test_a_cutoff_leaves_eight_points_or_the_map_is_too_small():
    wave = np.sin(np.arange(20.0) * 28).repeat(28).reshape(20, 28)
    for shape in ((28, 28), (28, 40), (40, 28)):
        left = smooth(Topography(np.resize(wave, shape), (1.0, 1.0)), 10.0)
        assert min(left.heights.shape) == 8
    for shape in ((27, 40), (40, 27)):
        with pytest.raises(ValueError, match=f"leaves nothing of a map of {shape[1]} x {shape[0]} m"):
            smooth(Topography(np.resize(wave, shape), (1.0, 1.0)), 10.0)
    for shape, pixel in (((20, 40), (1.0, 1.0)), ((40, 20), (1.0, 1.0))):
        whole = Topography(np.resize(wave, shape), pixel, periodic=True)
        assert smooth(whole, 19.0).heights.shape == shape
        with pytest.raises(ValueError, match=f"longer than the map of {shape[1]} x {shape[0]} m"):
            smooth(whole, 20.0)


@pytest.mark.parametrize(("form", "order"), [("plane", 1), ("quadratic", 2), ("cubic", 3), ("quartic", 4)])
@pytest.mark.parametrize("holes", [False, True])
def test_a_polynomial_is_that_of_least_squares(form, order, holes):
    """Over the points that are there, of all powers together up to its order."""
    z = np.random.default_rng(1).normal(size=(40, 30))
    y, x = np.mgrid[-1:1:40j, -1:1:30j]
    z += 3 * x**2 * y - x**4 + y**4
    if holes:
        z[3:9, 4:20] = np.nan
    there = np.isfinite(z)
    terms = polyvander2d(y, x, [order, order])[
        ..., np.add.outer(*2 * [np.arange(order + 1)]).ravel() <= order
    ]
    left = z - terms @ np.linalg.lstsq(terms[there], z[there], rcond=None)[0]
    found = without_form(Topography(z, PIXEL, periodic=True), form)
    np.testing.assert_allclose(found.heights, left, atol=1e-9)
    assert not found.periodic
    assert without_form(Topography(z, PIXEL, periodic=True), "none").periodic


@pytest.mark.parametrize("lines", ["rows", "columns"])
def test_offsets_of_lines_are_sums_of_medians_less_their_long_waves(lines):
    """In plain loops; a line without heights is passed over. The root mean square of offsets is told."""
    z = np.random.default_rng(1).normal(size=(60, 45))
    z += 2 * np.random.default_rng(2).normal(size=(60, 1))
    z[7, 3:20] = z[20] = np.nan
    level, last = [0.0], z[0]
    for row in z[1:]:
        steps = (row - last)[np.isfinite(row - last)]
        level.append(level[-1] + (np.median(steps) if steps.size else 0.0))
        last = row if steps.size else last
    offsets = np.array(level) - gaussian_filter1d(level, 10, mode="nearest")
    turned = z if lines == "rows" else z.T
    found, rms = without_offsets(Topography(turned, PIXEL), lines)
    expected = z - offsets[:, None]
    np.testing.assert_allclose(found.heights, expected if lines == "rows" else expected.T, atol=1e-12)
    assert rms == pytest.approx(np.sqrt(np.mean(offsets**2)), rel=1e-12)


@pytest.mark.parametrize("cutoff", [None, 4e-6])
@pytest.mark.parametrize("number", [40, 330])
def test_points_count_whose_neighbours_were_seen(cutoff, number):
    """Of a filtered map those whose window has less than a tenth of filled ones; half of all must remain."""
    z = rough(1, n=60)
    holes = np.zeros(z.size, dtype=bool)
    holes[np.random.default_rng(1).choice(z.size, number, replace=False)] = True
    holes = holes.reshape(z.shape)
    z[holes] = np.nan
    seen = ~holes
    if cutoff:
        seen = smooth(Topography(holes + 0.0, PIXEL), cutoff).heights < 0.1
    whole = minimum_filter(seen, 5)
    left = whole.mean() / np.mean(~holes)
    masked = ready(z, cutoff, missing="mask", form="none")
    np.testing.assert_array_equal(masked.seen, seen)
    told = f"missing: {number} of 3600 points ({number / 36:.2g} %) filled from their edges"
    assert masked.notes[0].startswith(told)
    assert f"which leaves {100 * whole.mean():.3g} % of the map" in masked.notes[0]
    assert masked.filled == number / 3600
    auto = ready(z, cutoff, form="none")
    assert (auto.seen is None) == (left < 0.5) == (number == 330)
    if auto.seen is None:
        assert f"only {100 * left:.2g} % of the others have all neighbours" in auto.notes[0]
    if number == 330:
        z[::3, ::3] = np.nan
        with pytest.raises(ValueError, match="use --missing fill"):
            fitted(z, missing="mask")
        return
    filled_in = ready(z, cutoff, missing="fill", form="none")
    assert filled_in.seen is None


def test_spikes_that_touch_at_a_corner_are_one_place():
    """It goes with the points around it, and with nothing else."""
    z = rough(n=80)
    z[[40, 41], [50, 51]] += 3e-5
    found = ready(z, spikes="remove")
    assert found.notes[0].startswith("spikes: 1 places removed, up to ")
    assert found.notes[1].startswith("missing: 14 of 6400 points (0.22 %)")
    assert "1 place stands" in next(line for line in fitted(z).cautions if line.startswith("spikes:"))
    gone = np.argwhere(~found.seen)
    assert gone.min(axis=0).tolist() == [39, 49]
    assert gone.max(axis=0).tolist() == [42, 52]


def test_a_mask_that_leaves_half_is_kept():
    """Of the points that were measured, those with all neighbours; a hole more, and all of them count."""
    z, order = rough(1, n=60), np.random.default_rng(1).permutation(3600)

    def left(number):
        there = np.ones(3600)
        there[order[:number]] = 0
        return minimum_filter(there.reshape(60, 60), 5).sum() / (3600 - number)

    last = max(number for number in range(50, 200) if left(number) >= 0.5)
    assert 0.495 < left(last + 1) < 0.5 <= left(last) < 0.505
    for number, masked in ((last, True), (last + 1, False)):
        holed = z.copy()
        holed.flat[order[:number]] = np.nan
        assert (ready(holed, form="none").seen is not None) == masked


@pytest.mark.parametrize(("size", "told"), [(0.995e-150, "the map is flat, without"), (1.005e-150, None)])
def test_a_map_is_flat_whose_squares_vanish(size, told):
    z = np.zeros((20, 20))
    z[7, 8] = size
    if told:
        with pytest.raises(ValueError, match=told):
            ready(z, form="none")
    else:
        assert ready(z, form="none").used.highest == size


def test_notes_tell_what_was_done_to_a_map():
    z = np.full((50, 70), np.nan)
    z[10:45, 8:66] = rough(1, n=58)[:35]
    found = ready(z, trim=3, form="none", long_cutoff=30e-6)
    assert found.notes == (
        "trim: 3 points removed along each edge",
        "edges: 58 x 35 points kept; all points outside are missing",
        "long cutoff: waves longer than 3e-05 m removed (Gaussian, ISO 16610-61)",
    )
    np.testing.assert_array_equal(found.levelled.heights, z[10:45, 8:66])
    long = lowpass(Topography(z[10:45, 8:66], PIXEL), 30e-6)
    np.testing.assert_allclose(found.used.heights, z[10:45, 8:66] - long, atol=1e-12 * 1e-6)
    periodic = prepared(Topography(rough(), PIXEL, periodic=True), Preparation(None, form="none"))
    assert periodic.used.periodic
    assert periodic.notes == ()
    assert (periodic.filled, periodic.seen) == (0.0, None)
    edge = rough()
    edge[0] = np.nan
    part = prepared(Topography(edge, PIXEL, periodic=True), Preparation(None, form="none"))
    assert not part.used.periodic  # what is left of a map does not repeat itself
    for steps in ({"trim": 1}, {"form": "plane"}):
        asked = Preparation(None, **{"form": "none", **steps})
        assert not prepared(Topography(rough(), PIXEL, periodic=True), asked).used.periodic
    assert ready(rough(n=58), spikes="remove").notes == ("spikes: 0 places removed",)
    narrow = np.add.outer(np.arange(9.0) ** 2, np.arange(20.0) ** 2)
    assert ready(narrow, trim=4, form="none").used.heights.shape == (1, 12)
    for turned in (narrow[:8], narrow[:8].T):
        with pytest.raises(ValueError, match="trim = 4: leaves nothing of"):
            ready(turned, trim=4)
