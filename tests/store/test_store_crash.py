"""A run struck at its file-modifying system calls: killed, torn, out of space, failing once.

A committed block must never be lost, no file may be silently wrong, and the same command must go on to
the digest of the undisturbed run. Every call is struck here, and of a run of eight blocks
by `runs/reliability/measure.py`.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parents[1] / "crash"
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


def said_by(script, folder, *words, **env):
    """What a script of the folder `crash` found."""
    memory = Path("/dev/shm")  # where flushing is quick: what is tried is the order of the calls
    place = (memory if memory.is_dir() else folder) / f"{folder.name}-{os.getpid()}"
    paths = [
        str(HERE.parent.parent),
        str(HERE.parent),
        str(HERE),
        *filter(None, [os.environ.get("PYTHONPATH")]),
    ]
    env = os.environ | {"PYTHONPATH": os.pathsep.join(paths)} | env
    call = [sys.executable, HERE / script, place, *map(str, words)]
    try:
        done = subprocess.run(call, capture_output=True, text=True, env=env, check=False, timeout=500)
    finally:
        shutil.rmtree(place, ignore_errors=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["kill", "torn", "ENOSPC", "EIO"])
def test_nothing_is_lost_at_any_call(shim, mode, tmp_path):
    found = said_by("harness.py", tmp_path, mode, BLOCKS, 1, LD_PRELOAD=str(shim))
    assert found["points"] >= BLOCKS * 5
    assert found["problems"] == {}


@pytest.mark.slow
def test_the_harness_sees_a_shard_written_in_place(shim, tmp_path):
    """A companion: without the temporary name, torn writes leave half a shard, and that is noticed."""
    struck = {"LD_PRELOAD": str(shim), "MCGW_IN_PLACE": "1"}
    assert said_by("harness.py", tmp_path, "torn", BLOCKS, 5, **struck)["problems"]


@pytest.mark.slow
def test_flipped_bits_are_seen_on_opening(tmp_path):
    found = said_by("flips.py", tmp_path, 100)
    assert found["flips"] == sum(place["flips"] for place in found["where"].values()) == 100
    assert len(found["where"]) == 10
    assert found["unseen"] == 0, found
