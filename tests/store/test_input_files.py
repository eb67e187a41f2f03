"""HDF5 files from elsewhere: hostile and damaged ones are errors, not crashes or hangs."""

import json
import os
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import h5py
import numpy as np
import pytest
from oracles.inside import MOST_TEXT, attributes_in, checksum_of, open_results, table_names, verify

import mcgw
from mcgw.errors import StoreError

TESTS = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def good(make_scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("good") / "e.h5"
    mcgw.run(make_scene(separations=(1.0, 2.0), n_surfaces=20, sampler="tail"), path)
    return path.read_bytes()


@pytest.fixture
def path(good, tmp_path):
    (tmp_path / "e.h5").write_bytes(good)
    return tmp_path / "e.h5"


def load(*of, **options):
    """A dataset that h5py makes of these, in place of that of loads."""
    return lambda data: data.create_dataset("load", *of, **options)


def put(**items):
    return lambda data: data.update(items)


# What is made where the dataset of loads was taken away, and what is said of it; see `formats/test_gate`.
ONES, NONE = np.ones((20, 2)), h5py.Empty("f8")
HOSTILE = {
    "external link": (put(load=h5py.ExternalLink("other.h5", "/load")), "load: a link to another file"),
    "soft loop": (put(load=h5py.SoftLink("/load")), "not an HDF5 file, or a damaged one"),
    "group": (lambda data: data.create_group("load"), "load: not a table"),
    "int32": (load(data=ONES.astype("int32")), "load: not a table"),
    "empty": (put(load=NONE), "load: not a table"),
    "other numbers": (put(load=ONES), "damaged"),
    "missing": (lambda data: None, "damaged"),
    "no group": (put(drawn=ONES), "damaged"),
    "a link in the group": (
        lambda data: data.create_group("drawn").update({"x": h5py.SoftLink("/load")}), "damaged",
    ),
    "no scene": (lambda data: (data.update(load=ONES), data.attrs.pop("scene")), "damaged"),
    "odd attribute": (
        lambda data: (data.update(load=ONES), data.attrs.update(wall_seconds=NONE)),
        "attribute wall_seconds|not an HDF5 file, or a damaged one",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("change", "told"), HOSTILE.values(), ids=HOSTILE)
def test_hostile_files_are_refused(change, told, path):
    with h5py.File(path, "r+") as data:
        del data["load"]
        change(data)
    with pytest.raises(StoreError, match=told) as caught:
        mcgw.open_ensemble(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_a_scene_that_this_version_cannot_read_is_one_line(path):
    with h5py.File(path, "r+") as data:
        data.attrs["scene"] = "[" * 5000
        data.attrs["checksum"] = checksum_of(data)
    with pytest.raises(StoreError, match="its scene cannot be read: this is not TOML"):
        mcgw.open_ensemble(path)


def test_other_files_and_formats_are_named(good, tmp_path):
    found = r"(results \[[02], [09]\]|ensemble \[\d, \d\]) is not read by this version"
    files = {
        "not an HDF5 file, or a damaged one": [b"", b"load,area\n1,2\n", os.urandom(5000)],
        "holds no results of mcgw": [{"filetype": "x"}],
        found: [{"format": (2, 0)}, {"format": (0, 9)}, {"filetype": "mcgw-ensemble"}],
    }
    for told, contents in files.items():
        for content in contents:
            (tmp_path / "e.h5").write_bytes(content if isinstance(content, bytes) else good)
            if isinstance(content, dict):
                with h5py.File(tmp_path / "e.h5", "r+") as data:
                    data.attrs.update(content)
            with pytest.raises(StoreError, match=told):
                mcgw.open_ensemble(tmp_path / "e.h5")


# What a file may hold of something, as `n`, and with one more the line that refuses it.
LIMITS = {
    "tables": (128, lambda file, n: [file.create_dataset(f"x{k}", data=ONES) for k in range(n)],
     "^129 datasets; at most 128 are allowed$"),
    "tables of the group": (128, lambda file, n: [file.create_dataset(f"drawn/x{k}", data=ONES)
                                                  for k in range(n)], "^129 datasets; at most 128 are"),
    "numbers of an attribute": (64, lambda file, n: file.attrs.update(format=np.zeros(n)),
     "^attribute format: too large$"),
    "characters": (MOST_TEXT, lambda file, n: file.attrs.update(title="x" * n),
     "^attribute title: too large$"),
    "lines of a text": (0, lambda file, n: file.attrs.update(title="a\nb", axes="a\nb", date="a" + "\n" * n),
     "^attribute date: not one line of text$"),
    "parts of a number": (1, lambda file, n: file.attrs.update(
        n=np.int32(1), wall_seconds=0.5, seed=np.complex128(1) if n > 1 else np.uint64(2)),
     "^attribute seed: neither text nor number$"),
    "axes": (-1, lambda file, n: file.__setitem__("x", np.ones(1) if n < 0 else np.float64(1)),
     "^x: not a table of 64-bit numbers$"),
}  # fmt: skip


@pytest.mark.parametrize("what", LIMITS)
def test_a_file_may_hold_so_much_and_no_more(what, tmp_path):
    most, change, told = LIMITS[what]
    for n in (most, most + 1):
        with h5py.File(tmp_path / f"{n}.h5", "w") as file:
            change(file, n)
            with nullcontext() if n == most else pytest.raises(StoreError, match=told):
                table_names(file), attributes_in(file)


@pytest.mark.slow
def test_damaged_files_are_read_or_refused():
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(TESTS.parent), str(TESTS)])}
    call = [sys.executable, str(TESTS / "fuzz" / "fuzz.py"), "100", "1"]
    done = subprocess.run(call, env=env, capture_output=True, text=True, check=True, timeout=300)
    found = json.loads(done.stdout)
    assert 0 < found["accepted"] < found["inputs"] == 100  # it reaches the good and the bad
    assert found["failures"] == []


KINDS = {
    "values": lambda scene, path: mcgw.run(scene, path),
    "statistics": lambda scene, path: mcgw.run(scene.replace(keep="statistics"), path),
    "sweep": lambda scene, path: mcgw.sweep(scene, {"grading.gamma": [0.5, 1.0]}, path=path),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_that_another_program_opened_for_writing_is_read_and_grows(kind, make_scene, tmp_path):
    path, scene = tmp_path / "e.h5", make_scene(n_surfaces=20, separations=(0.0, 1.0))
    before = KINDS[kind](scene, path).mean("load")
    with h5py.File(path, "a") as file:
        file.attrs["comment"] = "seen"
        file["separation"].attrs["comment"] = "seen"
    assert (open_results(path).mean("load") == before).all()
    assert verify(path)[0] == ""
    data = path.read_bytes()
    KINDS[kind](scene, path)  # it is done
    assert path.read_bytes() == data
    if kind == "values":
        grown = mcgw.run(scene, path, n_surfaces=30)
        assert (grown.load == mcgw.simulate(scene, n_surfaces=30).load).all()


def test_a_file_that_xarray_wrote_anew_is_read(make_scene, tmp_path):
    xarray = pytest.importorskip("xarray")
    path, scene = tmp_path / "e.h5", make_scene(n_surfaces=20, separations=(0.0, 1.0))
    before = mcgw.run(scene, path).load
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        data.load().to_netcdf(tmp_path / "new.h5", engine="h5netcdf")
    assert (mcgw.open_ensemble(tmp_path / "new.h5").load == before).all()
