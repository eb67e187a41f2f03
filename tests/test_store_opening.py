"""What is opened is what was written: all that is small is checked whenever a file is opened."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from new_trailer import trailer_again

import mcgw
from mcgw.errors import StoreError
from mcgw.jobs.job import Job
from mcgw.jobs.running import run, run_part
from mcgw.jobs.session import Part
from mcgw.store import ensembles, layout, run_folder, saving, structure
from mcgw.store.run_folder import RunFolder, parts_of
from mcgw.store.trailer import trailer_of

CRASH = Path(__file__).parent / "crash"


def flipped(folder, flips, *words):
    """What the harness says of so many flips."""
    place = (Path("/dev/shm") if Path("/dev/shm").is_dir() else folder) / f"flips-{folder.name}-{os.getpid()}"
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(CRASH.parent.parent), str(CRASH)])}
    call = [sys.executable, CRASH / "flips.py", place, str(flips), *words]
    try:
        done = subprocess.run(call, env=env, capture_output=True, text=True, check=True, timeout=500)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    return json.loads(done.stdout)


def test_flipped_bits_are_seen_on_opening(tmp_path):
    found = flipped(tmp_path, 60)
    assert found["flips"] == sum(place["flips"] for place in found["where"].values()) == 60
    assert len(found["where"]) == 10
    assert found["unseen"] == 0, found


def test_the_harness_sees_files_without_the_checksum(tmp_path):
    """A companion: in files of format 1.0 such flips went unnoticed."""
    assert flipped(tmp_path, 40, "old")["unseen"] > 0


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0), sampler="tail", n_surfaces=20)


@pytest.fixture
def file(scene, tmp_path, monkeypatch):
    """A finished file; looked at in this process, a child takes a second."""
    monkeypatch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))
    run(scene, tmp_path / "e.h5")
    return tmp_path / "e.h5"


@pytest.fixture
def old_file(scene, file, monkeypatch):
    """The same as version 0.2 wrote it."""
    file.unlink()
    monkeypatch.setattr(layout, "FORMAT", (1, 0))
    monkeypatch.setattr(saving, "trailer_notes", lambda opened: {})
    run(scene, file)
    return file


def test_files_of_format_1_0_are_opened(old_file, scene):
    with h5py.File(old_file) as data:
        assert tuple(data.attrs["format"]) == (1, 0)
    np.testing.assert_array_equal(mcgw.open_ensemble(old_file).load, mcgw.simulate(scene).load)
    assert ensembles.verify(old_file)[0] == ""


def test_a_new_file_without_the_checksum_is_refused(file):
    """Nobody makes it one of format 1.0 by leaving the checksum away."""
    with h5py.File(file, "r+") as data:
        data.attrs["seed"] = np.uint64(5)
    body = file.read_bytes()
    file.write_bytes(body + trailer_of(body))
    with pytest.raises(StoreError, match="checksum mismatch of its scene, attributes or scales"):
        mcgw.open_ensemble(file)


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.attrs.__setitem__("title", "another"),
        lambda data: data.attrs.__setitem__("wall_seconds", 1.0),
        lambda data: data.attrs.__setitem__("note", "added"),
        lambda data: data.attrs.__delitem__("cpu"),
        lambda data: data["load"].attrs.__setitem__("units", "kN"),
        lambda data: data["area"].attrs.__setitem__("long_name", "something else"),
        lambda data: data["separation"].__setitem__(1, 1.0000000000000002),
        lambda data: data["surface"].__setitem__(3, 4),
        lambda data: data["load"].dims[1].detach_scale(data["separation"]),
        lambda data: data.create_dataset("more", data=np.ones(3)),
    ],
)
def test_whatever_is_small_is_checked(file, change):
    """The trailer fits the bytes, only the checksum of the head is the old one."""
    head = structure.describe(str(file))["head"]
    with h5py.File(file, "r+") as data:
        change(data)
    body = file.read_bytes()
    file.write_bytes(body + trailer_of(body, head=head))
    with pytest.raises(StoreError, match="checksum mismatch of its scene, attributes or scales"):
        mcgw.open_ensemble(file)


def test_the_checksum_is_of_contents_alone(file):
    """Rewritten by another layout and sealed again it is the same."""
    head = structure.describe(str(file))["head"]
    with h5py.File(file, "r+") as data:
        values, units = data["load"][()], dict(data["load"].attrs)
        del data["load"]
        data.create_dataset("load", data=values)
        data["load"].attrs.update({key: units[key] for key in ("long_name", "units")})
        for axis, name in enumerate(("surface", "separation")):
            data["load"].dims[axis].attach_scale(data[name])
    assert structure.describe(str(file))["head"] == head


@pytest.mark.parametrize(("name", "value"), [("separation", 1.5), ("surface", 7)])
def test_scales_must_be_those_of_the_scene(old_file, name, value):
    """Also where no checksum guards them, and where somebody sealed the file anew."""
    with h5py.File(old_file, "r+") as data:
        data[name][1] = value
    trailer_again(old_file)
    with pytest.raises(StoreError, match=f"{name} does not hold the values that its scene declares"):
        mcgw.open_ensemble(old_file)


def test_a_file_without_a_trailer_is_refused_in_one_line(file):
    data = file.read_bytes()
    for changed in (data[:-512], data + b"\0"):
        file.write_bytes(changed)
        with pytest.raises(StoreError, match="no trailer at its end, so it was cut off or changed") as caught:
            mcgw.open_ensemble(file)
        assert "\n" not in str(caught.value)


def test_a_changed_number_is_an_error_when_it_is_read(file):
    """Each chunk has a checksum: what HDF5 reads is what was written, or nothing."""
    data, dice = bytearray(file.read_bytes()), np.random.default_rng(5)
    with h5py.File(file) as opened:
        chunk = opened["load"].id.get_chunk_info(0)
    for at in dice.integers(chunk.byte_offset, chunk.byte_offset + chunk.size, 20):
        changed = data.copy()
        changed[at] ^= 1 << int(dice.integers(8))
        file.write_bytes(changed)
        with pytest.raises(StoreError, match="cannot be read; is it damaged"):
            ensembles.FileResults(file).read("load", 0, None)


@pytest.fixture
def begun(scene, tmp_path, monkeypatch):
    """A run of which half is done."""
    monkeypatch.setattr(Job, "rows", 5)
    run_part(scene, tmp_path / "b.h5", Part(1, 2))
    return parts_of(tmp_path / "b.h5")


def test_another_scene_in_a_run_is_noticed(begun):
    file = begun / "run.toml"
    good = file.read_text()
    assert "sigma = 1.37e-06" in good
    file.write_text(good.replace("sigma = 1.37e-06", "sigma = 1.37e-05"))
    with pytest.raises(StoreError, match=r"run\.toml: damaged \(checksum mismatch\)"):
        RunFolder.open(begun)
    file.write_text(good[: good.index("sha256")])
    with pytest.raises(StoreError, match=r"run\.toml: damaged"):
        RunFolder.open(begun)


def test_runs_of_format_1_0_go_on(begun, scene, monkeypatch):
    file = begun / "run.toml"
    text = file.read_text()
    old = text[: text.index("sha256")].replace("    1,\n    1,\n", "    1,\n    0,\n")
    assert old.count("    0,\n") == 1
    file.write_text(old)
    monkeypatch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))
    assert run(scene, begun.with_suffix("")).n_surfaces == 20
    assert not begun.exists()


def test_the_checksum_of_a_run_is_of_its_text(begun):
    """Computed here anew, by what the format says: the last line is of all before it."""
    text = (begun / "run.toml").read_bytes()
    *lines, last = text.splitlines(keepends=True)
    expected = run_folder.hashlib.sha256(b"".join(lines)).hexdigest()
    assert last == f'sha256 = "{expected}"\n'.encode()
