"""Under a hard limit on memory (``ulimit -v``): all works where it suffices, and else it is what is named."""

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from oracles.inside import Group, block_size, memory_available, reducer_of
from oracles.memory_growth import peak_growth
from oracles.said import without_notes

import mcgw
from mcgw.errors import StoreError
from mcgw.machine import process as memory

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


@pytest.mark.slow
def test_commands_work_where_the_memory_suffices(tmp_path):
    path = tmp_path / "e.h5"
    for words in (["run", ROOT / "runs" / "quick.toml", "-o", path], ["show", path, "--verify"]):
        done = limited(1024, "-m", "mcgw", *words)
        assert (done.returncode, without_notes(done.stderr)) == (0, "")


def test_what_may_be_taken_heeds_the_limit():
    code = "from mcgw.machine.process import memory_available; print(memory_available())"
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
        ([], ["100"], [], None, 2**63 - 1),
    ],
)
def test_the_least_of_what_machine_group_and_user_leave(monkeypatch, machine, used, most, limit, least):
    group = "/sys/fs/cgroup/memory"
    files = {"/proc/meminfo": machine, f"{group}.current": used, f"{group}.max": most}
    files["/proc/self/status"] = ["VmPeak: 9 kB", "VmSize: 2 kB"]
    monkeypatch.setattr("mcgw.machine.process._lines", files.__getitem__)
    limit = resource.RLIM_INFINITY if limit is None else limit
    monkeypatch.setattr(resource, "getrlimit", lambda what: (limit, resource.RLIM_INFINITY))
    assert memory_available() == least


@pytest.mark.skipif(not os.access("/proc/self/clear_refs", os.W_OK), reason="Linux alone tells it")
def test_growth_is_of_the_call_alone():
    np.ones(2**24)  # a peak before it; more than 32 MiB comes fresh from the system
    assert peak_growth(lambda: np.ones(2**23)) == pytest.approx(2**26, rel=0.2)


WIDTH = 4 * 9  # numbers of a surface: quantities and separations of `make_scene`
SUMMARY = 8 * WIDTH * (WIDTH + 1)  # bytes of products and means


NEEDS = {
    "surfaces in memory": ({}, lambda scene: reducer_of(scene).check(100_000), 2 * 8 * 100_000 * WIDTH),
    "a block": ({"n_surfaces": 10**6}, lambda scene: reducer_of(scene).check(), 3 * 8 * 50_000 * WIDTH),
    "less than a block": ({"n_surfaces": 30_000}, lambda scene: reducer_of(scene).check(),
                          3 * 8 * 30_000 * WIDTH),
    "statistics": ({"keep": "statistics"}, lambda scene: reducer_of(scene).check(), 4 * SUMMARY + 3 * 2**26),
    "points": ({}, lambda scene: Group((scene,) * 300, ()).check(),
               2 * 8 * WIDTH * 300**2),
}  # fmt: skip


@pytest.mark.parametrize("what", NEEDS)
def test_work_is_refused_where_a_byte_is_missing(what, make_scene, blocks_of, monkeypatch):
    """And not where there is just enough."""
    blocks_of(50_000)
    changes, ask, size = NEEDS[what]
    scene = make_scene(**changes)
    monkeypatch.setattr(memory, "memory_available", lambda: size)
    ask(scene)
    monkeypatch.setattr(memory, "memory_available", lambda: size - 1)
    with pytest.raises(StoreError, match=rf" needs {size / 2**30:.4g} GiB of memory but only"):
        ask(scene)


@pytest.mark.parametrize("separations", [2, 40, 1000])
def test_a_block_fills_a_few_mebibytes(separations, make_scene):
    """So that writing one costs little, and holding some for each core too; or it is one of the sampler's."""
    reducer = reducer_of(make_scene(separations=np.linspace(0, 3, separations), n_surfaces=10**6))
    size = 8 * reducer.scene.width * reducer.rows
    assert size <= 2**23 or reducer.rows <= 256
    assert size > 2**20


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


DRAWS = st.sampled_from([0.0, 1e3, 1e6, 1e9, 1e12])


@given(st.integers(0, 10**8), DRAWS, st.sampled_from(["sums", "statistics"]))
def test_blocks_are_as_large_as_the_memory_and_an_interruption_allow(words, draws, keep):
    """A single surface may be beyond either limit; whole groups, and whole chunks of a file."""
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    scene = mcgw.Scene(surface, separations=np.arange(9.0), ensemble={"keep": keep}, n_surfaces=1)
    sampler = SimpleNamespace(words=words, draws=draws, moments=0, cells=0)
    size, reducer = block_size(scene, sampler), reducer_of(scene, sampler)
    assert size * (scene.width + words) <= 2e7 or size == 1
    assert size * draws <= 1.5e8 or size == 1
    assert size % 64 == 0 or size < 64
    assert reducer.rows * draws <= 1e9 or reducer.rows == 1
    assert reducer.rows % 256 == 0 or reducer.rows <= max(size, 256) or keep == "statistics"
    computed = (SimpleNamespace(width=scene.width + words, touching=draws),)
    rows = Group(computed, ()).rows
    assert rows == 1 or (8 * rows * (scene.width + words) <= 2**28 and rows * draws <= 1e10)
    assert rows <= 8192
