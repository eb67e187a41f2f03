"""What is damaged is never gone on with: each kind of damage, and then every way of going on."""

import h5py
import numpy as np
import pytest
from oracles.begun_runs import SURFACES, begun, in_small_blocks
from oracles.inside import RECORD, Plan, parts_of

import mcgw
from mcgw.cli import main
from mcgw.errors import RunError, StoreError
from mcgw.store import ensembles, h5_reading


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    in_small_blocks(monkeypatch)


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0, 3.0), sampler="tail", n_surfaces=SURFACES)


@pytest.fixture
def larger(scene):
    return scene.replace(n_surfaces=SURFACES + 30)


def flip(path, place):
    data = bytearray(path.read_bytes())
    data[place] ^= 4
    path.write_bytes(data)


def changed_in_place(path):
    """A number in the data; HDF5 opens the file as if nothing were."""
    with h5py.File(path, "r") as file:
        place = file["separation"].id.get_chunk_info(0).byte_offset
    flip(path, place + 3)


def flipped_in_a_result(path):
    """One bit of the stored loads: only who reads them, or all bytes, can see it."""
    with h5py.File(path, "r") as file:
        place = file["load"].id.get_chunk_info(0).byte_offset
    flip(path, place + 30)


def a_changed_load(path):
    """A number of a result, written by HDF5 itself over the old one."""
    with h5py.File(path, "r+") as file:
        file["load"][3, 1] *= 1 + 1e-12


def cut(path):
    path.write_bytes(path.read_bytes()[:-100])


def with_another_checksum(path):
    with h5py.File(path, "r+") as file:
        file.attrs["checksum"] = "0" * 64


DAMAGES = [changed_in_place, flipped_in_a_result, a_changed_load, cut, with_another_checksum]


# Every way to put more into a file.
WAYS = {
    "run": mcgw.run,
    "shard job": lambda scene, path: mcgw.run(scene, path, shard="1/2"),
    "stop rule": lambda scene, path: mcgw.run(scene.replace(rel_err=1e-4), path),
}


@pytest.mark.filterwarnings("ignore:.* more surfaces than n_surfaces allows")  # said before it is opened
@pytest.mark.parametrize(
    ("way", "damage", "large"),
    [*(("run", damage, False) for damage in DAMAGES),
     *((way, damage, damage is flipped_in_a_result) for way in WAYS
       for damage in (changed_in_place, flipped_in_a_result))][1:],
)  # fmt: skip
def test_a_damaged_file_is_not_extended_nor_sealed_anew(
    scene, larger, tmp_path, damage, way, large, monkeypatch
):
    """Of a large file only the head is looked at on opening: all of it before more is drawn for it."""
    damaged = tmp_path / "e.h5"
    mcgw.run(scene, damaged)
    assert ensembles.verify(damaged)[0] == ""
    damage(damaged)
    if large:
        monkeypatch.setattr(h5_reading, "LARGE", 0)
        assert ensembles.open_ensemble(damaged).n_surfaces == SURFACES
    before = damaged.read_bytes()
    with pytest.raises(StoreError):
        WAYS[way](larger, damaged)
    assert damaged.read_bytes() == before
    assert not parts_of(damaged).exists() or not list(parts_of(damaged).glob("shards/*.h5"))
    assert ensembles.verify(damaged)[1] == "unreadable"


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_file_damaged_while_more_is_drawn_is_not_merged(scene, larger, tmp_path, damage, capsys):
    """Its own surfaces come first in the file that takes its place: they are looked at again."""
    path = tmp_path / "e.h5"
    mcgw.run(scene, path)
    assert mcgw.run(larger, path, shard="1/1") == 0
    assert main(["show", "--verify", str(path)]) == 0
    assert "intact" in capsys.readouterr().out
    damage(path)
    assert main(["show", "--verify", str(path)]) == 1
    assert "DAMAGED" in capsys.readouterr().out
    before = path.read_bytes()
    with pytest.raises((StoreError, RunError)):
        mcgw.merge(path)
    assert path.read_bytes() == before


def test_seconds_of_all_blocks_and_of_the_file_before_add_up(scene, larger, tmp_path):
    path = tmp_path / "e.h5"
    begun(scene, path)
    each = [shard.seconds for shard in Plan.open(parts_of(path)).shards()]
    mcgw.merge(path)
    first = ensembles.read_attributes(path)["wall_seconds"]
    assert first == pytest.approx(sum(each), rel=1e-12)
    assert mcgw.run(larger, path, shard="1/1") == 0
    more = [shard.seconds for shard in Plan.open(parts_of(path)).shards()]
    mcgw.merge(path)
    assert ensembles.read_attributes(path)["wall_seconds"] == pytest.approx(first + sum(more), rel=1e-12)
    assert sum(more) > 0


# --- what is small is checked whenever a file is opened -------------------------------------------------


@pytest.fixture
def file(scene, tmp_path):
    """A finished file."""
    mcgw.run(scene, tmp_path / "e.h5")
    return tmp_path / "e.h5"


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.attrs.__setitem__("title", "another"),
        lambda data: data.attrs.__setitem__("wall_seconds", 1.0),
        lambda data: data.attrs.__delitem__("cpu"),
        lambda data: data["load"].attrs.__setitem__("units", "kN"),
        lambda data: data["area"].attrs.__setitem__("long_name", "something else"),
        lambda data: data["separation"].__setitem__(1, 1.0000000000000002),
        lambda data: data["surface"].__setitem__(3, 4),
        lambda data: data.create_dataset("more", data=np.ones(3)),
    ],
)
def test_whatever_is_small_is_checked(file, change):
    with h5py.File(file, "r+") as data:
        change(data)
    with pytest.raises(
        StoreError, match=r"checksum mismatch of (its scene or attributes|separation|surface)"
    ):
        mcgw.open_ensemble(file)


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
def half(scene, tmp_path):
    """A run of which half is done."""
    mcgw.run(scene, tmp_path / "b.h5", shard="1/2")
    return parts_of(tmp_path / "b.h5")


def test_a_run_of_another_format_is_refused(half):
    with h5py.File(half / RECORD, "r+") as file:
        file.attrs["format"] = [2, 0]
    with pytest.raises(StoreError, match=r"mcgw-run \[2, 0\] is not read by this version, which reads"):
        Plan.open(half)
