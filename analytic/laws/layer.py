"""A spot on a layer of any thickness on a half-space, whose conductivity is another one."""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from analytic.laws.law import PerRadius

_DIRECT = 60  # images that are rather summed one by one
_NEGLIGIBLE = 1e-18  # weight of an image
_ALTERNATING = 24  # terms of an alternating sum, whose error is 5.8 to that power
_SMALLEST = 1e-100  # radius over thickness
_REACH = np.geomspace(1e-4, 1e4, 401)  # radii over thicknesses at which a pole is looked for


@dataclass(frozen=True)
class LayeredSpot(PerRadius):
    """What takes the place of both bodies' resistivities under a spot, of its radius.

    ``rho(a) = 4 a R_1(a) + 1/k_other``. With the flux of an isothermal spot, as ``1/sqrt(1 - r^2/a^2)``, over
    a layer of thickness t and conductivity k on a half-space the mean temperature gives ::

        4 k a R_1 = 1 + (8/pi) sum_n K^n G(2 n t/a),    K = (k - k_under)/(k + k_under)
        G(p) = int_0^inf exp(-p x) sin(x) J_1(x)/x^2 dx = Im [s (s - sqrt(1 + s^2)) - asinh s]/2,  s = p - i

    Thin layers of little conductivity add ``t/(pi k a^2)`` to the half-space, thick ones are a half-space.

    Parameters
    ----------
    thickness : float or ndarray
        Over the unit of radii; one for each summit where these differ in radius.
    conductivity, under, other : float
        Of the layer, the body under it, and the other body, W/(m K).
    """

    of_radius: ClassVar[tuple[str, float]] = ("thickness", -0.5)

    thickness: Any
    conductivity: float
    under: float
    other: float

    def analytic_up_to(self, film: float) -> float:
        """Radius up to which negative ones meet no pole, with a film b rho besides, and no branch point.

        These are at radii of i n t.
        """
        thinnest = float(np.min(self.thickness))
        resists = replace(self, thickness=1.0)(-_REACH) * thinnest * _REACH
        changes = np.flatnonzero((resists > film) != (film == 0))
        return thinnest * float(min([1.0, *_REACH[np.maximum(changes[:1] - 1, 0)]]))

    def __call__(self, radius: Any) -> Any:
        """Resistivity rho of spots, m K/W, in the shape of the radii, negative ones too.

        A small step of a radius into the complex plane gives the derivative.
        """
        radius, thickness = np.broadcast_arrays(radius, self.thickness)
        side = np.where(np.real(radius) < 0, -1.0, 1.0)
        smallest = _SMALLEST * thickness
        over = 2 * thickness / np.where(np.abs(radius) > smallest, side * radius, smallest)
        images = np.zeros_like(over)
        for n, weight in _images((self.conductivity - self.under) / (self.conductivity + self.under)):
            images += weight * _image(n * over)
        return (1 + side * (8 / math.pi) * images) / self.conductivity + 1 / self.other


def _image(p: Any) -> Any:
    """G of what an image of the spot adds, to first order in the imaginary part of p, a small step."""
    s = np.real(p) - 1j
    half = s + np.sqrt(1 + s * s)
    value = -(s / half + np.arcsinh(s)).imag / 2
    return value - 1j * np.imag(p) * (1 / half).imag if np.iscomplexobj(p) else value


@lru_cache(64)
def _images(ratio: float) -> tuple[tuple[int, float], ...]:
    """Images and their weights, whose sum is that of all ``ratio^n``.

    Where many count, by the transformation of van Wijngaarden into an alternating sum, and the acceleration
    of H. Cohen, F. Rodriguez Villegas, D. Zagier, Exp. Math. 9 (2000) 3, algorithm 1.
    """
    size = abs(ratio)
    if size**_DIRECT < _NEGLIGIBLE:
        return tuple((n, ratio**n) for n in range(1, _DIRECT) if size**n > _NEGLIGIBLE)
    found: dict[int, float] = {}
    total = ((3 + math.sqrt(8)) ** _ALTERNATING + (3 - math.sqrt(8)) ** _ALTERNATING) / 2
    b, c, m = -1.0, -total, _ALTERNATING
    for k in range(m):
        c = b - c
        b *= (k + m) * (k - m) / ((k + 0.5) * (k + 1))
        n, times = k + 1, 1.0
        while (weight := times * size**n) > _NEGLIGIBLE:
            found[n] = found.get(n, 0.0) + (c / total) * weight * (1.0 if ratio > 0 else -1.0)
            if ratio < 0:
                break
            n, times = 2 * n, 2 * times
    return tuple(found.items())
