"""Laws of contact that tests share, and what asperities add under each."""

from dataclasses import replace

import numpy as np

from analytic import ChangEtsionBogy, JacksonGreen, KogutEtsion, Surface, ZhaoMaiettaChang, quantity_of
from analytic.laws import Branch

ONE = np.array(1.0)
SURFACE = Surface(sigma=1e-6, radius=1e-3, eta=1e9, nominal_area=1e-6, E_star=100e9)
STEEL = JacksonGreen(yield_strength=0.4e9).on(SURFACE)
FOUR = (ChangEtsionBogy(critical=0.05), ZhaoMaiettaChang(critical=0.05), KogutEtsion(critical=0.05), STEEL)
BRIDGED = tuple(replace(law, bridge="hermite") for law in (FOUR[0], FOUR[2], STEEL))


def name(law):
    return law.name + ("+bridge" if getattr(law, "bridge", None) else "")


def term(quantity, law, penetration, e):
    """What asperities add that are loaded to a penetration, each by the formula of its piece."""
    return Branch(law).terms([quantity], 0.0, penetration, e)[0]


def own_terms(scene, quantity, heights, radii):
    """What each summit adds, in SI, by the law on a surface of its own radius: (separations, summits)."""
    terms = []
    for s, radius in zip(heights.tolist(), radii.tolist(), strict=True):
        own = replace(scene.surface, radius=radius)
        branch, e = Branch(scene.law.on(own)), scene.modulus(np.array(s))
        (term,) = branch.terms([quantity], np.array(scene.separations), s, e)
        terms.append(term * quantity_of(quantity).scale(own))
    return np.array(terms).T
