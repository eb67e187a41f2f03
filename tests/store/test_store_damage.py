"""What is damaged is never gone on with: each kind of damage, and then every way of going on."""

from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np
import pytest
from oracles.begun_runs import SURFACES, begun, digest
from oracles.flipped import flip_a_number
from oracles.inside import RECORD, Plan, home, parts_of, read_attributes, verify

import mcgw
from mcgw.cli import main
from mcgw.errors import RunError, StoreError

pytestmark = pytest.mark.usefixtures("small_blocks")
SLOW = pytest.mark.slow


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0, 3.0), sampler="tail", n_surfaces=SURFACES)


@pytest.fixture
def larger(scene):
    return scene.replace(n_surfaces=SURFACES + 30)


@pytest.fixture
def file(scene, tmp_path):
    """A finished file."""
    mcgw.run(scene, tmp_path / "e.h5")
    return tmp_path / "e.h5"


def edited(change):
    """What HDF5 itself writes over the old contents."""

    def edit(path):
        with h5py.File(path, "r+") as data:
            change(data)

    return edit


DAMAGES = {
    "a bit of a coordinate": lambda path: flip_a_number(path, "separation"),
    "a bit of a result": lambda path: flip_a_number(path, "load"),  # seen by who reads it, or all bytes
    "a result": edited(lambda data: data["load"].__setitem__((3, 1), data["load"][3, 1] * (1 + 1e-12))),
    "the end": lambda path: path.write_bytes(path.read_bytes()[:-100]),
    "the checksum": edited(lambda data: data.attrs.update(checksum="0" * 64)),
}
# Every way to put more into a file.
WAYS = {
    "run": mcgw.run,
    "shard job": lambda scene, path: mcgw.run(scene, path, shard="1/2"),
    "stop rule": lambda scene, path: mcgw.run(scene.replace(rel_err=1e-4), path),
}
OF_LARGE = "a bit of a result"


@pytest.mark.filterwarnings("ignore:.* more surfaces than n_surfaces allows")  # said before it is opened
@pytest.mark.parametrize(
    ("way", "damage"),
    [*(("run", damage) for damage in DAMAGES), ("shard job", OF_LARGE), ("stop rule", OF_LARGE)],
)
def test_a_damaged_file_is_not_extended_nor_sealed_anew(way, damage, file, larger, monkeypatch):
    """Of a large file only the head is looked at on opening: all of it before more is drawn for it."""
    assert verify(file)[0] == ""
    DAMAGES[damage](file)
    if damage == OF_LARGE:
        monkeypatch.setattr(home("LARGE"), "LARGE", 0)
        assert mcgw.open_ensemble(file).n_surfaces == SURFACES
        with pytest.raises(StoreError, match="not an HDF5 file, or a damaged one"):
            mcgw.open_ensemble(file).values("load")
    before = file.read_bytes()
    with pytest.raises(StoreError):
        WAYS[way](larger, file)
    assert file.read_bytes() == before
    assert not parts_of(file).exists() or not list(parts_of(file).glob("shards/*.h5"))
    assert verify(file)[1] == "unreadable"


@pytest.mark.parametrize("damage", [OF_LARGE, "the end"])
def test_a_file_damaged_while_more_is_drawn_is_not_merged(file, larger, damage, capsys):
    """Its own surfaces come first in the file that takes its place: they are looked at again."""
    assert mcgw.run(larger, file, shard="1/1") == 0
    for code, said in ((0, "intact"), (1, "DAMAGED")):
        assert main(["show", "--verify", str(file)]) == code
        assert said in capsys.readouterr().out
        if not code:
            DAMAGES[damage](file)
    before = file.read_bytes()
    with pytest.raises((StoreError, RunError)):
        mcgw.merge(file)
    assert file.read_bytes() == before


def test_seconds_of_all_blocks_and_of_the_file_before_add_up(scene, larger, tmp_path):
    path, total = tmp_path / "e.h5", 0.0
    for asked in (scene, larger):
        assert mcgw.run(asked, path, shard="1/1") == 0
        more = sum(Plan.open(parts_of(path)).shards().values())
        assert more > 0
        total += more
        mcgw.merge(path)
        assert read_attributes(path)["wall_seconds"] == pytest.approx(total, rel=1e-12)


SMALL = [
    lambda data: data.attrs.update(title="another"),
    lambda data: data.attrs.pop("cpu"),
    lambda data: data["load"].attrs.update(units="kN"),
    lambda data: data["area"].attrs.update(long_name="something else"),
    lambda data: data["separation"].__setitem__(1, 1.0000000000000002),
    lambda data: data["surface"].__setitem__(3, 4),
    lambda data: data.update(more=np.ones(3)),
]


@pytest.mark.parametrize("change", SMALL)
def test_whatever_is_small_is_checked(file, change):
    edited(change)(file)
    told = r"checksum mismatch of (its scene or attributes|separation|surface)"
    with pytest.raises(StoreError, match=told):
        mcgw.open_ensemble(file)


@SLOW
def test_a_flipped_bit_anywhere_is_seen_or_changes_nothing(file):
    """HDF5 leaves room that nobody reads; where the scene stands all is read."""
    whole, said, data = mcgw.open_ensemble(file), read_attributes(file), file.read_bytes()
    dice, scene = np.random.default_rng(1), data.index(said["scene"].encode())
    of_scene = dice.integers(scene, scene + len(said["scene"].encode()), 20)
    for k, at in enumerate([*of_scene, *dice.integers(len(data), size=40)]):
        changed = bytearray(data)
        changed[at] ^= 1 << int(dice.integers(8))
        file.write_bytes(changed)
        with suppress(StoreError):
            found = mcgw.open_ensemble(file)
            assert k >= 20
            assert (found.scene, read_attributes(file)) == (whole.scene, said)
            assert all(np.array_equal(found[name], whole[name]) for name in whole.scene.quantities)


@pytest.mark.parametrize(
    ("keep", "damage"),
    [("sums", Path.unlink), ("statistics", flip_a_number), pytest.param("sums", flip_a_number, marks=SLOW)],
)
def test_a_block_that_is_lost_late_never_comes_into_the_file(scene, tmp_path, keep, damage, monkeypatch):
    """After the shards were looked at."""
    path, merged, kept = tmp_path / "e.h5", home("_merged")._merged, scene.replace(keep=keep)
    block = begun(kept, path)[2]

    def damaged_first(*words):
        damage(block)
        return merged(*words)

    with monkeypatch.context() as patch:
        patch.setattr(home("_merged"), "_merged", damaged_first)
        with pytest.raises(RunError, match="a shard is damaged; run the jobs again to redraw it"):
            mcgw.merge(path)
    assert not path.exists()
    assert not list(parts_of(path).glob(".*.tmp"))
    mcgw.run(kept, path)
    mcgw.save(mcgw.simulate(kept), tmp_path / "whole.h5")
    assert digest(path) == digest(tmp_path / "whole.h5")


def test_numbers_that_go_to_another_place_are_seen(scene, tmp_path, monkeypatch):
    """Two chunks in the wrong order, each of them intact."""
    path, write = tmp_path / "e.h5", home("put").write
    begun(scene, path)

    def swapped(temporary, *words):
        write(temporary, *words)
        with h5py.File(temporary, "r+") as file:
            area = file["area"].id
            parts = [area.read_direct_chunk((row, 0))[1] for row in (32, 40)]
            for row, part in zip((40, 32), parts, strict=True):
                area.write_direct_chunk((row, 0), part)

    monkeypatch.setattr(home("put"), "write", swapped)
    with pytest.raises(RunError, match="was not written correctly"):
        mcgw.merge(path)
    assert not path.exists()


# --- the record of a run or a sweep: its blocks are whole, and the scene is at hand ------------------------


def flip_in(path, what):
    """A bit of something that stands in a file."""
    data = bytearray(path.read_bytes())
    data[data.index(what) + 1] ^= 1
    path.write_bytes(data)


@pytest.mark.parametrize(
    "what", [b"mcgw-run", b"seed = ", *(pytest.param(x, marks=SLOW) for x in (b"HDF", b"numba "))]
)
def test_a_run_goes_on_from_its_blocks(scene, what, tmp_path):
    """Whatever of its record is damaged; but no other scene takes them."""
    path = tmp_path / "e.h5"
    blocks = begun(scene, path)
    blocks.pop(4).unlink()
    times = [block.stat().st_mtime_ns for block in blocks]
    flip_in(parts_of(path) / RECORD, what)
    with pytest.raises(StoreError, match=r"damaged.* resume with mcgw run or mcgw sweep"):
        Plan.open(parts_of(path))
    with pytest.raises(StoreError, match="damaged"):
        mcgw.run(scene.replace(seed=2), path)
    assert mcgw.run(scene, path, shard="1/1") == 0
    assert [block.stat().st_mtime_ns for block in blocks] == times
    assert np.array_equal(mcgw.merge(path).load, mcgw.simulate(scene).load)


def test_a_sweep_goes_on_from_its_shards(make_scene, tmp_path):
    path, scene = tmp_path / "s.h5", make_scene(separations=(2.0,), n_surfaces=8)
    axes = {"grading.gamma": [1.2, 1.5], "ensemble.seed": [1, 2]}
    mcgw.sweep(scene, axes, path=path, shard="1/2")
    before = Plan.open(parts_of(path))
    flip_in(parts_of(path) / RECORD, b"grading.gamma")
    mcgw.sweep(scene, axes, path=path, shard="1/2")
    assert Plan.open(parts_of(path)).axes == before.axes


def test_a_run_of_another_format_is_refused(scene, tmp_path):
    mcgw.run(scene, tmp_path / "b.h5", shard="1/2")
    edited(lambda data: data.attrs.update(format=[2, 0]))(parts_of(tmp_path / "b.h5") / RECORD)
    with pytest.raises(StoreError, match=r"mcgw-run \[2, 0\] is not read by this version, which reads"):
        Plan.open(parts_of(tmp_path / "b.h5"))
