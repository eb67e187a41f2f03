"""Surfaces whose asperities press each other down: against literal sums, identities, and each other."""

import dataclasses

import interacting_by_hand as hand
import numpy as np
import pytest
import scipy.stats
from conftest import SURFACE
from interacting_by_hand import QUANTITIES, SEPARATIONS, STRENGTHS, interaction, literal_sums
from oracles import factor
from scipy.stats import ks_2samp

import analytic
import mcgw

GRADINGS = {
    "exponential": analytic.Exponential(2.0),
    "table": analytic.Table((-1.0, 0.5, 2.0), (0.8, 1.3, 1.1)),
    "own": analytic.Custom(lambda s: 1 + 0.3 * np.tanh(s)),
}
HEIGHTS = {
    "Weibull": analytic.Weibull(2.0),
    "Nayak": analytic.Nayak(5.0),
    "exponential": analytic.ExponentialHeights(),
    "uniform": scipy.stats.uniform(),
}


def check_against_literal_sums(scene, surface=1, tolerance=1e-12):
    """Every quantity at what the asperities feel, and that x = h + c P; stiffness in series."""
    ensemble, alone = mcgw.simulate(scene), mcgw.heights(scene, surface)
    felt = ensemble["effective_separation"][surface]
    c = scene.interaction.compliance(scene.surface, scene.n_asperities)
    for name in scene.quantities:
        expected = literal_sums(scene, alone, felt, name)
        if name == "stiffness":
            expected = expected / (1 + c * expected)
        np.testing.assert_allclose(ensemble[name][surface], expected, rtol=tolerance, err_msg=name)
    sunk = c / scene.surface.sigma * ensemble["load"][surface]
    np.testing.assert_allclose(felt, np.array(scene.separations) + sunk, rtol=0, atol=1e-13)
    assert np.abs(sunk).max() > 0.02


@pytest.mark.parametrize("strength", STRENGTHS.values(), ids=STRENGTHS)
class TestLiteralSums:
    @pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
    def test_gradings(self, pressed, strength, grading):
        check_against_literal_sums(pressed(strength, grading=grading))

    @pytest.mark.parametrize("heights", HEIGHTS.values(), ids=HEIGHTS)
    def test_heights(self, pressed, strength, heights):
        h = (-0.5, 0.3, 1.2)
        asked = {"heights": heights, "separations": h, "grading": GRADINGS["table"]}
        check_against_literal_sums(pressed(strength, **asked))

    @pytest.mark.parametrize("count", ["fixed", "poisson"])
    @pytest.mark.parametrize("n", [300, 10**5, 10**6])
    def test_numbers(self, pressed, strength, n, count):
        surfaces = {"n_surfaces": 2, "n_asperities": n, "count": count}
        check_against_literal_sums(pressed(strength, grading=analytic.Exponential(1.5), **surfaces))


def test_sums_where_the_plane_does_not_sink_fail(pressed):
    """What the tests above say is not said by sums at the separations asked."""
    scene = pressed(3.0)
    found = mcgw.simulate(scene)["load"][1]
    naive = literal_sums(scene, mcgw.heights(scene, 1), scene.separations, "load")
    assert naive[0] > 1.5 * found[0]


@pytest.mark.parametrize("strength", STRENGTHS.values(), ids=STRENGTHS)
def test_stiffness_is_the_slope_of_the_load_of_one_surface(pressed, strength):
    """By separations a little higher and lower, at each of which the surface finds its balance."""
    step = 1e-4
    h = tuple(1.0 + k * step for k in (-2, -1, 0, 1, 2))
    ensemble = mcgw.simulate(pressed(strength, separations=h))
    load = ensemble["load"]
    slope = -(load[:, 0] - 8 * load[:, 1] + 8 * load[:, 3] - load[:, 4]) / (12 * step)
    sigma = ensemble.scene.surface.sigma
    np.testing.assert_allclose(ensemble["stiffness"][:, 2], slope / sigma, rtol=1e-5)  # some touch anew
    c = ensemble.scene.interaction.compliance(ensemble.scene.surface, 3000)
    alone = 1 / (1 / ensemble["stiffness"][:, 2] - c)
    assert (np.abs(alone * sigma / slope - 1) > 0.02).all()


@pytest.mark.parametrize("strength", STRENGTHS.values(), ids=STRENGTHS)
def test_the_two_forms_agree(pressed, strength):
    """What one surface feels, given as effective separations, has the nominal ones beside it."""
    nominal = mcgw.simulate(pressed(strength))
    for surface in (0, 3):
        felt = tuple(nominal["effective_separation"][surface].tolist())
        effective = mcgw.simulate(pressed(strength, "effective", separations=SEPARATIONS + felt))
        heights = mcgw.heights(effective.scene, surface)
        c = effective.scene.interaction.compliance(effective.scene.surface, 3000)
        beside = effective["nominal_separation"][surface]
        loads = literal_sums(effective.scene, heights, felt, "load")
        back = np.array(felt) - c / effective.scene.surface.sigma * loads
        np.testing.assert_allclose(beside[len(SEPARATIONS) :], back, rtol=0, atol=1e-12)
    again = balanced_by_effective_form(nominal, 0)
    np.testing.assert_allclose(again, SEPARATIONS, rtol=0, atol=1e-12)


def balanced_by_effective_form(nominal, surface):
    """Nominal separations of the very asperities of a surface, told as a list, at what they felt."""
    scene, heights = nominal.scene, mcgw.heights(nominal.scene, surface, untouched=True)
    felt = nominal["effective_separation"][surface]
    mean, spread = heights.mean(), heights.std()
    own = dataclasses.replace(scene.surface, sigma=spread * scene.surface.sigma)
    listed = mcgw.Scene(
        own,
        heights=mcgw.MeasuredHeights(heights),
        grading=lambda s: scene.grading(mean + spread * s),
        separations=(felt - mean) / spread,
        n_surfaces=1,
        n_asperities=heights.size,
        interaction=dataclasses.replace(scene.interaction, at="effective"),
        seed=1,
    )
    return mean + spread * mcgw.simulate(listed)["nominal_separation"][0]


def test_effective_separations_change_the_stiffness_alone(pressed):
    """All else has the bits of surfaces without interaction; compliances add."""
    for sampler in ("direct", "tail", "cells", "aggregate"):
        scene = pressed(3.0, "effective", sampler=sampler, n_asperities=400)
        with_, without = mcgw.simulate(scene), mcgw.simulate(scene.replace(interaction=None))
        c = scene.interaction.compliance(scene.surface, 400)
        for name in set(QUANTITIES) - {"stiffness"}:
            np.testing.assert_array_equal(with_[name], without[name])
        touched = without["stiffness"] > 0
        apart = 1 / without["stiffness"][touched]
        np.testing.assert_allclose(1 / with_["stiffness"][touched], apart + c, rtol=1e-12)
        sunk = c / scene.surface.sigma * without["load"]
        np.testing.assert_array_equal(with_["nominal_separation"], np.array(SEPARATIONS) - sunk)


SAME = 1e-7  # false alarm of each comparison of two samples


@pytest.fixture(scope="module")
def laws_by_sampler():
    """Small surfaces of strength 3 drawn by every sampler that finds balances; and wrong strengths."""

    def drawn(sampler, seed, strength=3.0, n_surfaces=1200):
        scene = mcgw.Scene(
            SURFACE,
            separations=(0.4, 1.2),
            grading=analytic.Exponential(2.0),
            quantities=QUANTITIES,
            n_asperities=300,
            n_surfaces=n_surfaces,
            sampler=sampler,
            seed=seed,
            interaction=interaction(strength, SURFACE, 300),
        )
        return mcgw.simulate(scene)

    return {
        "cells": drawn("cells", 1, n_surfaces=4000),
        "tail": drawn("tail", 2, n_surfaces=600),
        "direct": drawn("direct", 3, n_surfaces=600),
        "sinking of the centre": drawn(
            "cells", 4, 3.0 * hand.SINKING_OF_THE_CENTRE / hand.MEAN_SINKING, n_surfaces=1200
        ),
    }


@pytest.mark.parametrize("name", [*QUANTITIES, "effective_separation"])
@pytest.mark.parametrize("other", ["tail", "direct"])
def test_samplers_have_one_law(laws_by_sampler, other, name):
    """Kolmogorov-Smirnov, 24 comparisons at 1e-7 each."""
    one, two = laws_by_sampler["cells"][name], laws_by_sampler[other][name]
    for k in range(one.shape[1]):
        assert ks_2samp(one[:, k], two[:, k]).pvalue > SAME


def test_sinking_of_the_centre_has_another_law(laws_by_sampler):
    """The companion."""
    wrong = laws_by_sampler["sinking of the centre"]["load"][:, 0]
    assert ks_2samp(laws_by_sampler["cells"]["load"][:, 0], wrong).pvalue < SAME


def by_identity(ensemble, strength):
    """Distance between the law of the loads at h and that which P(P <= p | h) = P(S(h + c p) <= p) gives.

    S(x) is of surfaces without interaction, drawn with another seed.
    """
    scene, n = ensemble.scene, 300
    loads = np.sort(ensemble["load"][:, 0])
    asked = loads[:: len(loads) // 50]
    felt = scene.separations[0] + strength / n * asked / factor(scene.surface, "load")
    alone = scene.replace(interaction=None, separations=felt, quantities=["load"], seed=99, n_surfaces=4000)
    below = (mcgw.simulate(alone)["load"] <= asked).mean(axis=0)
    return np.abs(below - np.searchsorted(loads, asked, side="right") / len(loads)).max()


def test_law_of_the_load_at_a_nominal_separation(laws_by_sampler):
    """Two samples of 4000; the distance that one in 10^7 pairs exceeds. Wrong versions go beyond."""
    gate = np.sqrt(-np.log(SAME / 2) / 2 * (1 / 4000 + 1 / 4000))
    ensemble = laws_by_sampler["cells"]
    assert by_identity(ensemble, 3.0) < gate
    for wrong in (3.0 * hand.SINKING_OF_THE_CENTRE / hand.MEAN_SINKING, -3.0, 0.0):
        assert by_identity(ensemble, wrong) > gate


def test_laws_with_breaks_and_own_radii(make_scene):
    """By `tail`: x = h + c P, and literal sums of the terms of the law."""
    from analytic.laws import LoadingBranch, term_of

    scene = make_scene(separations=(0.3, 1.0), n_surfaces=3, law=analytic.KogutEtsion(critical=0.3))
    scene = scene.replace(interaction=interaction(2.0, scene.surface, 3000))
    ensemble = mcgw.simulate(scene)
    assert ensemble.sampler == "tail"
    s, felt = mcgw.heights(scene, 2), ensemble["effective_separation"][2]
    for name in ("load", "area"):
        terms = [term_of(name, LoadingBranch(scene.contact), x, s, scene.modulus(s)).sum() for x in felt]
        np.testing.assert_allclose(
            ensemble[name][2], factor(scene.surface, name) * np.array(terms), rtol=1e-12
        )
    sunk = 2.0 / 3000 * ensemble["load"] / factor(scene.surface, "load")
    np.testing.assert_allclose(
        ensemble["effective_separation"], np.array([0.3, 1.0]) + sunk, rtol=0, atol=1e-13
    )


def test_own_radii():
    """Each summit with its own: literal Hertz at what it feels."""
    spectral = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
    scene = mcgw.Scene(spectral, separations=(0.3, 1.0), n_asperities=2000, n_surfaces=2, seed=1)
    scene = scene.replace(interaction=interaction(2.0, scene.surface, 2000))
    ensemble = mcgw.simulate(scene)
    s, radius = mcgw.heights(scene, 1), mcgw.radii(scene, 1)
    x = ensemble["effective_separation"][1]
    depth = scene.surface.sigma * np.maximum(s - x[:, None], 0)
    load = (4 / 3 * scene.surface.E_star * np.sqrt(radius) * depth**1.5).sum(axis=1)
    np.testing.assert_allclose(ensemble["load"][1], load, rtol=1e-12)
    np.testing.assert_allclose(ensemble["area"][1], np.pi * (radius * depth).sum(axis=1), rtol=1e-12)
    sunk = 2.0 / 2000 * load / factor(scene.surface, "load")
    np.testing.assert_allclose(x, np.array([0.3, 1.0]) + sunk, rtol=0, atol=1e-13)
