"""Stated errors against the scatter over maps: long waves are few on one, and its sub-areas share them."""

import math

import numpy as np
import pytest

import mcgw.maps.fit as fit_module
from analytic import SpectralMoments
from mcgw.maps.fit import fit_map
from mcgw.maps.spectrum import Spectrum, gaussian_map, moments_on_grid
from mcgw.maps.topography import Topography
from mcgw.maps.uncertain import Spread, uncertain
from mcgw.maps.waves import Waves, _taken

PARAMETERS = ("eta", "radius", "sigma")
MOMENTS = ("m0", "m2", "m4", "alpha")


def fits_of(alpha, waves, n, *, hurst=0.8, number=100):
    """So many Gaussian maps with this bandwidth, as many of their longest wave on each."""
    pixel = 1e-6
    shape = Spectrum.with_moments(SpectralMoments(1e-12, 1e-3, alpha * 1e6), hurst)
    long = n * pixel / waves
    spectrum = Spectrum(1e-6, long, long * shape.short / shape.long, hurst)
    truth = moments_on_grid(spectrum, (n, n), (pixel, pixel))
    maps = (
        gaussian_map(spectrum, (n, n), (pixel, pixel), np.random.default_rng(seed)) for seed in range(number)
    )
    return [(fit_map(Topography(m.heights, m.pixel), cutoff=None), truth) for m in maps]


@pytest.fixture
def without_caps(monkeypatch):
    """They are not what Gaussian maps have, and take most of the time."""
    monkeypatch.setattr(fit_module, "by_caps", lambda *_: None)


def compared(maps):
    """Of every estimate of every map: z of its logarithm, and whether its interval holds the truth."""
    found = {}
    for fit, truth in maps:
        pairs = {name: (getattr(fit, name), getattr(truth, name)) for name in MOMENTS}
        for method, e in fit.estimates.items():
            pairs |= {f"{method} {p}": (getattr(e, p), getattr(truth, p)) for p in PARAMETERS}
        for name, (x, true) in pairs.items():
            z = math.log(x.value / true) / (x.error / x.value)
            found.setdefault(name, []).append((z, x.low <= true <= x.high))
    return {name: np.array(rows) for name, rows in found.items()}


def outside(maps):
    """The largest share of intervals that do not hold the truth, over all estimates."""
    return max(1 - rows[:, 1].mean() for rows in compared(maps).values())


slow = pytest.mark.slow


@pytest.mark.parametrize(
    ("alpha", "waves", "n", "hurst"),
    [
        (2, 1, 96, -0.8),
        pytest.param(5, 1, 192, 0.5, marks=slow),
        (10, 1, 192, 0.8),
        (2, 3, 224, -0.8),
        pytest.param(5, 3, 320, 0.5, marks=slow),
        pytest.param(10, 3, 448, 0.8, marks=slow),
    ],
)
def test_intervals_hold_the_truth(alpha, waves, n, hurst, without_caps):
    """Of 100 maps at most 12 lie outside by any of ten estimates, where 5 are expected of each.

    Were it 5, more than 12 would be seen once in 680 sets of maps, of ten estimates once in 68 at most; the
    seeds are fixed. `runs/map_errors.py` has 200 maps of every case.
    """
    found = compared(fits_of(alpha, waves, n, hurst=hurst))
    assert {name: 1 - rows[:, 1].mean() for name, rows in found.items() if rows[:, 1].mean() < 0.88} == {}
    scatter = {name: rows[:, 0].std() for name, rows in found.items()}
    # 1 would be right; with 13 summits on a map errors are a third too large, else a fifth at most
    assert {name: s for name, s in scatter.items() if not 0.6 < s < 1.3} == {}


def test_sub_areas_alone_would_not_hold_it(without_caps, monkeypatch):
    """The companion: with the jackknife alone a third of the maps lies outside."""
    nothing = Spread(1e-9, 1e-9, 1e-9)
    monkeypatch.setattr(fit_module, "waves_of", lambda *_: Waves(*[nothing] * 7, independent=1e9))
    assert outside(fits_of(10, 1, 192)) > 0.3


def test_what_a_plane_takes_of_long_waves():
    """The share of a wave of random phase, against least squares on 12 phases of it."""
    n = 128
    t = (np.arange(n) + 0.5) / n
    y, x = np.meshgrid(t, t, indexing="ij")
    for order, columns in ((1, (1, x, y)), (2, (1, x, y, x * x, x * y, y * y))):
        basis = np.column_stack([np.broadcast_to(c, (n, n)).ravel() for c in columns])
        for kx, ky in ((1, 0), (0, 2), (1, 1), (3, 1)):
            phases = 2 * np.pi * (np.arange(12) + 0.5) / 12
            z = np.stack([np.cos(2 * np.pi * (kx * x + ky * y) + p).ravel() for p in phases], axis=1)
            rest = z - basis @ np.linalg.lstsq(basis, z, rcond=None)[0]
            left = (rest**2).sum() / (z**2).sum()
            near = 2 * (math.pi * max(kx, ky) / n) ** 2  # sums are off integrals by half of it
            assert _taken((n, n), order)[ky, kx] == pytest.approx(1 / left - 1, rel=near)


def test_the_larger_error_counts_and_arms_are_those_of_logarithms():
    x = uncertain(2.0, 0.1, Spread(0.2, 0.3, 0.5))
    assert x == pytest.approx((2.0, 0.4, 2 * math.exp(-0.3), 2 * math.exp(0.5)))
    y = uncertain(2.0, 0.6, Spread(0.2, 0.3, 0.5))
    assert y == pytest.approx((2.0, 0.6, 2 * math.exp(-0.6), 2 * math.exp(0.6)))
