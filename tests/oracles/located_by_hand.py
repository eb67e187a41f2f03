"""The balance of summits that press each other down, by plain loops over all pairs of them."""

import math

import numpy as np

from mcgw.elasticity.spots import HertzSpots


def residual(one, balance):
    """What is left of the balance, by plain loops over pairs and images' potential; of the deepest spot."""
    z, modulus = one.spots.heights, one.spots.E_star
    delta = np.maximum(balance.penetrations, 0)
    if isinstance(one.spots, HertzSpots):
        radii = one.spots.radii
        a2, loads = radii * delta, 4 / 3 * modulus * np.sqrt(radii) * delta**1.5
    else:
        a2, loads = one.spots.squared_radius(delta), one.spots.load(delta)
    rows, columns = one.places
    alone = one.spots.squared_radius(z - balance.start)
    reach = 16 * np.maximum(alone, alone.mean(where=alone > 0))
    half = (0.5 + 1e-9) * min(one.grid.size)  # beyond, another image is nearer
    worst = 0.0
    for i in range(z.size):
        pushed = 0.0
        for j in range(z.size):
            offset = rows[i] - rows[j], columns[i] - columns[j]
            value = one.grid.potential[offset]
            dy, dx = (abs(o) * p for o, p in zip(offset, one.grid.pixel[::-1], strict=True))
            if one.grid.periodic:
                dx, dy = min(dx, one.grid.size[0] - dx), min(dy, one.grid.size[1] - dy)
            r2, a = dx * dx + dy * dy, math.sqrt(1.125 * (a2[i] + a2[j]))
            if i != j and a > 0 and r2 < reach[i] + reach[j] and math.sqrt(r2) < half:
                r = math.sqrt(r2)
                angle = math.asin(min(a / r, 1))
                inside = (2 * a * a - r2) * angle + a * math.sqrt(max(r2 - a * a, 0))
                value += 0.75 * inside / a**3 - 1 / r
            pushed += value * loads[j] / (math.pi * modulus)
        gap = z[i] - balance.separation - pushed
        worst = max(worst, abs(max(gap, 0) - delta[i]))
    return worst / delta.max()
