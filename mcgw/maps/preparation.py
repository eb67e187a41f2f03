"""Preparation of a measured map before its evaluation, step by step, each with a line about it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
from scipy import ndimage

from analytic.arrays import Marks
from mcgw.maps.bad_points import filled, recorded, small_spike_heights, spike_heights
from mcgw.maps.form import lowpass, smooth, without_form, without_offsets
from mcgw.maps.steps import Form, LinesTo, Missing, SpikesTo
from mcgw.maps.topography import SMALLEST, Topography
from mcgw.scene.kinds import Whole, Word, argument, arguments
from mcgw.scene.section import Kind

_LEAST = 0.5  # share of measured points that must have all neighbours, else filled ones count


@dataclass(frozen=True)
class Preparation:
    """Requested steps, by the keywords of `mcgw.fit`.

    Parameters
    ----------
    cutoff, long_cutoff : float or None
        Shortest and longest wavelength that counts, m; None: as measured.
    form, missing, spikes, lines : str, optional
        Each by one of its words in `mcgw.maps.steps`.
    trim : int, optional
        Points that are left off along each edge.
    """

    cutoff: float | None
    form: Form = "plane"
    missing: Missing = "auto"
    spikes: SpikesTo = "keep"
    trim: int = 0
    long_cutoff: float | None = None
    lines: LinesTo = "keep"


def preparation_of(given: Mapping[str, Any]) -> tuple[Preparation, int]:
    """Read the keywords of `mcgw.fit` and ``parts``.

    Raises
    ------
    SceneError
        If words or numbers are none of those known, all of them told at once.
    """
    kinds: dict[str, Kind] = {"parts": Whole(2), "trim": Whole()}
    words = {"form": Form, "missing": Missing, "spikes": SpikesTo, "lines": LinesTo}
    kinds |= {name: Word(get_args(each)) for name, each in words.items()}
    chosen = arguments(given, kinds)
    parts = chosen.pop("parts")
    for key in ("cutoff", "long_cutoff"):
        value = given[key]
        chosen[key] = None if value is None or value == "none" else argument(key, value, "m")
    return Preparation(**chosen), parts


@dataclass(frozen=True)
class Prepared:
    """A map ready for evaluation.

    Parameters
    ----------
    levelled : Topography
        The map without its form, with no missing points and all wavelengths.
    used : Topography
        The map filtered between both cutoffs.
    seen : ndarray of bool or None
        Points of `used` that count; None: all.
    recorded : (float, float)
        Step and clipping of its instrument: see `mcgw.maps.bad_points.recorded`.
    asked : Preparation
        What was asked for.
    notes : tuple of str
        What was done, a line each.
    """

    levelled: Topography
    used: Topography
    seen: Marks | None
    recorded: tuple[float, float]
    asked: Preparation
    notes: tuple[str, ...]


def prepared(topography: Topography, asked: Preparation) -> Prepared:
    """Trim, crop, clean, level, fill and filter a map, in this order.

    Raises
    ------
    ValueError
        If nothing is left of the map, or it is flat.
    """
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
    if asked.long_cutoff is not None:
        used = replace(used, heights=used.heights - lowpass(used, asked.long_cutoff))
        notes.append(
            f"long cutoff: waves longer than {asked.long_cutoff:g} m removed (Gaussian, ISO 16610-61)"
        )
    if asked.cutoff is not None:
        used = smooth(used, asked.cutoff)
    seen = None if holes is None else _seen(level, holes, asked, notes)
    return Prepared(level, used, seen, seen_by, asked, tuple(notes))


def _within(topography: Topography, notes: list[str]) -> Topography:
    """Without edge rows and columns that lack all points."""
    there = np.isfinite(topography.heights)
    if there.all():
        return topography
    if not there.any():
        raise ValueError(f"all {there.size} points of the map are missing")
    (j0, j1), (i0, i1) = (np.flatnonzero(there.any(axis=axis))[[0, -1]] for axis in (1, 0))
    box = topography.heights[j0 : j1 + 1, i0 : i1 + 1]
    if box.size < there.size:
        notes.append(f"edges: {box.shape[1]} x {box.shape[0]} points kept; all points outside are missing")
        return replace(topography, heights=box, periodic=False)
    return topography


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
    if asked.missing == "fill" or (asked.missing == "auto" and left < _LEAST):
        why = (
            "" if asked.missing == "fill" else f": only {100 * left:.2g} % of the others have all neighbours"
        )
        notes.append(f"{told}, and used like the others{why}")
        return None
    notes.append(
        f"{told}; they and their neighbours are ignored, which leaves {100 * whole.mean():.3g} % of the map"
    )
    return seen
