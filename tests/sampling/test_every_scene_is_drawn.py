"""Contact laws that bend with the modulus inside a cell: every accepted scene is drawn, and right."""

import numpy as np
import pytest
from oracles.inside import sampler_of
from tables.drawn_scenes import CLIPPED, LAWS

import analytic
import mcgw
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.sampling.shared import common_edges, shared


@pytest.fixture
def scene_of(make_scene):
    return lambda **asked: make_scene(**{"n_surfaces": 2, "n_asperities": 3000, "seed": 5, **asked})


def test_scenes_that_share_surfaces_share_the_cells_that_were_cut_further(scene_of):
    scenes = [scene_of(**{**CLIPPED, "law": mcgw.ChangEtsionBogy(critical=c)}) for c in (0.08, 0.1)]
    one, other = shared(scenes, common_edges(scenes)).scenes
    np.testing.assert_array_equal(one.mesh.edges, other.mesh.edges)


def test_crowds_where_cells_that_are_wide_do_not_tell_which_moments_vary(scene_of):
    law, grading = (
        mcgw.Coated(reduced_thickness=0.002, ratio=3.0),
        analytic.Custom(lambda s: 1 + 0.9 * np.tanh(29 * (s - 1.47))),
    )
    scene = scene_of(law=law, grading=grading, sampler="aggregate", separations=[0.3, 1.9])
    assert mcgw.simulate(scene)["load"].shape == (2, 2)


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (
            {"grading": lambda s: 1 + 0.1 * np.sin(1e6 * s)},
            "grading: not resolved by 4096 pieces .* Smooth it",
        ),
        (
            {**CLIPPED, "law": mcgw.JohnsonKendallRoberts(pull_off=0.1)},
            'grading.negative = "clip": from s = .* pulls them in without limit; increase the separations',
        ),
        (
            {
                "grading": lambda s: np.exp(4.4 * (s - 1)),
                "heights": analytic.Nayak(1.92),
                "keep": "statistics",
                "separations": [-5.5, 1.0],
            },
            'ensemble.keep = "statistics": grading: .* let the grading level off; or use "sums"',
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused_when_it_is_made(scene_of, asked, line):
    with pytest.raises(mcgw.SceneError, match=line):
        scene_of(**asked)


@pytest.mark.parametrize("wish", [{}, {"sampler": "cells"}, {"accuracy": 1e-2}])
def test_what_no_cell_resolves_is_drawn_one_by_one(scene_of, monkeypatch, wish):
    monkeypatch.setattr("mcgw.sampling.samplers._CUTS", 0)
    assert sampler_of(scene_of(**LAWS["powers"], **wish)).name == "tail"
    with pytest.raises(UnresolvedError, match=r'not resolved near s = .*; use sampler = "auto"'):
        sampler_of(scene_of(**LAWS["powers"], sampler="aggregate"))
