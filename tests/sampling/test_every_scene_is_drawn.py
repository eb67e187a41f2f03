"""Contact laws that bend with the modulus inside a cell: every accepted scene is drawn, and right."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.stats
from tables.drawn_scenes import CLIPPED, LAWS

import analytic
import mcgw
from mcgw.sampling.block import Layout
from mcgw.sampling.response.rows import Powers, Rows
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.sampling.samplers import sampler_of
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


def test_each_cell_looks_at_the_highest_separation_of_each_formula_that_holds_there():
    """On the way back contacts of a higher separation may end first, and those of a lower one go on."""
    dice = np.random.default_rng(31)
    starts, n = np.linspace(0, 1, 40), 60
    kind, h, low = dice.integers(0, 5, n), dice.integers(0, 9, n) / 9, dice.integers(0, 40, n) / 39
    high = np.where(dice.random(n) < 0.3, np.inf, low + dice.exponential(0.3, n))
    none = np.zeros(n, dtype=bool)
    rooted = kind == 4
    rows = Rows(h, low, high, none, rooted, none, none, none, kind, kind, h, Powers(h, h, none))
    pairs = zip(*(x.tolist() for x in rows.nearest(starts)), strict=True)
    found = {(cell, int(kind[r])): h[r] for cell, r in pairs}
    wanted = {}
    for cell, s in enumerate(starts):
        for r in np.flatnonzero(((low < s) | ((low == s) & ~rooted)) & (high > s)):
            wanted[cell, int(kind[r])] = max(h[r], wanted.get((cell, int(kind[r])), -1.0))
    assert found == wanted
    assert len(found) > 100


@pytest.mark.parametrize("more", [0, 1, 2])
def test_any_number_of_moments_gives_the_same_values(scene_of, more):
    """As many as there are points make a series; to keep more than those is of no use, and does no harm."""
    asked = {"separations": [-1.0, 0.5, 2.0], "quantities": ["load", "area"]}
    sampler = sampler_of(scene_of(grading=analytic.Exponential(0.5), **asked))
    needed = sampler.response.layout
    wide = Layout(np.maximum(needed.plain, 19) + more, np.maximum(needed.rooted, 19) + more)
    sums = replace(sampler, response=sampler.response.out_of(wide)).sums(0, *sampler.drawn(0, 2, wide))
    for name, few in sampler.block(0, 2).sums.items():
        np.testing.assert_allclose(sums[name], few, rtol=1e-12)


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (
            {"grading": lambda s: 1 + 0.1 * np.sin(1e6 * s)},
            "grading: not resolved by 4096 pieces .* Smooth it",
        ),
        (
            {"law": mcgw.ZhaoMaiettaChang(critical=0.01), "unload_from": "loop", "quantities": ["load"]},
            "contact.unload_from = 0: .* no unloading is known for it; use 'kogut-etsion'",
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
        (
            {
                "grading": lambda s: 1 + 0.5 * np.sin(3 * s),
                "heights": scipy.stats.t(3.5),
                "interaction": "body",
                "separations": [0.0],
            },
            "grading: not resolved by 4096 pieces .* Smooth it",
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused_when_it_is_made(scene_of, asked, line):
    with pytest.raises(mcgw.SceneError, match=line):
        scene_of(**asked)


@pytest.mark.parametrize("wish", [{}, {"accuracy": 1e-2}])
def test_what_no_cell_resolves_is_drawn_one_by_one(scene_of, monkeypatch, wish):
    """Cells alone say what to do instead."""
    monkeypatch.setattr("mcgw.sampling.samplers._CUTS", 0)
    assert sampler_of(scene_of(**LAWS["powers"], **wish)).name == "tail"
    with pytest.raises(UnresolvedError, match=r'not resolved near s = .*; use sampler = "tail"'):
        sampler_of(scene_of(**LAWS["powers"], sampler="cells"))
