"""Fuzzing in children with limited memory: ``python fuzz.py scenes|files COUNT SEED``.

Prints one JSON line: how many inputs, how many were accepted, and a list of failures: an exception that
is not ours, a crash, more than 5 s, more than the memory. A crash of the child that looks at a file is no
failure, that is what it is for, and is counted; one of the reader that follows is.
"""

import json
import os
import random
import resource
import signal
import sys
import tempfile
from pathlib import Path

import mcgw
from mcgw.errors import StoreError
from mcgw.jobs.running import run
from mcgw.scene.scene import SceneError
from mcgw.store import ensembles, structure

MEMORY, SECONDS = 2**31, 4
SCENE = """title = "fuzz"
[surface]
sigma = 1e-6
radius = 1e-5
eta = 1e9
nominal_area = 1e-6
bodies = [{E = 70e9, nu = 0.33}, {E = inf}]
[grading]
law = "exponential"
gamma = 2.0
[heights]
law = "gaussian"
[contact]
separations = {start = 0.0, stop = 4.0, num = 5}
quantities = ["load", "area"]
[ensemble]
n_surfaces = 10
n_asperities = 1000
count = "fixed"
seed = 5
sampler = "tail"
"""
VALUES = [
    "nan", "inf", "-inf", "1e400", "-1", "0", "-0.0", "1e-320", "1e308", "true", "99999999999999999999",
    "1e6", "1.5", "2026-11-21", "0x10", "1_0", "[]", "{}", "[[1]]", "[nan]", "{start=0}",
    "{start=0,stop=1,num=1000000}", "[1e3,-40]", "{E=1}", "'x'", '""', "''", "'''", "'table'", "'allow'",
    "[1,'a']",
]  # fmt: skip


def limited(action):
    """Exit code of an action in a child with little memory and time; negative for a signal."""
    pid = os.fork()
    if not pid:
        code = 99
        try:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            signal.alarm(SECONDS)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            code = action()
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


def mutated_scene(dice):
    lines = SCENE.splitlines()
    for _ in range(dice.randint(1, 4)):
        i = dice.randrange(len(lines))
        key = lines[i].split("=")[0].strip()
        kind = dice.randrange(7)
        if kind == 0:
            lines[i] = f"{key} = {dice.choice(VALUES)}"
        elif kind == 1:
            del lines[i]
        elif kind == 2:
            lines.insert(i, dice.choice(lines))
        elif kind == 3:
            lines[i] = lines[i].replace(key, key[:-1] or "k", 1)
        elif kind == 4:
            lines[i] = f"{key} = {dice.uniform(-1, 1) * 10.0 ** dice.randint(-330, 308)}"
        elif kind == 5:
            at = dice.randrange(len(lines[i]) + 1)
            lines[i] = (
                lines[i][:at] + chr(dice.choice([0, 10, 34, 39, 91, 123, 125, 255, 0x1F600])) + lines[i][at:]
            )
        else:
            lines[i] = f"{key} = {'[' * dice.randint(1, 2000)}"
        lines = lines or [""]
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def scenes(count, seed):
    """Many scenes a child: each is read, and if it is good, written and read again."""
    accepted, failures, batch = 0, [], 2000
    for start in range(0, count, batch):
        note = Path(tempfile.gettempdir()) / f"fuzz-{os.getpid()}"

        def action(start=start, note=note):
            dice, good = random.Random(seed * 1_000_003 + start), 0
            for _ in range(min(batch, count - start)):
                text = mutated_scene(dice)
                signal.alarm(SECONDS)
                try:
                    scene = mcgw.scene_from(text)
                    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
                    good += 1
                except SceneError as error:
                    if not all(line and "\n" not in line for line in error.problems):
                        raise ValueError(error.problems) from None
                except BaseException as error:
                    note.write_text(json.dumps([repr(error), text.decode(errors="replace")]))
                    return 1
            note.write_text(str(good))
            return 0

        code = limited(action)
        if code:
            failures.append(json.loads(note.read_text()) if code == 1 else f"child ended with {code}")
        else:
            accepted += int(note.read_text())
        note.unlink(missing_ok=True)
    return {"accepted": accepted, "contained": 0, "failures": failures}


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
        run(mcgw.scene_from(SCENE), path)
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
        structure.describe(str(path))
    except (structure.RefusedError, MemoryError, OSError, RuntimeError, ValueError, KeyError, TypeError):
        return 2
    return 0


def use(path):
    ensembles.examine = lambda path: json.loads(json.dumps(structure.describe(str(path))))
    try:
        ensemble = ensembles.open_ensemble(path)
        for name in ensemble.scene.quantities:
            ensemble.mean(name)
        ensembles.verify(path)
    except (StoreError, SceneError):
        pass
    return 0


if __name__ == "__main__":
    kind, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    found = {"scenes": scenes, "files": files}[kind](count, seed)
    sys.stdout.write(json.dumps({"inputs": count, **found}) + "\n")
