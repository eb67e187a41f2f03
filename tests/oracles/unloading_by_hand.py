"""Etsion, Kligerman and Kadin's unloading, typed in: what one asperity carries, and integrals over heights.

Independent of `analytic.laws` but for the loading typed in beside it.
"""

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from oracles.laws_by_hand import kogut_etsion

TOP = 11.0  # e^-60


def carried(quantity, s, h, deepest, e=1.0, critical=0.05):
    """Load, area, number or radius of a contact of height s, at h, after `deepest`."""
    most, delta, dc = s - deepest, s - h, critical / e**2
    if delta <= 0:
        return 0.0
    x = most / dc
    law = kogut_etsion(critical)
    piece = sum(x >= limit for limit in (1, 6, 110))
    power = {"load": 1.5, "area": 1.0, "conductance": 0.5, "contacts": 0.0}[quantity]
    if piece == 0:
        return delta**power * (e if quantity == "load" else 1.0)
    residual = most * (1 - x**-0.28) * (1 - x**-0.69)
    if delta <= residual:
        return 0.0
    share = (delta - residual) / (most - residual)
    if quantity == "load":
        return law.load(piece, math.sqrt(most), e) * share ** (1.5 * x**-0.0331)
    return law.radius(piece, math.sqrt(most), e) ** (2 * power) * share ** (power * x**-0.12)


def ends(h, deepest, modulus=lambda _: 1.0, critical=0.05):
    """Heights at which an asperity lost or kept, elastic or not, changes, found on a grid and by Brent."""

    def touching(s):
        x = max((s - deepest) * modulus(s) ** 2 / critical, 1.0)
        return s - h - (s - deepest) * (1 - x**-0.28) * (1 - x**-0.69)

    def gaps():
        yield touching
        for factor in (1, 6, 110):
            yield lambda s, factor=factor: s - deepest - factor * critical / modulus(s) ** 2

    found, grid = [h, TOP], np.linspace(h, TOP, 1000)
    for gap in gaps():
        held = [gap(s) >= 0 for s in grid]
        for k in np.flatnonzero(np.diff(held)):
            found.append(brentq(gap, grid[k], grid[k + 1], xtol=1e-15, rtol=1e-15))
    return sorted(s for s in found if s >= h)


def density(s):
    return math.exp(-s * s / 2) / math.sqrt(2 * math.pi)


def integral(f, marks, density=density):
    """Of f(s) over the heights, by scipy's adaptive rule, on pieces that shrink to both of their ends."""
    total = []
    for a, b in pairwise(sorted(marks)):
        width = b - a
        shrink = [width / 2 * 8.0**-k for k in range(11)]
        edges = sorted({a, b, *(a + x for x in shrink), *(b - x for x in shrink)})
        for left, right in pairwise(edges):
            total.append(quad(lambda s: f(s) * density(s), left, right, epsabs=1e-15, epsrel=1e-11)[0])
    return math.fsum(total)
