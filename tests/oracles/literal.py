"""Deliberately slow and literal: what the simulator computes, written as one would on paper."""

import math

import numpy as np

# Powers of the approach and of the modulus, and the factor of one asperity, from Hertz' formulas.
POWERS = {
    "load": (1.5, 1), "area": (1.0, 0), "stiffness": (0.5, 1), "contacts": (0.0, 0), "conductance": (0.5, 0),
}  # fmt: skip


def factor(surface, quantity):
    E, R, s = surface.E_star, surface.radius, surface.sigma
    return {
        "load": 4 / 3 * E * R**0.5 * s**1.5,
        "area": math.pi * R * s,
        "stiffness": 2 * E * R**0.5 * s**0.5,
        "contacts": 1.0,
        "conductance": 4 * R**0.5 * s**0.5,
    }[quantity]


def sums_of_heights(scene, heights, quantity):
    """Exactly rounded sums over the asperities of one surface, one value a separation."""
    power, modulus = POWERS[quantity]
    values = []
    for h in scene.separations:
        touching = heights[heights > h]
        e = scene.modulus(touching) ** modulus if touching.size else touching
        terms = (touching - h) ** power * e if power else np.ones_like(touching)
        values.append(factor(scene.surface, quantity) * math.fsum(terms.tolist()))
    return np.array(values)


def scores(ensemble):
    """Of all means and variances, in exact standard errors."""
    scene, m, means, variances = ensemble.scene, ensemble.n_surfaces, [], []
    for name in scene.quantities:
        exact, values = scene.theory.cumulants(name, scene.separations), ensemble[name]
        means.append((values.mean(axis=0) - exact.mean) / np.sqrt(exact.variance / m))
        off = values.var(axis=0, ddof=1) / exact.variance - 1
        variances.append(off / np.sqrt(exact.excess_kurtosis / m + 2 / (m - 1)))
    return np.abs(means).max(), np.abs(variances).max()
