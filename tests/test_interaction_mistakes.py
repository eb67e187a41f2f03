"""Scenes whose asperities press each other down: every refusal, and its neighbour that passes."""

import numpy as np
import pytest
from interacting_by_hand import interaction

import analytic
import mcgw
from mcgw.sampling.nominal_literal import balanced_sums

NOMINAL, EFFECTIVE = {"reference": "body", "at": "nominal"}, "body"
KOGUT, JKR = analytic.KogutEtsion(critical=0.3), analytic.JohnsonKendallRoberts(pull_off=0.05)
NEGATIVE = {"grading": analytic.Exponential(2.0), "separations": (-1.0, 1.0)}
SIDEWAYS = analytic.Tangential(friction=0.3, displacements=(1e-7,), poisson=0.3)
# What is refused, a word of the line for it, and the neighbour that passes.
REFUSED = {
    "no load": (
        {"interaction": "body", "quantities": ["area"]},
        'add "load" to contact.quantities',
        {"quantities": ["area", "load"]},
    ),
    "no load there and back": (
        {"interaction": "body", "unload_from": "loop", "quantities": ["area"]},
        'add "load" to contact.quantities',
        {"quantities": ["area", "load"]},  # with its way back
    ),
    "sideways": (
        {"interaction": "body", "tangential": SIDEWAYS},
        "leave out it or \\[interaction\\]",
        {"tangential": None},
    ),
    "means alone": (
        {"interaction": "body", "sampler": "stratified"},
        "each surface sinks by its own load",
        {"sampler": "cells"},
    ),
    "no asperities": (
        {"interaction": NOMINAL, "sampler": "aggregate"},
        'it draws no asperities.*at = "effective"',
        {"interaction": "body"},
    ),
    "cells of another law": (
        {"interaction": NOMINAL, "sampler": "cells", "law": KOGUT},
        'found asperity by asperity; take "tail"',
        {"sampler": "tail"},
    ),
    "moments": (
        {"interaction": NOMINAL, "keep": "moments", "sampler": "cells"},
        'keeps none; take "sums"',
        {"interaction": "body"},
    ),
    "the way back": (
        {
            "interaction": NOMINAL,
            "unload_from": "loop",
            "quantities": ["load", "load_unloading"],
        },
        "has no way back",
        {"interaction": "body"},
    ),
    "negative moduli": (
        {"interaction": NOMINAL, "negative": "allow", **NEGATIVE},
        'needs loads that fall with the separation; say "clip"',
        {"negative": "clip"},
    ),
    "adhesion": (
        {"interaction": NOMINAL, "law": JKR, "quantities": ["load"]},
        "would have several balances",
        {"interaction": "body"},
    ),
}


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
    with pytest.raises(mcgw.SceneError, match="give higher separations") as caught:
        scene.replace(interaction=pulled)
    assert len(caught.value.problems) == 1
    assert scene.replace(interaction=pulled, separations=(1.5, 2.0)).separations == (1.5, 2.0)


def test_a_surface_without_balance_says_so(make_scene):
    """Small surfaces scatter about a mean that has a balance: the line names the surface."""
    scene = make_scene(separations=(0.0,), grading=None, n_asperities=30, n_surfaces=3000)
    pulled = interaction(-0.62, scene.surface, 30)
    for sampler in ("cells", "tail"):
        with pytest.raises(
            ValueError, match=r"interaction: surface .* has no balance at d/sigma = 0 "
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
    with pytest.raises(ValueError, match="surface 7 has no balance"):
        balanced_sums(strong, 7, heights, None)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"at": "nominal"}, "interaction.reference: missing"),
        ({"reference": "moon"}, "interaction.reference = 'moon'"),
        ({"reference": "body", "at": "once"}, "interaction.at = 'once'"),
        ({"reference": "body", "bulk_modulus": -1.0}, "interaction.bulk_modulus = -1"),
        ({"reference": "body", "bulk": 1.0}, "interaction.bulk"),
        (3, "interaction = 3"),
    ],
)
def test_keys(make_scene, given, line):
    with pytest.raises(mcgw.SceneError) as caught:
        make_scene(interaction=given)
    assert len(caught.value.problems) == 1
    assert line.replace("'", "") in caught.value.problems[0].replace("'", "").replace('"', "")


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"reference": "sea"}, "reference = 'sea'"),
        ({"reference": "body", "at": "sea"}, "at = 'sea'"),
        ({"reference": "body", "bulk_modulus": float("inf")}, "bulk_modulus = inf"),
    ],
)
def test_words_of_the_theory(given, line):
    with pytest.raises(ValueError, match=line):
        analytic.Interaction(**given)
