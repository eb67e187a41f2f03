"""Laws of contact where each summit has a radius of its own: each as on a surface of that radius."""

from dataclasses import replace

import numpy as np
import pytest

import analytic
from analytic import height_rule, laws, quantity_of
from analytic.laws import Ways, term_of

SURFACE = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e11)
RNG = np.random.default_rng(0)
S, RATIOS = RNG.normal(size=60), RNG.gamma(3, size=60) / 2
MODULI = np.exp(0.3 * S)
FILM = laws.Film(1e-7, 1e-12)
LAWS = {
    "hertz": laws.Hertz(),
    "kogut-etsion": laws.KogutEtsion(hardness=1.2e9),
    "bridged": laws.KogutEtsion(hardness=1.2e9, bridge="hermite"),
    "chang-etsion-bogy": laws.ChangEtsionBogy(hardness=1.2e9),
    "zhao-maietta-chang": laws.ZhaoMaiettaChang(hardness=1.2e9),
    "jackson-green": laws.JacksonGreen(yield_strength=4e8),
    "graded in depth": laws.PowerLawGraded(k=0.3, c0=1e-6),
    "coated": laws.Coated(thickness=1e-7, ratio=2.0),
    "johnson-kendall-roberts": laws.JohnsonKendallRoberts(work=0.05),
    "derjaguin-muller-toporov": laws.DerjaguinMullerToporov(work=0.05),
}
NO_WAY_BACK = ("chang-etsion-bogy", "zhao-maietta-chang", "jackson-green")


def literal(law, name, unload_from, h):
    """Summit by summit, in SI units."""
    q, terms = quantity_of(name), []
    for s, c, e in zip(S, RATIOS, MODULI, strict=True):
        own = replace(SURFACE, radius=SURFACE.radius * c)
        branch = Ways(law.on(own), unload_from, FILM.on(own)).of(name)
        terms.append(float(q.scale(own) * term_of(q.base, branch, h, s, e)))
    return np.array(terms)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("unload_from", [None, -1.0])
def test_each_summit_is_one_of_a_surface_of_its_radius(law, unload_from):
    names = ["load", "area", "stiffness", "conductance", "conductance_si", "contacts"]
    if unload_from is not None:
        if law in NO_WAY_BACK:
            return
        names = ["load_unloading", "area_unloading", "contacts_unloading"]
    ways = Ways(LAWS[law].on(SURFACE), unload_from, FILM.on(SURFACE))
    for name in names:
        for h in (-0.5, 0.2, 5.0):
            found = quantity_of(name).scale(SURFACE) * ways.term(name, h, S, MODULI, RATIOS)
            wanted = literal(LAWS[law], name, unload_from, h)
            assert np.abs(found - wanted).max() <= 1e-13 * max(np.abs(wanted).max(), 1e-300), (name, h)


@pytest.mark.parametrize("law", ["hertz", "kogut-etsion", "johnson-kendall-roberts"])
def test_terms_of_a_rule_are_those_of_its_summits(law, monkeypatch):
    """All quantities on both ways at all separations, found seven summits at a time."""
    monkeypatch.setattr(height_rule, "_TOGETHER", 21)
    names = ["contacts", "load_unloading", "conductance_si", "load", "area_unloading"]
    h = [-0.5, 0.2, 5.0]
    rule = height_rule.HeightRule(S, np.full(S.size, 1 / S.size), 0.0, RATIOS)
    ways = Ways(LAWS[law].on(SURFACE), -1.0, FILM.on(SURFACE))
    terms = rule.terms(names, h, analytic.Custom(lambda s: np.exp(0.3 * s)), ways)
    scales = [quantity_of(name).scale(SURFACE) for name in names]
    for found, scale, name in zip(terms.T.reshape(len(names), 3, -1), scales, names, strict=True):
        wanted = np.array([literal(LAWS[law], name, -1.0, x) for x in h])
        assert np.abs(scale * found - wanted).max() <= 1e-13 * np.abs(wanted).max()
