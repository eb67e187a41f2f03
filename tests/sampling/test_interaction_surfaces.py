"""Surfaces whose asperities press each other down: against literal sums, identities, and each other."""

import numpy as np
import pytest
import scipy.stats
from oracles.interacting_by_hand import STRENGTHS, literal_sums

import analytic
import mcgw

OWN = analytic.Custom(lambda s: 1 + 0.3 * np.tanh(s))
TABLE = analytic.Table((-1.0, 0.5, 2.0), (0.8, 1.3, 1.1))
HIGHER = {"grading": TABLE, "separations": (-0.5, 0.3, 1.2)}


@pytest.mark.parametrize(("strength", "changes"), [
    ("body", {"grading": OWN}),
    ("body", HIGHER | {"heights": analytic.Nayak(5.0)}),
    ("body", HIGHER | {"heights": scipy.stats.uniform()}),
    ("body", {"n_asperities": 300, "count": "poisson", "sampler": "tail"}),
    ("mean-plane", HIGHER),
    ("mean-plane", HIGHER | {"heights": analytic.ExponentialHeights()}),
    ("mean-plane", {"n_asperities": 10**5, "count": "poisson"}),
    ("mean-plane", {"n_asperities": 400, "sampler": "direct"}),
    pytest.param("mean-plane", {"n_asperities": 10**6}, marks=pytest.mark.slow),
])  # fmt: skip
def test_literal_sums(pressed, strength, changes):
    """Every quantity at what the asperities feel; nominal separations; stiffness, conductance in series."""
    scene, surface = pressed(STRENGTHS[strength], **changes), 1
    ensemble, alone = mcgw.simulate(scene), mcgw.heights(scene, surface)
    felt = scene.separations
    c = scene.interaction.compliance(scene.surface, scene.n_asperities)
    for name in scene.quantities:
        expected = literal_sums(scene, alone, felt, name)
        if name in ("stiffness", "conductance"):
            other = c if name == "stiffness" else c * scene.interaction.bulk_modulus / 2
            expected = expected / (1 + other * expected)
        np.testing.assert_allclose(ensemble[name][surface], expected, rtol=1e-12, err_msg=name)
    sunk = c / scene.surface.sigma * ensemble["load"][surface]
    nominal = ensemble["nominal_separation"][surface]
    np.testing.assert_allclose(nominal, np.array(felt) - sunk, rtol=0, atol=1e-13)
    assert np.abs(sunk).max() > 0.02


@pytest.mark.parametrize("more", [{}, {"unload_from": "loop"}])
def test_without_the_load_it_is_refused_in_one_line(make_scene, more):
    asked = {"grading": None, "separations": (0.5, 1.0), "interaction": "body", **more}
    with pytest.raises(mcgw.SceneError, match=r'add "load" to contact\.quantities') as caught:
        make_scene(quantities=["area"], **asked)
    assert len(caught.value.problems) == 1
    make_scene(quantities=["area", "load"], **asked)


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
