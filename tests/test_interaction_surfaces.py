"""Surfaces whose asperities press each other down: against literal sums, identities, and each other."""

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
from mcgw.sampling.nominal import balanced_sums
from mcgw.sampling.samplers import sampler_of
from mcgw.store import ensembles

GRADINGS = {
    "exponential": analytic.Exponential(2.0),
    "table": analytic.Table((-1.0, 0.5, 2.0), (0.8, 1.3, 1.1)),
    "own": analytic.Custom(lambda s: 1 + 0.3 * np.tanh(s)),
}
HEIGHTS = {
    "Weibull": analytic.Weibull(2.0), "Nayak": analytic.Nayak(5.0),
    "exponential": analytic.ExponentialHeights(), "uniform": scipy.stats.uniform(),
}  # fmt: skip


def check_against_literal_sums(scene, surface=1, tolerance=1e-12):
    """Every quantity at what the asperities feel, x = h + c P; stiffness and conductance in series."""
    ensemble, alone = mcgw.simulate(scene), mcgw.heights(scene, surface)
    felt = ensemble["effective_separation"][surface]
    c = scene.interaction.compliance(scene.surface, scene.n_asperities)
    for name in scene.quantities:
        expected = literal_sums(scene, alone, felt, name)
        if name in ("stiffness", "conductance"):
            other = c if name == "stiffness" else c * scene.interaction.bulk_modulus / 2
            expected = expected / (1 + other * expected)
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

    @pytest.mark.parametrize("changes", [
        {"n_asperities": 300, "count": "poisson", "sampler": "tail"},
        {"n_asperities": 300, "sampler": "cells"},
        {"n_asperities": 10**5, "count": "poisson"},
        pytest.param({"n_asperities": 10**6}, marks=pytest.mark.slow),
    ], ids=lambda changes: ", ".join(map(str, changes.values())))  # fmt: skip
    def test_numbers(self, pressed, strength, changes):
        check_against_literal_sums(
            pressed(strength, grading=analytic.Exponential(1.5), n_surfaces=2, **changes)
        )


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


def test_effective_separations_change_stiffness_and_conductance_alone(pressed):
    """All else has the bits of surfaces without interaction; compliances add."""
    for sampler in ("direct", "tail", "cells", "aggregate"):
        scene = pressed(3.0, "effective", sampler=sampler, n_asperities=400)
        with_, without = mcgw.simulate(scene), mcgw.simulate(scene.replace(interaction=None))
        c = scene.interaction.compliance(scene.surface, 400)
        for name in set(QUANTITIES) - {"stiffness", "conductance"}:
            np.testing.assert_array_equal(with_[name], without[name])
        touched = without["stiffness"] > 0
        apart = 1 / without["stiffness"][touched]
        np.testing.assert_allclose(1 / with_["stiffness"][touched], apart + c, rtol=1e-12)
        spots, both = 1 / without["conductance"][touched], c * scene.interaction.bulk_modulus / 2
        np.testing.assert_allclose(1 / with_["conductance"][touched], spots + both, rtol=1e-12)
        sunk = c / scene.surface.sigma * without["load"]
        np.testing.assert_array_equal(with_["nominal_separation"], np.array(SEPARATIONS) - sunk)


SAME = 1e-7  # false alarm of each comparison of two samples


@pytest.fixture(scope="module")
def laws_by_sampler():
    """Small surfaces of strength 3 by the sampler that tells no heights and by one that does."""

    def drawn(sampler, seed, strength=3.0, n_surfaces=1200):
        scene = mcgw.Scene(
            SURFACE, separations=(0.4, 1.2), grading=analytic.Exponential(2.0), quantities=QUANTITIES,
            n_asperities=300, n_surfaces=n_surfaces, sampler=sampler, seed=seed,
            interaction=interaction(strength, SURFACE, 300),
        )  # fmt: skip
        return mcgw.simulate(scene)

    return {
        "cells": drawn("cells", 1, n_surfaces=4000),
        "direct": drawn("direct", 3, n_surfaces=600),
        "sinking of the centre": drawn(
            "cells", 4, 3.0 * hand.SINKING_OF_THE_CENTRE / hand.MEAN_SINKING, n_surfaces=1200
        ),
    }


def test_samplers_have_one_law(laws_by_sampler):
    """Kolmogorov-Smirnov, 12 comparisons at 1e-7 each."""
    for name in (*QUANTITIES, "effective_separation"):
        one, two = laws_by_sampler["cells"][name], laws_by_sampler["direct"][name]
        for k in range(one.shape[1]):
            assert ks_2samp(one[:, k], two[:, k]).pvalue > SAME, (name, k)


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
    from analytic.laws import Branch, term_of

    scene = make_scene(separations=(0.3, 1.0), n_surfaces=3, law=analytic.KogutEtsion(critical=0.3))
    scene = scene.replace(interaction=interaction(2.0, scene.surface, 3000))
    ensemble = mcgw.simulate(scene)
    assert ensemble.sampler == "tail"
    s, felt = mcgw.heights(scene, 2), ensemble["effective_separation"][2]
    for name in ("load", "area"):
        terms = [term_of(name, Branch(scene.contact), x, s, scene.modulus(s)).sum() for x in felt]
        np.testing.assert_allclose(
            ensemble[name][2], factor(scene.surface, name) * np.array(terms), rtol=1e-12
        )
    sunk = 2.0 / 3000 * ensemble["load"] / factor(scene.surface, "load")
    np.testing.assert_allclose(
        ensemble["effective_separation"], np.array([0.3, 1.0]) + sunk, rtol=0, atol=1e-13
    )


def test_a_balance_next_to_the_separation_is_found(make_scene):
    """Where the load differs by its last digits between the two ends of the search."""
    for bulk in (1e16, 1e18):
        weakly = analytic.Interaction("body", at="nominal", bulk_modulus=bulk)
        scene = make_scene(
            law=analytic.JacksonGreen(critical=0.004, yield_strain=0.004), n_asperities=30, n_surfaces=3,
            separations=np.linspace(0, 4, 29), interaction=weakly, quantities=("load",),
        )  # fmt: skip
        ensemble = mcgw.simulate(scene)
        sunk = weakly.compliance(scene.surface, 30) / scene.surface.sigma * ensemble["load"]
        felt = np.array(scene.separations) + sunk
        np.testing.assert_allclose(ensemble["effective_separation"], felt, rtol=0, atol=1e-14)


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


@pytest.mark.parametrize("sampler", ["direct", "tail", "cells"])
def test_same_bits_in_any_block_by_any_threads(pressed, sampler):
    scene = pressed(3.0, sampler=sampler, n_asperities=200, n_surfaces=40)
    one, two = mcgw.simulate(scene, threads=1), mcgw.simulate(scene, threads=2)
    drawn = sampler_of(scene)
    whole = drawn.block(0, 40).sums
    for name, values in whole.items():
        np.testing.assert_array_equal(one[name], two[name])
        for first, n in ((0, 1), (33, 7), (10, 20)):
            np.testing.assert_array_equal(drawn.block(first, n).sums[name], values[first : first + n])


def test_company_of_separations_changes_hardly_a_digit(pressed):
    """The search begins anew at each; which asperities are drawn one by one is all that may differ."""
    h = (2.0, 0.0, 2.0, 1.0)
    many = sampler_of(pressed(3.0, separations=h)).block(0, 3).sums
    few = sampler_of(pressed(3.0, separations=(0.0, 1.0, 2.0))).block(0, 3).sums
    for name in many:
        np.testing.assert_array_equal(many[name][:, 0], many[name][:, 2])
        np.testing.assert_allclose(many[name][:, [1, 3, 0]], few[name], rtol=1e-13)


@pytest.mark.parametrize("at", ["effective", "nominal"])
def test_a_file_holds_both_separations_and_goes_on(pressed, at, tmp_path):
    """At once, in two goes, and in memory: one digest; the scene reads back from its text."""
    scene, path = pressed(3.0, at, n_surfaces=100, n_asperities=500), tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=40), path)
    mcgw.run(scene, path)
    mcgw.run(scene, tmp_path / "at_once.h5", threads=1)
    found, memory = mcgw.open_ensemble(path), mcgw.simulate(scene)
    assert ensembles.verify(path) == ensembles.verify(tmp_path / "at_once.h5")
    assert found.scene == scene
    assert mcgw.scene_from(mcgw.scene_text(found.scene)) == scene
    for name in (*QUANTITIES, *scene.other_separations):
        np.testing.assert_array_equal(found[name], memory[name])


NOMINAL, EFFECTIVE = {"reference": "body", "at": "nominal"}, "body"
KOGUT, JKR = analytic.KogutEtsion(critical=0.3), analytic.JohnsonKendallRoberts(pull_off=0.05)
NEGATIVE = {"grading": analytic.Exponential(2.0), "separations": (-1.0, 1.0)}
LOAD = 'add "load" to contact.quantities'
# What is refused, a word of the line for it, and the neighbour that passes.
REFUSED = {
    "no load": ({"interaction": "body", "quantities": ["area"]}, LOAD, {"quantities": ["area", "load"]}),
    "no load there and back": (
        {"interaction": "body", "unload_from": "loop", "quantities": ["area"]}, LOAD,
        {"quantities": ["area", "load"]},  # with its way back
    ),
    "no asperities": (
        {"interaction": NOMINAL, "sampler": "aggregate"}, 'it draws no asperities.*at = "effective"',
        {"interaction": "body"},
    ),
    "cells of another law": (
        {"interaction": NOMINAL, "sampler": "cells", "law": KOGUT}, 'needs single asperities; use "tail"',
        {"sampler": "tail"},
    ),
    "the way back": (
        {"interaction": NOMINAL, "unload_from": "loop", "quantities": ["load", "load_unloading"]},
        "has no unloading", {"interaction": "body"},
    ),
    "negative moduli": (
        {"interaction": NOMINAL, "negative": "allow", **NEGATIVE},
        'needs loads that decrease with the separation; use "clip"', {"negative": "clip"},
    ),
    "adhesion": (
        {"interaction": NOMINAL, "law": JKR, "quantities": ["load"]}, "would have several equilibria",
        {"interaction": "body"},
    ),
}  # fmt: skip


@pytest.mark.parametrize(("asked", "line", "neighbour"), REFUSED.values(), ids=REFUSED)
def test_refused_in_one_line_and_its_neighbour_not(make_scene, asked, line, neighbour):
    plain = {"grading": None, "n_surfaces": 2, "n_asperities": 100, "separations": (0.5, 1.0)}
    with pytest.raises(mcgw.SceneError, match=line) as caught:
        make_scene(**(plain | asked))
    assert len(caught.value.problems) == 1
    make_scene(**(plain | asked | neighbour))


@pytest.mark.parametrize("at", ["nominal", "effective"])
def test_separations_below_the_fold(make_scene, at):
    """Strength 1: loads pull the mean plane down faster than it is pressed, somewhere above 0."""
    scene = make_scene(separations=(-1.0, 2.0), grading=None, n_asperities=3000)
    pulled = interaction(-1.0, scene.surface, 3000, at)
    with pytest.raises(mcgw.SceneError, match="give larger separations") as caught:
        scene.replace(interaction=pulled)
    assert len(caught.value.problems) == 1
    assert scene.replace(interaction=pulled, separations=(1.5, 2.0)).separations == (1.5, 2.0)


def test_a_surface_without_balance_says_so(make_scene):
    """Small surfaces scatter about a mean that has a balance: the line names the surface."""
    scene = make_scene(separations=(0.0,), grading=None, n_asperities=30, n_surfaces=3000)
    pulled = interaction(-0.62, scene.surface, 30)
    for sampler in ("cells", "tail"):
        with pytest.raises(
            ValueError, match=r"interaction: surface .* no equilibrium at d/sigma = 0 "
        ) as one:
            mcgw.simulate(scene.replace(interaction=pulled, sampler=sampler))
        assert "\n" not in str(one.value)


def test_literal_search_gives_up_alike(make_scene):
    """One surface told by its heights: five summits far above a plane that each of them pulls down."""
    scene = make_scene(separations=(0.5,), grading=None, n_asperities=5)
    weak, strong = (
        scene.replace(interaction=interaction(-c, scene.surface, 5), separations=(3.0,)) for c in (0.02, 2.0)
    )
    heights = np.full(5, 4.0)
    found = balanced_sums(weak, 7, heights, None)["effective_separation"][0, 0]
    assert found == pytest.approx(3.0 - 0.02 * (4.0 - found) ** 1.5, abs=1e-14)
    with pytest.raises(ValueError, match="surface 7 has no equilibrium"):
        balanced_sums(strong, 7, heights, None)


@pytest.mark.parametrize(("given", "line"), [
    ({"at": "nominal"}, "interaction.reference: missing"),
    ({"reference": "moon"}, "interaction.reference = 'moon'"),
    ({"reference": "body", "at": "once"}, "interaction.at = 'once'"),
    ({"reference": "body", "bulk_modulus": -1.0}, "interaction.bulk_modulus = -1"),
    ({"reference": "body", "bulk": 1.0}, "interaction.bulk"),
    (3, "interaction = 3"),
])  # fmt: skip
def test_keys(make_scene, given, line):
    with pytest.raises(mcgw.SceneError) as caught:
        make_scene(interaction=given)
    assert len(caught.value.problems) == 1
    assert line.replace("'", "") in caught.value.problems[0].replace("'", "").replace('"', "")


@pytest.mark.parametrize("given", [{"reference": "sea"}, {"at": "sea"}, {"bulk_modulus": float("inf")}])
def test_words_of_the_theory(given):
    ((key, value),) = given.items()
    with pytest.raises(ValueError, match=f"{key} = '?{value}"):
        analytic.Interaction(**({"reference": "body"} | given))


@pytest.mark.parametrize("factor", [None, 1.0, 0.9, 1.1])
def test_errors_were_measured_for_one_modulus_of_the_bulk(factor):
    """That of the asperities: of softer bulks and of stiffer ones nothing is known but the area."""
    surface = analytic.SpectralMoments(1e-12, 1e-3, 4e6).surface(1e-6, 78.6e9)
    bulk = {} if factor is None else {"bulk_modulus": factor * 78.6e9}
    asked = {"reference": "mean-plane"} | bulk
    found = mcgw.Scene(surface, separations=[1.2, 1.6], interaction=asked, seed=1).validity()
    assert np.isfinite(found.error["area"]).all()
    known = factor in (None, 1.0)
    assert np.isfinite(found.error["stiffness"]).all() == known
    assert np.isfinite(found.bias["separation"]).all() == known
    assert ("only for a bulk with the modulus of the asperities" in found.details) != known
