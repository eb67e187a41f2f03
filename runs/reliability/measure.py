"""The long versions of the tests of the store: ``python runs/reliability/measure.py crash|kills|flips|fuzz``.

crash   every file-modifying system call of a run of eight blocks, in four ways (about a minute)
kills   500 random kills of all that writes
flips   500 bits flipped where files say what their numbers mean (half a minute)
fuzz    1e4 HDF5 files (about ten minutes)

Each line printed is JSON; a list or count of problems that is not empty or zero is one.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

TESTS = Path(__file__).parents[2] / "tests"


def call(*words, **environment):
    """Run one of the harnesses and pass on what it prints."""
    paths = os.pathsep.join([str(TESTS.parent), str(TESTS), str(TESTS / "crash")])
    env = os.environ | {"PYTHONPATH": paths} | environment
    subprocess.run([sys.executable, *map(str, words)], env=env, check=True)


def crash(folder):
    """Strike at every call."""
    shim = folder / "shim.so"
    source = TESTS / "crash" / "shim.c"
    subprocess.run(["gcc", "-shared", "-fPIC", "-O1", "-o", shim, source, "-ldl"], check=True)
    for mode in ("kill", "torn", "ENOSPC", "EIO"):
        print(mode, end=" ", flush=True)
        call(TESTS / "crash" / "harness.py", folder / mode, mode, 8, LD_PRELOAD=str(shim))


def kills(folder):
    """Kill at random."""
    call(Path(__file__).with_name("kills.py"), 500, 1, folder / "kills")


def flips(folder):
    """Flip single bits, and open."""
    call(TESTS / "crash" / "flips.py", folder / "flips", 500)


def fuzz(folder):  # noqa: ARG001
    """Read what is wrong in every way."""
    call(TESTS / "fuzz" / "fuzz.py", 10_000, 7)


if __name__ == "__main__":
    memory = Path("/dev/shm")  # flushing is quick there: what is tried is the order of the calls
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as place:
        for name in sys.argv[1:] or ("crash", "kills", "flips", "fuzz"):
            {"crash": crash, "kills": kills, "flips": flips, "fuzz": fuzz}[name](Path(place))
