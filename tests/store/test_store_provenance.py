"""All that is needed to repeat a run is in its file; and its memory does not grow with the ensemble."""

import json
import subprocess
from importlib.metadata import version
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.stats
from oracles.inside import SAMPLERS, home, sampler_of
from oracles.memory_growth import peak_growth
from oracles.scenes import scene_by

import analytic
import mcgw

GOLDEN = Path(__file__).parents[1] / "golden_samplers.json"


def test_what_is_recorded(make_scene, tmp_path):
    scene = make_scene(n_surfaces=2)
    mcgw.run(scene, tmp_path / "a.h5")
    with h5py.File(tmp_path / "a.h5") as file:
        known = {key: x.decode() if isinstance(x, bytes) else x for key, x in file.attrs.items()}
        units = {name: file[name].attrs["units"].decode() for name in scene.quantities}
        whole = [name for name in scene.quantities if file[name].dtype == "<i8"]
    assert units == {"load": "N", "area": "m^2", "stiffness": "N/m", "contacts": "1"}
    assert whole == ["contacts"]
    for package in ("mcgw", "numpy", "scipy", "numba", "h5py"):
        assert f"{package} {version(package)}" in known["versions"]
        assert (package in known["draws"]) == (package != "h5py")
    git = subprocess.run(["git", "rev-parse", "HEAD"], cwd=GOLDEN.parent, capture_output=True, text=True)
    assert known["commit"] == (git.stdout.strip() or "unknown")
    assert {"date", "wall_seconds", "seed", "run", "cpu"} <= set(known)
    assert known["cpu"].endswith(" cores)") == Path("/proc/cpuinfo").exists()
    assert known["sampler"] != "auto"


class OwnHeights(analytic.ExponentialHeights):
    """A law of the user: whatever its methods do, a file cannot hold them."""


class OwnScipy(type(scipy.stats.expon)):
    """One made of scipy's, that may do more."""


@pytest.mark.parametrize("heights", [OwnHeights(), OwnScipy(a=0.0, name="expon")()])
def test_a_height_law_that_no_file_can_hold_is_refused(make_scene, tmp_path, heights):
    scene = make_scene(heights=heights, n_surfaces=2)
    with pytest.raises(
        ValueError, match=r"^heights: Own.* is a Python class that a file cannot store; give a "
    ):
        mcgw.run(scene, tmp_path / "a.h5")
    assert not list(tmp_path.iterdir())
    assert mcgw.simulate(scene).load.shape == (2, 9)


CASES = {name: {"sampler": name} for name in SAMPLERS[1:]} | {
    "crowds to 1e-2": {"accuracy": 1e-2, "n_asperities": 10**7},
}


def drawn(case, seed=20240601):
    """Two surfaces of each sampler, and of those that are asked for less."""
    surface = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)
    scene = scene_by(
        surface=surface,
        separations=(0.0, 1.5, 3.0),
        grading=analytic.Exponential(2.0),
        seed=seed,
        **{"n_asperities": 2000, **CASES[case]},
    )
    return {name: values.ravel().tolist() for name, values in sampler_of(scene).block(3, 2).items()}


@pytest.mark.parametrize("case", CASES)
def test_golden_numbers(case):
    """Stored once: any change of the draws is seen. With any NumPy those without cells agree to 1e-12.

    A change on purpose makes old runs impossible to go on with, so it needs another version of the package;
    then ``python tests/store/test_store_provenance.py`` stores them anew.
    """
    stored = json.loads(GOLDEN.read_text())
    golden, of_numpy = stored[case], stored["numpy"]
    if case not in ("direct", "tail") and of_numpy != np.__version__.rpartition(".")[0]:
        pytest.skip(f"numbers in cells are of the multinomial of NumPy {of_numpy}, whose stream may change")
    found = drawn(case)
    assert set(found) == set(golden)
    for name, values in found.items():
        np.testing.assert_allclose(values, golden[name], rtol=1e-12, atol=0)


@pytest.mark.slow
def test_memory_does_not_grow_with_the_ensemble(make_scene, tmp_path, blocks_of):
    """Peak memory of a run that is merged: 32 times the surfaces, 1e4 the asperities.

    The larger file has 80 MB of numbers; 25 MB is what allocators differ by from run to run.
    """
    blocks_of(256)

    def peak(m, n):
        separations = tuple(np.linspace(2, 4, 40))
        scene = make_scene(n_surfaces=m, n_asperities=n, separations=separations, sampler="aggregate")
        return peak_growth(lambda: mcgw.run(scene, tmp_path / f"{m}-{n}.h5"))

    first = peak(256, 10**4)
    assert not max(peak(8192, 10**4), peak(256, 10**8)) > first + 25e6  # nan where the system does not tell


def test_what_keeps_two_runs_apart_is_said(make_scene):
    """What differs first; a key that only one has, on either side; then what draws, and on what."""
    one = make_scene(quantities=("load",))
    changes = ({}, {"seed": 9}, {"accuracy": 0.5e-3}, {"n_surfaces": 7})
    text, seed, cut, more = (mcgw.scene_text(one.replace(**change)) for change in changes)
    for there, here, told in (
        ((text, "", "a"), (seed, "", "b"), "ensemble.seed is 1 there and 9 here"),
        ((cut, "", "a"), (text, "", "a"), "ensemble.accuracy is 0.0005 there and not given here"),
        ((text, "", "a"), (cut, "", "a"), "ensemble.accuracy is None there and 0.0005 here"),
        ((text, "x", "a"), (text, "y", "a"), "sweep is 'x' there and 'y' here"),
        ((text, "", "numpy 1"), (more, "", "numpy 2"), "it was drawn with numpy 1, but this is numpy 2"),
    ):
        assert home("another").difference(there, here) == told


if __name__ == "__main__":
    stored = {"numpy": np.__version__.rpartition(".")[0], **{case: drawn(case) for case in CASES}}
    GOLDEN.write_text(json.dumps(stored, indent=1) + "\n")
