"""All that is needed to repeat a run is in its file; and its memory does not grow with the ensemble."""

import json
import re
import sys
from importlib.metadata import PackageNotFoundError
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import scipy.stats
from oracles.inside import SAMPLERS, Values, sampler_of
from oracles.memory_growth import peak_growth
from oracles.scenes import scene_by

import analytic
import mcgw
from mcgw.store import identity

GOLDEN = Path(__file__).parents[1] / "golden_samplers.json"


def test_what_is_recorded(make_scene, tmp_path):
    mcgw.run(make_scene(n_surfaces=2), tmp_path / "a.h5")
    with h5py.File(tmp_path / "a.h5") as file:
        known = {key: x.decode() if isinstance(x, bytes) else x for key, x in file.attrs.items()}
    for package in ("python", "mcgw", "numpy", "scipy", "numba", "h5py"):
        assert package in known["versions"]
    for key in ("commit", "date", "cpu", "wall_seconds", "sampler", "seed", "run", "draws"):
        assert key in known
    assert known["sampler"] != "auto"
    cores = Path("/proc/cpuinfo").read_text() if sys.platform == "linux" else ""
    if names := re.findall(r"model name\s*: (.+)", cores):
        assert known["cpu"].startswith(names[0].strip())


class OwnHeights(analytic.ExponentialHeights):
    """A law of the user: whatever its methods do, a file cannot hold them."""


class OwnScipy(type(scipy.stats.expon)):
    """One made of scipy's, that may do more."""


@pytest.mark.parametrize(
    ("heights", "name"), [(OwnHeights(), "OwnHeights"), (OwnScipy(a=0.0, name="expon")(), "OwnScipy")]
)
def test_a_height_law_that_no_file_can_hold_is_refused(make_scene, tmp_path, heights, name):
    scene = make_scene(heights=heights, n_surfaces=2)
    with pytest.raises(
        ValueError, match=f"^heights: {name} is a Python class that a file cannot store; give a "
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
    return {name: values.ravel().tolist() for name, values in sampler_of(scene).block(3, 2).sums.items()}


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
def test_memory_does_not_grow_with_the_ensemble(make_scene, tmp_path, monkeypatch):
    """Peak memory of a run that is merged: 32 times the surfaces, 1e4 the asperities.

    The larger file has 80 MB of numbers; 25 MB is what allocators differ by from run to run.
    """
    monkeypatch.setattr(Values, "rows", 256)

    def peak(m, n):
        separations = tuple(np.linspace(2, 4, 40))
        scene = make_scene(n_surfaces=m, n_asperities=n, separations=separations, sampler="aggregate")
        return peak_growth(lambda: mcgw.run(scene, tmp_path / f"{m}-{n}.h5"))

    first = peak(256, 10**4)
    assert not max(peak(8192, 10**4), peak(256, 10**8)) > first + 25e6  # nan where the system does not tell


if __name__ == "__main__":
    stored = {"numpy": np.__version__.rpartition(".")[0], **{case: drawn(case) for case in CASES}}
    GOLDEN.write_text(json.dumps(stored, indent=1) + "\n")


# --- what is not known is said to be so ---


def test_versions_are_those_of_the_packages_and_of_some_unknown(monkeypatch):
    known = {"mcgw": "1.2", "numpy": "2.0", "scipy": "1.1", "numba": "0.6"}

    def version(name):
        if name not in known:
            raise PackageNotFoundError(name)
        return known[name]

    monkeypatch.setattr(identity, "version", version)
    monkeypatch.setattr(identity.platform, "python_version", lambda: "3.99")
    told = identity.versions.__wrapped__
    assert told() == "python 3.99, mcgw 1.2, numpy 2.0, scipy 1.1, numba 0.6, h5py unknown"
    assert told(of_draws=True) == "mcgw 1.2, numpy 2.0, numba 0.6, scipy 1.1"


def test_the_commit_is_that_of_the_checkout_if_there_is_one(tmp_path, monkeypatch):
    package = tmp_path / "mcgw" / "store"
    package.mkdir(parents=True)
    monkeypatch.setattr(identity, "__file__", str(package / "identity.py"))
    told = identity.commit.__wrapped__
    assert told() == "unknown"  # installed
    (tmp_path / ".git").mkdir()
    assert told() == "unknown"  # git fails

    def git(call, **_):
        assert call == ["git", "-C", str(tmp_path), "rev-parse", "HEAD"]
        return SimpleNamespace(stdout="abc\n")

    monkeypatch.setattr(identity.subprocess, "run", git)
    assert told() == "abc"


def test_a_processor_is_told_by_what_the_system_knows(tmp_path, monkeypatch):
    info = tmp_path / "cpuinfo"
    info.write_text(
        "processor : 0\nmodel name : Z80 at 4: MHz\n\nprocessor : 1\nmodel name : Z80 at 4: MHz\n"
    )
    monkeypatch.setattr(identity, "Path", lambda _: info)
    monkeypatch.setattr(identity.sys, "platform", "linux")
    monkeypatch.setattr(identity.platform, "processor", lambda: "")
    monkeypatch.setattr(identity.platform, "machine", lambda: "z80")
    told = identity.processor.__wrapped__
    assert told() == "Z80 at 4: MHz (2 cores)"
    monkeypatch.setattr(identity.sys, "platform", "plan9")
    assert told() == "z80"
    monkeypatch.setattr(identity.sys, "platform", "linux")
    monkeypatch.setattr(identity.platform, "processor", lambda: "Z")
    info.write_text("processor : 0\n")
    assert told() == "Z"
    info.unlink()
    assert told() == "Z"


def test_what_keeps_two_runs_apart_is_said(make_scene):
    """What differs first; a key that only one has, on either side; then what draws, and on what."""
    one = make_scene(quantities=("load",))
    cut = one.replace(accuracy=0.5e-3)
    text, other = mcgw.scene_text(one), mcgw.scene_text(cut)
    told = identity.difference
    assert told((text, "", "a"), (mcgw.scene_text(one.replace(seed=9)), "", "b")) == (
        "ensemble.seed is 1 there and 9 here"
    )
    assert told((other, "", "a"), (text, "", "a")) == "ensemble.accuracy is 0.0005 there and not given here"
    assert told((text, "", "a"), (other, "", "a")) == "ensemble.accuracy is None there and 0.0005 here"
    assert told((text, "x", "a"), (text, "y", "a")) == "sweep is 'x' there and 'y' here"
    more = mcgw.scene_text(one.replace(n_surfaces=7))
    assert told((text, "", "numpy 1"), (more, "", "numpy 2")) == (
        "it was drawn with numpy 1, but this is numpy 2"
    )
