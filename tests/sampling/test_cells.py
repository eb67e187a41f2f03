"""Cells: their edges, probabilities and inverse distributions, and the response on them."""

from itertools import product

import mpmath as mp
import numpy as np
import pytest
from oracles.inside import sampler_of, summits_drawn

import analytic
import mcgw
from mcgw.sampling.cells import mesh_of, no_cells, tolerances


def test_heights_in_all_are_the_asperities_asked_for(make_scene):
    for count, sampler in product(("fixed", "poisson"), ("cells", "direct")):
        scene = make_scene(sampler=sampler, count=count, separations=(0.5, 2.0))
        touching, every = mcgw.heights(scene, 1), mcgw.heights(scene, 1, untouched=True)
        np.testing.assert_array_equal(every[: len(touching)], touching)
        assert (touching > 0.5).all()
        assert (every[len(touching) :] <= 0.5).all()
        if count == "fixed":
            assert len(every) == scene.n_asperities
        else:
            assert abs(len(every) - 3000) < 5 * 3000**0.5
        np.testing.assert_array_equal(touching, summits_drawn(scene, sampler_of(scene), 1)[0])


def test_aggregate_keeps_no_heights(make_scene):
    with pytest.raises(ValueError, match="keeps no heights"):
        mcgw.heights(make_scene(sampler="aggregate"), 0)


def mass(a, b):
    """Probability between a and b, at 40 digits."""
    with mp.workdps(40):
        return (mp.erfc(mp.mpf(a) / mp.sqrt(2)) - mp.erfc(mp.mpf(b) / mp.sqrt(2))) / 2


@pytest.mark.parametrize("separations", [(-40.0, -3.0, 0.0), (6.0, 6.5), (1.0, 1.0 + 1e-9)])
def test_probabilities_and_inverse_distribution(make_scene, separations):
    mesh = mesh_of(make_scene(separations=separations, n_asperities=10**15, grading=analytic.Homogeneous()))
    u = np.array([1e-6, 0.1, 0.5, 0.9])
    with mp.workdps(40):
        for cell in range(0, mesh.size, max(mesh.size // 40, 1)):
            a, b = mesh.edges[cell], mesh.edges[cell + 1]
            p = mass(a, b)
            # 1e-14: a Gauss rule of 20 points and one exponential.
            assert abs(mp.mpf(float(mesh.probability[cell])) / p - 1) < 1e-14
            for x, t in zip(u, mesh.offsets(cell, u), strict=True):
                # The height itself, relative to its distance from the edge, not to its size.
                found = mass(a, mp.mpf(float(a)) + mp.mpf(float(t)))
                assert abs(found / (p * mp.mpf(float(x))) - 1) < 5e-13


def test_cells_and_extras_share_the_contacting_heights(make_scene):
    for separations in ((0.0, 4.0), (-40.0, 1.0), (-2.0, 3.0)):  # the lowest one counts
        mesh = mesh_of(make_scene(separations=separations, grading=analytic.Homogeneous()))
        total = mesh.low_extras + mesh.probability.sum() + mesh.high_extras
        assert total == pytest.approx(float(analytic.fn(0, separations[0])), rel=1e-14)
        assert 3000 * (mesh.low_extras + mesh.high_extras) < 0.21


def test_far_out_there_are_no_cells(make_scene):
    mesh = mesh_of(make_scene(separations=(30.0, 38.0)))
    assert mesh.size == 0
    assert mesh.high_extras == pytest.approx(float(analytic.fn(0, 30.0)), rel=1e-13)
    assert no_cells(make_scene()).high_extras == 0.5


def test_errors_are_held_against_the_least_modulus_of_a_cell():
    """A lone contact may sit there: from a ratio of four on, unless the sign changes."""
    moduli = np.array([[1.0, 2.0], [0.25, 1.0], [0.05, 1.0], [1e-3, 1.0], [-1e-3, 1.0], [-0.01, -1.0]])
    found, _ = tolerances(analytic.Custom(np.tanh), 0.0, np.ones_like(moduli), moduli)
    np.testing.assert_allclose(found, [1.0, 1.0, 0.2, 1 / 16, 1.0, 1 / 16], rtol=1e-15)
