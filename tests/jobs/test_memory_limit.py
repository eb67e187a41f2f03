"""Under a hard limit on memory (``ulimit -v``): all works where it suffices, and else it is what is named."""

import os
import subprocess
import sys
import threading
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from oracles.inside import Values, block_size, check_memory, memory_available, reducer_of
from oracles.memory_growth import peak_growth
from oracles.said import without_notes

import mcgw
from mcgw.errors import StoreError
from mcgw.machine import child_process, memory
from mcgw.machine.child_process import end_with
from mcgw.sweeps.groups import Pooling

resource = pytest.importorskip("resource")

ROOT = Path(mcgw.__file__).parents[1]
MIB = 2**20


def limited(mib, *words):
    """A Python with so much address space, its children too; two threads, for each has a stack."""

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (mib * MIB, mib * MIB))

    few = {"OPENBLAS_NUM_THREADS": "2", "NUMBA_NUM_THREADS": "2", "MALLOC_ARENA_MAX": "2"}
    env = os.environ | {"PYTHONPATH": str(ROOT)} | few
    call = [sys.executable, *map(str, words)]
    return subprocess.run(call, env=env, preexec_fn=limit, capture_output=True, text=True, check=False)


@pytest.fixture
def file(make_scene, tmp_path):
    path = tmp_path / "e.h5"
    mcgw.run(make_scene(separations=(2.0, 3.0), sampler="tail", n_surfaces=20), path)
    return path


@pytest.mark.slow
def test_commands_work_where_the_memory_suffices(tmp_path):
    path = tmp_path / "e.h5"
    for words in (
        ["run", ROOT / "runs" / "quick.toml", "-o", path],
        ["show", path],
        ["show", path, "--verify"],
    ):
        done = limited(1024, "-m", "mcgw", *words)
        assert (done.returncode, without_notes(done.stderr)) == (0, "")


def test_what_may_be_taken_heeds_the_limit():
    code = "from mcgw.machine.memory import memory_available; print(memory_available())"
    assert int(limited(1024, "-c", code).stdout) < 1024 * MIB


FIVE = ["MemTotal: 9 kB", "MemFree: 3 kB", "MemAvailable: 5 kB"]


@pytest.mark.parametrize(
    ("machine", "used", "most", "limit", "least"),
    [
        (FIVE, [], [], None, 5120),
        (FIVE, ["100"], ["max"], None, 5120),
        (FIVE, ["100"], ["4000"], None, 3900),
        (FIVE, ["100"], ["90"], None, 0),
        (FIVE, ["100"], ["9000"], 4096, 2048),
        (FIVE, [], [], 1024, 0),
        ([], ["100"], [], None, 2**63 - 1),
    ],
)
def test_the_least_of_what_machine_group_and_user_leave(monkeypatch, machine, used, most, limit, least):
    group = "/sys/fs/cgroup/memory"
    files = {"/proc/meminfo": machine, f"{group}.current": used, f"{group}.max": most}
    files["/proc/self/status"] = ["VmPeak: 9 kB", "VmSize: 2 kB"]
    monkeypatch.setattr("mcgw.machine.memory._lines", files.__getitem__)
    monkeypatch.setattr("mcgw.machine.memory.memory_limit", lambda: limit)
    assert memory_available() == least


@pytest.mark.skipif(not os.access("/proc/self/clear_refs", os.W_OK), reason="Linux alone tells it")
def test_growth_is_of_the_call_alone():
    np.ones(2**24)  # a peak before it; more than 32 MiB comes fresh from the system
    assert peak_growth(lambda: np.ones(2**23)) == pytest.approx(2**26, rel=0.2)


# --- what is asked for, by hand -------------------------------------------------------------------------


WIDTH = 4 * 9  # numbers of a surface: quantities and separations of `make_scene`
SUMMARY = 8 * WIDTH * (WIDTH + 1)  # bytes of products and means


def points(scene, n):
    return Pooling(SimpleNamespace(computed=(scene,) * n))


PART = {"n_surfaces": 30_000}
NEEDS = {
    "surfaces in memory": ({}, lambda scene: reducer_of(scene).check(100_000), 2 * 8 * 100_000 * WIDTH),
    "a block": ({"n_surfaces": 10**6}, lambda scene: reducer_of(scene).check(), 3 * 8 * 50_000 * WIDTH),
    "less than a block": (PART, lambda scene: reducer_of(scene).check(), 3 * 8 * 30_000 * WIDTH),
    "statistics": ({"keep": "statistics"}, lambda scene: reducer_of(scene).check(), 4 * SUMMARY + 3 * 2**26),
    "points": ({}, lambda scene: points(scene, 300).check(), 2 * 8 * WIDTH * 300**2),
}  # fmt: skip


@pytest.mark.parametrize("what", NEEDS)
def test_work_is_refused_where_a_byte_is_missing(what, make_scene, monkeypatch):
    """And not where there is just enough."""
    monkeypatch.setattr(Values, "rows", 50_000)
    changes, ask, size = NEEDS[what]
    scene = make_scene(**changes)
    monkeypatch.setattr(memory, "memory_available", lambda: size)
    ask(scene)
    monkeypatch.setattr(memory, "memory_available", lambda: size - 1)
    with pytest.raises(StoreError, match=rf" needs {size / 2**30:.4g} GiB of memory but only"):
        ask(scene)


def test_small_requests_are_not_looked_up(monkeypatch):
    monkeypatch.setattr(memory, "memory_available", lambda: 0)
    check_memory("anything", 2**24 - 1)
    with pytest.raises(
        StoreError, match=r"^anything needs 0\.01562 GiB of memory but only 0 GiB is available"
    ):
        check_memory("anything", 2**24)


def test_disk_is_asked_for_blocks_and_file(make_scene):
    """Statistics: those of whole blocks are one in the file, which holds covariances too."""
    sampler = SimpleNamespace(draws=0, words=0, moments=100, cells=7)
    reducer = reducer_of(make_scene(), sampler)
    assert reducer.joined_bytes(50) == 8 * 50 * WIDTH
    assert reducer.disk == 2 * 8 * 200 * WIDTH
    for n, blocks, parts in ((1, 1, 1), (2**20, 1, 1), (2**20 + 1, 2, 2), (3 * 2**20, 3, 1)):
        reducer = reducer_of(make_scene(keep="statistics", n_surfaces=n), sampler)
        assert reducer.joined_bytes(n) == parts * SUMMARY + 8 * WIDTH**2
        assert reducer.disk == blocks * SUMMARY + reducer.joined_bytes(n)


@pytest.mark.parametrize(
    ("words", "draws", "surfaces"),
    [
        (64, 0, 30 * 64),  # 20e6/100 would fit, but never more than thirty groups
        (10_000 - WIDTH, 0, 6 * 64),  # 400 fit the cache: twice an odd number of groups
        (62_500 - WIDTH, 0, 64),  # 64 fit
        (10**6 - WIDTH, 0, 20),  # what memory allows
        (10**8, 0, 1),
        (0, 1.5e8 / 1000 - 1, 14 * 64),  # 1000 surfaces of so many draws
        (0, 1.5e8 / 64 - 1, 64),
        (0, 1.5e8 / 10 - 1, 10),
        (0, 1.5e9, 1),
    ],
)
def test_surfaces_of_a_block(words, draws, surfaces, make_scene):
    assert block_size(make_scene(), SimpleNamespace(words=words, draws=draws)) == surfaces


@pytest.mark.parametrize(
    ("draws", "file", "piece", "rows"),
    [
        (0, 28_672, 8192, 2**20),  # 2^23 bytes are 15 blocks of 30 groups of 36 numbers, cut at chunks of 256
        (4e8 / 3840 - 1, 2 * 22 * 64, 8192, 8192),  # 2.7 blocks of 22 groups draw 4e8 numbers
        (1e9 / 32_768 - 1, 6 * 30 * 64, 8192, 32_768),  # 6.8 of 30 groups
        (1e9 / 100 - 1, 2 * 15, 100, 100),  # 2.7 of 15 surfaces
        (1e9, 1, 1, 1),
    ],
)
def test_surfaces_of_what_is_written_at_once(draws, file, piece, rows, make_scene):
    sampler = SimpleNamespace(draws=draws, words=0, moments=0, cells=0)
    kept = reducer_of(make_scene(keep="statistics"), sampler)
    assert (kept._piece, kept.rows) == (piece, rows)
    assert reducer_of(make_scene(), sampler).rows == file


def test_points_of_a_sweep_that_are_drawn_at_once(make_scene):
    """As many surfaces as an ensemble has, fewer of many numbers or of many asperities; one at least."""

    def rows(n, touching, keep=1):
        one = SimpleNamespace(width=WIDTH, touching=touching)
        return Pooling(SimpleNamespace(computed=(one,) * n, scenes=(one, None))).rows

    assert rows(2, 0) == 8192
    assert rows(1000, 0) == 2**28 // (8 * 1000 * WIDTH) == 932
    assert rows(2, 1e10 / 50 - 1) == 50
    assert rows(2, 1e12) == 1
    assert rows(10**6, 0) == 1


# --- limits of a process, by a stand-in for the system ---------------------------------------------------


@pytest.mark.parametrize("linux", [True, False])
@pytest.mark.parametrize("waits", [True, False])
def test_a_process_ends_when_the_other_end_of_its_pipe_is_closed(linux, waits, monkeypatch):
    """At once: the kernel is asked to kill it, and a thread does so too."""
    asked, ended, gone = [], threading.Event(), threading.Event()
    names = ("F_SETOWN", "F_SETSIG", "F_SETFL", "F_GETFL")
    system = SimpleNamespace(fcntl=lambda *words: asked.append(words) or 4, **{name: name for name in names})
    monkeypatch.setitem(sys.modules, "fcntl", system if linux else None)
    monkeypatch.setattr(child_process.os, "_exit", lambda code: ended.set() if code == 1 else None)
    reading, writing = os.pipe()
    try:
        end_with(reading, gone.wait if waits else None)
        assert not ended.wait(timeout=0.05)
        if waits:
            gone.set()
        else:
            os.close(writing)
        assert ended.wait(timeout=30)
    finally:
        os.close(reading)
        if waits:
            os.close(writing)
    kernel = [("F_SETOWN", os.getpid()), ("F_SETSIG", 9), ("F_GETFL",), ("F_SETFL", 4 | os.O_ASYNC)]
    assert asked == ([(reading, *words) for words in kernel] if linux else [])
