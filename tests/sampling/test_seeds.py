"""All 64 bits of a seed, everywhere, and after a smaller seed in the same process."""

import numpy as np
import pytest
from oracles.inside import SAMPLERS, sampler_of

import mcgw

SMALL, LARGE = 1, [2**63 - 1, 2**63, 2**64 - 1]


@pytest.mark.parametrize("count", ["fixed", "poisson"])
@pytest.mark.parametrize("sampler", SAMPLERS[1:])
def test_every_sampler_takes_every_seed(make_scene, sampler, count):
    """One ensemble each, however large its neighbours."""
    drawn = [
        sampler_of(make_scene(sampler=sampler, count=count, seed=seed)).block(0, 3)["load"][:, 0]
        for seed in (SMALL, *LARGE, 2**63 + SMALL, 2**32 + SMALL, SMALL)
    ]
    np.testing.assert_array_equal(drawn[0], drawn[-1])
    assert len(np.unique(drawn)) == 3 * (len(drawn) - 1)


@pytest.mark.parametrize("seed", LARGE[1:])
def test_heights_and_convergence_take_it(make_scene, seed):
    scene = make_scene(seed=seed, n_surfaces=64, n_asperities=300, separations=(0.0, 1.0), sampler="cells")
    touching = mcgw.heights(scene, 0, untouched=True)
    assert touching.size == 300
    assert np.sum(touching > 0) == sampler_of(scene).block(0, 1)["contacts"][0, 0]
    seen = []
    mcgw.converge(scene, lambda x: seen.append(x.seed) or sampler_of(x).block(0, x.n_surfaces), seeds=3)
    assert {(seed + k) % 2**64 for k in range(3)} <= set(seen)
    assert all(0 <= value < 2**64 for value in seen)
