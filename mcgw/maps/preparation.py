"""Preparation of a measured map before its evaluation, step by step, each with a line about it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from analytic.arrays import Array, Marks
from mcgw.maps.form import lowpass, smooth, without_form, without_offsets
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo
from mcgw.maps.topography import SMALLEST, Topography
from mcgw.scene.kinds import Whole, Word, argument, arguments
from mcgw.scene.section import Kind

_REACH = 3  # pixels from a point to the ring around it: a spike is narrower than five


@dataclass(frozen=True)
class Preparation:
    """Requested steps, by the keywords of `mcgw.fit`."""

    cutoff: float | None  # shortest wavelength that counts, m; None: as measured
    form: Form = "plane"
    missing: Missing = "auto"
    spikes: SpikesTo = "keep"
    trim: int = 0  # points that are left off along each edge
    long_cutoff: float | None = None  # longest wavelength that counts, m; None: as measured
    lines: LinesTo = "keep"
    parts: int = 4  # sub-areas along each axis, to estimate errors


def preparation_of(given: Mapping[str, Any]) -> Preparation:
    """Read the keywords of `mcgw.fit`; SceneError tells all mistakes at once."""
    kinds: dict[str, Kind] = {"parts": Whole(2), "trim": Whole()}
    words = {"form": Form, "missing": Missing, "spikes": SpikesTo, "lines": LinesTo}
    chosen = arguments(given, kinds | {name: Word(get_args(each)) for name, each in words.items()})
    for key in ("cutoff", "long_cutoff"):
        chosen[key] = None if given[key] in (None, "none") else argument(key, given[key], "m")
    return Preparation(**chosen)


@dataclass(frozen=True)
class Prepared:
    """A map ready for evaluation."""

    levelled: Topography  # without its form, with no missing points and all wavelengths
    used: Topography  # filtered between both cutoffs
    seen: Marks | None  # points of `used` that count; None: all
    recorded: tuple[float, float]  # step and clipping of its instrument: see `recorded`
    asked: Preparation
    notes: tuple[str, ...]  # what was done, a line each


def prepared(topography: Topography, asked: Preparation) -> Prepared:
    """Trim, crop, clean, level, fill and filter a map, in this order; ValueError if it is flat or gone."""
    notes: list[str] = []
    kept, trim = topography, asked.trim
    if trim:
        rows, columns = kept.heights.shape
        if 2 * trim >= min(rows, columns):
            raise ValueError(f"trim = {trim}: leaves nothing of {columns} x {rows} points")
        notes.append(f"trim: {trim} points removed along each edge")
        kept = replace(kept, heights=kept.heights[trim:-trim, trim:-trim], periodic=False)
    kept = _within(kept, notes)
    del topography  # frees the memory of a large map that nobody else uses
    if not np.nanmax(kept.heights) - np.nanmin(kept.heights) > SMALLEST:
        raise ValueError("the map is flat, without roughness")
    seen_by = recorded(kept.heights)
    if asked.lines != "keep":
        kept, offsets = without_offsets(kept, asked.lines)
        notes.append(f"lines: offsets of {asked.lines} removed, {offsets:.3g} m rms")
    level, holes = _levelled(kept, asked, notes)
    del kept
    used = level
    if (longest := asked.long_cutoff) is not None:
        used = replace(used, heights=used.heights - lowpass(used, longest))
        notes.append(f"long cutoff: waves longer than {longest:g} m removed (Gaussian, ISO 16610-61)")
    if asked.cutoff is not None:
        used = smooth(used, asked.cutoff)
    seen = None if holes is None else _seen(level, holes, asked, notes)
    return Prepared(level, used, seen, seen_by, asked, tuple(notes))


def _within(topography: Topography, notes: list[str]) -> Topography:
    """Without edge rows and columns that lack all points."""
    there = np.isfinite(topography.heights)
    if not there.any():
        raise ValueError(f"all {there.size} points of the map are missing")
    box = topography.heights[ndimage.find_objects(there.view(np.int8))[0]]
    if box.size == there.size:
        return topography
    notes.append(f"edges: {box.shape[1]} x {box.shape[0]} points kept; all points outside are missing")
    return replace(topography, heights=box, periodic=False)


def _levelled(
    topography: Topography, asked: Preparation, notes: list[str]
) -> tuple[Topography, Marks | None]:
    """Return the map without spikes, form and holes; and where its holes are."""
    kept, number, largest = topography, 0, 0.0
    for _ in range(5):  # searches for spikes: small ones stand beside large ones
        plain = without_form(kept, asked.form)
        if plain.highest < 1e-12 * kept.highest:  # share of the removed range
            raise ValueError(f"the map is flat after removing its form ({asked.form})")
        whole = replace(plain, heights=filled(plain.heights))
        if asked.spikes == "keep":
            break
        above = spike_heights(whole)
        above = np.where(above == 0, small_spike_heights(whole), above) * np.isfinite(plain.heights)
        places = ndimage.label(above, structure=np.ones((3, 3)))[1]
        if not places:
            break
        number, largest = number + places, max(largest, float(np.abs(above).max()))
        around = ndimage.binary_dilation(above != 0, np.ones((3, 3), dtype=np.bool_))
        kept = replace(kept, heights=np.where(around, np.nan, kept.heights))
    if asked.spikes == "remove":
        notes.append(f"spikes: {number} places removed" + (f", up to {largest:.3g} m" if number else ""))
    holes = ~np.isfinite(kept.heights)
    return whole, holes if holes.any() else None


def _seen(topography: Topography, holes: Marks, asked: Preparation, notes: list[str]) -> Marks | None:
    """Which points of the map between its cutoffs count."""
    if asked.cutoff is None:
        seen = ~holes
    else:
        share = smooth(replace(topography, heights=holes.astype(np.float64)), asked.cutoff).heights
        seen = share < 0.1  # share of the filter's window that may be filled
    number = int(np.count_nonzero(holes))
    told = f"missing: {number} of {holes.size} points ({100 * holes.mean():.2g} %) filled from their edges"
    whole = ndimage.minimum_filter(seen, 2 * 2 + 1)  # pixels on each side that differences need
    left = np.count_nonzero(whole) / max(np.count_nonzero(~holes) * seen.size / holes.size, 1)
    if asked.missing == "fill" or (asked.missing == "auto" and left < 0.5):
        few = f": only {100 * left:.2g} % of the others have all neighbours"
        notes.append(f"{told}, and used like the others{'' if asked.missing == 'fill' else few}")
        return None
    notes.append(
        f"{told}; they and their neighbours are ignored, which leaves {100 * whole.mean():.3g} % of the map"
    )
    return seen


# --- bad points: missing, spikes, or cut off ---


def filled(heights: Array) -> Array:
    """Fill missing points: each is the mean of its neighbours left, right, above and below.

    That is Laplace's equation on the pixels. Neighbours beyond the map do not count. In holes wider than
    some thousand points the iteration ends before its limit, near the height of the nearest edge. Missing
    points are nan, not all of them.
    """
    missing = ~np.isfinite(heights)
    number = int(np.count_nonzero(missing))
    if not number:
        return heights
    nearest = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    result = heights[tuple(nearest)]
    index = np.full(heights.shape, -1, dtype=np.int64)
    index[missing] = np.arange(number)
    ways = np.array([[[0, 1]], [[0, -1]], [[1, 0]], [[-1, 0]]])
    at = tuple(np.moveaxis(np.clip(np.argwhere(missing) + ways, 0, np.array(heights.shape) - 1), -1, 0))
    beside = index[at]  # beyond an edge the point itself stands for its missing neighbour
    way, point = np.nonzero(beside >= 0)
    others = coo_array((np.ones(way.size), (point, beside[way, point])), shape=(number, number))
    matrix: Any = diags_array(np.full(number, 4.0), format="csr") - others.tocsr()
    start = result[missing]
    known = np.where(beside < 0, result[at], 0.0).sum(axis=0)
    away = known - matrix @ start  # solved for the difference, since heights may be far from zero
    scale = float(np.abs(away).max())
    if scale > 0:
        found = cg(matrix, away / scale, rtol=1e-8, maxiter=min(2000, 10 * math.isqrt(number) + 50))[0]
        result[missing] = start + scale * found
    return np.asarray(result)


def spike_heights(topography: Topography) -> Array:
    """How far every point of a spike stands above (or, below 0, under) its ring, m; 0 for all others.

    Points of a spike stand out of the ring three pixels around them, on a map that lacks no points: by more
    than three times the range of heights on that ring, and on half of all rings of the map. So the scale is
    that of the surface next to the point, and a few spikes do not change it. White noise would have to be 12
    deviations beyond the ring; ridges, pits and peaks stay below.
    """
    heights = topography.heights
    above = np.zeros(heights.shape)
    if min(heights.shape) <= 2 * _REACH:
        return above
    ring = np.pad(np.zeros((2 * _REACH - 1,) * 2, dtype=np.bool_), 1, constant_values=True)
    filters = ndimage.minimum_filter, ndimage.maximum_filter
    low, high = (extreme(heights, footprint=ring, mode="mirror") for extreme in filters)
    high -= low
    some = high[:: max(heights.size // 2**20, 1)]  # rings: enough for their median to a thousandth
    usual = float(np.median(some)) or float(some.mean())  # 0: most of it is flat
    out = np.clip(heights - low, None, 0) + np.clip(heights - low - high, 0, None)
    return np.where(np.abs(out) > 3 * np.maximum(high, usual), out, 0.0)


def small_spike_heights(topography: Topography) -> Array:
    """Heights of spikes above the mean of their four neighbours, for points with unusual bends.

    A spike may be lower than its surroundings are high and still have most of the curvature of a map. Its
    second differences lie beyond seven times the usual ones (once in 4e11 points of a Gaussian map), and
    beyond those of the points next to it.
    """
    bends = ndimage.laplace(topography.heights, mode="nearest")
    size = np.abs(bends)
    usual = float(np.median(np.abs(bends - np.median(bends)))) / 0.6745  # of a Gaussian
    out = (size > 7 * usual) & (size == ndimage.maximum_filter(size, 3))
    return np.asarray(np.where(out, bends / -4, 0.0))


def recorded(heights: Array) -> tuple[float, float]:
    """Return resolution and clipping of a map as it was read; some points may be missing.

    The step between two heights that follow each other, m, 0 if they are as good as continuous; and the
    share of the points that have the greatest height, or the least, where they are more than a range that
    holds all heights leaves there, else 0.
    """
    some = heights.ravel()[:: max(heights.size // 2**18, 1)]  # enough for up to some thousand levels
    levels = np.unique(some[np.isfinite(some)])
    steps = np.diff(levels)
    step = float(np.median(steps)) if 1 < levels.size < min(2**12, some.size / 8) else 0.0
    clipped = 0.0
    for end, inwards in ((np.nanmax(heights), -step), (np.nanmin(heights), step)):
        number = np.count_nonzero(heights == end)
        below = np.count_nonzero(np.abs(heights - (end + inwards)) < step / 2) if step else 0
        if number > max(1.3 * below, 1):  # of a summit that a step cuts, no level has so many more
            clipped = max(clipped, number / heights.size)
    return step, clipped
