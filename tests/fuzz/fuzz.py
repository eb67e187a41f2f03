"""Damaged HDF5 files in children with limited memory: ``python fuzz.py COUNT SEED``.

Prints one JSON line: how many files, how many were accepted, and a list of failures: an exception that is
not ours, a crash, more than 4 s of CPU, more than the memory. A crash of the child that looks at a file is
no failure, that is what it is for, and is counted; one of the reader that follows is.
"""

import json
import os
import random
import resource
import signal
import sys
import tempfile
from pathlib import Path

from oracles.inside import home, verify

import mcgw
from mcgw import SceneError, run
from mcgw.errors import StoreError

MEMORY, SECONDS = 2**31, 4
SURFACE = mcgw.Surface("1 um", "10 um", 1e9, 1e-6, "70 GPa")


def limited(action):
    """Exit code of an action in a child with little memory and time; negative for a signal."""
    pid = os.fork()
    if not pid:
        code = 99
        try:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            code = action()
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def mutated_file(data, dice):
    data = bytearray(data)
    for _ in range(dice.choice([1, 1, 2, 8])):
        at, n = dice.randrange(len(data)), dice.choice([1, 2, 4, 8, 64])
        match dice.randrange(6):
            case 0:
                data[at] ^= 1 << dice.randrange(8)
            case 1:
                data[at : at + n] = dice.randbytes(n)
            case 2:
                data[at : at + n] = bytes(n)
            case 3:
                data[at : at + n] = b"\xff" * n
            case 4:
                other = dice.randrange(len(data))
                data[at : at + n] = data[other : other + n]
            case 5:
                data = data[: max(at, 1)] if dice.random() < 0.2 else data
    return bytes(data)


def files(count, seed):
    """What the child refuses is an error; what it lets through must be read without a crash."""
    dice = random.Random(seed)
    result = {"accepted": 0, "contained": 0, "failures": []}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "e.h5"
        run(mcgw.Scene(SURFACE, separations=[0.0, 1.0, 2.0], n_surfaces=10, seed=5), path)
        good = path.read_bytes()
        for i in range(count):
            path.write_bytes(mutated_file(good, dice))
            looked = limited(lambda: look(path))
            if looked == 0:
                result["accepted"] += 1
                used = limited(lambda: use(path))
                if used:
                    result["failures"].append(f"file {i}: reading it ended with {used}")
            elif looked != 2:
                result["contained"] += 1
    return result


def look(path):
    try:
        home("table_names").look(path)
    except StoreError:
        return 2
    return 0


def use(path):
    try:
        ensemble = mcgw.open_ensemble(path)
        for name in ensemble.scene.quantities:
            ensemble.mean(name)
        verify(path)
    except (StoreError, SceneError):
        pass
    return 0


if __name__ == "__main__":
    sys.stdout.write(
        json.dumps({"inputs": int(sys.argv[1]), **files(int(sys.argv[1]), int(sys.argv[2]))}) + "\n"
    )
