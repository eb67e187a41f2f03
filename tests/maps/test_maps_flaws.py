"""What lies on a map and is no roughness is named with its size; clean maps are left in peace."""

import re
from dataclasses import replace

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.inside import (
    Preparation,
    fit_prepared,
    prepared,
    recorded,
    small_spike_heights,
    spike_heights,
    usual_bend,
    visible,
    without_form,
)
from scipy.optimize import brentq

import mcgw
from mcgw.maps import Spectrum, Topography, gaussian_map
from mcgw.maps.fit_cautions import cautions
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


def test_summits_that_are_all_equally_high_are_refused():
    """A regular texture."""
    j, i = np.mgrid[:N, :N]
    waves = 1e-6 * np.cos(2 * np.pi * i / 16) * np.cos(2 * np.pi * j / 16)
    fit = mcgw.fit(topography(waves), cutoff=None, form="none")
    with pytest.raises(ValueError, match=r"all \d+ summits are equally high, within .* m: a regular"):
        mcgw.fitted_scene(fit)


@pytest.mark.parametrize("factor", [0.995, 1.005])
def test_a_thousandth_of_the_roughness_tells_summits_apart(factor, sound):
    fit, _ = sound
    ends = np.linspace(0, factor * 1e-3 * fit.numbers["m0"].value ** 0.5, fit.summits.size)
    fit = replace(fit, listed=replace(fit.listed, heights=ends))
    if factor < 1:
        with pytest.raises(ValueError, match="are equally high, within"):
            mcgw.fitted_scene(fit, use="summits")
    else:
        assert mcgw.fitted_scene(fit, use="summits").surface.sigma > 0


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


def apart(fit, **factors):
    both = {"moments": fit.estimates["moments"], "summits": scaled(fit.estimates["moments"], **factors)}
    return replace(fit, estimates=both)


def squares(fit, **changes):
    return replace(fit, mean_squares=fit.mean_squares | changes)


def crowded(fit, overlap):
    one = fit.estimates["moments"]
    return replace(fit, estimates={"moments": scaled(one, eta=overlap / one.overlap)})


def blurred(fit, lost):
    one = scaled(fit.estimates["moments"], eta=0.01 / fit.estimates["moments"].overlap)
    seen = visible(0.01)
    return replace(
        fit, estimates={"moments": one, "caps": one}, visible=replace(seen, share=seen.share - lost)
    )


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
    "blur": (0.1, lambda f, r, x: (blurred(f, x), r)),
    "waves": (1 / 50, lambda f, r, x: (replace(f, waves=replace(f.waves, independent=1 / x)), r)),
    "summits": (
        0.01,
        lambda f, r, x: (replace(f, listed=replace(f.listed, heights=np.zeros(int(1 / x)))), r),
    ),
    "pixel": (1.05, lambda f, r, x: (squares(f, bend=x, bend_1=1.0), r)),
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


def rings(z):
    """Lowest and highest of the 24 points three pixels around each, mirrored at edges, one by one."""
    around = [(j, i) for j in range(-3, 4) for i in range(-3, 4) if max(abs(j), abs(i)) == 3]
    padded = np.pad(z, 3, mode="reflect")
    seen = np.array([padded[3 + j : 3 + j + z.shape[0], 3 + i : 3 + i + z.shape[1]] for j, i in around])
    return seen.min(axis=0), seen.max(axis=0)


def test_spikes_stand_out_of_their_ring_by_three_ranges():
    """Of that ring and of the usual one; on more rows than are looked at together."""
    z = np.round(rng(1).normal(size=(150, 40)), 3)
    z[:, 20:] *= 0.1  # there the usual range is more than that of a ring
    places = [(j, i) for j in (2, 30, 63, 100, 127, 147) for i in (4, 13, 24, 36)]
    for _ in range(6):  # a spike belongs to the rings of others
        low, high = rings(z)
        least = 3 * np.maximum(high - low, np.median(high - low))
        for k, (j, i) in enumerate(places):
            out = (0.999, 1.001)[k % 2] * least[j, i]
            z[j, i] = high[j, i] + out if k // 2 % 2 else low[j, i] - out
    low, high = rings(z)
    out = np.where(z > high, z - high, np.minimum(z - low, 0))
    usual = np.median(high - low)
    expected = np.where(np.abs(out) > 3 * np.maximum(high - low, usual), out, 0)
    assert [expected[at] != 0 for at in places] == 12 * [False, True]
    np.testing.assert_allclose(spike_heights(topography(z)), expected, rtol=1e-12)


def test_a_small_spike_bends_by_seven_deviations_more_than_those_beside_it():
    """Deviations that have the median of the bends, of which half are 8 and half -8."""
    assert usual_bend(np.array([-1.0, 1, 3, 5, np.nan])) == pytest.approx(2 / 0.6745, rel=1e-12)
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
    smooth = rng(1).normal(size=(30, 30))
    assert recorded(smooth) == (0.0, 0.0)
    assert recorded(np.minimum(smooth, 1))[1] == np.mean(smooth >= 1)
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
