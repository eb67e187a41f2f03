"""Under a hard limit on memory (``ulimit -v``): all works where it suffices, and else it is what is named."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from said import without_notes

import mcgw
from mcgw.jobs.running import run
from mcgw.machine.child_process import run_child
from mcgw.machine.memory import memory_available, peak_growth

resource = pytest.importorskip("resource")

ROOT = Path(mcgw.__file__).parents[1]
MIB = 2**20
TIGHT = 80  # MiB: Python starts, NumPy does not


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
    run(make_scene(separations=(2.0, 3.0), sampler="tail", n_surfaces=20), path)
    return path


@pytest.mark.slow
def test_commands_work_where_the_memory_suffices(tmp_path):
    """Half of what the child that looks at files would otherwise allow itself."""
    path = tmp_path / "e.h5"
    for words in (
        ["run", ROOT / "runs" / "quick.toml", "-o", path],
        ["show", path],
        ["show", path, "--verify"],
    ):
        done = limited(1024, "-m", "mcgw", *words)
        assert (done.returncode, without_notes(done.stderr)) == (0, "")


LOOK = """
import sys
from pathlib import Path
from mcgw.errors import StoreError
from mcgw.store import untrusted
path = Path(sys.argv[1])
try:
    untrusted._examined_by_child(path, path, 0)
except StoreError as error:
    print(error)
"""


def test_too_little_memory_is_not_blamed_on_the_file(file):
    (line,) = limited(TIGHT, "-c", LOOK, file).stdout.splitlines()
    assert line.startswith(f"{file}: cannot be checked within the memory limit of this process")
    assert f"(ulimit -v {TIGHT * 1024})" in line
    assert limited(1024, "-c", LOOK, file).stdout == ""


def test_a_damaged_file_is_blamed_all_the_same(file):
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    (line,) = limited(TIGHT, "-c", LOOK, file).stdout.splitlines()
    assert "damaged or hostile" in line


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


def test_a_child_has_what_it_needs_whatever_its_user_has_set(tmp_path, monkeypatch):
    """One thread of BLAS, and this package before those of the user, which stay."""
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    ask = "import os; print(os.environ['OPENBLAS_NUM_THREADS'], os.environ['PYTHONPATH'])"
    said = run_child("timeit", "-n", "1", "-r", "1", "-s", ask, "pass", seconds=60)
    threads, paths = said.split()[:2]
    assert threads == "1"
    assert paths.split(os.pathsep) == [str(Path(mcgw.__file__).parents[1]), str(tmp_path)]
