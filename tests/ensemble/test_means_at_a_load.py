"""Exact means over specimens under a load, where asperities yield or have radii of their own.

Specimens are drawn here, and their separations found by bisection of sums written out.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from oracles.laws_of_one_depth import kogut_etsion

import analytic
import mcgw
from analytic import at_load
from analytic.at_load import specimen_means
from mcgw.sampling.asperities import summits

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=6e-8, E_star=1e11)
NAMES = ["load", "area", "contacts", "conductance", "yielded"]
POISSON, MANY = 0.3, 1000
K = 0.577


def hertz(d, critical):
    return d**1.5, d


def drawn(heights, weight, critical, target, contact):
    """Means of specimens, each at its own separation, and their standard errors."""
    low, high = np.full(len(heights), -6.0), heights.max(axis=1)
    for _ in range(40):
        middle = (low + high) / 2
        sums = (weight * contact(np.maximum(heights - middle[:, None], 0.0), critical=critical)[0]).sum(
            axis=1
        )
        low, high = np.where(sums >= target, middle, low), np.where(sums >= target, high, middle)
    depth = np.maximum(heights - low[:, None], 0.0)
    load, area = contact(depth, critical=critical)
    area = np.where(depth > 0, area, 0.0)
    found = {
        "load": weight * load,
        "area": weight**2 * area,
        "contacts": depth > 0,
        "conductance": weight * np.sqrt(area),
        "yielded": depth >= critical,
    }
    found = {name: terms.sum(axis=1) for name, terms in found.items()} | {"separation": low}
    return {name: (x.mean(), x.std() / np.sqrt(len(x))) for name, x in found.items()}


def residuals(model, target, wanted):
    """In standard errors, of all but the load; and by how much of the load a specimen jumps past it."""
    scale = {name: analytic.quantity_of(name).scale(model.surface) for name in NAMES} | {"separation": 1.0}
    found = specimen_means(model, "load", target * scale["load"], [x for x in NAMES if x in wanted])
    off = {name: (found[name] / scale[name] - mean) / error for name, (mean, error) in wanted.items()}
    beyond = wanted["load"][0] / target - 1
    assert found["load"] / scale["load"] / target - 1 == pytest.approx(beyond, abs=1e-3)
    return np.abs([off[name] for name in off if name != "load"])


@cache
def of_yielding(share):
    """A model of contacts that pass several pieces of Kogut and Etsion's law, a load, and drawn means."""
    hardness = 4e9
    model = analytic.Model(SURFACE, law=analytic.KogutEtsion(hardness=hardness, poisson=POISSON))
    critical = (np.pi * K * hardness / (2 * SURFACE.E_star)) ** 2 * SURFACE.radius / SURFACE.sigma
    target = float(model.mean("load", share)) / analytic.quantity_of("load").scale(SURFACE)
    heights = np.random.default_rng(7).normal(size=(MANY, int(SURFACE.n_asperities)))
    return model, target, drawn(heights, 1.0, critical, target, kogut_etsion)


@pytest.mark.parametrize("h", [pytest.param(2.2, marks=pytest.mark.slow), 1.0])
def test_of_contacts_that_yield(h):
    """About one contact, and ten. Five means, |z| < 5: one false alarm in 3e5 seeds."""
    assert residuals(*of_yielding(h)).max() < 5


def test_without_its_jumps_a_law_is_seen_to_be_wrong(monkeypatch):
    monkeypatch.setattr(at_load, "_jumping", lambda *_: iter(()))
    with pytest.raises(AssertionError):
        assert residuals(*of_yielding(1.0)).max() < 5


@pytest.mark.slow
@pytest.mark.parametrize("law", [None, analytic.KogutEtsion(hardness=4e9, poisson=POISSON)])
def test_of_radii_of_their_own(law):
    """Summits of a Gaussian surface, each with its radius, some six in contact."""
    surface = mcgw.SpectralSurface(m0=1e-12, m2=4e-3, m4=8e7, nominal_area=1e-8, E_star=1e11)
    scene = mcgw.Scene(surface, separations=[-9.0], n_surfaces=3000, seed=3, sampler="direct", law=law)
    pairs = [summits(scene, k) for k in range(scene.n_surfaces)]
    heights, ratios = (np.array(part) for part in zip(*pairs, strict=True))
    model, s = replace(scene.theory, law=law), scene.surface
    critical = (np.pi * K * 4e9 / (2 * s.E_star)) ** 2 * s.radius / s.sigma * ratios
    contact = hertz if law is None else kogut_etsion
    target = float(model.mean("load", 1.5)) / analytic.quantity_of("load").scale(s)
    wanted = drawn(heights, np.sqrt(ratios), critical, target, contact)
    if law is None:
        del wanted["yielded"]
    assert residuals(model, target, wanted).max() < 5
