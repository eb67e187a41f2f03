"""What is damaged is never gone on with: each kind of damage, and then every way of going on."""

import shutil
import sys
from dataclasses import replace

import h5py
import numpy as np
import pytest

import mcgw
from mcgw.cli import main
from mcgw.errors import RunError, StoreError
from mcgw.jobs.job import Job
from mcgw.jobs.merging import merge
from mcgw.jobs.running import run, run_part
from mcgw.jobs.session import Part
from mcgw.store import ensembles, merged_file, shards, structure, untrusted
from mcgw.store.run_folder import RunFolder, parts_of
from mcgw.store.trailer import TRAILER_BYTES, check_trailer, read_checked, trailer_of

SIZE, SURFACES = 16, 100


@pytest.fixture(autouse=True)
def _small_blocks_in_this_process(monkeypatch):
    """Seven blocks, looked at here: children take most of the time."""
    monkeypatch.setattr(Job, "rows", SIZE)
    monkeypatch.setattr(ensembles, "examine", examined_here)


def examined_here(path):
    try:
        return structure.describe(str(path))
    except OSError as error:
        raise StoreError(f"{path}: {error}") from None


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0, 3.0), sampler="tail", n_surfaces=SURFACES)


@pytest.fixture
def larger(scene):
    return replace(scene, n_surfaces=SURFACES + 30)


def nobody():
    """Asks for an end."""


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


def without_its_trailer(path):
    path.write_bytes(path.read_bytes()[:-TRAILER_BYTES])


def with_another_trailer(path):
    flip(path, len(path.read_bytes()) - 40)


DAMAGES = [changed_in_place, flipped_in_a_result, a_changed_load, without_its_trailer, with_another_trailer]
every_damage = pytest.mark.parametrize("damage", DAMAGES)


@pytest.fixture
def damaged(scene, tmp_path, request):
    path = tmp_path / "e.h5"
    run(scene, path)
    assert ensembles.verify(path)[0] == ""
    request.param(path)
    return path


def ways(larger):
    """Every way to put more into a file, by name."""
    return {
        "run": lambda path: run(larger, path),
        "shard job": lambda path: run_part(larger, path, Part(1, 2)),
        "command": lambda path: as_typed(larger, path),
        "stop rule": lambda path: by_rule(larger, path),
    }


def as_typed(scene, path):
    file = path.with_suffix(".toml")
    file.write_text(mcgw.scene_text(scene))
    assert main(["run", str(file), "-o", str(path)]) == 2
    raise StoreError("by the command")


def by_rule(scene, path):
    run(replace(scene, rel_err=1e-4), path)


@pytest.mark.parametrize("damaged", DAMAGES, indirect=True)
@pytest.mark.parametrize("way", ["run", "shard job", "command", "stop rule"])
def test_a_damaged_file_is_not_extended_nor_sealed_anew(damaged, larger, way):
    before = damaged.read_bytes()
    with pytest.raises(StoreError):
        ways(larger)[way](damaged)
    assert damaged.read_bytes() == before
    assert not parts_of(damaged).exists() or not list(parts_of(damaged).glob("shards/*.h5"))
    with pytest.raises(StoreError):
        check_trailer(damaged)


@pytest.mark.filterwarnings("ignore:.* more surfaces than max_surfaces allows")  # said before it is opened
@pytest.mark.parametrize("damaged", [flipped_in_a_result], indirect=True)
@pytest.mark.parametrize("way", ["run", "shard job", "command", "stop rule"])
def test_a_large_damaged_file_is_not_extended_either(damaged, larger, way, monkeypatch):
    """Of a large file only the head is looked at on opening: all of it before more is drawn for it."""
    monkeypatch.setattr(ensembles, "examine", untrusted.examine)
    monkeypatch.setattr(untrusted, "_SMALL", 0)
    untrusted._examined.cache_clear()
    assert ensembles.open_ensemble(damaged).n_surfaces == SURFACES
    before = damaged.read_bytes()
    with pytest.raises(StoreError):
        ways(larger)[way](damaged)
    assert damaged.read_bytes() == before
    assert not parts_of(damaged).exists() or not list(parts_of(damaged).glob("shards/*.h5"))


@every_damage
def test_a_file_damaged_while_more_is_drawn_is_not_merged(scene, larger, tmp_path, damage):
    """Its own surfaces come first in the file that takes its place: they are looked at again."""
    path = tmp_path / "e.h5"
    run(scene, path)
    assert run_part(larger, path, Part(1, 1)) == 0
    damage(path)
    before = path.read_bytes()
    with pytest.raises((StoreError, RunError)):
        merge(path)
    assert path.read_bytes() == before


@every_damage
def test_verify_tells_it(scene, tmp_path, damage, capsys):
    path = tmp_path / "e.h5"
    run(scene, path)
    assert main(["show", "--verify", str(path)]) == 0
    assert "intact" in capsys.readouterr().out
    damage(path)
    assert main(["show", "--verify", str(path)]) == 1
    assert "DAMAGED" in capsys.readouterr().out


def begun(scene, path, jobs=1):
    """All blocks of a run, not merged yet."""
    for k in range(1, jobs + 1):
        run_part(scene, path, Part(k, jobs))
    assert not path.exists()
    return sorted(parts_of(path).glob("shards/block-*.h5"))


def make_trailer_anew(path, change):
    """Other numbers under a good trailer: only the digest of the contents is as before."""
    trailer, body = read_checked(path)
    with shards.tables_in(body, path) as tables:
        arrays = {name: table[()] for name, table in tables.items()}
    change(arrays)
    body = shards.pack(arrays)
    path.write_bytes(body + trailer_of(body, **trailer.notes))


def another_number(arrays):
    arrays["load"][3, 1] *= 1.5


def test_contents_that_are_others_than_the_digest_says_are_refused(scene, tmp_path):
    path = tmp_path / "e.h5"
    make_trailer_anew(begun(scene, path)[2], another_number)
    run_here = RunFolder.open(parts_of(path))
    with pytest.raises(StoreError, match=r"block-0000000000032.*mismatch of its contents"):
        [shard.arrays() for shard in run_here.shards()]


@pytest.mark.parametrize("way", ["merge", "run", "merge as typed", "run as typed", "read"])
def test_a_shard_of_other_contents_never_becomes_a_file(scene, tmp_path, way, capsys):
    path = tmp_path / "e.h5"
    make_trailer_anew(begun(scene, path)[2], another_number)
    if way == "read":
        with pytest.raises(StoreError, match="mismatch of its contents"):
            _ = mcgw.open_ensemble(path).load
    elif "typed" in way:
        (tmp_path / "s.toml").write_text(mcgw.scene_text(scene))
        words = ["merge", str(path)] if "merge" in way else ["run", str(tmp_path / "s.toml"), "-o", str(path)]
        assert main(words) in (1, 2)
        assert "damaged" in capsys.readouterr().err
    else:
        with pytest.raises((RunError, StoreError), match="damaged"):
            merge(path) if way == "merge" else run(scene, path)
    assert not path.exists()


def test_what_was_written_is_read_again_before_it_is_sealed(scene, tmp_path, monkeypatch):
    """A number that reaches the file as another: the digest of the shards tells."""
    from mcgw.store import layout

    path = tmp_path / "e.h5"
    begun(scene, path)
    put = layout._put

    def slip(file, span, arrays):
        put(file, span, arrays)
        if span.first == 32:
            file["area"][33, 0] *= 1 + 1e-15

    monkeypatch.setattr(layout, "_put", slip)
    with pytest.raises(OSError, match="reads otherwise than written"):
        merged_file.merge_into(parts_of(path), path, tmp_path / "x.tmp", nobody)
    monkeypatch.setattr(layout, "_put", put)
    merged_file.merge_into(parts_of(path), path, tmp_path / "y.tmp", nobody)
    assert ensembles.verify(tmp_path / "y.tmp")[0] == ""


def test_a_digest_that_is_written_wrong_is_seen(scene, tmp_path, monkeypatch):
    path = tmp_path / "e.h5"
    begun(scene, path)
    describe = merged_file.describe

    def forged(file, *arguments, **options):
        describe(file, *arguments, **options)
        file.attrs["digest"] = "0" * 64

    monkeypatch.setattr(merged_file, "describe", forged)
    with pytest.raises(OSError, match="reads otherwise than written"):
        merged_file.merge_into(parts_of(path), path, tmp_path / "x.tmp", nobody)


@pytest.mark.parametrize("gone", [0, 3, 6])
def test_a_shard_that_is_gone_is_missing(scene, tmp_path, gone):
    path = tmp_path / "e.h5"
    begun(scene, path, jobs=2)[gone].unlink()
    with pytest.raises(StoreError):
        merged_file.merge_into(parts_of(path), path, tmp_path / "x.tmp", nobody)
    with pytest.raises(RunError, match=f"surfaces are missing, from {16 * gone} on"):
        merge(path)
    assert not path.exists()


def test_shards_of_another_run_are_not_taken(scene, tmp_path):
    """The same place and numbers of another seed, trailer and digest in order."""
    a, b = tmp_path / "a.h5", tmp_path / "b.h5"
    ours, theirs = begun(scene, a), begun(replace(scene, seed=99), b)
    shutil.copy(theirs[1], ours[1])
    with pytest.raises(RunError, match="16 of 100 surfaces are missing, from 16 on"):
        merge(a)
    run(scene, a)
    np.testing.assert_array_equal(mcgw.open_ensemble(a).load, mcgw.simulate(scene).load)


@pytest.mark.skipif(sys.platform == "win32", reason="an open file cannot be removed there")
@pytest.mark.parametrize("way", ["run", "shard job", "merge"])
def test_nobody_works_on_a_folder_that_was_just_removed(scene, tmp_path, way, monkeypatch):
    """Another one's run ends between our opening of its lock and our getting it."""
    path = tmp_path / "e.h5"
    begun(scene, path)
    work = {
        "run": lambda: run(scene, path),
        "shard job": lambda: run_part(scene, path, Part(1, 2)),
        "merge": lambda: merge(path),
    }[way]
    asked = ended_while_locking(monkeypatch, parts_of(path))
    try:
        work()
    except (RunError, StoreError) as error:
        assert "its run has just ended; repeat the command" in str(error)  # noqa: PT017
    else:
        assert not asked, "it worked on in a folder that is no longer the run's"
        pytest.skip("this lock is not fcntl's")
    assert not path.exists()


def ended_while_locking(monkeypatch, folder):
    """The system's lock is granted only after the folder was removed and made anew; who asked, in a list."""
    fcntl, asked = pytest.importorskip("fcntl"), []
    for name in ("flock", "lockf"):
        granted = getattr(fcntl, name)

        def late(fd, *arguments, granted=granted):
            asked.append(fd)
            if folder.exists():
                shutil.rmtree(folder)
                (folder / "shards").mkdir(parents=True)
                (folder / "lock").touch()
            return granted(fd, *arguments)

        monkeypatch.setattr(fcntl, name, late)
    return asked


def test_a_shard_of_other_surfaces_than_its_block_is_drawn_again(scene, tmp_path):
    """Eight surfaces where the block has sixteen, in order otherwise: not what is held."""
    path = tmp_path / "e.h5"
    third = begun(scene, path)[2]
    there = RunFolder.open(parts_of(path))
    assert there.held(shards.Span(32, 16)).span == shards.Span(32, 16)
    arrays = {name: x[:8] for name, x in shards.open_shard(third, there.identity).arrays().items()}
    shards.commit_shard(third, there.identity, shards.Span(32, 8), arrays, 0.0)
    assert there.held(shards.Span(32, 16)) is None
    assert there.held(shards.Span(32, 8)) is not None
    run(scene, path)
    np.testing.assert_array_equal(mcgw.open_ensemble(path).load, mcgw.simulate(scene).load)


def test_seconds_of_all_blocks_and_of_the_file_before_add_up(scene, larger, tmp_path):
    path = tmp_path / "e.h5"
    begun(scene, path)
    each = [shard.seconds for shard in RunFolder.open(parts_of(path)).shards()]
    merge(path)
    first = ensembles.read_attributes(path)["wall_seconds"]
    assert first == pytest.approx(sum(each), rel=1e-12)
    assert run_part(larger, path, Part(1, 1)) == 0
    more = [shard.seconds for shard in RunFolder.open(parts_of(path)).shards()]
    merge(path)
    assert ensembles.read_attributes(path)["wall_seconds"] == pytest.approx(first + sum(more), rel=1e-12)
    assert sum(more) > 0
