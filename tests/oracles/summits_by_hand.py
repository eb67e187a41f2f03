"""Measured summits against a flat, in plain Python."""

import math
from types import SimpleNamespace

import numpy as np


def summit_contact(heights, radii, E_star, separations):
    """Hertz by the radius a of each spot: P = 4 E a^3/(3 R), A = pi a^2, K = 2 E a; rows of one surface."""
    load, area, stiffness, contacts = [], [], [], []
    for d in separations:
        spots = [(math.sqrt(r * (z - d)), r) for z, r in zip(heights, radii, strict=True) if z > d]
        load.append(math.fsum(4 * E_star * a**3 / (3 * r) for a, r in spots))
        area.append(math.fsum(math.pi * a * a for a, _ in spots))
        stiffness.append(math.fsum(2 * E_star * a for a, _ in spots))
        contacts.append(len(spots))
    found = {"load": load, "area": area, "stiffness": stiffness, "contacts": contacts}
    return SimpleNamespace(**{name: np.array([values]) for name, values in found.items()})
