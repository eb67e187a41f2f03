"""What lies on a map and is no roughness is named with its size; clean maps are left in peace."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from oracles.inside import (
    Preparation,
    fit_prepared,
    prepared,
    recorded,
    small_spike_heights,
    spike_heights,
    visible,
    without_form,
)
from oracles.rough import fit_map
from scipy.optimize import brentq

import mcgw
from mcgw.maps import Spectrum, Topography, gaussian_map
from mcgw.maps.fit_cautions import WORDS, cautions, faults, shares
from mcgw.maps.form import form_left

N, PIXEL = 240, (1e-6, 2e-6)
OF_THE_MAP = {"spikes", "form", "waves", "slope"}

pytestmark = pytest.mark.usefixtures("without_caps")


def rng(seed):
    return np.random.default_rng(seed)


def rough(seed=1, long=40e-6, n=N):
    """1 um rms, waves from 40 um to 16 um on 240 um x 480 um."""
    return gaussian_map(Spectrum(1e-6, long, 16e-6), (n, n), PIXEL, rng(seed)).heights


def grid(n=N):
    """Places along x and y from 0 to 1."""
    y, x = (np.mgrid[0:n, 0:n] + 0.5) / n
    return x, y


def topography(z):
    return Topography(z, PIXEL)


def lines(z, pixel=PIXEL, **keywords):
    """Warnings by their first word."""
    found = mcgw.fit(Topography(z, pixel), **{"cutoff": None, **keywords}).cautions
    return {line.partition(":")[0]: line for line in found}


CLEAN = {
    "rough": lambda x, y: rough(2),
    "tilted, far from zero": lambda x, y: 1e-3 + rough(4) + 5e-5 * x - 5e-5 * y,
    "skewed": lambda x, y: 1e-6 * np.exp(rough(5) / 1e-6),
    "few levels": lambda x, y: np.round(rough(6) / 2e-7) * 2e-7,
    "white": lambda x, y: rng(7).normal(size=(N, N)) * 1e-7,
    "valleys like knives": lambda x, y: np.abs(rough(8)),
}


@pytest.mark.parametrize("name", CLEAN)
def test_clean_maps_are_left_in_peace(name):
    assert not OF_THE_MAP & set(lines(CLEAN[name](*grid())))


def test_spikes_are_counted_and_the_largest_is_located():
    z = rough()
    places = [(20 + 37 * (k % 6), 25 + 50 * (k // 6)) for k in range(24)]
    for j, i in places:
        z[j : j + 2, i : i + 3] += 30e-6 if (j, i) != places[7] else -60e-6  # narrower than five pixels
    told = re.search(r"(\d+) place.* x = (.*) m, y = (.*) m, (.*) m (\w+) and", lines(z)["spikes"]).groups()
    assert (told[0], told[-1]) == ("24", "deep")
    x, y, size = map(float, told[1:-1])
    assert size == pytest.approx(60e-6, rel=0.1)  # below the lowest point of its ring
    assert round(y / PIXEL[1] - 0.5) - places[7][0] in (0, 1)
    assert round(x / PIXEL[0] - 0.5) - places[7][1] in (0, 1, 2)


def test_a_tilt_and_a_form_that_leaves_no_summit_are_named():
    x, _ = grid()
    assert "tilt" in lines(rough() + 1.2e-5 * x, form="none")["form"]
    with pytest.raises(ValueError, match=r"no summit; .* --form quadratic"):
        fit_map(topography(1e-3 * x * x), cutoff=None)


@pytest.fixture(scope="module")
def sound():
    """A fit that nothing is said of, and its map."""
    ready = prepared(topography(rough(2)), Preparation(None))
    fit = fit_prepared(ready)
    assert cautions(fit, ready) == []
    return fit, ready


def scaled(estimate, **factors):
    changes = {
        name: getattr(estimate, name)._replace(value=x * getattr(estimate, name).value)
        for name, x in factors.items()
    }
    return replace(estimate, **changes)


def known(fit, name, value):
    return replace(fit, numbers={**fit.numbers, name: fit.numbers[name]._replace(value=value)})


def listing(fit, heights):
    return replace(fit, listed=replace(fit.listed, heights=heights))


def apart(fit, **factors):
    both = {"moments": fit.estimates["moments"], "summits": scaled(fit.estimates["moments"], **factors)}
    return replace(fit, estimates=both)


def squares(fit, **changes):
    return replace(fit, mean_squares=fit.mean_squares | changes)


def crowded(fit, overlap, lost=0.0):
    """By caps, of which so many are not seen because of the pixel."""
    one, seen = fit.estimates["moments"], visible(overlap)
    one = scaled(one, eta=overlap / one.overlap)
    return replace(fit, estimates={"caps": one}, visible=seen._replace(share=seen.share - lost))


def with_slope(ready, slope):
    level = ready.levelled
    return replace(ready, levelled=replace(level, heights=level.heights * (slope / level.steepness)))


# Of each caution: how far it goes without a word, and what is changed to be there.
LIMITS = {
    "skewness": (0.3, lambda f, r, x: (replace(f, skewness=(-x, 0.05)), r)),
    "skewness, little known": (0.6, lambda f, r, x: (replace(f, skewness=(x, 0.2)), r)),
    "alpha": (1 / 1.5, lambda f, r, x: (known(f, "alpha", 1 / x), r)),
    "lay": (1.5, lambda f, r, x: (squares(f, slope_x=x, slope_y=1.0, slope_xy=0.0), r)),
    "estimates": (1.2, lambda f, r, x: (apart(f, eta=1.1, sigma=1 / x), r)),
    "estimates, radius": (1.2, lambda f, r, x: (apart(f, radius=x), r)),
    "overlap": (0.05, lambda f, r, x: (crowded(f, x), r)),
    "blur": (0.1, lambda f, r, x: (crowded(f, 0.01, x), r)),
    "waves": (1 / 50, lambda f, r, x: (replace(f, waves=replace(f.waves, independent=1 / x)), r)),
    "summits": (0.01, lambda f, r, x: (listing(f, np.zeros(int(1 / x))), r)),
    "pixel": (0.05, lambda f, r, x: (squares(f, bend=1 + x, bend_1=1.0), r)),
    "cutoff": (1 / 20e-6, lambda f, r, x: (f, replace(r, asked=replace(r.asked, cutoff=1 / x)))),
    "slope": (10.0, lambda f, r, x: (f, with_slope(r, x))),
    "unit": (1e-2, lambda f, r, x: (f, replace(r, levelled=replace(r.levelled, pixel=(1e-3, x))))),
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_caution_begins_at_its_limit(name, sound):
    """Half a per cent below it, nothing is said."""
    limit, change = LIMITS[name]
    word = name.partition(",")[0]
    for factor, there in ((0.995, False), (1.005, True)):
        fit, ready = change(*sound, factor * limit)
        told = [line for line in cautions(fit, ready, "caps") if line.startswith(f"{word}:")]
        assert bool(told) == there, (factor, told)


def test_spikes_stand_out_of_their_ring_by_three_ranges():
    """Of that ring, or of the usual one; on more rows than are looked at together, mirrored at the edges."""
    z, out_of = rng(1).normal(size=(150, 40)), rng(2).choice(6000, 80, replace=False)
    z[:, 20:] *= 0.1  # there the usual range is more than that of a ring
    z.flat[out_of] += np.linspace(3, 25, 80) * np.resize([1, -1], 80)
    around = [(j, i) for j in range(7) for i in range(7) if max(abs(j - 3), abs(i - 3)) == 3]
    padded = np.pad(z, 3, mode="reflect")
    ring = np.array([padded[j : j + 150, i : i + 40] for j, i in around])
    low, high = ring.min(axis=0), ring.max(axis=0)
    least = 3 * np.maximum(high - low, np.median(high - low))
    out = np.where(z > high, z - high, np.minimum(z - low, 0))
    assert np.count_nonzero(np.abs(np.abs(out) / least - 1) < 0.1) > 5
    expected = np.where(np.abs(out) > least, out, 0)
    np.testing.assert_allclose(spike_heights(topography(z)), expected, rtol=1e-12)


@pytest.mark.parametrize("factor", [0.995, 1.005])
def test_a_thousandth_of_the_roughness_tells_summits_apart(factor, sound):
    fit, _ = sound
    fit = listing(fit, np.linspace(0, factor * 1e-3 * fit.numbers["m0"].value ** 0.5, fit.summits.size))
    if factor < 1:
        with pytest.raises(ValueError, match=r"all \d+ summits are equally high, within .* m: a regular"):
            mcgw.fitted_scene(fit, use="summits")
    else:
        assert mcgw.fitted_scene(fit, use="summits").surface.sigma > 0


def test_a_small_spike_bends_by_seven_deviations_more_than_those_beside_it():
    """Deviations that have the median of the bends, of which half are 8 and half -8."""
    j, i = np.indices((40, 40))
    for factor, there in ((0.998, False), (1.002, True)):
        z = np.where((j + i) % 2 == 0, 1.0, -1.0)
        z[20, [20, 22]] += (factor * 7 * 8 / 0.6745 - 8) / 4
        found = small_spike_heights(topography(z))
        assert np.argwhere(found).tolist() == [[20, 20], [20, 22]] * there
        if there:  # above the mean of the four beside it
            assert found[20, 20] == pytest.approx(z[20, 20] + 1, rel=1e-12)


def test_levels_and_ends_of_a_recording():
    """The median step between levels, of which there are few; an end has more than 1.3 times the next."""
    z = np.repeat([0.0, 1.0, 2.0, 4.0], [130, 100, 700, 1]).reshape(7, -1)
    assert recorded(z) == (1.0, 0.0)  # 130 of 100 are not more
    more = np.repeat([0.0, 1.0, 2.0, 4.0], [131, 100, 699, 1]).reshape(7, -1)
    assert recorded(more)[1] == recorded(-more)[1] == 131 / 931
    fine = rng(1).normal(size=(30, 30))
    assert recorded(fine) == (0.0, 0.0)
    assert recorded(np.minimum(fine, 1))[1] == np.mean(fine >= 1)
    fine[3, 4:6] = 9.0
    assert recorded(fine)[1] == 2 / 900
    assert recorded(np.zeros((20, 20)))[0] == 0
    # a level for eight points is none, and as many levels are as good as none
    for number, levels, step in ((800, 100, 0), (800, 99, 1), (9 * 4095, 4095, 1), (9 * 4096, 4096, 0)):
        rows = (np.arange(number) % levels + 0.0).reshape(-1, number // 9 if levels > 999 else 40)
        assert recorded(rows)[0] == step


@pytest.mark.parametrize("seen", [False, True])
def test_a_form_counts_from_a_twentieth_of_the_variance_on(seen):
    """What a polynomial of second order takes off, over all; its range is what is told."""
    x, y = (2 * t - 1 for t in grid())
    z, share = rough(3, long=16.1e-6), 0.0502 if seen else 0.0498

    def parts(size):
        whole = topography(z + size * x * y)
        return whole, whole.heights - without_form(whole, "quadratic").heights

    size = brentq(lambda s: parts(s)[1].var() / parts(s)[0].heights.var() - share, 0.1e-6, 2e-6, rtol=1e-6)
    whole, shape = parts(size)
    left = form_left(whole, "plane")
    assert (left is not None) == seen
    if seen:
        assert left[:2] == (pytest.approx(share, rel=1e-4), pytest.approx(np.ptp(shape), rel=1e-6))


def test_the_gravest_caution_comes_first():
    """A map in a wrong unit is wrong by a million: no spike and no offset of a line stands before that."""
    z = 1e6 * (rough() + 0.1e-6 * rng(1).normal(size=(N, 1)))
    z[101, 200] += 30.0
    assert list(lines(z))[:3] == ["slope", "spikes", "lines"]


# --- faults of instruments, planted in Gaussian maps ------------------------------------------------------

SQUARE = (1e-6, 1e-6)


def instrument_map(seed, n=256, long=120e-6):
    return gaussian_map(Spectrum(1e-6, long, 12e-6), (n, n), SQUARE, rng(seed)).heights


def plain(z, cutoff=None, **known):
    ready = prepared(Topography(z, (1e-6, 2e-6), periodic=True), Preparation(cutoff, form="none"))
    return replace(ready, **known)


def test_what_rounding_adds_to_bends():
    """Step^2/12 is its variance, of which second differences have six times as much, on the worse axis."""
    z = instrument_map(1, 64, 50e-6)
    bends = [np.mean(np.diff(z, 2, axis=axis) ** 2) for axis in (0, 1)]
    seen = shares(plain(z, recorded=(3e-8, 0.0)))["rounding"]
    assert seen == pytest.approx((3e-8) ** 2 / 12 * 6 / min(bends), rel=1e-3)
    assert shares(plain(z, recorded=(0.0, 0.0)))["rounding"] == 0


def test_what_rounding_adds_is_filtered_along_both_axes():
    """On pixels of 1 x 2 um the filter leaves less of it along x; literal weights of its window."""
    ready, expected = plain(instrument_map(1, 64, 50e-6), 16e-6, recorded=(3e-8, 0.0)), []
    width = math.sqrt(math.log(2) / math.pi) * 16e-6
    for axis, pixels in ((1, (1e-6, 2e-6)), (0, (2e-6, 1e-6))):
        windows = (np.exp(-math.pi * (np.arange(-24, 25) * p / width) ** 2) for p in pixels)
        along, across = (w / w.sum() for w in windows)
        added = np.sum(np.diff(np.pad(along, 2), 2) ** 2) * np.sum(across**2) * (3e-8) ** 2 / 12
        expected.append(added / np.mean(np.diff(ready.used.heights, 2, axis=axis) ** 2))
    assert shares(ready)["rounding"] == pytest.approx(max(expected), rel=0.02)


@pytest.mark.parametrize("turned", [False, True])
def test_the_share_of_offsets_in_bends(turned):
    """The wave that does not change along a line, beyond the largest of the eight next to it, over all."""
    z = instrument_map(1, 64, 50e-6) + 3e-7 * rng(1).normal(size=(64, 1))
    power = np.mean(np.abs(np.fft.fft(np.diff(z, 2, axis=0))) ** 2, axis=0)
    share = (power[0] - 2 * power[1:9].max()) / power.sum()
    found = shares(plain(z.T.copy() if turned else z))
    one, other = (found[name] for name in (("columns", "rows") if turned else ("rows", "columns")))
    assert one == pytest.approx(share, rel=1e-9)
    assert other < 0.05 < share


def test_offsets_alternate_and_waves_along_lines_do_not():
    """Second differences of the means of lines: neighbours have a correlation below -0.4."""
    noise, wave = rng(1).normal(size=64), 20 * np.sin(np.arange(64) * 2 * np.pi / 8)

    def correlation(share):
        bends = np.diff((1 - share) * noise + share * wave, 2)
        return (bends[1:] @ bends[:-1]) / (bends @ bends)

    for target, seen in ((-0.402, True), (-0.398, False)):
        share = brentq(lambda x, t=target: correlation(x) - t, 0.0, 1.0, xtol=1e-12)
        z = 1e-7 * ((1 - share) * noise + share * wave)[:, None] + np.zeros(64)
        assert (shares(plain(z))["rows"] > 0.05) == seen


def test_a_fault_is_named_from_its_limit_on_with_its_share():
    """Planted so that half a per cent is missing or too much; the proposed cutoff and the step are told."""
    z = instrument_map(1, 64, 50e-6)
    one = shares(plain(z, recorded=(1e-8, 0.0)))["rounding"]
    white = 1e-7 * rng(3).normal(size=(64, 64))  # whose means of lines alternate too
    off = 1e-7 * rng(1).normal(size=(64, 1))
    for factor, told in ((0.995, False), (1.005, True)):
        step = 1e-8 * (factor * 0.05 / one) ** 0.5
        size = brentq(lambda x, f=factor: shares(plain(white + x * off))["rows"] - 0.05 * f, 0.0, 1.0)
        rows = white + size * off
        for ready, line in (
            (plain(z, recorded=(0.0, factor * 1e-3)), "range: 0.1 % of the points have the same"),
            (plain(z, recorded=(step, 0.0)), f"rounding: heights are multiples of {step:.3g} m; "
             "this rounding makes 5 % of m4, and false summits; use --cutoff of 12.3 pixels or more"),
            (plain(rows), "lines: offsets between rows, as in a line scan, make 5 % of the curvature across"),
            (plain(rows.T.copy()), "lines: offsets between columns, as in a line scan, make 5 %"),
        ):  # fmt: skip
            found = [f"{name}: {WORDS[name].format(*x)}" for name, *x in faults(ready, 12.34)]
            assert len(found) == told
            assert all(x.startswith(line) for x in found)
