"""Exact statistics of a scene by plain quadrature: densities from scipy.stats, Hertz from `oracles.literal`.

Nothing here is taken from `analytic` but the grading, which is a formula.
"""

import math

import numpy as np
import scipy.stats

import analytic
from oracles.literal import POWERS, factor

_X, _W = np.polynomial.legendre.leggauss(24)
UNITS = {"load": "N", "area": "m^2", "stiffness": "N/m", "contacts": "1", "conductance": "m"}


def heights_of(scene):
    """Law of the reduced heights, as scipy has it."""
    law = scene.heights
    if isinstance(law, analytic.Gaussian):
        return scipy.stats.norm()
    if isinstance(law, analytic.ExponentialHeights):
        return scipy.stats.expon(loc=-1)
    if isinstance(law, analytic.Weibull):
        c = law.shape
        mean = math.gamma(1 + 1 / c)
        std = math.sqrt(math.gamma(1 + 2 / c) - mean**2)
        return scipy.stats.weibull_min(c, loc=-mean / std, scale=1 / std)
    raise TypeError(law)


def nodes(scene, h):
    """Heights above `h` and their probabilities: 250 panels in the root of the approach."""
    law = heights_of(scene)
    low, top = max(law.support()[0], -12.0, h), max(law.isf(1e-40), h + 1)
    edges = np.linspace(math.sqrt(low - h), math.sqrt(top - h), 251)
    half = np.diff(edges)[:, None] / 2
    v = edges[:-1, None] + half * (1 + _X)
    s = h + v * v
    return s.ravel(), (half * _W * 2 * v * law.pdf(s)).ravel()


def term(scene, quantity, s, h):
    """What an asperity of height `s` adds, SI."""
    power, modulus = POWERS[quantity]
    d = np.maximum(s - h, 0.0)
    value = (d > 0) * d**power
    return factor(scene.surface, quantity) * (value * scene.grading(s) if modulus else value)


def mean(scene, quantity, separations=None):
    """Exact mean of a surface of the scene, at its separations or others."""
    found = []
    for h in scene.separations if separations is None else separations:
        s, p = nodes(scene, h)
        found.append(scene.n_asperities * float(p @ term(scene, quantity, s, h)))
    return np.array(found)


def covariance(scene, columns):
    """Covariance over surfaces of (quantity, separation) pairs."""
    n = scene.n_asperities
    matrix = np.empty((len(columns), len(columns)))
    for i, (a, g) in enumerate(columns):
        for j, (b, h) in enumerate(columns[: i + 1]):
            s, p = nodes(scene, max(g, h))
            both = float(p @ (term(scene, a, s, g) * term(scene, b, s, h)))
            means = mean(scene, a, [g])[0] * mean(scene, b, [h])[0] / n**2
            matrix[i, j] = matrix[j, i] = n * (both - means * (scene.count == "fixed"))
    return matrix


def std(scene, quantity):
    """Exact standard deviation over surfaces, at each separation."""
    return np.array([math.sqrt(covariance(scene, [(quantity, h)])[0, 0]) for h in scene.separations])


def share_above(scene, h):
    """Share of the asperities that touch."""
    return heights_of(scene).sf(h)
