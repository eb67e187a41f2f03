"""Surfaces whose asperities press each other down, written as on paper: for tests of those.

``strength`` is what the sunk plane feels of the mean load p of an asperity, in reduced units:
``x = h + strength p``, positive where the body is the reference, negative where the mean plane is.
"""

import math
from types import SimpleNamespace

import analytic
from oracles.literal import factor, sums_of_heights

# Of a square under uniform pressure, at its mean; and of a square lattice of point loads.
MEAN_SINKING = 0.9464020088186771
LATTICE = 3.900264920001956

QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance")
SEPARATIONS = (0.0, 0.8, 1.7, 3.0)
STRENGTHS = {"body": 3.0, "mean-plane": -0.25}


def interaction(strength, surface, n):
    """The interaction that is so strong on a surface with `n` asperities, by its bulk modulus."""
    alone = n * factor(surface, "load") / (abs(strength) * surface.sigma)
    if strength > 0:
        modulus = MEAN_SINKING * alone / math.sqrt(surface.nominal_area)
        return analytic.Interaction("body", bulk_modulus=modulus)
    modulus = LATTICE / math.pi * alone / math.sqrt(n * surface.nominal_area)
    return analytic.Interaction("mean-plane", bulk_modulus=modulus)


def literal_sums(scene, heights, felt, quantity):
    """Exactly rounded sums over the asperities of one surface at what they feel."""
    asked = SimpleNamespace(separations=felt, modulus=scene.modulus, surface=scene.surface)
    return sums_of_heights(asked, heights, quantity)
