"""What an instrument did to a map: how much of each fault it shows, and how much is too much.

Most faults put power into waves as short as a pixel, which is all of m4 and of the curvature of summits. So
they are measured on the map between its cutoffs, where they count, by second differences; of a large map
about a million of them are looked at. No row of an isotropic Gaussian map differs from its neighbours more
than waves that cross it slantwise do.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy import fft

from analytic.arrays import Array
from mcgw.maps.form import gaussian_transmission
from mcgw.maps.preparation import Prepared

_ENOUGH = 2**20  # second differences
_NEAR = slice(1, 9)  # waves along a row that are nearly as long as those that do not change along it
_ALTERNATE = -0.4  # correlation of second differences of neighbours: -2/3 of independent offsets
LIMITS = {"range": 1e-3, "rounding": 0.05, "rows": 0.05, "columns": 0.05}  # shares that are let pass


def shares(ready: Prepared) -> dict[str, float]:
    """Return how much of each fault a map shows: a share of its points (range) or of its mean square bend."""
    return {
        "range": ready.recorded[1],
        "rounding": _rounding(ready),
        "rows": _offsets(ready, 0),
        "columns": _offsets(ready, 1),
    }


def faults(ready: Prepared, longer: float) -> Iterator[tuple[Any, ...]]:
    """Faults beyond their limits, for words of `mcgw.maps.fit_cautions`; `longer` is a cutoff, in pixels."""
    percent = {name: 100 * share for name, share in shares(ready).items() if share > LIMITS[name]}
    if "range" in percent:
        yield "range", percent["range"]
    if "rounding" in percent:
        yield "rounding", ready.recorded[0], percent["rounding"], longer
    yield from (("lines", name, percent[name]) for name in ("rows", "columns") if name in percent)


def _rounding(ready: Prepared) -> float:
    """Share of the mean square bend, by plain differences, that rounding to steps adds."""
    if not ready.recorded[0]:
        return 0.0
    z = ready.used.heights
    kept = _kept_of_noise(ready.asked.cutoff, ready.used.pixel)
    return max(
        ready.recorded[0] ** 2 / 12 * gain / max(float(np.mean(_second(along) ** 2)), 1e-300)
        for along, gain in zip((z.T, z), kept, strict=True)
    )


def _kept_of_noise(cutoff: float | None, pixel: tuple[float, float]) -> list[float]:
    """Mean squares of second differences along x and y of independent heights of variance 1, filtered."""
    k = math.pi * (np.arange(128) + 0.5) / 128
    left = [1.0 if cutoff is None else gaussian_transmission(k / p, cutoff) ** 2 for p in pixel]
    bend = (2 - 2 * np.cos(k)) ** 2
    x, y = (np.mean(bend * t) for t in left), [float(np.mean(t)) for t in left]
    return [float(b) * other for b, other in zip(x, y[::-1], strict=True)]


def _offsets(ready: Prepared, axis: int) -> float:
    """Share of the mean square bend across rows (0) or columns (1) that is the same all along a line.

    Beyond twice what any of its neighbours in the spectrum has; nothing, if the means of lines do not
    alternate as independent offsets do: grooves along the lines are as wide as several of them.
    """
    means = np.diff(ready.levelled.heights.mean(axis=1 - axis), 2)
    if not float(means[1:] @ means[:-1]) < _ALTERNATE * float(means @ means):
        return 0.0
    bends = _second(np.moveaxis(ready.used.heights, axis, 0))
    power = np.mean(np.abs(fft.rfft(bends)) ** 2, axis=0)
    power[1:] *= 2
    return float((power[0] - power[_NEAR].max()) / power.sum())


def _second(z: Array) -> Array:
    """Second differences from row to row, around rows that are equally far apart."""
    j = np.arange(1, len(z) - 1, max(z.size // _ENOUGH, 1))
    return np.asarray(z[j - 1] - 2 * z[j] + z[j + 1])
