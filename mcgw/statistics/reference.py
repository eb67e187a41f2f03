"""Exact means by a rule that shares nothing with `analytic`: over the share of higher heights.

With ``p = exp(-t)`` the share of the touching heights that lie above s, the mean of f over these is
``int exp(-t) f(s(t)) dt``: no density is asked for, any tail falls at least like a power of p, and a
bounded distribution ends where p does. Panels shrink towards t = 0, where f has a root or the density a
broken power.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from analytic import MeasuredHeights, Quantity, quantity_of, resolved_breaks
from mcgw.scene.scene import Scene

__all__ = ["quantiles", "reference"]

Array = NDArray[np.float64]

_POINTS = 24
_SMALLEST = -50  # power of two of the panel next to t = 0, which is left out
_WIDEST = 0.5
_STAGES = (50.0, 100.0, 200.0, 400.0)  # after each of which the rest may be below a last digit
_LAST = 600.0  # p = 1e-260
_NOTHING = 1e-18
_BREAKS = 46.0  # t up to which kinks are looked for: p = 1e-20


def reference(scene: Scene, chosen: tuple[int, ...]) -> Array:
    """Exact mean of the first quantity of a scene, SI, at the chosen separations; shape (chosen,)."""
    q = quantity_of(scene.quantities[0])
    of_one = [_one_asperity(scene, q, scene.separations[k]) for k in chosen]
    return scene.n_asperities * q.scale(scene.surface) * np.array(of_one)


def quantiles(scene: Scene, h: float, t: Array) -> Array:
    """Heights above which the share ``exp(-t)`` of the heights above `h` lies, rising with t."""
    with np.errstate(under="ignore"):  # a share of 0 is the end of the support
        return np.maximum(scene.heights.from_above(np.exp(-t), h), h)


def _one_asperity(scene: Scene, q: Quantity, h: float) -> float:
    """Mean of ``(s - h)_+^n e(s)``."""
    heights = scene.heights
    if isinstance(heights, MeasuredHeights):
        s = np.array(heights.heights)
        return float(np.sum(_term(scene, q, h, s[s > h]))) / s.size
    touching = float(heights.above(np.array(h)))
    if not touching > 0:
        return 0.0
    x, w = leggauss(_POINTS)
    edges = _edges(scene, h, touching)
    total = 0.0
    for few in np.split(edges, np.searchsorted(edges, _STAGES)):
        ends = np.append(few, edges[edges > few[-1]][:1])
        half = np.diff(ends)[:, None] / 2
        t = ends[:-1, None] + half * (1 + x)
        s = quantiles(scene, h, t)
        there = np.isfinite(s)
        values = np.exp(-t) * _term(scene, q, h, np.where(there, s, h))
        more = float(np.sum(np.where(there, half * w * values, 0.0)))
        total += more
        if abs(more) < _NOTHING * abs(total):
            break
    return touching * total


def _term(scene: Scene, q: Quantity, h: float, s: Array) -> Array:
    modulus = scene.modulus(s) if q.modulus else np.ones_like(s)
    return np.asarray((s - h) ** q.exponent * modulus)


def _edges(scene: Scene, h: float, touching: float) -> Array:
    """Ends of the panels in t: small ones first, and one at every kink of density and modulus."""
    lowest, highest = quantiles(scene, h, np.array([0.0, _BREAKS]))
    kinks = [*scene.heights.breaks, *resolved_breaks(scene.modulus, float(lowest), float(highest))]
    share = scene.heights.above(np.array([b for b in kinks if lowest < b < highest])) / touching
    small = 2.0 ** np.arange(_SMALLEST, 0)
    return np.unique([*small, *np.arange(_WIDEST, _LAST, _WIDEST), *-np.log(share[share > 0])])
