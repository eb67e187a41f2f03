"""The balance of summits that press each other down, by plain loops over all pairs of them."""

import math

import numpy as np


def residual(spots, places, grid, start, balance):
    """What is left of the balance, of the deepest spot; fields are of contacts of spots alone at a start."""
    delta = np.maximum(balance.penetrations, 0)
    loads, z, modulus = spots.loads(delta), spots.heights, spots.E_star
    alone = spots.contact_radii(z - start) ** 2
    alone = [max(x, np.mean([y for y in alone if y > 0])) for x in alone]
    half = (0.5 + 1e-9) * min(grid.size)  # beyond, another image is nearer
    worst = 0.0
    for i in range(z.size):
        pushed = 0.0
        for j in range(z.size):
            value = grid.potential[tuple(places[:, i] - places[:, j])]
            away = [
                abs(a - b) * p for a, b, p in zip(places[:, i], places[:, j], grid.pixel[::-1], strict=True)
            ]
            r = math.hypot(*(min(x, s - x) for x, s in zip(away, grid.size[::-1], strict=True)))
            if i != j and r**2 < 16 * (alone[i] + alone[j]) and r < half:
                a = math.sqrt(1.125 * (alone[i] + alone[j]))
                inside = (2 * a * a - r * r) * math.asin(min(a / r, 1)) + a * math.sqrt(max(r * r - a * a, 0))
                value += 0.75 * inside / a**3 - 1 / r
            pushed += value * loads[j] / (math.pi * modulus)
        gap = z[i] - balance.separation - balance.share * pushed
        worst = max(worst, abs(max(gap, 0) - delta[i]))
    return worst / delta.max()
