"""Removal from a map: form, offsets of lines, waves shorter than a cutoff; and what form is left."""

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy import fft
from scipy.ndimage import gaussian_filter, gaussian_filter1d

from analytic.arrays import Array
from mcgw.maps.steps import Form, LinesTo
from mcgw.maps.topography import Topography, filter_variance
from mcgw.maps.waves import coarser

ORDERS = {"none": -1, "plane": 1, "quadratic": 2, "cubic": 3, "quartic": 4}

_COARSE, _FINE = 192, 1024  # points along each axis tell the longest waves, and a form


def without_form(topography: Topography, form: Form) -> Topography:
    """Subtract the form of least squares: a polynomial of two coordinates.

    Missing points neither count nor get a height. The rest is no longer periodic, unless nothing was taken
    off.
    """
    if form == "none":
        return topography
    z, order = topography.heights, ORDERS[form]
    y, x = (legvander((np.arange(n) + 0.5) / n * 2 - 1, order) for n in z.shape)
    a, b = np.nonzero(np.add.outer(np.arange(order + 1), np.arange(order + 1)) <= order)  # degrees of y and x
    there = np.isfinite(z)
    whole = bool(there.all())
    projected = y.T @ (z if whole else np.where(there, z, 0.0)) @ x
    square_y, square_x = ((v[:, :, None] * v[:, None, :]).reshape(len(v), -1) for v in (y, x))
    squares = np.outer(square_y.sum(axis=0), square_x.sum(axis=0)) if whole else square_y.T @ there @ square_x
    gram = squares.reshape([order + 1] * 4)  # degrees of y, twice, and of x, twice
    weights = np.zeros_like(projected)
    weights[a, b] = np.linalg.lstsq(gram[a[:, None], a, b[:, None], b], projected[a, b], rcond=None)[0]
    return replace(topography, heights=z - y @ weights @ x.T, periodic=False)


def gaussian_transmission(q: Array, cutoff: float) -> Array:
    """Share of the amplitude that `smooth` leaves to the wave number `q`, 1/m."""
    return np.asarray(np.exp(-filter_variance(cutoff) * q**2 / 2))


def smooth(topography: Topography, cutoff: float) -> Topography:
    """Apply the areal Gaussian filter of ISO 16610-61 and leave off the margin it cannot reach.

    Of the wavelength `cutoff`, m, half the amplitude is left. Unless it is periodic, the map becomes smaller
    by one cutoff along each edge; ValueError if nothing would be left. No point may be missing.
    """
    radius, shape = _window(topography, cutoff), topography.heights.shape
    size = "{:g} x {:g} m".format(*topography.size)
    if topography.periodic:
        if max(radius) >= min(shape):
            raise ValueError(f"cutoff = {cutoff:g} m: longer than the map of {size}")
        return replace(topography, heights=np.ascontiguousarray(lowpass(topography, cutoff)))
    if any(2 * margin + 8 > n for margin, n in zip(radius, shape, strict=True)):
        raise ValueError(
            f"cutoff = {cutoff:g} m: leaves nothing of a map of {size} after removing a margin of one cutoff"
        )
    inside = tuple(slice(margin, -margin) for margin in radius)
    return replace(topography, heights=np.ascontiguousarray(lowpass(topography, cutoff)[inside]))


def lowpass(topography: Topography, cutoff: float) -> Array:
    """Return what the filter leaves of every point, in m; beyond its edges the map goes on as in a mirror.

    Unless it is periodic. No point may be missing.
    """
    width = math.sqrt(filter_variance(cutoff))
    dx, dy = topography.pixel
    mode: Literal["wrap", "reflect"] = "wrap" if topography.periodic else "reflect"
    rows, columns = topography.heights.shape
    # along x first, into rows of an odd length: down columns a power of two apart the cache holds nothing
    result = np.empty((rows, columns | 1))[:, :columns]
    widths, radius = (width / dx, width / dy), _window(topography, cutoff)[::-1]
    gaussian_filter(topography.heights, widths, mode=mode, radius=radius, axes=(1, 0), output=result)
    return result


def _window(topography: Topography, cutoff: float) -> tuple[int, int]:
    """Half its size along y and x, in points: beyond a cutoff lies a share of 5e-7."""
    dx, dy = topography.pixel
    return max(math.ceil(cutoff / dy), 1), max(math.ceil(cutoff / dx), 1)


def without_offsets(topography: Topography, lines: LinesTo) -> tuple[Topography, float]:
    """Return a map whose lines are shifted by the medians of their differences; and the rms of the shifts, m.

    Medians of the differences between neighbouring lines add up to offsets, and to waves that run across all
    lines. Those that a Gaussian window of ten lines lets pass are kept: half of waves as long as 53 lines.
    """
    z = topography.heights if lines == "rows" else topography.heights.T
    level, last = np.zeros(len(z)), z[0]
    for j in range(1, len(z)):
        steps = z[j] - last
        steps = steps[np.isfinite(steps)]
        level[j] = level[j - 1] + (np.median(steps) if steps.size else 0.0)
        last = z[j] if steps.size else last  # a line without heights is passed over
    offsets = level - gaussian_filter1d(level, 10.0, mode="nearest")
    shifted = z - offsets[:, None]
    heights = shifted if lines == "rows" else np.ascontiguousarray(shifted.T)
    return replace(topography, heights=heights), float(np.sqrt(np.mean(offsets**2)))


def form_left(topography: Topography, form: Form) -> tuple[float, float, Form] | None:
    """Find a polynomial that is more than long waves, on a map that this form was taken off.

    Its share of the variance of heights, its peak to valley in m, and what takes it off. It is of second
    order, or of fourth where that was taken off already. It must hold more than a twentieth of the variance,
    and three times what the longest waves do, two on the map, once it is taken off too. No point may be
    missing.
    """
    more: Form = "quadratic" if ORDERS[form] < ORDERS["quadratic"] else "quartic"
    coarse = coarser(topography, _FINE)
    rest = without_form(coarse, more)
    left, z = coarse.heights - rest.heights, coarser(rest, _COARSE).heights
    power = np.abs(fft.fft2(z) / z.size) ** 2
    along, down = (fft.fftfreq(n) * n for n in z.shape[::-1])
    longest = float(power[np.hypot(along, down[:, None]) < 2.3].sum())  # there are 20 such wave vectors
    variance = float(left.var())
    share = variance / float(topography.heights.var())
    if share < 0.05 or variance < 3 * longest:
        return None
    return share, float(np.ptp(left)), more
