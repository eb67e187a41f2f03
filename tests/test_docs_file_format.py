"""The page of the file format names all that a file holds."""

import re

import h5py

import mcgw
import mcgw.store
import mcgw.sweeps.file

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")


def test_every_dataset_and_attribute_is_described(tmp_path):
    asked = {"quantities": ("load", "area", "stiffness", "contacts", "conductance"), "keep": "moments"}
    scene = mcgw.Scene(
        SURFACE, separations=[0.0, 1.0], n_surfaces=3, seed=1, title="x", interaction="body", **asked
    )
    mcgw.run(scene, tmp_path / "a.h5")
    words = set(re.findall(r"\w+", mcgw.store.__doc__))
    with h5py.File(tmp_path / "a.h5") as file:
        found = set(file.attrs)
        file.visit(lambda name: found.update(name.split("/")))
        for name in ("load", "surface"):
            found |= {
                key for key in file[name].attrs if key.islower()
            }  # those of HDF5 itself are in capitals
    assert found - words == set()
    assert {"load", "moments", "digest", "units"} <= found


def test_every_dataset_of_a_sweep_is_described(tmp_path):
    scene = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=10, seed=1, title="x")
    mcgw.sweep(scene, {"grading.gamma": [0.5, 2.0]}, path=tmp_path / "a.h5")
    words = set(re.findall(r"\w+", mcgw.sweeps.file.__doc__))
    quantities = {f"{name}_" for name in scene.quantities}
    with h5py.File(tmp_path / "a.h5") as file:
        found = set(file.attrs) | set(file) | set(file["drawn"])
        assert file.attrs["filetype"] == "mcgw-sweep"
    told = {name for name in found if name.startswith(tuple(quantities))}  # as those of the load
    assert found - told - words - {"grading.gamma"} == set()
    assert {"load_mean", "load_std"} <= told
