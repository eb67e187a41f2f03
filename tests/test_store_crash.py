"""A run struck at its file-modifying system calls: killed, torn, out of space, failing once.

A committed block must never be lost, no file may be silently wrong, and the same command must go on to
the digest of the undisturbed run. Every call is struck in the slow part, every ninth in the other, and
every call of a run of eight blocks by `runs/reliability/measure.py`.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent / "crash"
BLOCKS = 3


@pytest.fixture(scope="module")
def shim(tmp_path_factory):
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None or not sys.platform.startswith("linux"):
        pytest.skip("needs a C compiler and LD_PRELOAD")
    library = tmp_path_factory.mktemp("shim") / "shim.so"
    call = [compiler, "-shared", "-fPIC", "-O1", "-o", library, HERE / "shim.c", "-ldl"]
    subprocess.run(call, check=True)
    return library


def harness(shim, mode, *, stride, folder):
    """What the harness found: points that were tried, and those with problems."""
    memory = Path("/dev/shm")  # where flushing is quick: what is tried is the order of the calls
    place = (memory if memory.is_dir() else folder) / f"{folder.name}-{os.getpid()}"
    paths = [str(HERE.parent.parent), *filter(None, [os.environ.get("PYTHONPATH")])]
    env = os.environ | {"LD_PRELOAD": str(shim), "PYTHONPATH": os.pathsep.join(paths)}
    call = [sys.executable, HERE / "harness.py", place, mode, str(BLOCKS), str(stride)]
    try:
        done = subprocess.run(call, capture_output=True, text=True, env=env, check=False, timeout=300)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("mode", ["kill", "torn", "ENOSPC", "EIO"])
def test_nothing_is_lost_at_some_calls(shim, mode, tmp_path):
    found = harness(shim, mode, stride=9, folder=tmp_path)
    assert found["points"] >= BLOCKS * 5 // 9  # open, write, flush, rename, flush for each block
    assert found["problems"] == {}


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["kill", "torn", "ENOSPC", "EIO"])
def test_nothing_is_lost_at_any_call(shim, mode, tmp_path):
    found = harness(shim, mode, stride=1, folder=tmp_path)
    assert found["points"] >= BLOCKS * 5
    assert found["problems"] == {}


def test_the_harness_sees_a_shard_written_in_place(shim, tmp_path, monkeypatch):
    """A companion: without the temporary name, torn writes leave half a shard, and that is noticed."""
    monkeypatch.setenv("MCGW_IN_PLACE", "1")
    assert harness(shim, "torn", stride=5, folder=tmp_path)["problems"]
