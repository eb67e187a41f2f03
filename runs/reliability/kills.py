"""Random ``kill -9`` of all that writes ensembles: ``python runs/reliability/kills.py [KILLS [SEED]]``.

Runs that are one block, runs in blocks, extensions, jobs that share a run, and merges: each is killed at
random moments, several times in a row, and repeated at once. Prints one JSON line: kills of each kind; blocks
that were committed and are gone (lost), files with another digest than the undisturbed run's (wrong) or with
anything beside them (left), and commands that did not go on (stuck). All but the kills should be 0.

The surfaces are made up: what is tried here is the store.
"""

import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "crash"))

import harness

from mcgw.errors import RunError, StoreError
from mcgw.jobs import making, running
from mcgw.store import ensembles, lock
from mcgw.store.lock import parts_of
from mcgw.store.run_folder import RECORD, RunFolder

BLOCKS = 12
WANTED = harness.scene_of(BLOCKS)
ONE = replace(WANTED, n_surfaces=harness.ROWS)
HALF = replace(WANTED, n_surfaces=harness.ROWS * BLOCKS // 2 + 3)


def run(scene):
    """Draw a scene, as `mcgw run` does."""
    return lambda file: running.run(scene, file)


def job(number):
    """Draw a share, as `mcgw run --shard` does."""
    return lambda file: running.run(WANTED, file, shard=f"{number}/2")


# What lies there before, what is killed again and again, and what ends it.
KINDS = {
    "one block": ([], [run(ONE)]),
    "blocks": ([], [run(WANTED)]),
    "extension": ([run(HALF)], [run(WANTED)]),
    "one block grows": ([run(replace(ONE, n_surfaces=3))], [run(ONE)]),
    "jobs": ([], [job(1), job(2), making.merge]),
    "merge": ([job(1), job(2)], [making.merge]),
}


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


def committed(file):
    """Surfaces that lie there, in the file or in shards of its run."""
    held = set()
    if file.exists():
        held.update(range(ensembles.open_ensemble(file).n_surfaces))
    if (parts_of(file) / RECORD).is_file():
        for shard in RunFolder.open(parts_of(file)).shards():
            held.update(range(shard.span.first, shard.span.stop))
    return held


def struck(action, file, after, count):
    """Kill an action; whether it was still at work."""
    before = committed(file)
    pid = forked(action, file)
    time.sleep(after)
    os.kill(pid, signal.SIGKILL)
    killed = os.waitpid(pid, 0)[1] == signal.SIGKILL
    count["lost"] += len(before - committed(file))
    return killed


def trial(kind, folder, dice, count, expected):
    """Kill every step of one kind some times, let it go on, and look at what is there."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    file = folder / "e.h5"
    before, steps = KINDS[kind]
    span, right = expected
    for action in before:
        count["stuck"] += done(action, file) != 0
    for action in steps:
        while dice.random() < 0.7:
            count[kind] += struck(action, file, dice.uniform(0, span), count)
        count["stuck"] += done(action, file) != 0  # the same command, repeated at once
    problem, digest = ensembles.verify(file) if file.exists() else ("none", "")
    count["wrong"] += bool(problem) or digest != right
    count["left"] += [path.name for path in folder.iterdir()] != ["e.h5"]


def undisturbed(kind, folder):
    """Time of the last step of a kind, and its digest."""
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
    count = {"lost": 0, "wrong": 0, "left": 0, "stuck": 0, **dict.fromkeys(KINDS, 0)}
    expected = {kind: undisturbed(kind, folder / "whole") for kind in KINDS}
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
