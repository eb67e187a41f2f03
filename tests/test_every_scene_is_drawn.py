"""Contact laws that bend with the modulus inside a cell: every accepted scene is drawn, and right."""

import numpy as np
import pytest

import analytic
import mcgw
from analytic import quantity_of
from analytic.laws import term_of
from mcgw.sampling.response.walk import UnresolvedError
from mcgw.sampling.samplers import sampler_of
from mcgw.sampling.shared import on_common_cells, shared

CLIPPED = {"grading": analytic.Exponential(5.5), "negative": "clip", "separations": [-2.4, -0.5, 2.0]}
BELOW_ONE = {"grading": analytic.Exponential(-1.5), "negative": "clip", "separations": [-1.2, 1.8]}
STEP = analytic.Table([1.0, 1.0004, 1.0008, 3.0], [1.0, 3.0, 1.0, 2.0])
SCENES = {
    "plastic at once": {**CLIPPED, "law": mcgw.ChangEtsionBogy(critical=0.08)},
    "by and by": {**CLIPPED, "law": mcgw.ZhaoMaiettaChang(critical=0.0013)},
    "powers": {**BELOW_ONE, "law": mcgw.KogutEtsion(critical=0.0018)},
    "and back": {**BELOW_ONE, "law": mcgw.KogutEtsion(critical=0.0018), "unload_from": "loop"},
    "a table": {"grading": STEP, "separations": [1.0, 2.0]},
    "sticks": {
        "law": mcgw.JohnsonKendallRoberts(pull_off=0.5),
        "unload_from": "loop",
        "separations": [1.0, 1.0 + 1e-9, 1.5],
        "quantities": ["load", "area", "contacts"],
    },
}


@pytest.fixture
def scene_of(make_scene):
    return lambda **asked: make_scene(n_surfaces=2, n_asperities=3000, seed=5, **asked)


@pytest.mark.parametrize("name", SCENES)
def test_values_are_literal_sums_over_the_heights(scene_of, name):
    scene = scene_of(**SCENES[name])
    ensemble = mcgw.simulate(scene)
    for surface in range(2):
        s = mcgw.heights(scene, surface)
        for quantity in scene.quantities:
            q, branch = quantity_of(quantity), scene.branch_of(quantity)
            terms = term_of(q.base, branch, np.array(scene.separations)[:, None], s, scene.modulus(s))
            allowed = 1e-11 * np.abs(terms).sum(axis=1) * q.scale(scene.surface)
            off = ensemble.values(quantity)[surface] - terms.sum(axis=1) * q.scale(scene.surface)
            assert np.all(np.abs(off) <= allowed), quantity


def test_scenes_that_share_surfaces_share_the_cells_that_were_cut_further(scene_of):
    scenes = [scene_of(**{**CLIPPED, "law": mcgw.ChangEtsionBogy(critical=c)}) for c in (0.08, 0.1)]
    one, other = shared(on_common_cells(scenes)).scenes
    np.testing.assert_array_equal(one.mesh.edges, other.mesh.edges)


@pytest.mark.parametrize("wish", [{}, {"law_error": 1e-2}])
def test_what_no_cell_resolves_is_drawn_one_by_one(scene_of, monkeypatch, wish):
    """Cells alone say what to do instead."""
    monkeypatch.setattr("mcgw.sampling.samplers._HALVINGS", 0)
    assert sampler_of(scene_of(**SCENES["powers"], **wish)).name == "tail"
    with pytest.raises(UnresolvedError, match=r'not resolved near s = .*; take sampler = "tail"'):
        sampler_of(scene_of(**SCENES["powers"], sampler="cells"))
