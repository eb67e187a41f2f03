"""Random ``kill -9`` of all that writes ensembles: ``python runs/reliability/kills.py [KILLS [SEED]]``.

Runs that are one block, runs in blocks, extensions, jobs that share a run, and merges: each is killed at
random moments, several times in a row, and repeated at once. Prints one JSON line: kills of each kind; blocks
that were committed and are gone (lost), files with another digest than the undisturbed run's (wrong) or with
anything beside them (left), children that outlived their parent, and commands that did not go on (stuck). All
but the kills should be 0.

The surfaces are made up: what is tried here is the store. Merging is done by a process of its own, as always;
in nine trials of ten it is forked, with the same pipe to its parent, which saves the start of a Python.
"""

import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "crash"))

import harness

from mcgw.errors import RunError, StoreError
from mcgw.jobs import merging, running
from mcgw.machine.child_process import ChildError
from mcgw.machine.lifeline import end_with
from mcgw.store import ensembles, lock, merged_file
from mcgw.store.run_folder import RunFolder, parts_of

BLOCKS = 12
WANTED = harness.scene_of(BLOCKS)
ONE = replace(WANTED, n_surfaces=harness.ROWS)
HALF = replace(WANTED, n_surfaces=harness.ROWS * BLOCKS // 2 + 3)
_STARTED = merging._merge_in_child
_DYING = 30.0  # seconds that a child has to follow its parent: a machine may be busy


def run(scene):
    """Draw a scene, as `mcgw run` does."""
    return lambda file: running.run(scene, file)


def job(number):
    """Draw a share, as `mcgw run --shard` does."""
    return lambda file: running.run_part(WANTED, file, running.Part(number, 2))


# What lies there before, what is killed again and again, and what ends it.
KINDS = {
    "one block": ([], [run(ONE)]),
    "blocks": ([], [run(WANTED)]),
    "extension": ([run(HALF)], [run(WANTED)]),
    "one block grows": ([run(replace(ONE, n_surfaces=3))], [run(ONE)]),
    "jobs": ([], [job(1), job(2), merging.merge]),
    "merge": ([job(1), job(2)], [merging.merge]),
}


def merged_by_fork(folder, path, temporary):
    """Merge in a child that ends with its parent."""
    pipe, ours = os.pipe()
    pid = os.fork()
    if not pid:
        code = 1
        try:
            os.close(ours)
            end_with(pipe)
            merged_file.merge_into(folder, path, temporary)
            code = 0
        finally:
            os._exit(code)
    os.close(pipe)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    os.close(ours)
    if code:
        raise ChildError(f"exit code {code}", "")


def forked(action, file):
    """Begin an action in a process of its own."""
    pid = os.fork()
    if not pid:
        code = 1
        try:
            action(file)
            code = 0
        except (RunError, StoreError, OSError) as error:
            sys.stderr.write(f"{error}\n")
        finally:
            os._exit(code)
    return pid


def done(action, file):
    """Exit code of an action that is left alone."""
    return os.waitstatus_to_exitcode(os.waitpid(forked(action, file), 0)[1])


def children(pid):
    """Processes that a process has begun."""
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []


def lives(pid):
    """Whether a process is there and not only waits to be counted out."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def outlived(pids):
    """How many processes are still there after a while; these are then killed."""
    until = time.monotonic() + _DYING
    alive = list(pids)
    while alive and time.monotonic() < until:
        alive = [pid for pid in alive if lives(pid)]
        time.sleep(0.005)
    for pid in alive:
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    return len(alive)


def committed(file):
    """Surfaces that lie there, in the file or in shards of its run."""
    held = set()
    if file.exists():
        held.update(range(ensembles.open_ensemble(file).n_surfaces))
    if (parts_of(file) / "run.toml").is_file():
        for shard in RunFolder.open(parts_of(file)).shards():
            held.update(range(shard.span.first, shard.span.stop))
    return held


def struck(action, file, after, count, *, wait):
    """Kill an action; whether it was still at work."""
    before = committed(file)
    pid = forked(action, file)
    time.sleep(after)
    begun = children(pid)
    os.kill(pid, signal.SIGKILL)
    killed = os.waitpid(pid, 0)[1] == signal.SIGKILL
    if wait:  # else the next command comes while a child may still be dying
        count["outlived"] += outlived(begun)
    count["lost"] += len(before - committed(file))
    return killed


def trial(kind, folder, dice, count, expected):
    """Kill every step of one kind some times, let it go on, and look at what is there."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    file = folder / "e.h5"
    before, steps = KINDS[kind]
    merging = dice.choices(list(expected), weights=[9, 1])[0]
    merging._merge_in_child = merging
    span, right = expected[merging]
    for action in before:
        count["stuck"] += done(action, file) != 0
    for action in steps:
        while dice.random() < 0.7:
            after, wait = dice.uniform(0, span), dice.random() < 0.5
            if struck(action, file, after, count, wait=wait):
                count[kind] += 1
        count["stuck"] += done(action, file) != 0  # the same command, repeated at once
    problem, digest = ensembles.verify(file) if file.exists() else ("none", "")
    count["wrong"] += bool(problem) or digest != right
    count["left"] += [path.name for path in folder.iterdir()] != ["e.h5"]


def undisturbed(kind, merging, folder):
    """Time of the last step of a kind, and its digest."""
    merging._merge_in_child = merging
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    file = folder / "e.h5"
    before, steps = KINDS[kind]
    for action in (*before, *steps[:-1]):
        assert done(action, file) == 0
    begin = time.perf_counter()
    assert done(steps[-1], file) == 0
    return 1.1 * (time.perf_counter() - begin), ensembles.verify(file)[1]


def main(kills, seed, folder):
    """As many kills, spread over all kinds alike."""
    harness.prepare()
    lock.PATIENCE = 1.0
    dice = random.Random(seed)
    count = {"lost": 0, "wrong": 0, "left": 0, "outlived": 0, "stuck": 0, **dict.fromkeys(KINDS, 0)}
    ways = (merged_by_fork, _STARTED)
    expected = {kind: {way: undisturbed(kind, way, folder / "whole") for way in ways} for kind in KINDS}
    while sum(count[kind] for kind in KINDS) < kills:
        least = min(KINDS, key=lambda kind: count[kind])
        trial(least, folder / "trial", dice, count, expected[least])
        print(json.dumps(count), file=sys.stderr)
    print(json.dumps({"kills": sum(count[kind] for kind in KINDS), **count}))


if __name__ == "__main__":
    memory = Path("/dev/shm")  # flushing is quick there: what is tried is the order of the calls
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as place:
        words = [int(word) for word in sys.argv[1:]]
        main(words[0] if words else 200, words[1] if len(words) > 1 else 1, Path(place))
