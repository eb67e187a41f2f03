"""A run that is killed or fails at each of its file-modifying system calls, one after the other.

Run under ``LD_PRELOAD=shim.so``: ``python harness.py FOLDER MODE BLOCKS [STRIDE]``. Imports once and
forks for each point. Prints one JSON line: points, and those where something was lost or wrong. The surfaces
are made up: what is tried here is the store, and it knows nothing of physics.
"""

import ctypes
import gc
import json
import multiprocessing
import os
import shutil
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from oracles.inside import RECORD, Plan, Values, home, parts_of, read_tables, verify

import analytic
import mcgw
from mcgw.errors import RunError, StoreError

multiprocessing.set_start_method("spawn")  # else Numba has a lock for all forks, which a killed one keeps
_DRAW = Plan.draw
MODES = {"kill": 1, "torn": 2, "ENOSPC": 3, "EIO": 4}
ROWS = 8
SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e8, nominal_area=1e-4, E_star=1e9)


def scene_of(blocks):
    return mcgw.Scene(
        surface=SURFACE,
        separations=(0.0, 1.0, 2.0),
        contact={"quantities": ("load", "contacts")},
        n_surfaces=ROWS * blocks,
        seed=7,
        ensemble={"sampler": "direct"},
    )


def made_up(job, span, *how):
    if job and job.axes:  # statistics of several scenes are not made up
        return _DRAW(job, span, *how)
    i = np.arange(span.first, span.stop)[:, None] + np.arange(3) / 3
    return {"load": np.sqrt(i + 2), "contacts": np.floor(i**2).astype(np.int64)}


def prepare():
    Plan.draw = made_up
    home("PATIENCE").PATIENCE = 0.0  # a second driver is refused at once
    Values.rows = home("CHUNK_ROWS").CHUNK_ROWS = ROWS  # blocks are merged by their packed chunks
    if "MCGW_IN_PLACE" in os.environ:  # the wrong way, which the harness must notice
        home("commit_shard").whole_file = written_in_place


@contextmanager
def written_in_place(path, **_):
    path.unlink(missing_ok=True)
    yield path


def attempt(scene, file, progress=None):
    """Exit code of a run, as the command line would have it."""
    try:
        mcgw.run(scene, file, progress=progress)
    except (RunError, StoreError, OSError):
        return 1
    except BaseException as error:
        sys.stderr.write(f"{type(error).__name__}: {error}\n")
        return 99
    return 0


def forked(action):
    """Exit status of an action in a process of its own, negative for a signal."""
    pid = os.fork()
    if not pid:
        code = 98
        try:
            code = action()
        finally:
            os._exit(code)
    status = os.waitpid(pid, 0)[1]
    return os.waitstatus_to_exitcode(status)


def struck(scene, file, n, mode):
    """Run with the n-th call struck: exit code, committed surfaces, calls."""
    read, write = os.pipe()
    shim = ctypes.CDLL(None)

    def action():
        shim.crash_arm(str(file.parent).encode(), ctypes.c_long(n), mode)
        code = attempt(scene, file, lambda done, _: os.write(write, b"%d\n" % done))
        shim.crash_calls.restype = ctypes.c_long
        os.write(write, b"calls %d\n" % shim.crash_calls())
        shim.crash_arm(b"", ctypes.c_long(0), -1)
        return code

    code = forked(action)
    os.close(write)
    with os.fdopen(read) as pipe:
        said = pipe.read().split("\n")
    acked = max([int(line) for line in said if line.isdecimal()], default=0)
    calls = max([int(line.split()[1]) for line in said if line.startswith("calls")], default=0)
    return code, acked, calls


def found(scene, file, acked, digest):
    """What is wrong with what lies there: all that was committed must be readable and right."""
    if file.exists():
        problem, now = verify(file)
        return [] if not problem and now == digest else [f"final file: {problem or now}"]
    if not (parts_of(file) / RECORD).exists():
        return ["lost everything"] if acked else []
    try:
        run, wrong = Plan.open(parts_of(file)), []
    except StoreError as error:
        return [f"the record: {error}"]
    valid = run.shards()
    if sum(span.n for span in valid) < acked:
        wrong.append(f"{acked} surfaces were committed, {sum(span.n for span in valid)} are there")
    if len(valid) != len(list(run.shards_folder.glob("block-*.h5"))):
        wrong.append("a shard is there and not whole")
    for span in valid:
        for name, values in made_up(None, span, 1).items():
            if not np.array_equal(read_tables(run.shard_path(span))[name], values):
                wrong.append(f"{span}: {name} is wrong")
    return wrong


def trial(scene, folder, n, mode, digest):
    """Strike at call n, look, go on: problems, and whether the call was reached."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    file = folder / "e.h5"
    code, acked, calls = struck(scene, file, n, mode)
    wrong = [] if code in (0, 1, -signal.SIGKILL) else [f"exit code {code}"]
    if mode in (3, 4) and code < 0:
        wrong.append(f"crashed with signal {-code}")
    wrong += found(scene, file, acked, digest)
    if forked(lambda: attempt(scene, file)) or not file.exists():
        wrong.append("did not go on")
    elif verify(file) != ("", digest):
        wrong.append("another digest after going on")
    if [path.name for path in folder.iterdir()] != ["e.h5"]:
        wrong.append(f"left behind: {sorted(path.name for path in folder.iterdir())}")
    return wrong, calls < n and code == 0


def main(folder, mode, blocks, stride):
    prepare()
    scene = scene_of(blocks)
    whole = folder / "whole"
    whole.mkdir(parents=True)
    if attempt(scene, whole / "e.h5"):
        sys.exit("the run fails without being struck")
    digest = verify(whole / "e.h5")[1]
    gc.collect()
    problems, n = {}, 1
    while True:
        wrong, passed = trial(scene, folder / "trial", n, MODES[mode], digest)
        if wrong:
            problems[n] = wrong
        if passed:
            break
        n += stride
    sys.stdout.write(json.dumps({"points": (n - 1) // stride, "problems": problems}) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1)
