"""Summits with radii of their own: drawn sums against literal ones, the law of the radii, every crossing."""

import dataclasses
import math

import numpy as np
import pytest
from oracles.accurately import worst_error
from oracles.inside import sampler_of, summits, summits_drawn
from oracles.law_means import own_terms
from oracles.scenes import scene_by
from scipy import stats

import analytic
import mcgw
from mcgw.sampling.own_radii import radius_table

ALPHAS = (1.55, 2.0, 5.0, 50.0)
QUANTITIES = ("load", "area", "stiffness", "conductance", "contacts")


def spectral(alpha=5.0, **changes):
    """A scene of a surface with this bandwidth."""
    moments = analytic.SpectralMoments(1e-12, 1e-3, alpha * 1e-6 / 1e-12)
    surface = mcgw.SpectralSurface(moments.m0, moments.m2, moments.m4, 1e-6, 78.6e9)
    values = {
        "separations": np.linspace(0, 4, 9), "n_asperities": 20_000, "n_surfaces": 20, "seed": 1,
        "quantities": QUANTITIES,
    }  # fmt: skip
    return scene_by(surface, **(values | changes))


H = [-1.0, 0.0, 0.3, 1.0, 2.5]


@pytest.mark.parametrize(("alpha", "changes"), [
    (1.55, {"separations": H}),
    (50.0, {"separations": H, "quantities": ("contacts", "area", "load")}),
    (2.0, {"separations": H, "sampler": "tail"}),
    (5.0, {"grading": analytic.Exponential(2.0)}),
    (5.0, {"grading": analytic.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5])}),
    (5.0, {"grading": lambda s: 1 + 0.3 * np.tanh(s)}),
    (5.0, {"n_asperities": 400_000, "separations": (1.0,), "seed": 2**64 - 1}),
    (5.0, {"separations": (1.0, 1.0 + 1e-9, 1.5), "summits": analytic.RandomCurvature(5.0, 2.0)}),
])  # fmt: skip
def test_sums_are_those_of_the_very_summits(alpha, changes):
    assert worst_error(spectral(alpha, **{"sampler": "cells", **changes}), 2) < 1e-12


@pytest.mark.parametrize("alpha", ALPHAS)
def test_table_is_the_inverse_of_the_law(alpha):
    """Shares of what the table gives, by the law's own distribution function, down to 2^-40 at both ends."""
    curvature = analytic.RandomCurvature(alpha)
    table, rng = radius_table(curvature, -3.0), np.random.default_rng(1)
    s = rng.uniform(-3, 7, 400)
    p = np.concatenate([rng.uniform(0, 0.5, 200), 2.0 ** rng.uniform(-40, -1, 200)])
    for side, of in ((-1, curvature.cdf), (1, curvature.sf)):
        x = 1 - 2 * p
        coarse = side * ((np.floor(np.abs(x) * 2**31) + 0.5) * 2.0**-31)  # as 32 bits give it
        fine = ((1 - np.abs(coarse)) / 2 - p) * -(2.0**33)
        g = (8 / math.sqrt(3 * math.pi)) / table.root_ratios(s, coarse, fine) ** 2
        np.testing.assert_allclose(of(g, s), p, rtol=2e-5, atol=0)
        np.testing.assert_allclose(of(g, s), p, rtol=0, atol=1e-6 if alpha < 2 else 3e-8)


@pytest.mark.parametrize("sampler", ["cells", "tail", "direct"])
def test_means_are_those_of_theory(sampler):
    """|z| < 5 by the exact variance, which exists though the kurtosis of the area does not."""
    scene = spectral(2.0, n_asperities=2000, separations=(0.0, 1.5), sampler=sampler, n_surfaces=400)
    ensemble, theory = mcgw.simulate(scene), scene.theory
    for name in scene.quantities:
        mean, std = (get(name, scene.separations) for get in (theory.mean, theory.std))
        assert (np.abs(ensemble.mean(name) - mean) < 5 * std / 20).all(), name


LAWS = [
    mcgw.KogutEtsion(hardness=1.2e9), mcgw.JacksonGreen(yield_strength=4e8),
    mcgw.JohnsonKendallRoberts(work=0.05), mcgw.PowerLawGraded(k=0.3, c0=1e-6),
]  # fmt: skip


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_each_summit_has_the_law_of_its_own_radius(law):
    scene = spectral(
        law=law, n_asperities=150, separations=(-0.5, 1.0), grading=analytic.Exponential(0.5),
        quantities=("load", "area", "stiffness", "contacts"),
    )  # fmt: skip
    sampler = sampler_of(scene)
    assert sampler.name == "tail"
    drawn = sampler.block(0, 1)
    s, ratios = summits_drawn(scene, sampler, 0)
    for name in scene.quantities:
        sums = own_terms(scene, name, s, scene.surface.radius * ratios).sum(axis=1)
        np.testing.assert_allclose(drawn[name][0], sums, rtol=1e-12)


def test_all_summits_of_a_surface():
    scene = spectral(sampler="cells", n_asperities=5000)
    s, ratios = summits(scene, 0)
    touching = mcgw.radii(scene, 0)
    assert s.size == ratios.size == 5000
    np.testing.assert_allclose(scene.surface.radius * ratios[: touching.size], touching, rtol=1e-15)
    assert stats.kstest(s, lambda x: analytic.Nayak(5.0).cdf(x)).pvalue > 1e-4
    assert np.mean(1 / ratios) == pytest.approx(2.34902690068464 / 2.60588006348224, abs=0.02)


def test_a_wrong_area_is_seen_though_its_kurtosis_is_infinite():
    """The verdict holds areas to theory: of five per cent fewer asperities it would say so."""
    scene = spectral(n_surfaces=400, n_asperities=5000, sampler="cells", separations=(0.0, 1.0, 2.0))
    scene = scene.replace(quantities=("area",))
    ensemble = mcgw.simulate(scene)
    assert np.isinf(scene.theory.cumulants("area", 1.0).excess_kurtosis)
    assert mcgw.compare(ensemble).verdict.agrees
    fewer = dataclasses.replace(ensemble, scene=scene.replace(n_asperities=4760))
    assert not mcgw.compare(fewer).verdict.agrees
