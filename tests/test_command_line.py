"""The commands, as a user types them."""

import os
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from new_trailer import trailer_again
from said import call, without_notes

import mcgw

SCENE = Path(__file__).parent.parent / "runs" / "quick.toml"


def child(*words, cwd=None):
    """In a process of its own, by the entry point of `python -m mcgw`."""
    command = [sys.executable, "-m", "mcgw", *map(str, words)]
    env = os.environ | {"PYTHONPATH": str(SCENE.parent.parent)}
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, env=env, check=False, timeout=120)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "quick.h5"
    done = child("run", SCENE, "-o", path)
    assert (done.returncode, without_notes(done.stderr)) == (0, "")
    assert str(path) in done.stdout
    return path


def test_command_line_and_python_give_the_same_bits(file):
    ensemble, again = mcgw.open_ensemble(file), mcgw.simulate(mcgw.load_scene(SCENE))
    for name in again.scene.quantities:
        np.testing.assert_array_equal(ensemble.values(name), again.values(name))


def test_file_keeps_to_its_schema(file):
    units = {"load": "N", "area": "m^2", "stiffness": "N/m", "contacts": "1", "conductance": "m"}
    with h5py.File(file) as data:
        assert data.attrs["filetype"] == "mcgw-ensemble"
        assert tuple(data.attrs["format"]) == (1, 1)
        assert data.attrs["seed"] == 1
        assert bool(data.attrs["complete"])
        for key in ("scene", "sampler", "versions", "commit", "date", "cpu", "wall_seconds"):
            assert key in data.attrs
        for name, unit in units.items():
            assert data[name].shape == (200, 9)
            assert data[name].attrs["units"] == unit
            assert data[name].dtype == ("<i8" if name == "contacts" else "<f8")


def test_xarray_opens_it_as_it_is(file):
    with xarray.open_dataset(file, engine="h5netcdf") as data:
        assert dict(data.sizes) == {"surface": 200, "separation": 9}
        assert data["load"].attrs["units"] == "N"
        np.testing.assert_array_equal(data["separation"], np.linspace(0, 4, 9))
        np.testing.assert_array_equal(data["load"], mcgw.open_ensemble(file).load)


def test_show(file):
    shown = call("show", file).stdout
    assert "200 of 1000 asperities" in shown
    assert "normal load (N)" in shown
    scene = call("show", file, "--scene").stdout
    assert mcgw.scene_from(scene) == mcgw.load_scene(SCENE)
    assert call("show", file, "--verify").returncode == 0
    assert len(call("show", file, "--digest").stdout.strip()) == 64


def test_a_changed_number_is_noticed(file, tmp_path):
    copy = tmp_path / "copy.h5"
    copy.write_bytes(file.read_bytes())
    with h5py.File(copy, "r+") as data:
        data["load"][3, 3] *= 1 + 1e-15
    assert child("show", copy, "--verify").returncode == 1


def test_compare_agrees_and_draws(file, tmp_path):
    picture = tmp_path / "quick.png"
    done = call("compare", file, "-o", picture)
    assert done.returncode == 0, done.stderr
    assert "Monte Carlo and theory of this model agree" in done.stdout
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_compare_fails_where_they_differ(file, tmp_path):
    wrong = tmp_path / "wrong.h5"
    wrong.write_bytes(file.read_bytes())
    with h5py.File(wrong, "r+") as data:
        data["load"][...] *= 1.05
    trailer_again(wrong)
    done = call("compare", wrong, "-o", tmp_path / "wrong.png")
    assert done.returncode == 1
    assert "DISAGREE" in done.stdout


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("run", "absent.toml"), "absent.toml: No such file"),
        (("show", "absent.h5"), "absent.h5: No such file"),
        (("compare", SCENE), "not an HDF5 file"),
        (("run", SCENE, "--threads", "0", "-o", "x.h5"), "threads = 0: give a whole number >= 1"),
    ],
)
def test_bad_input_is_one_line_and_exit_code_2(words, message, tmp_path):
    done = call(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.startswith("mcgw: ")
    assert len(done.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_all_mistakes_of_a_scene_are_listed(tmp_path):
    scene = tmp_path / "bad.toml"
    scene.write_text(SCENE.read_text().replace("sigma", "sigam").replace("radius = 13e-6", "radius = nan"))
    done = call("run", scene)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 3


@pytest.mark.parametrize("command", ["run", "show", "compare", "merge"])
def test_help_has_an_example(command):
    done = call(command, "--help")
    assert done.returncode == 0
    assert f"example: mcgw {command}" in done.stdout


def test_a_child_answers_as_this_process_does(file, tmp_path):
    """What other tests see in this process: exit code, output and errors of the entry point."""
    for words in (("show", file), ("run", "absent.toml"), ("merge", "--help")):
        ours, theirs = call(*words, cwd=tmp_path), child(*words, cwd=tmp_path)
        said = (theirs.returncode, theirs.stdout, theirs.stderr)
        assert said == (ours.returncode, ours.stdout, ours.stderr), words
