"""One ensemble whoever draws it: in memory, at once, in steps, stopped on the way, by shares, from its text.

A row is a feature that changes what is drawn, or what its scene must remember.
"""

import h5py
import numpy as np
import pytest
from conftest import SURFACE
from oracles.begun_runs import SIZE, digest, halted
from oracles.inside import read_attributes, storable
from oracles.interacting_by_hand import interaction
from oracles.laws_by_hand import OWN

import analytic
import mcgw
from analytic import laws
from mcgw.errors import StoreError

pytestmark = pytest.mark.usefixtures("small_blocks")

SURFACES = 60  # in four blocks, the last one short
HEIGHTS = mcgw.MeasuredHeights(np.random.default_rng(1).normal(size=50), resampled=True)
RADII = mcgw.MeasuredRadii(HEIGHTS, np.random.default_rng(2).lognormal(sigma=0.3, size=50))


def bent(s):
    """A kink that nobody tells of."""
    return 1 + 0.3 * np.abs(s - 0.777)


SCENES = {
    "function": {"grading": lambda s: 1 + 0.3 * np.tanh(s), "title": 'Ra = 1 µm, "quoted"'},
    "kinks told": {"grading": analytic.Custom(lambda s: abs(s - 0.4) + (s > 1.1), (0.4, 1.1))},
    "weibull, poisson": {"grading": bent, "heights": analytic.Weibull(2.0), "count": "poisson"},
    "direct": {"grading": bent, "sampler": "direct", "seed": 2**64 - 1},
    "tail": {"grading": bent, "sampler": "tail", "seed": 2**63},
    "aggregate": {"grading": bent, "sampler": "aggregate"},
    "crowds": {"accuracy": 1e-2, "n_asperities": 10**6, "sampler": "auto"},
    "pressed down": {"interaction": interaction(3.0, SURFACE, 3000)},
    "summits": {"heights": HEIGHTS, "summits": RADII, "n_asperities": 50, "sampler": "auto"},
    "much": {"hardness": "2 GPa", "seed": 2**64 - 1,
             "joint": mcgw.Joint((200.0, 16.0), gas="air", rms="2 um"),
             "uncertainty": {"sigma": "20 %", "eta": 0.1, "correlation": [[1, -0.5], [-0.5, 1]]},
             "keep": "statistics", "grading": lambda s: 1 + 0.3 * np.tanh(s)},
    "coated": {"law": laws.Coated(thickness=1e-6, ratio=3.0), "unload_from": "loop"},
    "own": {"law": OWN, "grading": analytic.Exponential(1.5)},
}  # fmt: skip
OFTEN = {"own", "much"}
EVERY = [pytest.param(name, marks=[] if name in OFTEN else pytest.mark.slow) for name in SCENES]


@pytest.fixture
def make(make_scene):
    def of(name, **changes):
        values = {"separations": (2.0, 0.5, 3.0), "n_surfaces": SURFACES, "sampler": "cells", "grading": None}
        return make_scene(**(values | SCENES[name] | changes))

    return of


def assert_same(one, other):
    for quantity in one.scene.quantities:
        if one.scene.keep == "sums":
            np.testing.assert_array_equal(one[quantity], other[quantity])
        else:
            np.testing.assert_array_equal(one.mean(quantity), other.mean(quantity))
            np.testing.assert_array_equal(one.covariance(quantity), other.covariance(quantity))


@pytest.mark.parametrize("name", EVERY)
def test_one_file_and_one_memory(name, make, tmp_path):
    """One file in one go; another begun smaller, extended, stopped on the way and finished by shares."""
    scene, path = make(name), tmp_path / "e.h5"
    memory, whole = mcgw.simulate(scene), mcgw.run(scene, tmp_path / "whole.h5", threads=1)
    mcgw.run(scene, path, n_surfaces=20)
    halted(scene, path, 2 * SIZE)
    for i in (2, 1, 3):
        mcgw.run(scene, path, shard=f"{i}/3")
    mcgw.merge(path)
    mcgw.save(memory, tmp_path / "saved.h5")
    assert digest(path) == digest(tmp_path / "whole.h5") == digest(tmp_path / "saved.h5")
    assert_same(mcgw.open_ensemble(path), memory)
    assert whole.scene == memory.scene == storable(scene)
    again = mcgw.scene_from(read_attributes(path)["scene"])  # of what the file says alone
    assert again == whole.scene == mcgw.scene_from(mcgw.scene_text(scene))
    assert_same(mcgw.simulate(again), memory)
    with h5py.File(path) as file:
        assert (file.attrs["seed"].dtype, int(file.attrs["seed"])) == (np.uint64, scene.seed)


# A change of a scene, and the key by which it is told from what a file holds.
OTHERS = {
    "function": ({"grading": np.cosh}, "grading"),
    "much": ({"keep": "sums"}, r"ensemble\.keep"),
    "weibull, poisson": ({"law": laws.KogutEtsion(critical=0.05)}, "contact"),  # beside a function
    "own": ({"law": laws.KogutEtsion(critical=0.05)}, "contact"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_scene_is_not_taken_for_it(name, make, tmp_path):
    """Whether a file is finished or begun, it is left as it is."""
    change, told = OTHERS[name]
    scene, path = make(name, n_surfaces=2 * SIZE), tmp_path / "e.h5"
    mcgw.run(scene, tmp_path / "begun.h5", shard="1/2")
    mcgw.run(scene, path)
    before = path.read_bytes()
    for place in (path, tmp_path / "begun.h5"):
        with pytest.raises(StoreError, match=rf"holds a different .*{told}"):
            mcgw.run(make(name, **change), place)
    assert path.read_bytes() == before
