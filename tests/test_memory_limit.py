"""Under a hard limit on memory (``ulimit -v``): all works where it suffices, and else it is what is named."""

import os
import subprocess
import sys
from pathlib import Path

import h5py
import pytest
from new_trailer import trailer_again
from said import without_notes

import mcgw
from mcgw.errors import StoreError
from mcgw.jobs.running import run

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
    assert line.startswith(f"{file}: cannot be looked at with the memory this process may have")
    assert f"(ulimit -v {TIGHT * 1024})" in line
    assert limited(1024, "-c", LOOK, file).stdout == ""


def test_a_damaged_file_is_blamed_all_the_same(file):
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    (line,) = limited(TIGHT, "-c", LOOK, file).stdout.splitlines()
    assert "damaged or hostile" in line


def test_a_hostile_file_is_named_as_such(file):
    with h5py.File(file, "r+") as data:
        del data["load"]
        data["load"] = h5py.SoftLink("/area")
    trailer_again(file)
    (line,) = limited(1024, "-c", LOOK, file).stdout.splitlines()
    assert "refused: load: a link to another place" in line
    with pytest.raises(StoreError, match="refused: load: a link to another place"):
        mcgw.open_ensemble(file)


def test_what_may_be_taken_heeds_the_limit():
    code = "from mcgw.machine.memory import memory_available; print(memory_available())"
    assert int(limited(1024, "-c", code).stdout) < 1024 * MIB
