"""Spheres and cylinders of least squares under a map."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from mcgw.maps.topography import Topography

__all__ = ["round_form"]

Array = NDArray[np.float64]

_POINTS = 96  # along each axis that are looked at: a form is smooth
_AXES = 4  # directions that are tried first


def round_form(topography: Topography, *, axis: bool) -> Array:
    """Heights of the sphere, or of the cylinder along an axis, that is nearest to a map, in m.

    Least squares of distances along z. It may be tilted, hollow or flat: its parameters are height, two
    slopes and curvature in the middle of the map, and the direction of the axis.

    Raises
    ------
    ValueError
        If the map does not lie on one sheet of the form.
    """
    rows, columns = topography.heights.shape
    unit = max(topography.size) / 2
    y, x = (
        (np.arange(n) + 0.5 - n / 2) * p / unit
        for n, p in zip((rows, columns), topography.pixel[::-1], strict=True)
    )
    j, i = (np.unique(np.linspace(0, n - 1, _POINTS).astype(int)) for n in (rows, columns))
    some = topography.heights[np.ix_(j, i)] / unit
    there = np.isfinite(some)
    u, v = (np.broadcast_to(t, some.shape)[there] for t in (x[i], y[j][:, None]))
    level, scale = float(some[there].mean()), float(np.ptp(some[there])) or 1.0

    def misfit(p: Array) -> Array:
        return np.asarray((level + scale * _height(u, v, p, scale, axis=axis) - some[there]) / scale)

    turns = [math.pi * k / _AXES for k in range(_AXES)] if axis else [0.0]
    starts = (np.array([0.0, 0.0, 0.0, bend, turn]) for turn in turns for bend in (1.0, -1.0))
    found = min((least_squares(misfit, start, method="lm") for start in starts), key=lambda f: float(f.cost))
    shape = unit * (level + scale * _height(x, y[:, None], found.x, scale, axis=axis))
    return np.asarray(shape)


def _height(u: Array, v: Array, p: Array, scale: float, *, axis: bool) -> Array:
    """Of a sphere or cylinder above the middle of a map, over `scale`; u and v are lengths.

    With curvature c and unit normal n in the middle, points X of a sphere have ``c |X|^2 = 2 n X``; of a
    cylinder, whose axis has the direction a, ``c (|X|^2 - (a X)^2) = 2 n X``: a quadratic equation for the
    height, whose smaller root stays regular where c vanishes.
    """
    height, slope_x, slope_y, bend, turn = p
    along, across = scale * slope_x, scale * slope_y
    upright = 1 / math.sqrt(1 + along**2 + across**2)
    flat = -upright * (along * u + across * v)  # n X without the height
    c = scale * bend
    square, with_height, of_height = u * u + v * v, 0.0, 1.0
    if axis:
        cos, sin = math.cos(turn), math.sin(turn)
        rise = along * cos + across * sin
        length = math.sqrt(1 + rise**2)
        beside = (cos * u + sin * v) / length  # a X without the height
        up = rise / length
        square, with_height, of_height = square - beside**2, up * beside, 1 - up**2
    first = upright + c * with_height
    under = first**2 - of_height * c * (c * square - 2 * flat)
    root = np.sqrt(np.maximum(under, 0.0))
    return np.asarray(height + (c * square - 2 * flat) / (first + root) / scale)
