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


def sums_of_heights(scene, heights, quantity, exponent=None):
    """Exactly rounded sums over the asperities of one surface, one value a separation."""
    power, modulus = POWERS[quantity]
    power = power if exponent is None else exponent
    values = []
    for h in scene.separations:
        touching = heights[heights > h]
        e = scene.modulus(touching) ** modulus if touching.size else touching
        terms = (touching - h) ** power * e if power else np.ones_like(touching)
        values.append(factor(scene.surface, quantity) * math.fsum(terms.tolist()))
    return np.array(values)


def ensemble_arrays(scene, seed, *, exponent=None, heights=None):
    """An ensemble by a vector expression over NumPy's normals; `heights` transforms them."""
    rng = np.random.default_rng(seed)
    s = rng.standard_normal((scene.n_surfaces, scene.n_asperities))
    s = s if heights is None else heights(s)
    e = scene.grading(s)
    arrays = {}
    for quantity in scene.quantities:
        power, modulus = POWERS[quantity]
        if exponent is not None and quantity == "load":
            power = exponent
        columns = []
        for h in scene.separations:
            d = np.maximum(s - h, 0.0)
            columns.append(((d > 0) * d**power * e**modulus).sum(axis=1))
        arrays[quantity] = factor(scene.surface, quantity) * np.stack(columns, axis=1)
    return arrays


def scores(ensemble):
    """Of all means and variances, in exact standard errors."""
    scene, m, means, variances = ensemble.scene, ensemble.n_surfaces, [], []
    for name in scene.quantities:
        exact, values = scene.theory.cumulants(name, scene.separations), ensemble[name]
        means.append((values.mean(axis=0) - exact.mean) / np.sqrt(exact.variance / m))
        off = values.var(axis=0, ddof=1) / exact.variance - 1
        variances.append(off / np.sqrt(exact.excess_kurtosis / m + 2 / (m - 1)))
    return np.abs(means).max(), np.abs(variances).max()
