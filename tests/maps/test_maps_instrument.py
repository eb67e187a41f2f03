"""Faults of instruments, planted in Gaussian maps: each is named, and what its caution says helps."""

from dataclasses import replace

import numpy as np
import pytest
from oracles.fit_of_maps import fit_map
from oracles.inside import Preparation, prepared, smooth
from scipy.optimize import brentq

from mcgw.maps import Spectrum, Topography, gaussian_map
from mcgw.maps.instrument import LIMITS, _kept_of_noise, faults, shares

PIXEL = (1e-6, 1e-6)

pytestmark = pytest.mark.usefixtures("without_caps")


def rough(seed=1, long=120e-6, n=256):
    return gaussian_map(Spectrum(1e-6, long, 12e-6), (n, n), PIXEL, np.random.default_rng(seed)).heights


# Of each: what is planted, and the flags that its caution names.
FAULTS = {
    "rounding": (lambda z, rng: np.round(z / z.std() * 5) * z.std() / 5, {"cutoff": 10e-6}),
    "rows": (lambda z, rng: z + 0.1 * z.std() * rng.normal(size=(len(z), 1)), {"lines": "rows"}),
}


def named(z, pixel=PIXEL, **steps):
    """Faults beyond their limits."""
    ready = prepared(Topography(z, pixel), Preparation(**{"cutoff": None, **steps}))
    return {name for name, share in shares(ready).items() if share > LIMITS[name]}


def numbers(z, **steps):
    fit = fit_map(Topography(z, PIXEL), **{"cutoff": None, **steps})
    e = fit.estimates["summits"]
    return np.log([e.eta.value, e.radius.value])


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_named_and_its_flag_helps(fault):
    """On every map of three; and what was wrong by a tenth to a factor of fifty is right within 7 %."""
    plant, flags = FAULTS[fault]
    wrong, left = [], []
    for seed in range(3):
        z = rough(seed)
        broken = plant(z, np.random.default_rng(seed + 50))
        assert named(broken) == {fault}
        assert fault not in named(broken, **flags)
        filtered = {"cutoff": flags["cutoff"]} if "cutoff" in flags else {}
        wrong.append(numbers(broken) - numbers(z))
        left.append(numbers(broken, **flags) - numbers(z, **filtered))
    wrong, left = np.abs(np.mean(wrong, axis=0)).max(), np.abs(np.mean(left, axis=0)).max()
    assert wrong > 0.07 > left
    assert left < wrong / 2


def test_a_range_that_cuts_off_summits_is_named():
    z = rough()
    assert named(np.minimum(z, 2.5 * z.std())) == {"range"}


@pytest.mark.parametrize("cutoff", [None, 12e-6])
def test_what_a_filter_keeps_of_noise(cutoff):
    """Against white noise that is filtered: mean squares of its second differences, within a few per cent."""
    noise = Topography(np.random.default_rng(1).normal(size=(400, 400)), (1e-6, 2e-6), periodic=True)
    z = noise.heights if cutoff is None else smooth(noise, cutoff).heights
    seen = [np.mean(np.diff(z, 2, axis=axis) ** 2) for axis in (1, 0)]
    assert _kept_of_noise(cutoff, noise.pixel) == pytest.approx(seen, rel=0.05)


def plain(z, cutoff=None, **known):
    ready = prepared(Topography(z, (1e-6, 2e-6), periodic=True), Preparation(cutoff, form="none"))
    return replace(ready, **known)


def test_what_rounding_adds_to_bends():
    """Step^2/12 is its variance, of which second differences have six times as much, on the worse axis."""
    z = rough(1, n=64, long=50e-6)
    bends = [np.mean(np.diff(z, 2, axis=axis) ** 2) for axis in (0, 1)]
    seen = shares(plain(z, recorded=(3e-8, 0.0)))["rounding"]
    assert seen == pytest.approx((3e-8) ** 2 / 12 * 6 / min(bends), rel=1e-3)
    assert shares(plain(z, recorded=(0.0, 0.0)))["rounding"] == 0


def offsets(size, n=64):
    """A rough map whose rows are off by so much."""
    return rough(1, n=n, long=50e-6) + size * np.random.default_rng(1).normal(size=(n, 1))


@pytest.mark.parametrize("turned", [False, True])
def test_the_share_of_offsets_in_bends(turned):
    """The wave that does not change along a line, beyond the largest of the eight next to it, over all."""
    z = offsets(3e-7)
    power = np.mean(np.abs(np.fft.fft(np.diff(z, 2, axis=0))) ** 2, axis=0)
    share = (power[0] - 2 * power[1:9].max()) / power.sum()
    found = shares(plain(z.T.copy() if turned else z))
    one, other = (found[name] for name in (("columns", "rows") if turned else ("rows", "columns")))
    assert one == pytest.approx(share, rel=1e-9)
    assert other < 0.05 < share


def test_offsets_alternate_and_waves_along_lines_do_not():
    """Second differences of the means of lines: neighbours have a correlation below -0.4."""
    noise, wave = np.random.default_rng(1).normal(size=64), 20 * np.sin(np.arange(64) * 2 * np.pi / 8)

    def correlation(share):
        bends = np.diff((1 - share) * noise + share * wave, 2)
        return (bends[1:] @ bends[:-1]) / (bends @ bends)

    for target, seen in ((-0.402, True), (-0.398, False)):
        share = brentq(lambda x, t=target: correlation(x) - t, 0.0, 1.0, xtol=1e-12)
        z = 1e-7 * ((1 - share) * noise + share * wave)[:, None] + np.zeros(64)
        assert (shares(plain(z))["rows"] > 0.05) == seen


def test_a_fault_is_named_from_its_limit_on_with_its_share():
    """Planted so that half a per cent is missing or too much; the proposed cutoff and the step are told."""
    z = rough(1, n=64, long=50e-6)
    one = shares(plain(z, recorded=(1e-8, 0.0)))["rounding"]
    white = 1e-7 * np.random.default_rng(3).normal(size=(64, 64))  # whose means of lines alternate too
    off = 1e-7 * np.random.default_rng(1).normal(size=(64, 1))
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
            found = faults(ready, 12.34)
            assert len(found) == told
            assert all(x.startswith(line) for x in found)
