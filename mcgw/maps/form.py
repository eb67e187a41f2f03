"""What is taken off a measured map before it is looked at: its form, and what is finer than the cutoff."""

import math
from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from mcgw.maps.round_forms import round_form
from mcgw.maps.topography import Topography

__all__ = ["FORMS", "ORDERS", "Form", "gaussian_transmission", "lowpass", "smooth", "without_form"]

Array = NDArray[np.float64]
Form = Literal["none", "plane", "quadratic", "cubic", "quartic", "sphere", "cylinder"]
FORMS: tuple[str, ...] = get_args(Form)
ORDERS = {"none": -1, "plane": 1, "quadratic": 2, "cubic": 3, "quartic": 4, "sphere": 2, "cylinder": 2}

_ALPHA = math.sqrt(math.log(2) / math.pi)  # ISO 16610-61: half the amplitude is left at the cutoff
_REACH = 1.0  # of the filter's window, in cutoffs: beyond lies a share of 5e-7


def without_form(topography: Topography, form: Form) -> Topography:
    """Subtract the form of least squares: a polynomial of two coordinates, a sphere or a cylinder.

    Missing points neither count nor get a height. The rest is no longer periodic, unless nothing was taken
    off.
    """
    match form:
        case "none":
            return topography
        case "sphere" | "cylinder":
            shape = round_form(topography, axis=form == "cylinder")
        case _:
            shape = _polynomial(topography.heights, ORDERS[form])
    return replace(topography, heights=np.subtract(topography.heights, shape, out=shape), periodic=False)


def _polynomial(z: Array, order: int) -> Array:
    """Of least squares over the points that are there."""
    y, x = (_powers(n, order) for n in z.shape)
    terms = [(a, b) for a in range(order + 1) for b in range(order + 1 - a)]
    there = np.isfinite(z)
    whole = bool(there.all())
    projected = y.T @ (z if whole else np.where(there, z, 0.0)) @ x
    square_y, square_x = ((v[:, :, None] * v[:, None, :]).reshape(len(v), -1) for v in (y, x))
    squares = np.outer(square_y.sum(axis=0), square_x.sum(axis=0)) if whole else square_y.T @ there @ square_x
    gram = squares.reshape([order + 1] * 4)  # powers a and c of y, b and d of x
    matrix = np.array([[gram[a, c, b, d] for c, d in terms] for a, b in terms])
    found = np.linalg.lstsq(matrix, np.array([projected[a, b] for a, b in terms]), rcond=None)[0]
    weights = np.zeros_like(projected)
    for (a, b), value in zip(terms, found, strict=True):
        weights[a, b] = value
    return np.asarray((y @ weights) @ x.T)


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
    radius = _window(topography, cutoff)
    rows, columns = topography.heights.shape
    if topography.periodic and max(radius) >= min(rows, columns):
        raise ValueError(f"cutoff = {cutoff:g} m: longer than the map of {columns * dx:g} x {rows * dy:g} m")
    if not topography.periodic and (2 * radius[0] + 8 > rows or 2 * radius[1] + 8 > columns):
        raise ValueError(
            f"cutoff = {cutoff:g} m: leaves nothing of a map of {columns * dx:g} x {rows * dy:g} m "
            "without its margin of one cutoff"
        )
    smoothed = lowpass(topography, cutoff)
    if not topography.periodic:
        smoothed = smoothed[radius[0] : rows - radius[0], radius[1] : columns - radius[1]]
    return replace(topography, heights=np.ascontiguousarray(smoothed))


def lowpass(topography: Topography, cutoff: float) -> Array:
    """What the filter leaves of every point, in m; beyond its edges the map goes on as in a mirror.

    Unless it is periodic. No point may be missing.
    """
    width = _ALPHA / math.sqrt(2 * math.pi) * cutoff  # standard deviation of the window
    dx, dy = topography.pixel
    mode: Literal["wrap", "reflect"] = "wrap" if topography.periodic else "reflect"
    widths = (width / dy, width / dx)
    return np.asarray(
        gaussian_filter(topography.heights, widths, mode=mode, radius=_window(topography, cutoff))
    )


def _window(topography: Topography, cutoff: float) -> tuple[int, int]:
    """Half its size along y and x, in points."""
    dx, dy = topography.pixel
    return max(math.ceil(_REACH * cutoff / dy), 1), max(math.ceil(_REACH * cutoff / dx), 1)
