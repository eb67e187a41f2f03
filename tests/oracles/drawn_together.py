"""Values on each surface of the points of a sweep that share their surfaces."""

import numpy as np

from mcgw.sampling.shared import common_edges, shared
from oracles.inside import kept


def drawn_together(sweep):
    """Return the values of each point by quantity, each of shape (surfaces, separations)."""
    scenes = list(sweep.scenes)
    edges = common_edges(scenes)
    blocks = shared(scenes, edges).block(0, scenes[0].n_surfaces)
    return edges, [kept(scene, block) for scene, block in zip(scenes, blocks, strict=True)]


def check_points(sweep, rtol=1e-12):
    """Compare means and deviations of every point with the values on its surfaces."""
    _, values = drawn_together(sweep)
    for at, one in zip(np.ndindex(sweep.shape), values, strict=True):
        for name in sweep.quantities:
            np.testing.assert_allclose(sweep.mean(name)[at], one[name].mean(axis=0), rtol=rtol)
            np.testing.assert_allclose(sweep.std(name)[at], one[name].std(axis=0, ddof=1), rtol=rtol)
