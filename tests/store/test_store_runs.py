"""Runs that are interrupted, gone on with, extended, shared, disturbed: always the same digest."""

import errno
import os
import shutil
import signal
from itertools import product

import h5py
import numpy as np
import pytest
from oracles.begun_runs import SIZE, SURFACES, begun, digest, halted
from oracles.flipped import flip_a_number
from oracles.inside import (
    RECORD,
    Plan,
    Span,
    blocks_of,
    commit_block,
    home,
    parts_of,
    read_attributes,
    share_of,
)
from oracles.said import call

import mcgw
from mcgw.errors import RunError, StoppedError, StoreError

pytestmark = pytest.mark.usefixtures("small_blocks")


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0, 3.0), sampler="tail", n_surfaces=SURFACES)


@pytest.fixture
def expected(scene, tmp_path):
    """Digest of what was drawn in memory and saved, without blocks."""
    mcgw.save(mcgw.simulate(scene), tmp_path / "expected" / "whole.h5")
    return digest(tmp_path / "expected" / "whole.h5")


@pytest.fixture
def drawn(monkeypatch):
    """First surfaces of the blocks that were drawn, in order."""
    found, draw = [], Plan.draw

    def counted(job, span, *more):
        found.append(span.first)
        return draw(job, span, *more)

    monkeypatch.setattr(Plan, "draw", counted)
    return found


def test_another_version_is_refused(scene, tmp_path, monkeypatch):
    path = tmp_path / "e.h5"
    halted(scene, path, 40)
    monkeypatch.setattr(home("Plan"), "versions", lambda **_: "mcgw 99")
    with pytest.raises(StoreError, match=r"drawn with .*, but this is mcgw 99"):
        mcgw.run(scene, path)


def test_what_is_damaged_is_drawn_again(scene, tmp_path, expected):
    path = tmp_path / "e.h5"
    halted(scene, path, 64)
    shards = sorted(parts_of(path).glob("shards/*.h5"))
    flip_a_number(shards[0])
    shards[1].write_bytes(shards[3].read_bytes())  # another block
    shards[2].rename(tmp_path / "elsewhere.h5")
    shards[2].symlink_to(tmp_path / "elsewhere.h5")
    (shards[3].parent / ".left.tmp").write_bytes(b"half")
    assert mcgw.open_ensemble(path).n_surfaces == min(SIZE * len(shards), SURFACES) - 3 * SIZE
    halted(scene, path, 0)
    assert not list(parts_of(path).glob("shards/.*.tmp"))
    mcgw.run(scene, path)
    assert digest(path) == expected


def test_a_run_without_a_block_or_its_record_is_said_to_have_none(scene, tmp_path):
    path = tmp_path / "e.h5"
    begun(scene, path)
    folder = parts_of(path)
    for shard in folder.glob("shards/*"):
        shard.unlink()
    with pytest.raises(StoreError, match=r"e\.h5: no block of its run is finished yet$"):
        mcgw.open_ensemble(path)
    (folder / "shards").rmdir()
    with pytest.raises(RunError, match=r"e\.h5\.parts: is missing or incomplete; run the command again$"):
        mcgw.open_ensemble(path)
    (folder / RECORD).unlink()
    with pytest.raises(StoreError, match=r"run\.h5: there is none$"):
        Plan.open(folder)


def test_what_is_left_out_of_a_run_is_told(scene, tmp_path):
    """Blocks of a share, by their numbers among all."""
    path = tmp_path / "e.h5"
    for k, held in ((2, [16, 64]), (3, [16, 32, 64, 80])):
        mcgw.run(scene, path, shard=f"{k}/3")
        assert [span.first for span in Plan.open(parts_of(path)).shards()] == held
    for wrong in ("0/3", "4/3", "1", "a/b", "1/0", "-1/3", "1/3/5", ""):
        with pytest.raises(ValueError, match=r"^--shard .*: give i/n with 1 <= i <= n$"):
            share_of(None, None, wrong)
    assert share_of(None, None, "3/3") == (3, 3)


def test_a_file_of_another_run_is_told_as_such(scene, tmp_path):
    """Not as a damaged shard, and its own stay."""
    shards = begun(scene, tmp_path / "e.h5")
    mcgw.run(scene.replace(seed=9), tmp_path / "f.h5")
    (tmp_path / "f.h5").rename(tmp_path / "e.h5")
    with pytest.raises(StoreError, match=r"holds a different ensemble: ensemble\.seed is 9 there and 1 here"):
        mcgw.merge(tmp_path / "e.h5")
    assert sorted(parts_of(tmp_path / "e.h5").glob("shards/block-*.h5")) == shards


@pytest.mark.parametrize(
    ("by", "keep"), [("run", "sums"), ("shares", "sums"), ("workers", "sums"), ("run", "statistics")]
)
def test_going_on_draws_each_missing_block_once(scene, tmp_path, drawn, by, keep):
    """Blocks 0 to 2 and 5 are held: nobody draws them again, whoever goes on."""
    scene, path = scene.replace(keep=keep), tmp_path / "e.h5"
    blocks = begun(scene, path)
    assert drawn == [0, 16, 32, 48, 64, 80, 96]
    for lost in (3, 4, 6):
        blocks[lost].unlink()
    drawn.clear()
    if by == "run":
        told = []
        mcgw.run(scene, path, progress=lambda *pair: told.append(pair))
        assert told == [(64, 100), (80, 100), (96, 100), (100, 100)]
        mcgw.run(scene, path, progress=lambda *pair: told.append(pair))
        assert told[4:] == [(100, 100)]
    elif by == "shares":
        assert [mcgw.run(scene, path, shard=f"{k}/2") for k in (1, 2, 1)] == [16, 0, 0]
    else:
        for first, n in ((0, 16), (48, 16), (64, 16), (48, 16), (96, 4)):
            commit_block(str(parts_of(path)), first, n)
    assert sorted(drawn) == [48, 64, 96]


def test_n_surfaces_is_the_total(scene, tmp_path, expected, drawn):
    """Extended in steps that are no multiple of a block, once in the middle of a run; each is drawn once."""
    path = tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=5), path)
    mcgw.run(scene.replace(n_surfaces=37), path)
    assert drawn == [0, 0, 16, 32]
    halted(scene.replace(n_surfaces=90), path, 64)
    assert mcgw.open_ensemble(path).n_surfaces == 37  # the finished file stays as it is
    drawn.clear()
    mcgw.run(scene, path)
    assert 64 <= drawn[0] <= 90
    assert digest(path) == expected
    with pytest.raises(StoreError, match="holds 100 surfaces already"):
        mcgw.run(scene.replace(n_surfaces=99), path)


def test_a_short_block_of_statistics_gives_way_to_a_whole_one(scene, tmp_path, drawn):
    """Both are read while the run is not finished."""
    path, kept = tmp_path / "e.h5", scene.replace(keep="statistics")
    mcgw.run(kept.replace(n_surfaces=20), path, shard="1/1")
    begun, whole = mcgw.open_ensemble(path), mcgw.simulate(kept, n_surfaces=20)
    np.testing.assert_array_equal(
        [begun.mean("load"), begun.std("load")], [whole.mean("load"), whole.std("load")]
    )
    mcgw.run(kept, path)
    assert drawn == [0, 16, 16, 32, 48, 64, 80, 96]
    mcgw.save(mcgw.simulate(kept), tmp_path / "whole.h5")
    assert digest(path) == digest(tmp_path / "whole.h5")


@pytest.mark.parametrize("keep", ["statistics", pytest.param("sums", marks=pytest.mark.slow)])
def test_shares_of_more_surfaces_than_before_are_merged(keep, scene, tmp_path):
    """Not refused as too many for what the first job wanted; a later job that wants fewer changes nothing."""
    path, kept = tmp_path / "e.h5", scene.replace(keep=keep)
    for n in (20, 100, 20):
        assert mcgw.run(kept.replace(n_surfaces=n), path, shard="1/1") == 0
    assert mcgw.merge(path).n_surfaces == 100
    mcgw.save(mcgw.simulate(kept, n_surfaces=100), tmp_path / "whole.h5")
    assert digest(path) == digest(tmp_path / "whole.h5")


def test_rows_of_a_run_in_progress_are_those_of_a_list(scene, tmp_path):
    """From any surface to any other, within a block and beyond one."""
    path, asked = tmp_path / "e.h5", scene.replace(sampler="cells")
    *shards, last = begun(asked, path)
    last.unlink()
    held, whole = mcgw.open_ensemble(path).sums, mcgw.simulate(asked)
    assert not read_attributes(path)["complete"]
    shown = call("show", path).stdout
    assert "Ensemble of 96 surfaces of 3000 asperities" in shown
    assert "  complete     no: 96 of 100\n" in shown
    for start, stop in product((0, 5, 15, 16, 33), (16, 17, 40, 48, None)):
        if start < (stop or 96):
            np.testing.assert_array_equal(held.read("load", start, stop), whole.load[start : stop or 96])
    shards[1].unlink()
    with pytest.raises(StoreError, match=r"block-0000000000016\.h5: no longer exists; its run has ended"):
        held.read("load", 0, 20)
    np.testing.assert_array_equal(held.read("load", 0, 16), whole.load[:16])


def test_room_is_asked_for_what_is_not_there_yet(scene, tmp_path, monkeypatch):
    path = tmp_path / "e.h5"
    halted(scene, path, 64)
    half = 8 * SURFACES * len(scene.separations) * len(scene.quantities)
    free = shutil.disk_usage(tmp_path)._replace(free=2 * half - 1)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: free)
    with pytest.raises(StoreError, match="free some space"):
        mcgw.run(scene, tmp_path / "other.h5")
    mcgw.run(scene, path)


def test_blocks_of_several_groups_end_with_their_group():
    """Two groups of 50 and 20 surfaces, in blocks of 16 and 20, one after the other."""
    blocks = blocks_of([(50, 16), (20, 20)])
    assert list(blocks.items()) == [
        (Span(0, 16), (0, 0)), (Span(16, 16), (0, 16)), (Span(32, 16), (0, 32)), (Span(48, 2), (0, 48)),
        (Span(50, 20), (1, 0)),
    ]  # fmt: skip


def test_blocks_are_whole_or_missing(scene, tmp_path):
    """Of 100 surfaces in blocks of 16: of what a file holds whole ones alone, or all, are not drawn again."""
    plan = Plan(scene, tmp_path / "e.h5")
    blocks = [Span(first, min(16, 100 - first)) for first in range(0, 100, 16)]
    assert [plan.kept(n) for n in (0, 15, 16, 20, 32, 99, 100)] == [0, 0, 16, 16, 32, 96, 100]
    assert plan.missing(0, []) == blocks
    for i, span in enumerate(blocks):
        assert plan.missing(0, [span]) == blocks[:i] + blocks[i + 1 :]
        assert plan.missing(span.stop, [blocks[0]]) == blocks[i + 1 :]
    assert plan.missing(99, []) == blocks[-1:]
    assert plan.missing(96, [Span(96, 16)]) == []  # of more surfaces than now


@pytest.mark.parametrize(
    ("number", "code", "surfaces"), [(signal.SIGINT, 130, SURFACES), (signal.SIGTERM, 143, SIZE)]
)
def test_signals_stop_a_run_that_then_goes_on(scene, tmp_path, number, code, surfaces, expected, monkeypatch):
    """Sent while the third block is drawn: it is kept, and the rest drawn later; of one block nothing is."""
    path, draw, seen = tmp_path / "e.h5", Plan.draw, []

    def signalled(job, span, *more):
        seen.append(span.first)
        if len(seen) == (3 if surfaces > SIZE else 1):
            os.kill(os.getpid(), number)  # once: the second one ends everything
        return draw(job, span, *more)

    monkeypatch.setattr(Plan, "draw", signalled)
    told = "kept in .*; the same command resumes" if surfaces > SIZE else "nothing was saved"
    with pytest.raises(StoppedError, match=told) as caught:
        mcgw.run(scene.replace(n_surfaces=surfaces), path)
    assert caught.value.code == code
    assert not path.exists()
    assert parts_of(path).exists() == (surfaces > SIZE)
    assert (3 if surfaces > SIZE else 1) <= len(seen) < 7
    mcgw.run(scene, path)
    assert digest(path) == expected


@pytest.mark.parametrize(
    ("of", "where", "calls", "words"),
    [
        ("commit_block", "commit_shard", 2, "finished blocks are kept"),
        ("put", "write", 0, "is the disk full"),
    ],
)
def test_a_full_disk_is_one_line_and_the_run_completes_later(
    scene, tmp_path, expected, of, where, calls, words, monkeypatch
):
    """At the third block, which leaves two, and at the file."""
    path, done, work = tmp_path / "e.h5", [], getattr(home(of), where)

    def full(*arguments):
        if len(done) == calls:
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        done.append(arguments)
        return work(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(home(of), where, full)
        with pytest.raises(RunError, match=words) as caught:
            mcgw.run(scene, path)
    assert "\n" not in str(caught.value)
    assert not path.exists()
    assert len(list(parts_of(path).glob("shards/block-*.h5"))) >= 2
    mcgw.run(scene, path)
    assert digest(path) == expected


@pytest.mark.parametrize("rows", [4, 12, 256])
def test_blocks_and_chunks_of_any_size_make_the_same(scene, tmp_path, expected, blocks_of, monkeypatch, rows):
    """The first three blocks as of a version with other blocks; the file is one of 37 surfaces that grows."""
    monkeypatch.setattr(home("CHUNK_ROWS"), "CHUNK_ROWS", rows)
    path = tmp_path / "e.h5"
    mcgw.run(scene.replace(n_surfaces=37), path)
    blocks_of(20)
    assert mcgw.run(scene, path, shard="1/1") == 0
    blocks_of(SIZE)
    made, drawn = mcgw.run(scene, path), mcgw.simulate(scene)
    assert digest(path) == expected
    for name in scene.quantities:
        np.testing.assert_array_equal(made[name], drawn[name])


@pytest.mark.parametrize("step", ["__setitem__", "__getitem__"])
def test_a_signal_while_merging_keeps_all_blocks(scene, tmp_path, expected, monkeypatch, step):
    """While the file is written, or read back."""
    path, work, struck = tmp_path / "e.h5", getattr(h5py.Dataset, step), []
    blocks = begun(scene, path)

    def signalled(*arguments):
        if not struck:
            struck.append(True)
            os.kill(os.getpid(), signal.SIGINT)
        return work(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(h5py.Dataset, step, signalled)
        with pytest.raises(StoppedError, match=r"all blocks are kept in .*; the same command merges them"):
            mcgw.merge(path)
    assert not path.exists()
    assert sorted(parts_of(path).glob("shards/*.h5")) == blocks
    assert not list(parts_of(path).glob(".*.tmp"))
    mcgw.merge(path)
    assert digest(path) == expected
