"""Files of scenes with a contact law: written, gone on with, read again; one's own as series."""

import numpy as np
import pytest
from conftest import SURFACE
from oracles.laws_by_hand import OWN

import analytic
import mcgw
from analytic import laws
from mcgw.errors import StoreError

KOGUT = laws.KogutEtsion(critical=0.05)


def scene_of(law, **changes):
    asked = {"separations": (0.0, 1.0, 2.5), "n_asperities": 2000, "n_surfaces": 300, "seed": 3}
    return mcgw.Scene(SURFACE, law=law, **{**asked, **changes})


@pytest.mark.parametrize(
    "grading", [analytic.Homogeneous(), analytic.Exponential(2.0)], ids=["same", "graded"]
)
def test_a_law_of_ones_own_is_the_same_from_its_file(grading, tmp_path):
    """Kogut and Etsion's pieces, written by a user, are theirs; shards and merging know them too."""
    names = ("load", "area", "stiffness", "contacts", "load_slope", "yielded")
    scene = scene_of(OWN, grading=grading, quantities=names)
    built_in = mcgw.simulate(scene.replace(law=KOGUT))
    path = tmp_path / "own.h5"
    for part in ("1/2", "2/2"):
        mcgw.run(scene, path, shard=part)
    if not path.exists():
        mcgw.merge(path)
    found = mcgw.open_ensemble(path)
    for name in names:
        np.testing.assert_allclose(found[name], built_in[name], rtol=1e-12)
    with pytest.raises(StoreError):  # another law is another run
        mcgw.run(scene.replace(law=KOGUT), path)


def test_unloading_of_a_law_of_ones_own_is_refused():
    with pytest.raises(mcgw.SceneError, match=r"contact\.unload_from = 0: law = 'custom'"):
        scene_of(OWN, unload_from=0.0)
