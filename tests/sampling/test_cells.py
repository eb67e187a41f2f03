"""Cells: their edges, probabilities and inverse distributions, and the response on them."""

from itertools import product

import mpmath as mp
import numpy as np
import pytest
from tables.drawn_scenes import GRADINGS

import analytic
import mcgw
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.cells import evenness, mesh_of, no_cells
from mcgw.sampling.samplers import sampler_of
from mcgw.sampling.spacing import Gaps, cuts


@pytest.mark.parametrize(
    ("grading", "number"),
    [("homogeneous", 1), ("gamma 2", 4), ("table", 17), ("steeper", 4), ("exp(60 s)", 17)],
)
def test_the_sparse_product_is_that_of_the_matrix(make_scene, grading, number):
    h = tuple(np.linspace(0, 4, number)) if number > 1 else (1.0,)
    scene = make_scene(grading=GRADINGS[grading], separations=h, n_asperities=30_000)
    response = sampler_of(scene).response
    moments = np.random.default_rng(1).normal(size=(response.layout.starts[-1], 70))
    plain = np.einsum("qhm,mi->qih", response.matrix(), moments)
    size = np.einsum("qhm,mi->qih", np.abs(response.matrix()), np.abs(moments))
    assert np.all(np.abs(response @ moments - plain) <= 1e-14 * size)


def test_derivative_of_the_load_is_the_stiffness(make_scene):
    """-dP/dd = K on one surface: central differences in the separation, error O(step^2)."""
    step = 1e-4
    h = np.linspace(0.5, 2.5, 5)
    scene = make_scene(
        separations=tuple(np.concatenate([h - step, h, h + step])), quantities=("load", "stiffness"),
        sampler="cells", n_asperities=10**6,
    )  # fmt: skip
    sums = sampler_of(scene).block(0, 1).sums
    before, _, after = sums["load"][0].reshape(3, -1)
    stiffness = sums["stiffness"][0].reshape(3, -1)[1]
    slope = (before - after) / (2 * step * scene.surface.sigma)
    # Each root sqrt(s - h) within a step of h spoils the difference: 1e-5 of the load here.
    np.testing.assert_allclose(slope, stiffness, rtol=1e-5)


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


def test_what_is_not_asked_is_not_computed(make_scene):
    """Fewer quantities need fewer moments; contacts alone need none, and draw no uniform."""
    size = {}
    for quantities in (("load", "area", "stiffness"), ("area",), ("contacts",)):
        scene = make_scene(sampler="cells", quantities=quantities, n_asperities=10**6)
        sampler = sampler_of(scene)
        size[quantities] = sampler.response.layout.sizes.sum()
        assert set(sampler.block(0, 1).sums) == set(quantities)
    assert size["load", "area", "stiffness"] > size["area",] > 0 == size["contacts",]
    full = make_scene(sampler="cells", n_asperities=10**6)
    alone = full.replace(quantities=("contacts",))
    counted, all_of_it = (sampler_of(scene).block(0, 5).sums["contacts"] for scene in (alone, full))
    np.testing.assert_array_equal(counted, all_of_it)


def mass(a, b):
    """Probability between a and b, at 40 digits."""
    with mp.workdps(40):
        return (mp.erfc(mp.mpf(a) / mp.sqrt(2)) - mp.erfc(mp.mpf(b) / mp.sqrt(2))) / 2


@pytest.mark.parametrize("separations", [(0.0, 2.0, 4.0), (-40.0, -3.0, 0.0), (6.0, 6.5), (1.0, 1.0 + 1e-9)])
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


def test_every_separation_and_break_is_an_edge(make_scene):
    grading = analytic.Custom(lambda s: np.where(s > 1.234, 2.0, 1.0), (1.234,))
    mesh = mesh_of(make_scene(separations=(0.3, 0.1, 2.7), grading=grading))
    assert {0.1, 0.3, 1.234, 2.7} <= set(mesh.edges)


@pytest.mark.parametrize("gap", [1e-9, 1e-3, 0.7])
def test_cells_are_no_wider_than_their_distance_to_a_root(make_scene, gap):
    separations = np.array([0.5, 0.5 + gap, 2.0])
    mesh = mesh_of(make_scene(separations=tuple(separations)))
    for a, b in zip(mesh.edges[:-1], mesh.edges[1:], strict=True):
        below = separations[separations < a]
        if below.size:
            assert b - a <= (a - below[-1]) * (1 + 1e-6)


def cut(law, n, low, high, before):
    """Edges of one gap."""
    gap = Gaps(*np.array([[low], [high], [before]]), np.array([True]))
    return np.array(sorted([low, *cuts(law, n, gap), high]))


@pytest.mark.parametrize("gap", [1e-9, 0.01, 0.1, 3.0])
def test_the_fewest_cells_between_two_separations(gap):
    """As wide as the distance below it lets each be: one for equal gaps, then one for each doubling."""
    law, high = analytic.Gaussian(), 1.0 + gap
    gap = high - 1.0  # as it is after rounding
    assert len(cut(law, 0, 1.0, high, gap)) == 2
    assert len(cut(law, 0, 1.0, high, np.inf)) == 2
    for doublings in (1, 2, 5, 30):
        edges = cut(law, 0, 1.0, high, gap / 2**doublings)
        np.testing.assert_allclose(
            (edges[1:] - 1) / gap, 0.5 ** np.arange(doublings, -1, -1), atol=1e-15 / gap
        )


def test_crowds_pay_for_more_cells():
    """From none to many, and never one that is wider than its distance to the separation below."""
    law, sizes = analytic.Gaussian(), []
    for n in (0, 10**3, 10**5, 10**6, 10**8):
        edges = cut(law, n, 0.5, 0.6, 0.1)
        assert edges[0] == 0.5
        assert edges[-1] == 0.6
        distance = np.concatenate([[0.1], edges[1:-1] - 0.5])
        assert (np.diff(edges) <= distance * (1 + 1e-9)).all()
        sizes.append(edges.size - 1)
    assert sizes == sorted(sizes)
    assert sizes[0] == sizes[1] == 1
    assert sizes[-1] > 4


def test_errors_are_held_against_the_least_modulus_of_a_cell():
    """A lone contact may sit there: from a ratio of four on, unless the sign changes."""
    moduli = np.array([[1.0, 2.0], [0.25, 1.0], [0.05, 1.0], [1e-3, 1.0], [-1e-3, 1.0], [-0.01, -1.0]])
    for grading in (analytic.Custom(np.tanh), analytic.resolved(analytic.Custom(np.tanh), -1.0, 1.0)):
        found = evenness(grading, moduli)
        np.testing.assert_allclose(found, [1.0, 1.0, 0.2, 1 / 16, 1.0, 1 / 16], rtol=1e-15)
    assert evenness(analytic.Exponential(2.0), moduli).tolist() == [1.0] * 6
