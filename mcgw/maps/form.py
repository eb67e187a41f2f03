"""What is taken off a measured map before it is looked at: its form, and what is finer than the cutoff."""

import math
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from mcgw.maps.topography import Topography

__all__ = ["FORMS", "Form", "gaussian_transmission", "smooth", "without_form"]

Array = NDArray[np.float64]
Form = Literal["none", "plane", "quadratic"]
FORMS: tuple[str, ...] = get_args(Form)

_ALPHA = math.sqrt(math.log(2) / math.pi)  # ISO 16610-61: half the amplitude is left at the cutoff
_REACH = 1.0  # of the filter's window, in cutoffs: beyond lies a share of 5e-7
_ORDER = {"none": -1, "plane": 1, "quadratic": 2}


def without_form(topography: Topography, form: Form) -> Topography:
    """Subtract the plane, or the second-order polynomial, of least squares from a map that lacks no points.

    The rest is no longer periodic, unless nothing was taken off.
    """
    order = _ORDER[form]
    if order < 0:
        return topography
    z = topography.heights
    y, x = (_powers(n, order) for n in z.shape)
    terms = [(a, b) for a in range(order + 1) for b in range(order + 1 - a)]
    projected = y.T @ z @ x
    gram_y, gram_x = y.T @ y, x.T @ x
    matrix = np.array([[gram_y[a, c] * gram_x[b, d] for c, d in terms] for a, b in terms])
    found = np.linalg.lstsq(matrix, np.array([projected[a, b] for a, b in terms]), rcond=None)[0]
    weights = np.zeros_like(projected)
    for (a, b), value in zip(terms, found, strict=True):
        weights[a, b] = value
    return Topography(z - (y @ weights) @ x.T, topography.pixel)


def _powers(n: int, order: int) -> Array:
    t = (np.arange(n) + 0.5) / n * 2 - 1
    return np.asarray(np.polynomial.legendre.legvander(t, order))


def gaussian_transmission(q: Array, cutoff: float) -> Array:
    """Share of the amplitude that `smooth` leaves to the wave number `q`, 1/m."""
    return np.asarray(np.exp(-math.pi * (_ALPHA * cutoff * q / (2 * math.pi)) ** 2))


def smooth(topography: Topography, cutoff: float) -> Topography:
    """Apply the areal Gaussian filter of ISO 16610-61 and leave off the margin it cannot reach.

    Of the wavelength `cutoff`, m, half the amplitude is left. Unless it is periodic, the map becomes smaller
    by one cutoff along each edge. No point may be missing.

    Raises
    ------
    ValueError
        If nothing would be left.
    """
    dx, dy = topography.pixel
    width = _ALPHA / math.sqrt(2 * math.pi) * cutoff  # standard deviation of the window
    mode: Literal["wrap", "reflect"] = "wrap" if topography.periodic else "reflect"
    radius = tuple(max(math.ceil(_REACH * cutoff / p), 1) for p in (dy, dx))
    rows, columns = topography.heights.shape
    if topography.periodic and max(radius) >= min(rows, columns):
        raise ValueError(f"cutoff = {cutoff:g} m: longer than the map of {columns * dx:g} x {rows * dy:g} m")
    if not topography.periodic and (2 * radius[0] + 8 > rows or 2 * radius[1] + 8 > columns):
        raise ValueError(
            f"cutoff = {cutoff:g} m: leaves nothing of a map of {columns * dx:g} x {rows * dy:g} m "
            "without its margin of one cutoff"
        )
    smoothed = gaussian_filter(topography.heights, (width / dy, width / dx), mode=mode, radius=radius)
    if not topography.periodic:
        smoothed = smoothed[radius[0] : rows - radius[0], radius[1] : columns - radius[1]]
    return Topography(np.ascontiguousarray(smoothed), topography.pixel, topography.periodic)
