"""Surfaces pushed sideways: the theorem contact by contact, limits, and files with a third axis."""

import math

import h5py
import numpy as np
import pytest
from conftest import SURFACE

import analytic
import mcgw
from analytic.laws import Hertz, KogutEtsion, PowerLawGraded, Tangential, masing
from mcgw.errors import StoreError

PUSHED = Tangential(friction=0.3, poisson=0.3, displacements=[0.0, 1e-9, 1e-7, 1e-5])
AXES = ["surface", "separation", "displacement"]


def scene_of(**changes):
    asked = {"separations": (1.0, 0.0, 2.0), "n_asperities": 2000, "n_surfaces": 40, "seed": 3}
    return mcgw.Scene(SURFACE, **{**asked, "tangential": PUSHED, **changes})


def slipping(law, heights, moduli, h, shift):
    """Friction times the difference of two normal loads, contact by contact, exactly summed."""

    def load(s, e, at):
        return law.load(0, math.sqrt(max(s - at, 0.0)), e)

    terms = (0.3 * (load(s, e, h) - load(s, e, h + shift)) for s, e in zip(heights, moduli, strict=True))
    return math.fsum(terms)


@pytest.mark.parametrize("law", [Hertz(), PowerLawGraded(0.5, reduced_c0=1.0)], ids=lambda law: law.name)
@pytest.mark.parametrize("sampler", ["cells", "tail"])
def test_each_contact_slips_by_itself(law, sampler):
    scene = scene_of(law=law, sampler=sampler, n_surfaces=3, grading=analytic.Exponential(2.0))
    drawn = mcgw.simulate(scene)
    unit = analytic.QUANTITIES["load"].scale(SURFACE)
    for surface in range(3):
        s = mcgw.heights(scene, surface)
        e = scene.modulus(s)
        for k, h in enumerate(scene.separations):
            for j, shift in enumerate(PUSHED.shifts(SURFACE)):
                expected = unit * slipping(law, s, e, h, shift)
                found = drawn["tangential_load"][surface, k, j]
                assert found == pytest.approx(expected, rel=1e-12, abs=1e-12 * drawn.load[surface, k])


def test_the_witness_slides_too():
    """`direct` draws other surfaces, by other means; fully slipping, friction times the normal load."""
    drawn = mcgw.simulate(scene_of(sampler="direct"))
    np.testing.assert_allclose(drawn["tangential_load"][:, :, -1], 0.3 * drawn.load, rtol=1e-13)


def test_limits():
    """Nothing without displacement, full slip far on, and Mindlin's stiffness at the start."""
    drawn = mcgw.simulate(scene_of())
    loads = drawn["tangential_load"]
    np.testing.assert_array_equal(loads[:, :, 0], 0.0)
    np.testing.assert_allclose(loads[:, :, -1], 0.3 * drawn.load, rtol=1e-13)
    assert np.all(np.diff(loads[:, :, :3], axis=2) > 0)
    # K_t = c K: the first step, of 1e-9 m, is nearly linear
    np.testing.assert_allclose(loads[:, :, 1] / 1e-9, PUSHED.ratio * drawn.stiffness, rtol=0.02)


def test_a_cycle_closes_and_takes_work():
    """Masing's branch meets the virgin curve at both ends, and lies below it."""
    u = np.linspace(0, 1e-7, 21)
    scene = scene_of(tangential=Tangential(0.3, 0.3, u), separations=(0.0, 1.0))
    loads = mcgw.simulate(scene)["tangential_load"]
    back = masing(loads)
    np.testing.assert_array_equal(back[..., 0], loads[..., -1])
    np.testing.assert_allclose(back[..., -1], -loads[..., -1])
    down = np.interp(u, (u[-1] - 2 * u)[::-1], back[0, 0][::-1])
    assert np.all(down[:-1] < loads[0, 0][:-1])


@pytest.mark.parametrize(("changes", "said"), [
    ({"law": KogutEtsion(critical=0.05)}, "contact.tangential: the theorem needs elastic half-spaces"),
    ({"quantities": ["area"]}, 'contact.tangential: it needs normal loads; add "load"'),
])  # fmt: skip
def test_what_the_theorem_does_not_cover_is_refused(changes, said):
    with pytest.raises(mcgw.SceneError) as caught:
        scene_of(**changes)
    assert caught.value.problems[0].startswith(said)


def test_a_file_has_the_third_axis(tmp_path):
    """Written, gone on with, in shards, merged: the same numbers, opened by xarray as they are."""
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    scene, path = scene_of(n_surfaces=700), tmp_path / "pushed.h5"
    memory = mcgw.simulate(scene)
    mcgw.run(scene.replace(n_surfaces=300), path)
    whole = mcgw.run(scene, path)
    for part in ("1/2", "2/2"):
        mcgw.run(scene, tmp_path / "shared.h5", shard=part)
    if not (tmp_path / "shared.h5").exists():
        mcgw.merge(tmp_path / "shared.h5")
    for found in (whole, mcgw.open_ensemble(tmp_path / "shared.h5")):
        np.testing.assert_array_equal(found["tangential_load"], memory["tangential_load"])
    with h5py.File(path) as file:
        assert file["tangential_load"].shape == (700, 3, 4)
        assert [axis.keys()[0] for axis in file["tangential_load"].dims] == AXES
    with xarray.open_dataset(path, engine="h5netcdf") as found:
        assert list(found.tangential_load.dims) == AXES
        np.testing.assert_array_equal(found.displacement, PUSHED.displacements)
    assert whole.to_xarray()["tangential_load"].attrs["units"] == "N"
    with h5py.File(path, "r+") as file:
        file["displacement"][1] = 2e-9
    with pytest.raises(StoreError):
        mcgw.open_ensemble(path)
