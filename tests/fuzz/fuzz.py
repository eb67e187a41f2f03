"""Fuzzing in children with limited memory: ``python fuzz.py files|maps COUNT SEED``.

Prints one JSON line: how many inputs, how many were accepted, and a list of failures: an exception that
is not ours, a crash, more than 4 s of CPU, more than the memory. A crash of the child that looks at a file
is no failure, that is what it is for, and is counted; one of the reader that follows is. Maps are read and
fitted in 1 GiB beyond what the program takes; run them under NUMBA_BOUNDSCHECK=1, with a NUMBA_CACHE_DIR of
its own.
"""

import json
import os
import random
import re
import resource
import signal
import sys
import tempfile
from pathlib import Path

import numpy as np

import mcgw
from mcgw import SceneError, run
from mcgw.errors import StoreError
from mcgw.maps import Topography, write_map
from mcgw.maps.map_files import WRITTEN
from mcgw.store import ensembles, h5_reading

MEMORY, SECONDS, OF_MAPS = 2**31, 4, 2**30
SURFACE = mcgw.Surface("1 um", "10 um", 1e9, 1e-6, "70 GPa")
VALUES = [
    "nan", "inf", "-inf", "1e400", "-1", "0", "-0.0", "1e-320", "1e308", "true", "99999999999999999999",
    "1e6", "1.5", "2026-11-21", "0x10", "1_0", "[]", "{}", "[[1]]", "[nan]", "{start=0}",
    "{start=0,stop=1,num=1000000}", "[1e3,-40]", "{E=1}", "'x'", '""', "''", "'''", "'table'", "'allow'",
    "[1,'a']",
]  # fmt: skip


def limited(action, memory=MEMORY):
    """Exit code of an action in a child with little memory and time; negative for a signal."""
    pid = os.fork()
    if not pid:
        code = 99
        try:
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
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
        h5_reading.look(path)
    except StoreError:
        return 2
    return 0


def use(path):
    try:
        ensemble = ensembles.open_ensemble(path)
        for name in ensemble.scene.quantities:
            ensemble.mean(name)
        ensembles.verify(path)
    except (StoreError, SceneError):
        pass
    return 0


def mutated_map(folder, dice):
    """A file of a map, or of numbers x y z, with wild heights, damaged bytes or other numbers in its text."""
    heights = 1e-6 * np.random.default_rng(dice.randrange(9)).normal(size=(64, 66))
    ending = dice.choice([*WRITTEN, ".txt", ".csv"])
    path = folder / f"map{ending}"
    try:
        if ending in WRITTEN:
            write_map(Topography(heights, (1e-6, dice.choice([*[1e-6] * 8, 1e-300, 1e300]))), path)
        else:
            np.savetxt(path, heights, delimiter="," if ending == ".csv" else " ")
    except ValueError:
        return None
    if ending in (".npy", ".txt", ".csv") and dice.random() < 0.5:
        some = np.random.default_rng(dice.randrange(10**6)).integers(4224, size=dice.choice([1, 5, 4224]))
        heights.flat[some] = dice.choice([np.nan, 1e308, -1.7e308, 1e200, 5e-324, 0.0, 1e155])
        if ending == ".npy":
            np.save(path, heights)
        else:
            np.savetxt(path, heights, delimiter="," if ending == ".csv" else " ")
    for one in sorted(folder.iterdir()):
        data = one.read_bytes()
        if dice.random() < 0.4 and one.suffix in (".json", ".txt", ".csv", ".sdf"):
            numbers = list(re.finditer(rb"[-+]?\d+\.?\d*(e[-+]?\d+)?", data[:2000]))
            at = dice.choice(numbers or [re.match(b"", data)])
            data = data[: at.start()] + dice.choice(VALUES).encode() + data[at.end() :]
        elif dice.random() < 0.4:
            data = mutated_file(data, dice)
        one.write_bytes(data)
    return path


def maps(count, seed):
    """Each is fitted, or refused by an error that is ours."""
    dice, result = random.Random(seed), {"accepted": 0, "contained": 0, "failures": []}
    fit_map(good_map())  # loops are compiled before there is a limit
    memory = OF_MAPS + 1024 * int(re.search(r"VmSize:\s+(\d+)", Path("/proc/self/status").read_text())[1])
    for i in range(count):
        with tempfile.TemporaryDirectory() as folder:
            path = mutated_map(Path(folder), dice)
            ended = limited(lambda: fit_map(path), memory) if path else 2  # noqa: B023
            if ended in (0, 2):
                result["accepted"] += not ended
            else:
                kept = Path(tempfile.gettempdir()) / f"fuzz-map-{seed}-{i}{path.suffix}"
                kept.write_bytes(path.read_bytes())
                result["failures"].append(f"map {i}: ended with {ended}: {kept}")
    return result


def good_map():
    """A file that can be fitted."""
    path = Path(tempfile.mkdtemp()) / "map.npy"
    heights = 1e-6 * np.random.default_rng(1).normal(size=(64, 66))
    write_map(Topography(heights, (1e-6, 1e-6)), path)
    return path


def fit_map(path):
    try:
        mcgw.fit(path, cutoff="none", **({} if path.suffix in WRITTEN else {"pixel": "1 um", "unit": "um"}))
    except (ValueError, OSError):
        return 2
    return 0


if __name__ == "__main__":
    kind, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    found = {"files": files, "maps": maps}[kind](count, seed)
    sys.stdout.write(json.dumps({"inputs": count, **found}) + "\n")
