"""What is made before anything is drawn: by compiled steps, once, and never the result of another scene."""

import numpy as np
import pytest
import scipy.stats

import analytic
import mcgw
from mcgw.machine.process import kept
from mcgw.sampling.kernels import product


def test_each_sum_of_a_product_has_one_order():
    """A column has the same bits whichever columns stand beside it."""
    rng = np.random.default_rng(2)
    a, b = rng.normal(size=(20, 20)), rng.normal(size=(20, 45))
    whole = product(a, b)
    for columns in (slice(0, 1), slice(3, 24), slice(44, 45)):
        np.testing.assert_array_equal(product(a, np.ascontiguousarray(b[:, columns])), whole[:, columns])


def test_scenes_drawn_after_others_are_those_drawn_alone(make_scene):
    """Cells and trees are kept from scene to scene: in any order, each surface has the same bits.

    Two histograms are two laws, though both are called rv_histogram.
    """
    rng = np.random.default_rng(1)
    bins = [np.histogram(x, bins=12) for x in (rng.normal(size=1000), rng.uniform(size=1000))]
    changes = [
        {"grading": analytic.Exponential(2.0)},
        {"grading": analytic.Exponential(0.5)},
        {"grading": analytic.Table((0.0, 1.37, 3.0), (1.0, 2.0, 1.5))},
        {"separations": (0.0, 1.0, 2.5)},
        {"n_asperities": 5000},
        {"heights": analytic.Weibull(2.0)},
        {"law": mcgw.KogutEtsion(critical=0.1)},
        {"law": mcgw.KogutEtsion(critical=0.2)},
        *({"heights": analytic.ScipyHeights(scipy.stats.rv_histogram(x, density=True))} for x in bins),
    ]
    scenes = [make_scene(n_surfaces=3, **change) for change in changes]
    first = [mcgw.simulate(scene).load for scene in scenes]
    for again in np.random.default_rng(4).integers(0, len(scenes), 30):
        np.testing.assert_array_equal(mcgw.simulate(scenes[again]).load, first[again])
    assert len({load.tobytes() for load in first}) == len(scenes)


def test_only_what_cannot_change_is_remembered():
    calls = []

    @kept
    def asked(argument):
        calls.append(argument)
        return argument

    class Loose:
        pass

    for argument, times in ((2.5, 1), (b"2", 1), (analytic.Exponential(2.0), 1), (Loose(), 2), ([1], 2)):
        calls.clear()
        asked(argument)
        asked(argument)
        assert len(calls) == times, argument


def test_a_histogram_with_an_empty_bin_is_refused(make_scene):
    """It would be cut into ever smaller cells, without an end."""
    counts, edges = np.array([5.0, 9.0, 0.0, 2.0]), np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    law = analytic.ScipyHeights(scipy.stats.rv_histogram((counts, edges), density=False))
    with pytest.raises(ValueError, match=r"density is 0 at s = .*; fill the gap"):
        mcgw.simulate(make_scene(heights=law, grading=None, separations=(-1.0,)))
