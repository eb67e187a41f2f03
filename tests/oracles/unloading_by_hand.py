"""Etsion, Kligerman and Kadin's unloading, typed in: what asperities carry, and integrals over heights.

Independent of `analytic.laws` but for the loading typed in beside it.
"""

from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from oracles.laws_by_hand import kogut_etsion, over_pieces

TOP = 11.0  # e^-60


def carried(quantity, s, h, deepest, e=1.0, critical=0.05):
    """Load, area, number or radius of contacts of heights s, at h, after `deepest`."""
    s, e = np.broadcast_arrays(np.asarray(s, dtype=float), e)
    law, power = (
        kogut_etsion(critical),
        {"load": 1.5, "area": 1.0, "conductance": 0.5, "contacts": 0.0}[quantity],
    )
    most, delta = np.maximum(s - deepest, 0), np.maximum(s - h, 0)
    x = most * e**2 / critical
    values = delta**power * (e if quantity == "load" else 1.0)  # of those that stayed elastic
    for piece, (low, high) in enumerate(pairwise((1, 6, 110, np.inf)), start=1):
        here = (x >= low) & (x < high)
        deep, ratio = most[here], x[here]
        residual = deep * (1 - ratio**-0.28) * (1 - ratio**-0.69)
        share = np.maximum(delta[here] - residual, 0) / (deep - residual)
        if quantity == "load":
            loaded, power_of = law.load(piece, np.sqrt(deep), e[here]), 1.5 * ratio**-0.0331
        else:
            loaded, power_of = law.radius(piece, np.sqrt(deep), e[here]) ** (2 * power), power * ratio**-0.12
        values[here] = np.where(share > 0, loaded * share**power_of, 0)
    return np.where(delta > 0, values, 0)


def ends(h, deepest, modulus=np.ones_like, critical=0.05):
    """Heights at which an asperity lost or kept, elastic or not, changes, found on a grid and by Brent."""

    def touching(s):
        x = np.maximum((s - deepest) * modulus(s) ** 2 / critical, 1.0)
        return s - h - (s - deepest) * (1 - x**-0.28) * (1 - x**-0.69)

    def gaps():
        yield touching
        for factor in (1, 6, 110):
            yield lambda s, factor=factor: s - deepest - factor * critical / modulus(s) ** 2

    found, grid = [h, TOP], np.linspace(h, TOP, 1000)
    for gap in gaps():
        held = gap(grid) >= 0
        for k in np.flatnonzero(np.diff(held)):
            found.append(brentq(gap, grid[k], grid[k + 1], xtol=1e-15, rtol=1e-15))
    return sorted(s for s in found if s >= h)


def density(s):
    return np.exp(-s * s / 2) / np.sqrt(2 * np.pi)


def integral(f, marks, density=density):
    """Of f(s) over the heights, by Gauss's rule on pieces that shrink to both of their ends."""
    edges = []
    for a, b in pairwise(sorted(marks)):
        shrink = [(b - a) / 2 * 8.0**-k for k in range(13)]
        edges += [a, b, *(a + x for x in shrink), *(b - x for x in shrink)]
    return over_pieces(lambda s: f(s) * density(s), np.unique(edges))
