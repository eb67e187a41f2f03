"""Runs that are interrupted, gone on with, extended, shared, disturbed: always the same digest."""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from new_trailer import trailer_again
from said import without_notes

import mcgw
from mcgw.errors import RunError, StoppedError, StoreError
from mcgw.jobs import merging
from mcgw.jobs.job import Job
from mcgw.jobs.merging import merge
from mcgw.jobs.running import run, run_part
from mcgw.jobs.session import Part
from mcgw.store import chunks, ensembles, layout, structure
from mcgw.store.lock import LockedError, locked
from mcgw.store.run_folder import missing, parts_of
from mcgw.store.shards import Span

SIZE, SURFACES = 16, 100
HERE = Path(__file__).parent


class HaltError(Exception):
    """Stands for whatever ends a run."""


@pytest.fixture
def small_blocks(monkeypatch):
    """A run of seven blocks, the last one short."""
    monkeypatch.setattr(Job, "rows", SIZE)
    monkeypatch.setattr(chunks, "CHUNK_ROWS", SIZE // 2)


@pytest.fixture(autouse=True)
def _in_this_process(request, monkeypatch):
    """Look here: children take most of the time. Tests of the command line have them."""
    monkeypatch.setattr(ensembles, "examine", lambda path: structure.describe(str(path)))


@pytest.fixture
def scene(make_scene):
    return make_scene(separations=(2.0, 1.0, 3.0), sampler="tail", n_surfaces=SURFACES)


def stop_after(surfaces):
    """Progress that ends the run."""

    def progress(done):
        if done >= surfaces:
            raise HaltError

    return progress


def halted(scene, path, surfaces):
    with pytest.raises(HaltError):
        run(scene, path, progress=stop_after(surfaces))
    assert not path.exists()
    assert parts_of(path).is_dir()


def digest(path):
    problem, found = ensembles.verify(path)
    assert problem == ""
    return found


@pytest.fixture
def expected(scene, tmp_path):
    """Digest of the run in one piece, without shards."""
    path = tmp_path / "expected" / "whole.h5"
    run(scene, path)
    assert not parts_of(path).exists()
    return digest(path)


def test_blocks_change_no_bit(small_blocks, scene, tmp_path, expected):
    done = []
    ensemble = run(scene, tmp_path / "e.h5", progress=done.append)
    assert done == [0, 16, 32, 48, 64, 80, 96, 100]
    assert digest(tmp_path / "e.h5") == expected
    assert not parts_of(tmp_path / "e.h5").exists()
    np.testing.assert_array_equal(ensemble.load, mcgw.simulate(scene).load)


def test_one_block_leaves_no_trace_beside_its_file(scene, tmp_path):
    run(scene, tmp_path / "e.h5")
    assert [p.name for p in tmp_path.iterdir()] == ["e.h5"]


def test_going_on_draws_only_what_is_missing(small_blocks, scene, tmp_path, expected):
    path, done = tmp_path / "e.h5", []
    halted(scene, path, 40)
    run(scene, path, progress=done.append)
    assert done[0] >= 48
    assert digest(path) == expected


def test_moments_are_kept_through_shards_and_extension(small_blocks, make_scene, tmp_path):
    scene = make_scene(sampler="cells", keep="moments", n_surfaces=50)
    run(replace(scene, n_surfaces=33), tmp_path / "e.h5")
    grown = run(scene, tmp_path / "e.h5")
    whole = mcgw.simulate(scene)
    for name in ("load", "moments", "cells", "extras"):
        np.testing.assert_array_equal(grown.sums.read(name, 0, None), whole.sums.read(name, 0, None))
    assert digest(tmp_path / "e.h5") == ensembles.read_attributes(tmp_path / "e.h5")["digest"]


@pytest.mark.parametrize("bytes_at_a_time", [1, 20_000, 2**23])
def test_a_file_is_read_again_in_pieces_that_make_the_whole(
    make_scene, tmp_path, monkeypatch, bytes_at_a_time
):
    """Tables with a row a surface and the ragged one: each row once, in the piece of its surface."""
    scene = make_scene(sampler="cells", keep="moments", n_surfaces=50)
    whole = run(scene, tmp_path / "e.h5")
    assert len(np.unique(whole.sums.read("extras", 0, None)[:, 0])) > 4
    monkeypatch.setattr(layout, "_PIECE", bytes_at_a_time)
    with h5py.File(tmp_path / "e.h5", "r") as file:
        pieces = list(layout.file_pieces(file))
    assert [span.first for span, _ in pieces[1:]] == [span.stop for span, _ in pieces[:-1]]
    assert (len(pieces) > 1) == (bytes_at_a_time < 2**23)
    for name in ("load", "moments", "cells", "extras"):
        read = np.concatenate([arrays[name] for _, arrays in pieces])
        np.testing.assert_array_equal(read, whole.sums.read(name, 0, None))


def test_n_surfaces_is_the_total(small_blocks, scene, tmp_path, expected):
    """Extended in steps that are no multiple of a block, once in the middle of a run."""
    path = tmp_path / "e.h5"
    run(replace(scene, n_surfaces=5), path)
    run(replace(scene, n_surfaces=37), path)
    assert ensembles.open_ensemble(path).n_surfaces == 37
    with pytest.raises(HaltError):
        run(replace(scene, n_surfaces=90), path, progress=stop_after(64))
    assert ensembles.open_ensemble(path).n_surfaces == 37  # the finished file stays as it is
    run(scene, path)
    assert digest(path) == expected
    with pytest.raises(StoreError, match="holds 100 surfaces already"):
        run(replace(scene, n_surfaces=99), path)


def test_a_finished_run_is_not_drawn_again(scene, tmp_path, monkeypatch):
    run(scene, tmp_path / "e.h5")
    before = (tmp_path / "e.h5").stat()
    monkeypatch.setattr(Job, "draw", None)
    run(scene, tmp_path / "e.h5")
    assert (tmp_path / "e.h5").stat().st_mtime_ns == before.st_mtime_ns


@pytest.mark.parametrize("begun", [False, True], ids=["finished", "in progress"])
@pytest.mark.parametrize(
    ("change", "word"),
    [({"seed": 2}, "ensemble.seed is 1 there and 2 here"), ({"separations": (0.5,)}, "contact.separations")],
)
def test_another_scene_or_seed_in_that_place_is_refused(small_blocks, scene, tmp_path, change, word, begun):
    path = tmp_path / "e.h5"
    if begun:
        halted(scene, path, 40)
    else:
        run(replace(scene, n_surfaces=8), path)
    with pytest.raises(StoreError, match=word):
        run(replace(scene, **change), path)


def test_another_version_is_refused(small_blocks, scene, tmp_path, monkeypatch):
    path = tmp_path / "e.h5"
    halted(scene, path, 40)
    monkeypatch.setattr("mcgw.store.arithmetic.versions", lambda **_: "mcgw 99")
    with pytest.raises(StoreError, match=r"drawn with .*, this is mcgw 99"):
        run(scene, path)


def test_two_drivers(small_blocks, scene, tmp_path):
    path = tmp_path / "e.h5"
    with locked(parts_of(path)), pytest.raises(LockedError, match=f"locked by pid {os.getpid()} on"):
        run(scene, path)
    run(scene, path)


def test_damage_is_put_aside_and_drawn_again(small_blocks, scene, tmp_path, expected):
    path = tmp_path / "e.h5"
    halted(scene, path, 64)
    shards = sorted(parts_of(path).glob("shards/*.h5"))
    data = bytearray(shards[0].read_bytes())
    data[1000] ^= 1
    shards[0].write_bytes(data)  # a flipped bit
    shards[1].write_bytes(shards[1].read_bytes()[:-700])  # truncated
    shards[2].write_bytes(shards[3].read_bytes())  # another block
    (shards[3].parent / ".left.tmp").write_bytes(b"half")
    assert ensembles.open_ensemble(path).n_surfaces <= 32
    with pytest.raises(HaltError):
        run(scene, path, progress=stop_after(0))
    assert len(list(parts_of(path).glob("shards/*.bad"))) == 3
    assert not list(parts_of(path).glob("shards/.*.tmp"))
    run(scene, path)
    assert digest(path) == expected


def test_damage_found_while_merging_is_mended(small_blocks, scene, tmp_path, expected, monkeypatch):
    path, merged = tmp_path / "e.h5", merging.merge_into

    def damage_first(folder, *rest):
        monkeypatch.setattr(merging, "merge_into", merged)
        shard = min(folder.glob("shards/*.h5"))
        shard.write_bytes(shard.read_bytes()[:-1])
        merged(folder, *rest)

    monkeypatch.setattr(merging, "merge_into", damage_first)
    run(scene, path)
    assert digest(path) == expected


def test_a_run_in_progress_can_be_read(small_blocks, scene, tmp_path):
    path = tmp_path / "e.h5"
    halted(scene, path, 48)
    ensemble, whole = ensembles.open_ensemble(path), mcgw.simulate(scene)
    m = ensemble.n_surfaces
    assert m % SIZE == 0
    np.testing.assert_array_equal(ensemble.load, whole.load[:m])
    np.testing.assert_allclose(ensemble.mean("area"), whole.area[:m].mean(axis=0), rtol=1e-12)  # rounding
    assert not ensembles.read_attributes(path)["complete"]


def test_jobs_that_share_a_run(small_blocks, scene, tmp_path, expected):
    path = tmp_path / "e.h5"
    assert run_part(scene, path, Part(2, 3)) == SURFACES - 2 * SIZE
    with pytest.raises(RunError, match="68 of 100 surfaces are missing, from 0 on"):
        merge(path)
    assert run_part(scene, path, Part(1, 3)) == 2 * SIZE
    assert run_part(scene, path, Part(3, 3)) == 0
    merge(path)
    assert digest(path) == expected
    with pytest.raises(ValueError, match="--shard 4/3: give i/n"):
        Part(4, 3)


def test_the_folder_of_a_run_vanishes(small_blocks, scene, tmp_path):
    path = tmp_path / "e.h5"

    def vanish(done):
        if done:
            shutil.rmtree(parts_of(path), ignore_errors=True)

    with pytest.raises((RunError, StoreError)):
        run(scene, path, progress=vanish)
    assert not path.exists()


def test_planted_links_are_not_followed(small_blocks, scene, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    parts_of(tmp_path / "e.h5").symlink_to(elsewhere)
    with pytest.raises(StoreError, match="is not a folder"):
        run(scene, tmp_path / "e.h5")
    assert not list(elsewhere.iterdir())
    (tmp_path / "f.h5").symlink_to(elsewhere / "victim")
    with pytest.raises(StoreError, match="is not a regular file"):
        run(scene, tmp_path / "f.h5")


def test_every_bit_of_the_file_counts(small_blocks, scene, tmp_path):
    """600 flips and 300 truncations; the trailer alone must see each, before HDF5 is asked."""
    path = tmp_path / "e.h5"
    run(scene, path)
    data, rng = path.read_bytes(), np.random.default_rng(3)
    copy = tmp_path / "copy.h5"
    for bit in rng.choice(8 * len(data), 600, replace=False):
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        copy.write_bytes(changed)
        with pytest.raises(StoreError):
            ensembles.check_trailer(copy)
    for length in rng.choice(len(data), 300, replace=False):
        copy.write_bytes(data[:length])
        with pytest.raises(StoreError):
            ensembles.check_trailer(copy)
    copy.write_bytes(data)
    assert ensembles.verify(copy)[0] == ""
    copy.write_bytes(changed)
    assert ensembles.verify(copy)[0].startswith("damaged")


def test_changed_data_with_a_good_trailer_are_noticed(scene, tmp_path):
    path = tmp_path / "e.h5"
    run(scene, path)
    with h5py.File(path, "r+") as file:
        file["load"][3, 1] *= 1 + 1e-15
    trailer_again(path)
    assert ensembles.verify(path)[0] == "digest mismatch of its data"


def test_room_is_asked_for_what_is_not_there_yet(small_blocks, scene, tmp_path, monkeypatch):
    path = tmp_path / "e.h5"
    halted(scene, path, 64)
    half = 8 * SURFACES * len(scene.separations) * len(scene.quantities)
    free = shutil.disk_usage(tmp_path)._replace(free=2 * half - 1)
    monkeypatch.setattr("mcgw.jobs.disk_space.shutil.disk_usage", lambda folder: free)
    with pytest.raises(StoreError, match="make room"):
        run(scene, tmp_path / "other.h5")
    run(scene, path)


def test_gaps_are_cut_at_multiples_of_a_block():
    assert missing(50, 16, []) == [Span(0, 16), Span(16, 16), Span(32, 16), Span(48, 2)]
    assert missing(50, 16, [Span(0, 20), Span(32, 16)]) == [Span(20, 12), Span(48, 2)]
    assert missing(50, 16, [Span(0, 50)]) == missing(50, 16, [Span(0, 64)]) == []


DRIVER = """
import sys, time
from mcgw.jobs.job import Job
Job.rows = 16
drawn = Job.draw
def slowly(*arguments):
    time.sleep(0.05)
    return drawn(*arguments)
Job.draw = slowly
from mcgw.cli import main
sys.exit(main(sys.argv[1:]))
"""


def started(scene, path, *words, **options):
    """The command line with small blocks that take 50 ms each."""
    file = path.with_suffix(".toml")
    file.write_text(mcgw.scene_text(scene))
    env = os.environ | {"PYTHONPATH": str(HERE.parent)}
    call = [sys.executable, "-c", DRIVER, "run", file, "-o", path, *words]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(list(map(str, call)), env=env, **pipes, **options)


def wait_for_shards(path, n):
    until = time.monotonic() + 60
    while len(list(parts_of(path).glob("shards/*.h5"))) < n:
        assert time.monotonic() < until
        time.sleep(0.01)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_stop_a_run_that_then_goes_on(small_blocks, scene, tmp_path, number, code, expected):
    path = tmp_path / "e.h5"
    process = started(scene, path)
    wait_for_shards(path, 2)
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert process.returncode == code
    assert out == ""
    assert len(without_notes(err).splitlines()) == 1
    assert "the same command goes on" in err
    assert not path.exists()
    run(scene, path)
    assert digest(path) == expected


def test_kill_9_and_going_on(scene, tmp_path, expected):
    path = tmp_path / "e.h5"
    process = started(scene, path)
    wait_for_shards(path, 3)
    process.kill()
    process.communicate()
    process = started(scene, path)
    err = process.communicate(timeout=60)[1]
    assert (process.returncode, without_notes(err)) == (0, "")
    assert digest(path) == expected


FULL = [
    (60_000, "cannot be merged"),  # shards fit, the merged file does not
    pytest.param(5_000, "finished blocks are kept", marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("limit", "words"), FULL)
def test_a_full_disk_is_one_line_and_the_run_completes_later(make_scene, tmp_path, limit, words):
    """A limit on the size of files stands for the disk."""
    scene = make_scene(separations=tuple(np.linspace(1, 3, 50)), sampler="tail", n_surfaces=SURFACES)
    path = tmp_path / "e.h5"
    full = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))}
    process = started(scene, path, **full)
    err = process.communicate(timeout=60)[1]
    assert process.returncode == 1, err
    assert len(without_notes(err).splitlines()) == 1
    assert words in err
    assert not path.exists()
    run(scene, path)
    whole = tmp_path / "whole.h5"
    run(scene, whole)
    assert digest(path) == digest(whole)


def soaked(tmp_path, kills, blocks):
    place = Path("/dev/shm") if Path("/dev/shm").is_dir() else tmp_path
    folder = place / f"soak-{os.getpid()}"
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(HERE.parent), str(HERE / "crash")])}
    call = [sys.executable, str(HERE / "crash" / "soak.py"), str(folder), str(kills), str(blocks)]
    try:
        done = subprocess.run(call, env=env, capture_output=True, text=True, check=True, timeout=500)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return json.loads(done.stdout)


def test_random_kills(tmp_path):
    found = soaked(tmp_path, 12, 30)
    assert found["kills"] >= 12
    assert (found["vanished"], found["wrong"]) == (0, 0)


@pytest.mark.slow
def test_many_random_kills(tmp_path):
    found = soaked(tmp_path, 80, 120)
    assert found["refused"] > 0
    assert (found["vanished"], found["wrong"]) == (0, 0)


def test_a_stopped_run_says_so_in_python(small_blocks, scene, tmp_path, monkeypatch):
    drawn = Job.draw

    def signalled(*arguments):
        monkeypatch.setattr(Job, "draw", drawn)
        os.kill(os.getpid(), signal.SIGINT)
        return drawn(*arguments)

    monkeypatch.setattr(Job, "draw", signalled)
    with pytest.raises(StoppedError) as caught:
        run(scene, tmp_path / "e.h5")
    assert caught.value.code == 130
