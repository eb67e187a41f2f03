"""Exact means and scatter of specimens under a load, of few and many asperities.

They may be elastic, yield, or have radii of their own.

Specimens are drawn here, and their separations found by bisection of sums written out.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from oracles.laws_of_one_depth import kogut_etsion

import analytic
import mcgw
from analytic.at_load import specimen_moments

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=6e-8, E_star=1e11)
NAMES = ["load", "area", "contacts", "conductance", "yielded"]
POISSON, MANY = 0.3, 1000
K = 0.577


def hertz(d, critical):
    return d**1.5, d


def drawn(heights, weight, critical, target, contact):
    """Means and scatter of specimens, each at its own separation, and their standard errors."""
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
    return {name: statistics(x) for name, x in found.items()}


def statistics(x):
    """Mean and standard deviation, each with its standard error."""
    far, m = (x - x.mean()) / (x.std() or 1.0), len(x)
    kurtosis = max(np.mean(far**4), 1.0)
    return x.mean(), x.std() / np.sqrt(m), x.std(), x.std() * np.sqrt((kurtosis - 1) / m) / 2


def residuals(model, target, wanted):
    """In standard errors, of all but the load; and by how much of the load a specimen jumps past it."""
    scale = {name: analytic.quantity_of(name).scale(model.surface) for name in NAMES} | {"separation": 1.0}
    load = target * scale["load"]
    found, std = specimen_moments(model, "load", load, [x for x in NAMES if x in wanted])
    off = []
    for name, (mean, error, scatter, its_error) in wanted.items():
        if name != "load":
            off.append((found[name] / scale[name] - mean) / (error + 1e-6 * abs(mean)))
            off.append((std[name] / scale[name] - scatter) / (its_error + 2e-4 * scatter + 1e-5 * abs(mean)))
    beyond = wanted["load"][0] / target - 1
    assert found["load"] / load - 1 == pytest.approx(beyond, abs=1e-3)
    assert std["load"] / load == pytest.approx(wanted["load"][2] / target, abs=5e-3)
    return np.abs(off)


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
    """About one contact, and ten. Ten numbers, |z| < 5: one false alarm in 1e5 seeds."""
    assert residuals(*of_yielding(h)).max() < 5


@pytest.mark.parametrize(
    ("n", "contacts", "count"),
    [(2, 0.3, "fixed"), (5, 2, "fixed"), (100, 1, "fixed"), (100, 20, "fixed"), (100, 1, "poisson"),
     (100, 20, "poisson"), pytest.param(3000, 300, "fixed", marks=pytest.mark.slow)],
)  # fmt: skip
def test_of_elastic_contacts(n, contacts, count):
    """Six numbers, |z| < 5: one false alarm in 3e5 seeds."""
    surface, grading = replace(SURFACE, nominal_area=n / SURFACE.eta), analytic.Exponential(0.5)
    model, target = analytic.Model(surface, grading=grading, count=count), contacts * 0.1
    rng, many = np.random.default_rng(11), 200_000 // n + 400
    s = rng.normal(size=(many, n if count == "fixed" else 2 * n))
    if count == "poisson":
        s[np.arange(2 * n) >= rng.poisson(n, many)[:, None]] = -99.0  # is not there
    e, low, high = (1 + np.exp(-s)) / 2, np.full(many, -8.0), s.max(axis=1)
    for _ in range(50):
        middle = (low + high) / 2
        beyond = (e * np.maximum(s - middle[:, None], 0.0) ** 1.5).sum(axis=1) > target
        low, high = np.where(beyond, middle, low), np.where(beyond, high, middle)
    d = np.maximum(s - low[:, None], 0.0)
    sums = {"area": d.sum(axis=1), "contacts": (d > 0).sum(axis=1), "separation": low}
    wanted = {name: statistics(x) for name, x in sums.items()} | {"load": (target, 0.0, 0.0, 0.0)}
    assert residuals(model, target, wanted).max() < 5


def test_of_one_asperity_alone():
    """Surfaces are drawn: the load of each is that of one contact, as are its area and approach."""
    surface = replace(SURFACE, nominal_area=1 / SURFACE.eta)
    found = mcgw.solve(mcgw.Scene(surface, separations=0.0, n_surfaces=200, seed=4), load=1e-3)
    depth = (1e-3 / (4 / 3 * surface.E_star * np.sqrt(surface.radius))) ** (2 / 3)
    assert found.value["area"] == pytest.approx(np.pi * surface.radius * depth, rel=1e-9)
    assert found.std["area"] == pytest.approx(0, abs=1e-9 * found.value["area"])
    assert found.std["separation"] == pytest.approx(1, abs=0.3)
