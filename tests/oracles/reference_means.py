"""Exact means of scenes by a rule that shares nothing with `analytic`: over the share of higher heights.

With ``p = exp(-t)`` the share of the touching heights that lie above s, the mean of f over these is
``int exp(-t) f(s(t)) dt``: no density is asked for, any tail falls at least like a power of p, and a
bounded distribution ends where p does. Panels shrink towards t = 0, where f has a root or the density a
broken power. Under other contact laws than Hertz's every asperity adds what its own formula says, and
panels shrink towards both sides of every height at which another formula begins.
"""

import numpy as np
from numpy.polynomial.legendre import leggauss

import mcgw
from analytic import LAW_QUANTITIES, MeasuredHeights, Quantity, RandomCurvature, quantity_of, resolved_breaks
from analytic.arrays import Array
from analytic.laws import Hertz, term_of

_POINTS = 24
_SMALLEST = -50  # power of two of the panel next to t = 0, which is left out
_WIDEST = 0.5
_STAGES = (50.0, 100.0, 200.0, 400.0)  # after each of these the rest may be negligible
_LAST = 600.0  # p = 1e-260
_NOTHING = 1e-18
_BREAKS = 46.0  # t up to which kinks are looked for: p = 1e-20


def reference(scene: mcgw.Scene, chosen: tuple[int, ...]) -> Array:
    """Exact mean of the first quantity of a scene, SI, at the chosen separations; shape (chosen,)."""
    q = quantity_of(scene.quantities[0])
    of_one = [_one_asperity(scene, q, scene.separations[k]) for k in chosen]
    return scene.n_asperities * q.scale(scene.surface) * np.array(of_one)


def quantiles(scene: mcgw.Scene, h: float, t: Array) -> Array:
    """Heights above which the share ``exp(-t)`` of the heights above `h` lies, rising with t."""
    with np.errstate(under="ignore"):  # a share of 0 is the end of the support
        return np.maximum(scene.heights.isf(np.exp(-t), h), h)


def _one_asperity(scene: mcgw.Scene, q: Quantity, h: float) -> float:
    """Mean contribution of one asperity, in units of the scale."""
    heights, low = scene.heights, lowest(scene, q, h)
    if isinstance(heights, MeasuredHeights):
        s = np.array(heights.heights)
        return float(np.sum(added(scene, q, h, s[s > low]))) / s.size
    touching = float(heights.sf(np.array(low)))
    x, w = leggauss(_POINTS)
    edges = _edges(scene, q, h, touching)
    total = 0.0
    for few in np.split(edges, np.searchsorted(edges, _STAGES)):
        ends = np.append(few, edges[edges > few[-1]][:1])
        half = np.diff(ends)[:, None] / 2
        t = ends[:-1, None] + half * (1 + x)
        s = quantiles(scene, low, t)
        there = np.isfinite(s)
        values = np.exp(-t) * added(scene, q, h, np.where(there, s, low))
        more = float(np.sum(np.where(there, half * w * values, 0.0)))
        total += more
        if abs(more) < _NOTHING * abs(total):
            break
    return touching * total


def added(scene: mcgw.Scene, q: Quantity, h: float, s: Array) -> Array:
    """What asperities at `s` above `h` add, in units of the scale: ``(s - h)^n e(s)`` under Hertz's law."""
    if by_powers(scene, q):
        weight = scene.modulus(s) if q.modulus else np.ones_like(s)
        if isinstance(scene.summits, RandomCurvature):  # of listed summits there is one method alone
            weight = weight * scene.summits.mean(q.radius, s)
        return np.asarray((s - h) ** q.exponent * weight)
    if scene.summits:
        raise ValueError(
            f'contact.law = "{scene.law.name}" with summits.curvature = "random": means are integrals over '
            'heights and radii, which no other rule can check; use curvature = "mean"'
        )
    return term_of(q.base, scene.branch_of(q.name), h, s, scene.modulus(s))


def by_powers(scene: mcgw.Scene, q: Quantity) -> bool:
    """Whether asperities add powers of their approach."""
    return type(scene.law) is Hertz and q.base not in LAW_QUANTITIES


def lowest(scene: mcgw.Scene, q: Quantity, h: float) -> float:
    """Height below which no asperity adds anything."""
    return h if by_powers(scene, q) else scene.branch_of(q.name).lowest(h)


def formula_ends(scene: mcgw.Scene, q: Quantity, h: float, low: float, high: float) -> Array:
    """Heights between two others where the formula changes, increasing."""
    if by_powers(scene, q):
        return np.empty(0)
    found = scene.branch_of(q.name).regimes(scene.modulus, [h], low, high)
    ends = np.unique([found.low, found.high])
    return np.asarray(ends[(low < ends) & (ends < high)])


def _edges(scene: mcgw.Scene, q: Quantity, h: float, touching: float) -> Array:
    """Ends of the panels in t: small ones first, and one at every kink of density, modulus and formula."""
    above, range_ends = scene.heights.sf, quantiles(scene, lowest(scene, q, h), np.array([0.0, _BREAKS]))
    low, high = range_ends.tolist()
    kinks = [*scene.heights.breaks, *resolved_breaks(scene.modulus, low, high)]
    share = above(np.array([b for b in kinks if low < b < high])) / touching
    ends = above(formula_ends(scene, q, h, low, high)) / touching
    t = -np.log(ends[ends > 0])[:, None]
    small = 2.0 ** np.arange(_SMALLEST, 0)
    around = [*t.ravel(), *(t - small).ravel(), *(t + small).ravel()]
    inside = [x for x in around if x > small[0]]
    return np.unique([*small, *np.arange(_WIDEST, _LAST, _WIDEST), *-np.log(share[share > 0]), *inside])
