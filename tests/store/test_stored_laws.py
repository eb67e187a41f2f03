"""Files of scenes with a contact law: written, gone on with, read again; one's own as series."""

import numpy as np
import pytest
from conftest import SURFACE
from oracles.laws_by_hand import OWN

import analytic
import mcgw
from analytic import laws
from mcgw.errors import StoreError
from mcgw.scene.scene import storable

KOGUT = laws.KogutEtsion(critical=0.05)
LAWS = {
    "Kogut": laws.KogutEtsion(hardness=1.2e9),
    "bridged": laws.KogutEtsion(critical=0.05, bridge="hermite"),
    "Chang": laws.ChangEtsionBogy(critical=0.05),
    "Zhao": laws.ZhaoMaiettaChang(hardness=1.2e9),
    "Jackson": laws.JacksonGreen(yield_strength=400e6),
    "half-space": laws.PowerLawGraded(0.3, c0=1e-5),
    "coated": laws.Coated(thickness=1e-6, ratio=3.0),
    "own": OWN,
}


def scene_of(law, **changes):
    asked = {"separations": (0.0, 1.0, 2.5), "n_asperities": 2000, "n_surfaces": 300, "seed": 3}
    return mcgw.Scene(SURFACE, law=law, **{**asked, **changes})


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_file_says_which_law_and_goes_on(law, tmp_path):
    """The same numbers in memory, at once, and in two goes; the law with its constants is in the scene."""
    path, back = tmp_path / "law.h5", "loop" if law.elastic else None
    scene = scene_of(law, unload_from=back, grading=analytic.Exponential(1.5))
    memory = mcgw.simulate(scene)
    mcgw.run(scene.replace(n_surfaces=100), path)
    mcgw.run(scene, path)
    found = mcgw.open_ensemble(path)
    assert found.scene == storable(scene)
    assert mcgw.scene_from(mcgw.scene_text(found.scene)) == found.scene
    for name in scene.quantities:
        np.testing.assert_array_equal(found[name], memory[name])


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
