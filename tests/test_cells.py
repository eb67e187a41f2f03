"""Mesh, probabilities and inverse distributions of the cells, against mpmath."""

import mpmath as mp
import numpy as np
import pytest

import analytic
from mcgw.sampling.cells import mesh_of, no_cells
from mcgw.sampling.samplers import sampler_of
from mcgw.sampling.spacing import Gaps, cuts


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


def test_what_auto_takes(make_scene):
    """One by one where a handful touches, more with many separations; cells for all else, and for moments."""
    many = tuple(np.linspace(0, 4, 601))
    cases = {
        "cells": (
            {},
            {"n_asperities": 10**12},
            {"separations": many},
            {"n_asperities": 50},
            {"separations": many, "n_asperities": 60},
        ),
        "tail": (
            {"n_asperities": 1},
            {"n_asperities": 8},
            {"separations": many, "n_asperities": 36},
            {"separations": many[300:], "n_asperities": 800},
        ),
    }
    for name, scenes in cases.items():
        for changes in scenes:
            assert sampler_of(make_scene(sampler="auto", **changes)).name == name
    kept = make_scene(sampler="auto", separations=many, n_asperities=20, keep="moments")
    assert sampler_of(kept).name == "cells"
