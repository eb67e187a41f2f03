"""What is done to a map before it is looked at: each step against a map that never needed it."""

import math

import numpy as np
import pytest
from oracles.inside import Preparation, filled, lowpass, prepared, smooth
from scipy.ndimage import minimum_filter

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
    """Or one, of a periodic map."""
    wave = np.sin(np.arange(20.0) * 28).repeat(28)

    def left(shape, cutoff, periodic=False):
        return smooth(Topography(np.resize(wave, shape), (1.0, 1.0), periodic), cutoff).heights.shape

    for turn in (1, -1):
        assert left((28, 40)[::turn], 10.0)[::turn] == (8, 20)
        with pytest.raises(ValueError, match=r"leaves nothing of a map of \d\d x \d\d m"):
            left((27, 40)[::turn], 10.0)
        assert left((20, 40)[::turn], 19.0, periodic=True)[::turn] == (20, 40)
        with pytest.raises(ValueError, match=r"longer than the map of \d\d x \d\d m"):
            left((20, 40)[::turn], 20.0, periodic=True)


@pytest.mark.parametrize("cutoff", [None, 4e-6])
def test_points_count_whose_neighbours_were_seen(cutoff):
    """Of a filtered map those whose window has less than a tenth of filled ones.

    Half of those that were measured must remain; a hole more, and all of them count.
    """
    z, order = rough(1, n=60), np.random.default_rng(1).permutation(3600)

    def around(number):
        """Points that were seen, those whose neighbours were too, and their share of what was measured."""
        holes = np.zeros(3600)
        holes[order[:number]] = 1
        holes = holes.reshape(60, 60)
        share = smooth(Topography(holes, PIXEL), cutoff).heights if cutoff else holes
        whole = minimum_filter(share < 0.1, 5)
        return share < 0.1, whole, whole.mean() / (1 - number / 3600)

    last = max(number for number in range(20, 330) if around(number)[2] >= 0.5)
    for number, kept in ((last, True), (last + 1, False)):
        seen, whole, left = around(number)
        z.flat[order[:number]] = np.nan
        masked, auto, used = (ready(z, cutoff, missing=x, form="none") for x in ("mask", "auto", "fill"))
        np.testing.assert_array_equal(masked.seen, seen)
        told = f"missing: {number} of 3600 points ({number / 36:.2g} %) filled from their edges"
        assert masked.notes[0].startswith(told)
        assert f"which leaves {100 * whole.mean():.3g} % of the map" in masked.notes[0]
        assert used.seen is None
        assert (auto.seen is not None) == kept
        assert kept or f"only {100 * left:.2g} % of the others have all neighbours" in auto.notes[0]
    z[::3, ::3] = np.nan
    with pytest.raises(ValueError, match="use --missing fill"):
        fitted(z, missing="mask")


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


def test_notes_tell_what_was_done_to_a_map():
    z = np.full((50, 70), np.nan)
    z[10:45, 8:66] = rough(1, n=58)[:35]
    found = ready(z, trim=3, form="none", long_cutoff=30e-6)
    assert [note.partition(":")[0] for note in found.notes] == ["trim", "edges", "long cutoff"]
    assert found.notes[1].startswith("edges: 58 x 35 points kept")
    np.testing.assert_array_equal(found.levelled.heights, z[10:45, 8:66])
    long = lowpass(Topography(z[10:45, 8:66], PIXEL), 30e-6)
    np.testing.assert_allclose(found.used.heights, z[10:45, 8:66] - long, atol=1e-12 * 1e-6)
    assert ready(rough(n=58), spikes="remove").notes == ("spikes: 0 places removed",)


def test_what_is_left_of_a_map_does_not_repeat_itself():
    whole, edge = rough(), rough()
    edge[0] = np.nan
    for z, steps, periodic in (
        (whole, {}, True), (edge, {}, False), (whole, {"trim": 1}, False), (whole, {"form": "plane"}, False)
    ):  # fmt: skip
        asked = Preparation(None, **{"form": "none", **steps})
        assert prepared(Topography(z, PIXEL, periodic=True), asked).used.periodic == periodic
