"""Means of what asperities add under a law of contact, by a quadrature of their own.

Between the heights at which pieces of the law begin, Gauss-Legendre in the root of the penetration on
intervals that shrink towards first touch by halves: formulas have poles and powers there.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

from analytic import ChangEtsionBogy, JacksonGreen, KogutEtsion, Surface, ZhaoMaiettaChang, quantity_of
from analytic.laws import Branch, term_of

ONE = np.array(1.0)
SURFACE = Surface(sigma=1e-6, radius=1e-3, eta=1e9, nominal_area=1e-6, E_star=100e9)
STEEL = JacksonGreen(yield_strength=0.4e9).on(SURFACE)
FOUR = (ChangEtsionBogy(critical=0.05), ZhaoMaiettaChang(critical=0.05), KogutEtsion(critical=0.05), STEEL)
BRIDGED = tuple(replace(law, bridge="hermite") for law in (FOUR[0], FOUR[2], STEEL))

TOP = 13.0  # above every separation: e^-84
X, W = np.polynomial.legendre.leggauss(40)


def name(law):
    return law.name + ("+bridge" if getattr(law, "bridge", None) else "")


def density(s):
    return np.exp(-s * s / 2) / np.sqrt(2 * np.pi)


def ones(s):
    return np.ones_like(s)


def term(quantity, law, penetration, e):
    """What asperities add that are loaded to a penetration, each by the formula of its piece."""
    return term_of(quantity, Branch(law), 0.0, penetration, e)


def starts(law, h, modulus=ones):
    """Penetrations above h at which pieces begin, whatever the grading."""
    if modulus is ones:
        return law.limits(np.array(1.0))
    count = len(law.limits(np.array(1.0)))

    def left(j, s):
        return s - h - law.limits(modulus(np.array(s)))[j]

    s = [brentq(lambda s, j=j: left(j, s), h, 1e4, xtol=1e-15, rtol=1e-15) for j in range(count)]
    return np.array(s) - h


def quadrature(f, breaks):
    """Of f(penetration) from 0 to TOP, cut at the breaks; f goes as some power next to 0."""
    marks = [*np.sqrt([b for b in breaks if 0 < b < TOP]), np.sqrt(TOP)]
    edges = [0.0, *(marks[0] * 2.0 ** -np.arange(40.0, 0, -1))]
    for mark in marks:
        edges += np.linspace(edges[-1], mark, 3 + int(4 * (mark - edges[-1])))[1:].tolist()
    a, b = np.array(edges[:-1])[:, None], np.array(edges[1:])[:, None]
    v = a + (b - a) * (1 + X) / 2
    return float(np.sum((b - a) / 2 * W * 2 * v * f(v * v)))


def mean(law, quantity, h=1.0, modulus=ones):
    return quadrature(
        lambda d: term(quantity, law, d, modulus(h + d)) * density(h + d), starts(law, h, modulus)
    )


def tail(h):
    """Share of the heights above h."""
    return float(ndtr(-h))


def own_terms(scene, quantity, heights, radii):
    """What each summit adds, in SI, by the law on a surface of its own radius: (separations, summits)."""
    terms = []
    for s, radius in zip(heights.tolist(), radii.tolist(), strict=True):
        own = replace(scene.surface, radius=radius)
        branch, e = Branch(scene.law.on(own)), scene.modulus(np.array(s))
        term = term_of(quantity, branch, np.array(scene.separations), s, e)
        terms.append(term * quantity_of(quantity).scale(own))
    return np.array(terms).T
